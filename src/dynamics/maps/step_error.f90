!> The error of one drive period, measured before anything is labelled: by step doubling, for each class of speeds; and
!> the interpolation error of the map table.
module kz_maps_step_error
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use kz_vector_map, only: map_t, flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_flow
  use kz_model_pendulum, only: pendulum_t, stiffness, is_mirrored
  use kz_vector_step_table, only: numerics_t
  use kz_vector_kept_errors, only: recall_errors, keep_errors
  use kz_maps_states, only: separation
  implicit none
  private
  public :: error_of_table

  !> States of a class of speeds.
  integer, parameter :: STATES = 8*WIDTH
  !> Such a sample has seen more than the inverse of this of the largest error (tests/extremes/step_error.c holds it
  !> against dense ones).
  real(dp), parameter :: SAFETY = 2

contains

  !> error(c) = an upper estimate of the error of one period of states with speeds from speed(c) to speed(c + 1), in rad
  !> (velocity and angle together): the largest of STATES, SAFETY times; huge where a state is lost: not finite, or
  !> faster than friction and drive can make it.
  subroutine step_errors(pendulum, numerics, n, speed, error) bind(C, name='kz_step_errors')
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: speed(n + 1)
    real(dp), intent(out) :: error(n)
    type(numerics_t) :: halved
    class(flow_t), allocatable :: flow, finer
    real(dp) :: limit, largest
    integer(c_int64_t) :: c
    integer :: first

    if (recall_errors(numerics%series, key_of(pendulum, numerics, speed), error)) return
    halved = numerics_t(numerics%scheme, 2*numerics%steps_per_period, fastest=numerics%fastest, series=numerics%series)
    call make_flow(pendulum, numerics, .true., flow)
    call make_flow(pendulum, halved, .true., finer, refined=2)
    do c = 1, n
      largest = 0
      limit = speed(c + 1) + 2*PI*stiffness(pendulum)
      do first = 1, STATES, WIDTH
        call advance_class(flow, first, speed(c), speed(c + 1), is_mirrored(pendulum) /= 0)
        call advance_class(finer, first, speed(c), speed(c + 1), is_mirrored(pendulum) /= 0)
        largest = max(largest, difference(flow, finer, limit))
      end do
      error(c) = merge(SAFETY*largest, largest, largest < huge(largest)/SAFETY)
    end do
    call keep_errors(numerics%series, key_of(pendulum, numerics, speed), error)
  end subroutine step_errors

  !> The bits of all numbers that the errors depend on.
  pure function key_of(pendulum, numerics, speed) result(key)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    real(dp), intent(in) :: speed(:)
    integer(c_int64_t), allocatable :: key(:)

    key = [transfer(pendulum, [0_c_int64_t]), &
           int([numerics%scheme, numerics%steps_per_period, numerics%drift_terms, numerics%kick_terms], c_int64_t), &
           transfer(numerics%fastest, 0_c_int64_t), transfer(speed, [0_c_int64_t])]
  end function key_of

  !> A period of states first .. first + WIDTH - 1 of STATES over the whole circle, both ends of the speeds included;
  !> the others are their mirror images, or every second one goes the other way.
  subroutine advance_class(map, first, slowest, fastest, mirrored)
    class(map_t), intent(inout) :: map
    integer, intent(in) :: first
    real(dp), intent(in) :: slowest, fastest
    logical, intent(in) :: mirrored
    real(dp), parameter :: GOLDEN = 0.61803398874989484820_dp
    integer :: lane, i, sign

    do lane = 1, WIDTH
      i = first + lane - 2
      sign = merge(1, 1 - 2*mod(i, 2), mirrored)
      call map%put(lane, 2*modulo(i*GOLDEN, 1.0_dp) - 1, sign*(slowest + (fastest - slowest)*(i/real(STATES - 1, dp))))
    end do
    call map%advance_physical(WIDTH)
  end subroutine advance_class

  !> Largest distance of two maps' states, rad. `limit` bounds true speeds: |v'| <= |k| + |m| besides friction.
  function difference(map, other, limit) result(largest)
    class(map_t), intent(in) :: map, other
    real(dp), intent(in) :: limit
    real(dp) :: largest
    integer :: lane

    largest = 0
    do lane = 1, WIDTH
      if (is_lost(map, lane, limit) .or. is_lost(other, lane, limit)) then
        largest = huge(largest)
      else
        largest = max(largest, separation(map%u(lane), map%v(lane), other%u(lane), other%v(lane)))
      end if
    end do
  end function difference

  pure function is_lost(map, lane, limit) result(lost)
    class(map_t), intent(in) :: map
    integer, intent(in) :: lane
    real(dp), intent(in) :: limit
    logical :: lost

    lost = .not. (ieee_is_finite(map%u(lane)) .and. abs(map%v(lane)) <= 1.01_dp*limit)
  end function is_lost

  !> The largest error of one period of the map table among states [2][n*WIDTH] within it, rad.
  function error_of_table(flow, table_map, state) result(table_error)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    class(map_t), intent(inout) :: table_map !< the map whose error is measured
    real(dp), intent(in) :: state(:, :) !< (2, n): half-turns, rad per drive radian
    real(dp) :: table_error
    integer :: first

    table_error = 0
    do first = 1, size(state, 2), WIDTH
      call flow%put_all(state(1, first:first + WIDTH - 1), state(2, first:first + WIDTH - 1))
      call table_map%put_all(state(1, first:first + WIDTH - 1), state(2, first:first + WIDTH - 1))
      call flow%advance(WIDTH)
      call table_map%advance(WIDTH)
      table_error = max(table_error, difference(flow, table_map, huge(1.0_dp)/2))
    end do
  end function error_of_table

end module kz_maps_step_error
