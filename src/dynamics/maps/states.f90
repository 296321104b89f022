!> States of the stroboscopic map, (half-turns, rad per drive radian): their distance, and when two count as one.
module kz_maps_states
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  implicit none
  private
  public :: wrapped, states_to_map, states_to_physical, angle_difference, separation, same_state, midperiod_angle, &
            rounded, MIDPERIOD

  !> States nearer than this are one: half-turns and rad per drive radian together.
  real(dp), parameter :: SAME = 1e-7_dp
  !> Half-turns of a free flight of unit velocity from the strobe to mid-period. (Loops over vectors take it: a function
  !> of another file would be called state by state.)
  real(dp), parameter :: MIDPERIOD = 1

contains

  !> An angle in half-turns, wrapped to [-1, 1].
  elemental function wrapped(u) result(w)
    real(dp), intent(in) :: u !< half-turns
    real(dp) :: w

    w = u - 2*anint(0.5_dp*u)
  end function wrapped

  !> Shortest difference of two angles in half-turns, in [-1, 1].
  elemental function angle_difference(a, b) result(d)
    real(dp), intent(in) :: a, b !< half-turns
    real(dp) :: d

    d = wrapped(a - b)
  end function angle_difference

  !> Distance of (u1, v1) and (u2, v2): rad and rad per drive radian together.
  elemental function separation(u1, v1, u2, v2) result(d)
    real(dp), intent(in) :: u1, v1, u2, v2 !< half-turns, rad per drive radian
    real(dp) :: d

    d = hypot(PI*angle_difference(u1, u2), v1 - v2)
  end function separation

  !> True if (u1, v1) and (u2, v2) count as one state.
  elemental function same_state(u1, v1, u2, v2) result(one)
    real(dp), intent(in) :: u1, v1, u2, v2 !< half-turns, rad per drive radian
    logical :: one

    one = abs(angle_difference(u1, u2)) + abs(v1 - v2) < SAME
  end function same_state

  !> The angle at mid-period of a free flight from (u, v), in half-turns, not wrapped. The map table and the regions are
  !> grids over it and the velocity: seen from mid-period the map varies half as fast with the velocity, and
  !> interpolation errs 2**order less.
  elemental function midperiod_angle(u, v) result(w)
    real(dp), intent(in) :: u, v !< angle at the strobe, half-turns, rad per drive radian
    real(dp) :: w

    w = u + MIDPERIOD*v
  end function midperiod_angle

  !> A number rounded to 1e-9, as it is compared where an order depends on it.
  elemental function rounded(x) result(n)
    real(dp), intent(in) :: x !< a number of order 1
    real(dp) :: n

    n = anint(x*1e9_dp)
  end function rounded

  !> Turns physical states into those in the flow's coordinates.
  subroutine states_to_map(flow, u, v)
    class(flow_t), intent(inout) :: flow !< the flow whose coordinates are entered
    real(dp), intent(inout) :: u(:), v(:) !< half-turns, rad per drive radian; in and out

    call change_states(flow, .true., u, v)
  end subroutine states_to_map

  !> Turns states in the flow's coordinates into physical ones.
  subroutine states_to_physical(flow, u, v)
    class(flow_t), intent(inout) :: flow !< the flow whose coordinates are left
    real(dp), intent(inout) :: u(:), v(:) !< half-turns, rad per drive radian; in and out

    call change_states(flow, .false., u, v)
  end subroutine states_to_physical

  subroutine change_states(flow, entering, u, v)
    class(flow_t), intent(inout) :: flow
    logical, intent(in) :: entering
    real(dp), intent(inout) :: u(:), v(:)
    integer :: first, last, n

    do first = 1, size(u), WIDTH
      last = min(first + WIDTH - 1, size(u))
      n = last - first + 1
      call flow%put_all(u(first:last), v(first:last))
      if (entering) then
        call flow%to_map(n)
      else
        call flow%to_physical(n)
      end if
      u(first:last) = flow%u(:n)
      v(first:last) = flow%v(:n)
    end do
  end subroutine change_states

end module kz_maps_states
