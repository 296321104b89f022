!> Multiple shooting: Newton's method for a closed orbit with all its points unknown. Errors do not grow along the
!> orbit, so that points that are right to some 0.1 rad lead to it, however strongly it repels.
module kz_saddles_shooting
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_maps_matrices, only: solve
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private
  public :: shoot, smallest_period, closed_orbit_t

  !> Results of the iteration beside the points of the orbit.
  type :: closed_orbit_t
    real(dp) :: step = huge(1.0_dp) !< the longest step of a point in the last iteration, rad: how well it is closed
    real(dp) :: blur = huge(1.0_dp) !< how far the rounding of the map may move a point, rad
    real(dp) :: matrix(2, 2) = 0    !< derivative of the map over the whole orbit: rad, rad per drive radian
    integer :: winding = 0          !< net turns
  end type closed_orbit_t

  !> Most iterations; those after which steps must be short (rad); the longest step of a point, rad.
  integer, parameter :: MOST = 30, ENOUGH = 12
  real(dp), parameter :: SHORT = 0.05_dp, LONGEST = 0.3_dp
  !> rad: steps below it that shrink no more are due to rounding; the error of the map by rounding.
  real(dp), parameter :: SMALL = 1e-9_dp, ROUNDING = 4e-15_dp

contains

  !> Moves the points to the closed orbit near them with as many periods as points, by Newton steps until a step is
  !> shorter than `close`.
  subroutine shoot(flow, close, orbit, closed)
    class(flow_t), intent(inout) :: flow !< the map of one drive period in physical coordinates
    real(dp), intent(in) :: close !< rad
    real(dp), intent(inout) :: orbit(:, :) !< points in order of time, at most WIDTH: half-turns, rad per drive radian
    type(closed_orbit_t), intent(out) :: closed !< how well it is closed
    real(dp) :: matrix(size(orbit), size(orbit)), side(size(orbit), 3), before
    logical :: regular
    integer :: iteration

    do iteration = 1, MOST
      call linearise(flow, orbit, matrix, side, closed)
      call solve(matrix, side, regular)
      before = closed%step
      closed%step = huge(1.0_dp)
      if (.not. regular) return
      closed%step = longest_of(side(:, 1))
      closed%blur = max(longest_of(side(:, 2)), longest_of(side(:, 3)))
      side(:, 1) = side(:, 1)*min(1.0_dp, LONGEST/closed%step)
      orbit(1, :) = angle_difference(orbit(1, :), -side(1::2, 1)/PI)
      orbit(2, :) = orbit(2, :) + side(2::2, 1)
      if (closed%step < close .or. (closed%step < SMALL .and. closed%step >= 0.5_dp*before)) return
      if (iteration >= ENOUGH .and. closed%step > SHORT) return
    end do
  end subroutine shoot

  !> The linear equations of the steps of all points, F(x(i)) + DF step(i) = x(i+1) + step(i+1), and two more right-hand
  !> sides as large as rounding.
  subroutine linearise(flow, orbit, matrix, side, closed)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: orbit(:, :)
    real(dp), intent(out) :: matrix(:, :), side(:, :)
    type(closed_orbit_t), intent(inout) :: closed !< takes the derivative and the winding
    real(dp) :: tangent(2, 2, WIDTH), flight
    integer :: n, i, next

    n = size(orbit, 2)
    do i = 1, n
      call flow%put(i, orbit(1, i), orbit(2, i))
      tangent(:, :, i) = reshape([1, 0, 0, 1], [2, 2])
    end do
    call flow%advance_tangent(n, tangent)
    closed%matrix = reshape([1, 0, 0, 1], [2, 2])
    matrix = 0
    flight = 0
    do i = 1, n
      next = mod(i, n) + 1
      closed%matrix = matmul(tangent(:, :, i), closed%matrix)
      flight = flight + 2*real(flow%turns(i), dp) + (flow%u(i) - orbit(1, i))
      matrix(2*i - 1:2*i, 2*i - 1:2*i) = tangent(:, :, i)
      matrix(2*i - 1, 2*next - 1) = matrix(2*i - 1, 2*next - 1) - 1
      matrix(2*i, 2*next) = matrix(2*i, 2*next) - 1
      side(2*i - 1:2*i, 1) = [PI*angle_difference(orbit(1, next), flow%u(i)), orbit(2, next) - flow%v(i)]
      side(2*i - 1:2*i, 2) = ROUNDING*[1, 1]
      side(2*i - 1:2*i, 3) = ROUNDING*[1, -1]
    end do
    closed%winding = nint(0.5_dp*flight)
  end subroutine linearise

  !> The longest step of a point.
  pure function longest_of(steps) result(longest)
    real(dp), intent(in) :: steps(:) !< angle and velocity of each point, rad
    real(dp) :: longest

    longest = maxval(hypot(steps(1::2), steps(2::2)))
  end function longest_of

  !> The smallest divisor of the period of a closed orbit after which all points return.
  pure function smallest_period(x, one) result(period)
    real(dp), intent(in) :: x(:, :) !< its points: half-turns, rad per drive radian
    real(dp), intent(in) :: one !< points nearer than this are one, rad
    integer :: period

    do period = 1, size(x, 2) - 1
      if (mod(size(x, 2), period) /= 0) cycle
      if (all(separation(x(1, :), x(2, :), cshift(x(1, :), period), cshift(x(2, :), period)) < one)) return
    end do
    period = size(x, 2)
  end function smallest_period

end module kz_saddles_shooting
