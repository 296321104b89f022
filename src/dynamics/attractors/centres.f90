!> Cycles that slow orbits spiral around: the mean of a few hundred states is near them, long before the orbit is.
module kz_attractors_centres
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: PI
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private
  public :: find_centre

  !> Periods for which orbits are followed.
  integer, parameter, public :: CENTRED = 256
  !> The longest period of the cycles, and how far from them orbits may be, rad.
  integer, parameter :: MOST_PERIODS = 32
  real(dp), parameter :: WIDEST = 0.7_dp

contains

  !> The state around which an orbit turns, seen every n periods: the mean of its states, if they keep together.
  subroutine find_centre(most, u, v, n, centre, spread)
    integer, intent(in) :: most !< drive periods of a cycle at most
    real(dp), intent(in) :: u(0:), v(0:) !< the orbit, half-turns, rad per drive radian
    integer, intent(out) :: n !< least periods for which the states keep together nearly as much as for any; 0 = none
    real(dp), intent(out) :: centre(2), spread !< rad: the farthest state from the centre
    real(dp) :: centres(2, min(most, MOST_PERIODS)), spreads(min(most, MOST_PERIODS))

    do n = 1, size(spreads)
      call average(u(::n), v(::n), centres(:, n), spreads(n))
    end do
    n = max(1, findloc(spreads <= 2*minval(spreads), .true., dim=1))
    centre = centres(:, n)
    spread = spreads(n)
    if (.not. spread <= WIDEST) n = 0
  end subroutine find_centre

  !> Mean of states with smooth weights, which suppress oscillations, and its distance from the farthest state, rad.
  pure subroutine average(u, v, mean, spread)
    real(dp), intent(in) :: u(:), v(:)
    real(dp), intent(out) :: mean(2), spread
    real(dp) :: weight(size(u))
    integer :: i

    weight = [(sin(PI*(i - 0.5_dp)/size(u))**2, i=1, size(u))]
    weight = weight/sum(weight)
    mean = [u(1) + sum(weight*angle_difference(u, u(1))), sum(weight*v)]
    spread = maxval(separation(u, v, mean(1), mean(2)))
  end subroutine average

end module kz_attractors_centres
