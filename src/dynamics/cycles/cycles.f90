!> Cycles of the stroboscopic map: from a state nearby to strobe points and multipliers, symmetry, mirror image.
module kz_cycles_cycles
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_cycles_newton, only: newton, n_periods, minimal_period
  use kz_maps_matrices, only: eigenvalues, solved, IDENTITY
  use kz_model_pendulum, only: MIRROR, HALF_PERIOD
  use kz_maps_states, only: angle_difference, states_to_map, same_state, rounded, wrapped
  implicit none
  private
  public :: numbers_t, attractor_t, close_cycle, complete_attractor, enter_points, is_slow, symmetrise, image_of, &
            half_period_images, listed_from_lowest

  !> In the place of a period: the attractor is a running state, a closed curve round the cylinder that a motion fills.
  integer, parameter, public :: RUNNING = -1

  !> 1/drive period: motions that spiral into a cycle at a lower rate do so long before they come near it.
  real(dp), parameter, public :: SLOW = 1.0_dp/64

  !> Largest distance of the cycle of another flow, rad.
  real(dp), parameter :: BESIDE = 1e-3_dp

  !> An attractor's numbers, without a gap in the memory. Angles are half-turns in [-1, 1].
  type :: numbers_t
    integer :: period = 0          !< drive periods; 0 = chaotic, RUNNING
    integer :: winding = 0         !< net turns per `period` drive periods; of a running state the mean velocity's sign
    integer :: symmetry = MIRROR   !< by which attractors have images: pairing_symmetry of the pendulum
    logical :: symmetric = .false. !< the orbit is its own image
    integer :: mirror = 0          !< number of the image in the catalogue, from 1
    integer :: centre = 3          !< 0 down, 1 inverted, 2 rotating, 3 none of these
    real(dp) :: mean = 0           !< mean angle and velocity over time, half-turns and rad per drive radian
    real(dp) :: mean_velocity = 0
    real(dp) :: amplitude = 0      !< largest angle from the centre, rad
    complex(dp) :: multiplier(2) = 0
    real(dp) :: lyapunov = 0       !< largest exponent per drive period
    real(dp) :: lyapunov_error = 0
  end type numbers_t

  !> An attractor. Strobe points are in the order of time.
  type, extends(numbers_t) :: attractor_t
    real(dp), allocatable :: u(:), v(:)
    !> Strobe points in the coordinates of the flow that labels (`enter_points`): half-turns, rad per drive radian
    real(dp), allocatable :: kernel_u(:), kernel_v(:)
    !> Trapping ellipse of each point: form(1) du**2 + 2 form(2) du dv + form(3) dv**2 < 1; form = 0: none
    real(dp), allocatable :: form(:, :)
    !> Cells of the cover of an attractor without a period
    integer, allocatable :: cover(:)
    !> Trapping region of a running state, from find_band
    real(dp), allocatable :: band(:, :)
  end type attractor_t

