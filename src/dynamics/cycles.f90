!> Attracting cycles of the stroboscopic map: Newton polish, multipliers, symmetry, mirror image.
module kz_dynamics_cycles
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: flow_t, WIDTH, PI
  implicit none
  private
  public :: attractor_t, sheared, polish_cycle, close_cycle, mirror_image, apart, listed_from_lowest, eigenvalues
  public :: n_periods, solved, minimal_period, orbit_of, same_state

  !> States nearer than this are one: half-turns and rad per drive radian together.
  real(dp), parameter :: SAME = 1e-7_dp
  !> So a cycle must be placed better, rad.
  real(dp), parameter :: PLACED = 1e-8_dp

  !> An attractor. Angles are half-turns in [-1, 1]; strobe points are in the order of time.
  type :: attractor_t
    integer :: period = 0          !< drive periods; 0 = aperiodic
    integer :: winding = 0         !< net turns per `period` drive periods
    logical :: symmetric = .false. !< the orbit is its own mirror image
    integer :: mirror = 0          !< number of the mirror image in the catalogue, from 1
    integer :: centre = 3          !< 0 down, 1 inverted, 2 rotating, 3 none of these
    real(dp) :: mean = 0           !< mean angle and velocity over time, half-turns and rad per drive radian
    real(dp) :: mean_velocity = 0
    real(dp) :: amplitude = 0      !< largest angle from the centre, rad
    complex(dp) :: multiplier(2) = 0
    real(dp) :: lyapunov = 0       !< largest exponent per drive period
    real(dp) :: lyapunov_error = 0
    real(dp), allocatable :: u(:)
    real(dp), allocatable :: v(:)
    !> Trapping ellipse of each point: form(1) du**2 + 2 form(2) du dv + form(3) dv**2 < 1; form = 0: none
    real(dp), allocatable :: form(:, :)
    !> Cells of the cover of a chaotic attractor
    integer, allocatable :: cover(:)
  end type attractor_t

