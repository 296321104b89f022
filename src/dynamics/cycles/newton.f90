!> Newton's method on the n-period stroboscopic map, and how well it places a fixed point.
module kz_cycles_newton
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_maps_matrices, only: solved, IDENTITY
  use kz_maps_states, only: angle_difference, same_state
  implicit none
  private
  public :: newton, n_periods, minimal_period

  !> rad: a fixed point must be placed better than states are distinguished.
  real(dp), parameter :: PLACED = 1e-8_dp

contains

  !> Moves x = (half-turns, velocity) to the fixed point of the n-period map near it. `found`: its place is accurate
  !> enough. `blurred`: the steps end, but rounding leaves the place open by more than that.
  subroutine newton(flow, n, max_distance, x, found, blurred)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: n !< drive periods of the map
    real(dp), intent(in) :: max_distance !< farthest that the cycle may lie from the start, rad
    real(dp), intent(inout) :: x(2) !< start, in; fixed point, out: half-turns, rad per drive radian
    logical, intent(out) :: found !< whether it is placed well enough
    logical, intent(out) :: blurred !< whether it was left undecided by rounding
    !> Steps below SMALL that shrink no more are due to rounding, if there are several.
    real(dp), parameter :: SMALL = 1e-5_dp
    integer, parameter :: MOST_STALLS = 3
    real(dp) :: start(2), residual(2), step(2), matrix(2, 2), size_now, size_before
    integer :: iteration, stalls

    start = x
    stalls = 0
    size_before = huge(1.0_dp)
    found = .false.
    blurred = .false.
    do iteration = 1, 40
      call n_periods(flow, n, 1, x, residual, matrix)
      step = solved(matrix, residual)
      if (.not. all(abs(step) < huge(1.0_dp))) return
      size_now = norm2(step)
      if (size_now < 1e-9_dp .and. size_now >= 0.5_dp*size_before) exit
      if (size_now < SMALL .and. size_now >= 0.9_dp*size_before) stalls = stalls + 1
      if (stalls > MOST_STALLS) exit
      x = x - [step(1)/PI, step(2)]
      if (norm2([PI, 1.0_dp]*(x - start)) > max_distance) return
      if (size_now < 1e-15_dp) exit
      size_before = size_now
    end do
    x(1) = angle_difference(x(1), 0.0_dp)
    if (size_now >= SMALL) return
    blurred = max(size_now, uncertainty(flow, n, x, matrix)) >= PLACED
    found = .not. blurred
  end subroutine newton

  !> How far x may lie from the fixed point of the n-period map, rad: so far from x ends Newton's method that starts a
  !> few roundings beside it. Near a bifurcation, where matrix - 1 is nearly singular, the rounding of F^n is amplified
  !> by the inverse, and by chance any state there comes back to the last bit: Newton's own last step says nothing.
  function uncertainty(flow, n, x, matrix) result(farthest)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: x(2), matrix(2, 2)
    real(dp) :: farthest
    real(dp), parameter :: ROUNDING = 1e-15_dp
    integer, parameter :: BESIDE = 8
    real(dp) :: start(2, BESIDE), residual(2)
    integer :: i

    do i = 1, BESIDE
      start(:, i) = x + ROUNDING*(i - BESIDE/2)*[1, -1]
      call flow%put(i, start(1, i), start(2, i))
    end do
    call flow%to_map(BESIDE)
    do i = 1, n
      call flow%advance(BESIDE)
    end do
    call flow%to_physical(BESIDE)
    farthest = 0
    do i = 1, BESIDE
      residual = [PI*angle_difference(flow%u(i), start(1, i)), flow%v(i) - start(2, i)]
      farthest = max(farthest, norm2([PI, 1.0_dp]*(start(:, i) - x) - solved(matrix, residual)))
    end do
  end function uncertainty

  !> residual = F^n(x) - x without whole turns (rad), matrix = the derivative of F^n, of each state.
  subroutine n_periods(flow, n, states, x, residual, matrix)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: n !< drive periods of the map
    integer, intent(in) :: states !< at most WIDTH
    real(dp), intent(in) :: x(2, states) !< physical states: half-turns, rad per drive radian
    real(dp), intent(out) :: residual(2, states) !< image less state: rad, rad per drive radian
    real(dp), intent(out) :: matrix(2, 2, states) !< derivative of the n-period map: rad, rad per drive radian
    real(dp) :: tangent(2, 2, WIDTH)
    integer :: i

    call flow%put_all(x(1, :), x(2, :))
    tangent(:, :, :states) = spread(IDENTITY, 3, states)
    call flow%to_map(states, tangent)
    do i = 1, n
      call flow%advance_tangent(states, tangent)
    end do
    call flow%to_physical(states, tangent)
    residual(1, :) = PI*angle_difference(flow%u(:states), x(1, :))
    residual(2, :) = flow%v(:states) - x(2, :)
    matrix = tangent(:, :, :states)
  end subroutine n_periods

  !> The smallest divisor of n after which the orbit of x returns to x.
  function minimal_period(flow, n, x) result(period)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: n !< a period that closes the cycle
    real(dp), intent(in) :: x(2) !< one of its points: half-turns, rad per drive radian
    integer :: period

    call flow%put(1, x(1), x(2))
    do period = 1, n - 1
      call flow%advance(1)
      if (mod(n, period) /= 0) cycle
      if (same_state(flow%u(1), flow%v(1), x(1), x(2))) return
    end do
    period = n
  end function minimal_period

end module kz_cycles_newton