contains

  !> Newton's method on the n-period map from (u, v), with a fine flow. `found`: it converges within `max_distance` of
  !> the start; the cycle, attracting or not, then has its smallest period. `blurred`: it converges, but so near a
  !> bifurcation that rounding does not define the point.
  function close_cycle(flow, beta, n, start, max_distance, cycle, blurred) result(found)
    class(flow_t), intent(inout) :: flow !< a fine flow
    real(dp), intent(in) :: beta !< damping
    integer, intent(in) :: n !< a period that closes the cycle
    real(dp), intent(in) :: start(2) !< half-turns, rad per drive radian
    real(dp), intent(in) :: max_distance !< farthest that the cycle may lie from the start, rad
    type(attractor_t), intent(out) :: cycle !< the cycle: points, multipliers, period, winding
    logical, intent(out) :: blurred !< whether it was left undecided by rounding
    logical :: found !< whether a cycle was found
    real(dp) :: x(2), matrix(2, 2)
    integer :: period

    x = start
    call newton(flow, n, max_distance, x, found, blurred)
    if (.not. found) return
    period = minimal_period(flow, n, x)
    if (period < n) call newton(flow, period, max_distance, x, found, blurred)
    if (.not. found) return
    call orbit_of(flow, period, x, cycle, matrix)
    cycle%multiplier = eigenvalues(matrix, exp(-2*PI*beta*period))
  end function close_cycle

  !> True if a closed cycle attracts; it then sets the exponent and the symmetry of the attractor.
  subroutine complete_attractor(sampling_flow, cycle, attracts)
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    type(attractor_t), intent(inout) :: cycle !< cycle found by close_cycle
    logical, intent(out) :: attracts !< its larger multiplier lies inside the unit circle

    attracts = abs(cycle%multiplier(1)) < 1
    if (.not. attracts) return
    cycle%lyapunov = log(abs(cycle%multiplier(1)))/cycle%period
    call symmetrise(sampling_flow, cycle)
  end subroutine complete_attractor

  !> Strobe points, winding and monodromy of the closed orbit through x.
  subroutine orbit_of(flow, period, x, cycle, matrix)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: period !< drive periods
    real(dp), intent(in) :: x(2) !< the first strobe point: half-turns, rad per drive radian
    type(attractor_t), intent(inout) :: cycle !< takes the points and the winding
    real(dp), intent(out) :: matrix(2, 2) !< derivative of the map over the period
    real(dp) :: tangent(2, 2, WIDTH)
    integer :: i

    cycle%period = period
    allocate (cycle%u(period), cycle%v(period), cycle%form(3, period))
    cycle%form = 0
    call flow%put(1, x(1), x(2))
    tangent(:, :, 1) = IDENTITY
    do i = 1, period
      cycle%u(i) = flow%u(1)
      cycle%v(i) = flow%v(1)
      call flow%advance_tangent(1, tangent)
    end do
    cycle%winding = nint(0.5_dp*(2*real(flow%turns(1), dp) + flow%u(1) - x(1)))
    matrix = tangent(:, :, 1)
  end subroutine orbit_of

  !> Sets kernel_u and kernel_v from the strobe points. Where motions approach them slowly, small errors of the flow
  !> move its own cycle so far from them that rings around them do not shrink: the points are those of its own cycle.
  subroutine enter_points(flow, attractor)
    class(flow_t), intent(inout) :: flow !< the flow whose coordinates are entered
    type(attractor_t), intent(inout) :: attractor !< u, v and multipliers, in; kernel_u and kernel_v, out
    integer :: first, last

    attractor%kernel_u = attractor%u
    attractor%kernel_v = attractor%v
    if (is_slow(attractor)) then
      do first = 1, attractor%period, WIDTH
        last = min(attractor%period, first + WIDTH - 1)
        call own_points(flow, attractor%period, attractor%kernel_u(first:last), attractor%kernel_v(first:last))
      end do
    end if
    call states_to_map(flow, attractor%kernel_u, attractor%kernel_v)
  end subroutine enter_points

  !> Moves strobe points to the flow's own cycle by Newton's method on each; keeps those that would move beyond BESIDE.
  subroutine own_points(flow, period, u, v)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: period
    real(dp), intent(inout) :: u(:), v(:)
    integer, parameter :: ITERATIONS = 4
    real(dp), parameter :: ENDED = 1e-10_dp
    real(dp) :: x(2, size(u)), step(2, size(u)), residual(2, size(u)), matrix(2, 2, size(u))
    integer :: n, i, iteration

    n = size(u)
    x = reshape([(u(i), v(i), i=1, n)], [2, n])
    do iteration = 1, ITERATIONS
      call n_periods(flow, period, n, x, residual, matrix)
      do i = 1, n
        step(:, i) = solved(matrix(:, :, i), residual(:, i))
      end do
      x = x - step/spread([PI, 1.0_dp], 2, n)
    end do
    do i = 1, n
      if (.not. (norm2(step(:, i)) < ENDED .and. abs(angle_difference(x(1, i), u(i))) + abs(x(2, i) - v(i)) < BESIDE)) &
        cycle
      u(i) = angle_difference(x(1, i), 0.0_dp)
      v(i) = x(2, i)
    end do
  end subroutine own_points

  !> Whether motions spiral into a cycle slowly.
  pure function is_slow(attractor)
    type(attractor_t), intent(in) :: attractor !< its period and multipliers
    logical :: is_slow

    is_slow = attractor%period > 0 .and. abs(aimag(attractor%multiplier(1))) > 0
    if (is_slow) is_slow = -log(abs(attractor%multiplier(1))) < SLOW*attractor%period
  end function is_slow

  !> Sees whether a cycle is its own image. It makes one that is its mirror image, x(1 + n/2) = -x(1), exact: x(j + n/2)
  !> = -x(j) to the bit, or exactly down or inverted.
  subroutine symmetrise(sampling_flow, cycle)
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    type(attractor_t), intent(inout) :: cycle !< in: points, winding, period; out: symmetrised if the cycle is
    real(dp) :: u(1), v(1)
    integer :: n, half

    n = cycle%period
    if (cycle%winding /= 0 .or. cycle%symmetry == 0) return
    if (cycle%symmetry == HALF_PERIOD) then
      if (mod(n, 2) == 0) return
      u = cycle%u(:1)
      v = cycle%v(:1)
      call half_period_images(sampling_flow, u, v)
      half = 1 + mod((n + 1)/2, n)
      cycle%symmetric = same_state(u(1), v(1), cycle%u(half), cycle%v(half))
      return
    end if
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
    cycle%u(:half) = angle_difference(cycle%u(:half) - 0.5_dp*angle_difference(cycle%u(:half), -cycle%u(half + 1:)), &
                                      0.0_dp)
    cycle%v(:half) = 0.5_dp*(cycle%v(:half) - cycle%v(half + 1:))
    cycle%u(half + 1:) = -cycle%u(:half)
    cycle%v(half + 1:) = -cycle%v(:half)
  end subroutine symmetrise

  !> Strobe states become those of their images under (theta, v, t) -> (-theta, -v, t + pi), half a period later.
  subroutine half_period_images(sampling_flow, u, v)
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    real(dp), intent(inout) :: u(:), v(:) !< physical states, half-turns, rad per drive radian
    real(dp) :: shown_u(2, WIDTH), shown_v(2, WIDTH)
    integer :: first, n

    do first = 1, size(u), WIDTH
      n = min(WIDTH, size(u) - first + 1)
      call sampling_flow%put_all(u(first:first + n - 1), v(first:first + n - 1))
      call sampling_flow%sample(2, shown_u(:, :n), shown_v(:, :n))
      u(first:first + n - 1) = -wrapped(shown_u(1, :n))
      v(first:first + n - 1) = -shown_v(1, :n)
    end do
  end subroutine half_period_images

  !> Image of an attractor: (-theta, -v), exact to the bit, or half a period later; no ellipses, no kernel coordinates.
  subroutine image_of(sampling_flow, attractor, image)
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    type(attractor_t), intent(in) :: attractor !< the attractor
    type(attractor_t), intent(out) :: image !< its image

    image = attractor
    image%winding = -attractor%winding
    image%mean = -attractor%mean
    image%mean_velocity = -attractor%mean_velocity
    if (attractor%period <= 0) return
    if (attractor%symmetry == HALF_PERIOD) then
      call half_period_images(sampling_flow, image%u, image%v)
      image%form = 0
      return
    end if
    image%u = -attractor%u
    image%v = -attractor%v
    if (allocated(attractor%kernel_u)) image%kernel_u = -attractor%kernel_u
    if (allocated(attractor%kernel_v)) image%kernel_v = -attractor%kernel_v
  end subroutine image_of

  !> The strobe points in order from that with the lowest velocity, then the lowest angle (compared rounded to 1e-9).
  subroutine listed_from_lowest(cycle)
    type(attractor_t), intent(inout) :: cycle !< a cycle with its points in the order of time
    integer :: i, first

    first = 1
    do i = 2, cycle%period
      if (rounded(cycle%v(i)) > rounded(cycle%v(first))) cycle ! not lower
      if (rounded(cycle%v(i)) < rounded(cycle%v(first)) .or. rounded(cycle%u(i)*PI) < rounded(cycle%u(first)*PI)) &
        first = i
    end do
    if (first == 1) return
    cycle%u = cshift(cycle%u, first - 1)
    cycle%v = cshift(cycle%v, first - 1)
    cycle%kernel_u = cshift(cycle%kernel_u, first - 1)
    cycle%kernel_v = cshift(cycle%kernel_v, first - 1)
    cycle%form = cshift(cycle%form, first - 1, dim=2)
  end subroutine listed_from_lowest

end module kz_cycles_cycles