contains

  !> Shortest difference of two angles in half-turns, in [-1, 1].
  elemental function apart(a, b) result(d)
    real(dp), intent(in) :: a
    real(dp), intent(in) :: b
    real(dp) :: d

    d = a - b
    d = d - 2*anint(0.5_dp*d)
  end function apart

  !> Are (u1, v1) and (u2, v2) one state?
  elemental function same_state(u1, v1, u2, v2) result(one)
    real(dp), intent(in) :: u1
    real(dp), intent(in) :: v1
    real(dp), intent(in) :: u2
    real(dp), intent(in) :: v2
    logical :: one

    one = abs(apart(u1, u2)) + abs(v1 - v2) < SAME
  end function same_state

  !> close_cycle, `found` only where the cycle attracts.
  subroutine polish_cycle(flow, beta, n, u, v, reach, cycle, found, blurred)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: beta
    integer, intent(in) :: n
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    real(dp), intent(in) :: reach
    type(attractor_t), intent(out) :: cycle
    logical, intent(out) :: found
    logical, intent(out) :: blurred

    call close_cycle(flow, beta, n, u, v, reach, cycle, found, blurred)
    if (.not. found) return
    found = abs(cycle%multiplier(1)) < 1
    if (.not. found) return
    cycle%lyapunov = log(abs(cycle%multiplier(1)))/cycle%period
    call symmetrise(cycle)
  end subroutine polish_cycle

  !> The angle at mid-period of a free flight from (u, v), in half-turns, not wrapped. The map table and the regions are grids over it
  !> and the velocity: seen from mid-period the map varies half as fast with the velocity, and interpolation errs 2**order less.
  elemental function sheared(u, v) result(w)
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    real(dp) :: w

    w = u + v
  end function sheared

  !> Newton's method on the n-period map from (u, v), with a fine flow. `found` only where it converges within `reach` of the
  !> start; the cycle, attracting or not, then has its true (minimal) period. `blurred` where it converges, but rounding leaves
  !> open where to: too near a bifurcation.
  subroutine close_cycle(flow, beta, n, u, v, reach, cycle, found, blurred)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: beta
    integer, intent(in) :: n
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    real(dp), intent(in) :: reach
    type(attractor_t), intent(out) :: cycle
    logical, intent(out) :: found
    logical, intent(out) :: blurred
    real(dp) :: x(2), matrix(2, 2)
    integer :: period

    x = [u, v]
    call newton(flow, n, reach, x, found, blurred)
    if (.not. found) return
    period = minimal_period(flow, n, x)
    if (period < n) call newton(flow, period, reach, x, found, blurred)
    if (.not. found) return
    call orbit_of(flow, period, x, cycle, matrix)
    cycle%multiplier = eigenvalues(matrix, exp(-2*PI*beta*period))
  end subroutine close_cycle

  !> x = (half-turns, velocity) becomes the fixed point of the n-period map near it: `found` where it is placed well enough,
  !> `blurred` where the steps end at more than that.
  subroutine newton(flow, n, reach, x, found, blurred)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: reach
    real(dp), intent(inout) :: x(2)
    logical, intent(out) :: found
    logical, intent(out) :: blurred
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
      call n_periods(flow, n, x, residual, matrix)
      step = solved(matrix, residual)
      if (.not. all(abs(step) < huge(1.0_dp))) return
      size_now = norm2(step)
      if (size_now < 1e-9_dp .and. size_now >= 0.5_dp*size_before) exit
      if (size_now < SMALL .and. size_now >= 0.9_dp*size_before) stalls = stalls + 1
      if (stalls > MOST_STALLS) exit
      x = x - [step(1)/PI, step(2)]
      if (norm2([PI, 1.0_dp]*(x - start)) > reach) return
      if (size_now < 1e-15_dp) exit
      size_before = size_now
    end do
    x(1) = apart(x(1), 0.0_dp)
    if (size_now >= SMALL) return
    blurred = max(size_now, uncertainty(flow, n, x, matrix)) >= PLACED
    found = .not. blurred
  end subroutine newton

  !> How far x may lie from the fixed point of the n-period map, rad: so far from x ends Newton's method that starts a few
  !> roundings beside it. Near a bifurcation, where matrix - 1 is nearly singular, the rounding of F^n is amplified by the inverse,
  !> and by chance any state there comes back to the last bit: Newton's own last step says nothing.
  function uncertainty(flow, n, x, matrix) result(farthest)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: x(2)
    real(dp), intent(in) :: matrix(2, 2)
    real(dp) :: farthest
    real(dp), parameter :: ROUNDING = 1e-15_dp
    integer, parameter :: BESIDE = 8
    real(dp) :: start(2, BESIDE), residual(2)
    integer :: i

    do i = 1, BESIDE
      start(:, i) = x + ROUNDING*(i - BESIDE/2)*[1, -1]
      call flow%put(i, start(1, i), start(2, i))
    end do
    do i = 1, n
      call flow%advance(BESIDE)
    end do
    farthest = 0
    do i = 1, BESIDE
      residual = [PI*apart(flow%u(i), start(1, i)), flow%v(i) - start(2, i)]
      farthest = max(farthest, norm2([PI, 1.0_dp]*(start(:, i) - x) - solved(matrix, residual)))
    end do
  end function uncertainty

  !> residual = F^n(x) - x with whole turns taken out (rad), matrix = its derivative + 1.
  subroutine n_periods(flow, n, x, residual, matrix)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: x(2)
    real(dp), intent(out) :: residual(2)
    real(dp), intent(out) :: matrix(2, 2)
    real(dp) :: tangent(2, 2, WIDTH)
    integer :: i

    call flow%put(1, x(1), x(2))
    tangent(:, :, 1) = reshape([1, 0, 0, 1], [2, 2])
    do i = 1, n
      call flow%advance_tangent(1, tangent)
    end do
    residual = [PI*apart(flow%u(1), x(1)), flow%v(1) - x(2)]
    matrix = tangent(:, :, 1)
  end subroutine n_periods

  !> Solves (matrix - 1) step = residual.
  pure function solved(matrix, residual) result(step)
    real(dp), intent(in) :: matrix(2, 2)
    real(dp), intent(in) :: residual(2)
    real(dp) :: step(2)
    real(dp) :: a, b, c, d

    a = matrix(1, 1) - 1
    b = matrix(1, 2)
    c = matrix(2, 1)
    d = matrix(2, 2) - 1
    step = [d*residual(1) - b*residual(2), a*residual(2) - c*residual(1)]/(a*d - b*c)
  end function solved

  !> The smallest divisor of n after which the orbit of x is back.
  function minimal_period(flow, n, x) result(period)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: x(2)
    integer :: period

    call flow%put(1, x(1), x(2))
    do period = 1, n - 1
      call flow%advance(1)
      if (mod(n, period) /= 0) cycle
      if (same_state(flow%u(1), flow%v(1), x(1), x(2))) return
    end do
    period = n
  end function minimal_period

  !> Strobe points, winding and monodromy of the closed orbit through x.
  subroutine orbit_of(flow, period, x, cycle, matrix)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: period
    real(dp), intent(in) :: x(2)
    type(attractor_t), intent(inout) :: cycle
    real(dp), intent(out) :: matrix(2, 2)
    real(dp) :: tangent(2, 2, WIDTH)
    integer :: i

    cycle%period = period
    allocate (cycle%u(period), cycle%v(period), cycle%form(3, period))
    cycle%form = 0
    call flow%put(1, x(1), x(2))
    tangent(:, :, 1) = reshape([1, 0, 0, 1], [2, 2])
    do i = 1, period
      cycle%u(i) = flow%u(1)
      cycle%v(i) = flow%v(1)
      call flow%advance_tangent(1, tangent)
    end do
    cycle%winding = nint(0.5_dp*(2*real(flow%turns(1), dp) + flow%u(1) - x(1)))
    matrix = tangent(:, :, 1)
  end subroutine orbit_of

  !> Eigenvalues of a 2 x 2 matrix of known determinant: larger modulus first, then + imaginary first.
  pure function eigenvalues(matrix, determinant) result(values)
    real(dp), intent(in) :: matrix(2, 2)
    real(dp), intent(in) :: determinant
    complex(dp) :: values(2)
    real(dp) :: half, root

    half = 0.5_dp*(matrix(1, 1) + matrix(2, 2))
    root = half**2 - determinant
    if (root < 0) then
      values = [cmplx(half, sqrt(-root), dp), cmplx(half, -sqrt(-root), dp)]
    else
      half = half + sign(sqrt(root), half)
      values(1) = half
      values(2) = 0
      if (abs(half) > 0) values(2) = determinant/half
    end if
  end function eigenvalues

  !> A cycle that is its own mirror image, x(1 + n/2) = -x(1), is made so to the bit: x(j + n/2) = -x(j), or exactly down or
  !> inverted.
  subroutine symmetrise(cycle)
    type(attractor_t), intent(inout) :: cycle
    integer :: n, half

    n = cycle%period
    if (cycle%winding /= 0) return
    if (n == 1) then
      cycle%symmetric = same_state(cycle%u(1), cycle%v(1), -cycle%u(1), -cycle%v(1))
      if (cycle%symmetric) then
        cycle%u = anint(abs(cycle%u))
        cycle%v = 0
      end if
      return
    end if
    if (mod(n, 2) /= 0) return
    half = n/2
    cycle%symmetric = same_state(cycle%u(1), cycle%v(1), -cycle%u(half + 1), -cycle%v(half + 1))
    if (.not. cycle%symmetric) return
    cycle%u(:half) = apart(cycle%u(:half) - 0.5_dp*apart(cycle%u(:half), -cycle%u(half + 1:)), 0.0_dp)
    cycle%v(:half) = 0.5_dp*(cycle%v(:half) - cycle%v(half + 1:))
    cycle%u(half + 1:) = -cycle%u(:half)
    cycle%v(half + 1:) = -cycle%v(:half)
  end subroutine symmetrise

  !> The image under (theta, v) -> (-theta, -v), to the bit.
  pure function mirror_image(attractor) result(image)
    type(attractor_t), intent(in) :: attractor
    type(attractor_t) :: image

    image = attractor
    image%winding = -attractor%winding
    image%mean = -attractor%mean
    image%mean_velocity = -attractor%mean_velocity
    if (allocated(attractor%u)) image%u = -attractor%u
    if (allocated(attractor%v)) image%v = -attractor%v
  end function mirror_image

  !> The strobe points rotated to begin with the lowest velocity, then the lowest angle (compared rounded to 1e-9).
  subroutine listed_from_lowest(cycle)
    type(attractor_t), intent(inout) :: cycle
    integer :: i, first

    first = 1
    do i = 2, cycle%period
      if (rounded(cycle%v(i)) > rounded(cycle%v(first))) cycle ! not lower
      if (rounded(cycle%v(i)) < rounded(cycle%v(first)) .or. rounded(cycle%u(i)*PI) < rounded(cycle%u(first)*PI)) first = i
    end do
    if (first == 1) return
    cycle%u = cshift(cycle%u, first - 1)
    cycle%v = cshift(cycle%v, first - 1)
    cycle%form = cshift(cycle%form, first - 1, dim=2)
  end subroutine listed_from_lowest

  elemental function rounded(x) result(n)
    real(dp), intent(in) :: x
    real(dp) :: n

    n = anint(x*1e9_dp)
  end function rounded

end module kz_dynamics_cycles
