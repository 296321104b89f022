!> Settling times that vary smoothly with the start, for pictures: whole numbers of periods would show as steps.
module kz_live_smooth
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_ellipses, only: ellipse_square
  use kz_vector_map, only: flow_t, WIDTH
  implicit none
  private
  public :: smooth_times

  !> Periods after which a motion that is not near a strobe point is left; and what is near, the square of an ellipse's
  !> norm: so deep inside it motions are linear.
  integer, parameter :: LONGEST = 200
  real(dp), parameter :: NEAR = 0.04_dp

contains

  !> time(i) becomes the time at which motion i comes into an ellipse of its attractor. At the first period n deep
  !> inside it, where the square of the ellipse's norm is q < NEAR, that was log(1/q)/(2 rate) periods before n, if the
  !> norm fell at the attractor's rate: so n and q together vary smoothly where the multipliers are complex, and nearly
  !> so where one of them is much larger.
  subroutine smooth_times(flow, attractors, label, state, time)
    class(flow_t), intent(inout) :: flow !< the scene's map
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    integer(c_int32_t), intent(in) :: label(:) !< [n] attractor from 1; others are left as they are
    real(dp), intent(in) :: state(:, :) !< [2, n] in the map's coordinates
    real(dp), intent(inout) :: time(:) !< [n] periods
    integer :: first, last, n
    real(dp) :: gained(WIDTH)

    do first = 1, size(label), WIDTH
      last = min(size(label), first + WIDTH - 1)
      n = last - first + 1
      call flow%put_all(state(1, first:last), state(2, first:last))
      call approach(flow, attractors, label(first:last), gained(:n))
      time(first:last) = max(0.0_dp, time(first:last) + gained(:n))
    end do
  end subroutine smooth_times

  subroutine approach(flow, attractors, label, gained)
    class(flow_t), intent(inout) :: flow
    type(attractor_t), intent(in) :: attractors(:)
    integer(c_int32_t), intent(in) :: label(:)
    real(dp), intent(out) :: gained(:)
    logical :: open(size(label))
    real(dp) :: square
    integer :: period, lane

    gained = 0
    do lane = 1, size(label)
      open(lane) = label(lane) > 0
      if (open(lane)) open(lane) = attractors(label(lane))%period > 0
    end do
    do period = 0, LONGEST
      if (period > 0) call flow%advance(size(label))
      do lane = 1, size(label)
        if (.not. open(lane)) cycle
        square = least_square(attractors(label(lane)), flow%u(lane), flow%v(lane))
        if (.not. square < NEAR) cycle
        open(lane) = .false.
        gained(lane) = period - 0.5_dp*log(max(square, tiny(square)))/attractors(label(lane))%lyapunov
      end do
      if (.not. any(open)) return
    end do
  end subroutine approach

  !> The least square of the norms of an attractor's ellipses at a state.
  pure function least_square(attractor, u, v) result(square)
    type(attractor_t), intent(in) :: attractor
    real(dp), intent(in) :: u, v
    real(dp) :: square
    integer :: j

    square = huge(square)
    do j = 1, attractor%period
      square = min(square, ellipse_square(attractor, j, u, v))
    end do
  end function least_square

end module kz_live_smooth
