!> Closed attracting invariant curves round the cylinder, filled by the motions of running states.
module kz_computed_curves
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  implicit none
  private
  public :: curve_t, find_curve, carry_curve, resample, node, is_locked, mean_turns, window_weight

  !> Nodes of a curve round the circle.
  integer, parameter, public :: NODES = 1024
  !> Periods through which states are followed for a first curve, twice; states of a first curve at least.
  integer, parameter :: VISITS = 1024, FEWEST = 8
  !> Change of a curve in a period, rad per drive radian, at which it counts as carried into itself; in lifetimes 1/(2
  !> pi beta), the error that it may have, which rounding leaves near fast motions, and the time that this may take;
  !> periods beside them.
  real(dp), parameter :: CLOSED = 1e-12_dp, PRECISE = 5e-9_dp, LIFETIMES = 40
  integer, parameter :: MORE_PERIODS = 64
  !> Half-turns: angles by which states turn in some periods that differ by less are one.
  real(dp), parameter :: NEUTRAL = 1e-9_dp
  !> Periods over which turns are averaged along a curve.
  integer, parameter :: TURN_PERIODS = 100000

  !> An attracting curve.
  type :: curve_t
    real(dp) :: v(NODES) = 0       !< velocity at each node, rad per drive radian
    real(dp) :: image(2, NODES) = 0 !< where a period takes the nodes; half-turns, not wrapped, rad per drive radian
    real(dp) :: density(NODES) = 0 !< with which motions visit the angles, 1 on average
    real(dp) :: shrinking = 0      !< factor of distances in a period
  end type curve_t

contains

  !> The curve that some states are on, in the coordinates of the flow. found = .false.: none was found.
  subroutine find_curve(flow, beta, u, v, curve, found)
    class(flow_t), intent(inout) :: flow !< the map
    real(dp), intent(in) :: beta !< damping
    real(dp), intent(in) :: u(:), v(:) !< [n <= WIDTH] half-turns in [-1, 1], rad per drive radian
    type(curve_t), intent(out) :: curve
    logical, intent(out) :: found

    curve%shrinking = exp(-2*PI*beta)
    call first_curve(flow, u, v, curve%v, found)
    if (found) call close_curve(flow, curve, found)
    if (found) call find_density(curve, found)
  end subroutine find_curve

  !> The angle of a node, half-turns.
  elemental function node(j) result(u)
    integer, intent(in) :: j
    real(dp) :: u

    u = 2*(j - 1)/real(NODES, dp) - 1
  end function node

  !> A curve through states that some orbits visit, between each two nodes that nearest to the middle: of two near each
  !> other rounding would tell the slope.
  subroutine first_curve(flow, u, v, at_nodes, found)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: u(:), v(:)
    real(dp), intent(out) :: at_nodes(NODES)
    logical, intent(out) :: found
    real(dp) :: visit(2, NODES), least(NODES), away
    logical :: visited(NODES)
    integer :: period, i, j

    least = huge(least)
    call flow%put_all(u, v)
    do period = 1, 2*VISITS
      call flow%advance(size(u))
      if (period <= VISITS) cycle
      do i = 1, size(u)
        j = 1 + min(int((flow%u(i) + 1)*(NODES/2)), NODES - 1)
        away = abs(flow%u(i) - node(j) - 1.0_dp/NODES)
        if (away < least(j)) visit(:, j) = [flow%u(i), flow%v(i)]
        least(j) = min(away, least(j))
      end do
    end do
    visited = least < 1
    found = count(visited) >= FEWEST
    if (found) call resample(pack(visit(1, :), visited), pack(visit(2, :), visited), at_nodes, found)
  end subroutine first_curve

  !> Images of the states (node, v), angles not wrapped.
  subroutine carry_curve(flow, v, image)
    class(flow_t), intent(inout) :: flow !< the map
    real(dp), intent(in) :: v(:) !< [NODES] rad per drive radian
    real(dp), intent(out) :: image(:, :) !< [2, NODES] half-turns, rad per drive radian
    integer :: first, n, j

    do first = 1, NODES, WIDTH
      n = min(WIDTH, NODES - first + 1)
      call flow%put_all([(node(j), j=first, first + n - 1)], v(first:first + n - 1))
      call flow%advance(n)
      image(1, first:first + n - 1) = flow%u(:n) + 2*flow%turns(:n)
      image(2, first:first + n - 1) = flow%v(:n)
    end do
  end subroutine carry_curve

  !> A periodic function at the nodes, from its values at increasing angles that lie within one turn; by cubics. found =
  !> .false.: they do not increase.
  subroutine resample(u, value, at_nodes, found)
    real(dp), intent(in) :: u(:), value(:) !< half-turns, not wrapped
    real(dp), intent(out) :: at_nodes(NODES)
    logical, intent(out) :: found
    real(dp) :: x(4), y(4), target
    integer :: n, i, j, k, offset

    n = size(u)
    at_nodes = 0
    found = all(u(2:) > u(:n - 1)) .and. u(n) < u(1) + 2
    if (.not. found) return
    i = 0 ! the target lies between the values i and i + 1
    offset = ceiling((u(1) + 1)*(NODES/2)) ! the first node at or beyond u(1), from 0
    do j = offset, offset + NODES - 1
      target = 2*j/real(NODES, dp) - 1
      do while (turned(i + 1) <= target)
        i = i + 1
      end do
      do k = 1, 4
        x(k) = turned(i + k - 2)
        y(k) = value(1 + modulo(i + k - 3, n))
      end do
      at_nodes(1 + modulo(j, NODES)) = cubic(x, y, target)
    end do
  contains
    !> Angle number k, for any k.
    pure function turned(k) result(angle)
      integer, intent(in) :: k
      real(dp) :: angle

      angle = u(1 + modulo(k - 1, n)) + 2*floor(real(k - 1, dp)/n)
    end function turned
  end subroutine resample

  !> The cubic through four points.
  pure function cubic(x, y, at) result(value)
    real(dp), intent(in) :: x(4), y(4), at
    real(dp) :: value, term
    integer :: i, j

    value = 0
    do i = 1, 4
      term = y(i)
      do j = 1, 4
        if (j /= i) term = term*(at - x(j))/(x(i) - x(j))
      end do
      value = value + term
    end do
  end function cubic

  !> Moves a curve to that which the map carries into itself. found = .false.: it folds over, or does not settle.
  subroutine close_curve(flow, curve, found)
    class(flow_t), intent(inout) :: flow
    type(curve_t), intent(inout) :: curve
    logical, intent(out) :: found
    real(dp) :: moved(NODES), change, least
    integer :: period, since

    least = huge(least)
    since = 0
    do period = 1, MORE_PERIODS + ceiling(LIFETIMES/abs(log(curve%shrinking)))
      call carry_curve(flow, curve%v, curve%image)
      call resample(curve%image(1, :), curve%image(2, :), moved, found)
      if (.not. found) return
      change = maxval(abs(moved - curve%v))
      curve%v = moved
      since = merge(0, since + 1, change < 0.5_dp*least) ! rounding ends the approach
      least = min(least, change)
      if (change < CLOSED .or. (least < PRECISE/4*(1 - curve%shrinking) .and. since > MORE_PERIODS)) exit
    end do
    found = least < PRECISE*(1 - curve%shrinking)
    call carry_curve(flow, curve%v, curve%image)
  end subroutine close_curve

  !> Invariant density along the curve, 1 on average: the average over images of an even one.
  subroutine find_density(curve, found)
    type(curve_t), intent(inout) :: curve
    logical, intent(out) :: found
    real(dp) :: slope(NODES), now(NODES), next(NODES), ahead(NODES), behind(NODES), weight
    integer :: periods, period

    periods = MORE_PERIODS + ceiling(LIFETIMES/4/abs(log(curve%shrinking)))
    ahead = cshift(curve%image(1, :), 1)
    ahead(NODES) = ahead(NODES) + 2
    behind = cshift(curve%image(1, :), -1)
    behind(1) = behind(1) - 2
    slope = (ahead - behind)*(NODES/4)
    found = minval(slope) > 0
    if (.not. found) return
    now = 1
    curve%density = 0
    do period = 1, periods
      weight = window_weight(period, periods)
      curve%density = curve%density + weight*now
      call resample(curve%image(1, :), now/slope, next, found)
      if (.not. found) return
      now = next/(sum(next)/NODES)
    end do
    curve%density = curve%density/(sum(curve%density)/NODES)
    found = minval(curve%density) > 0
  end subroutine find_density

  !> The weight of a period in averages over a window: smooth, and 0 with all its derivatives beside the window.
  pure function window_weight(period, periods) result(weight)
    integer, intent(in) :: period !< from 1
    integer, intent(in) :: periods !< drive periods of the window
    real(dp) :: weight

    weight = exp(-1/(real(period, dp)/(periods + 1)*(1 - real(period, dp)/(periods + 1))))
  end function window_weight

  !> True if a cycle of up to max_period periods is on the curve: motions on it end there. False if all of it returns.
  pure logical function is_locked(curve, max_period)
    type(curve_t), intent(in) :: curve !< curve from find_band
    integer, intent(in) :: max_period !< drive periods
    real(dp) :: turned(NODES), shift(NODES)
    integer :: n, j

    shift = curve%image(1, :) - [(node(j), j=1, NODES)]
    turned = 0
    is_locked = .false.
    do n = 1, max_period
      turned = turned + [(shift_at(shift, node(j) + turned(j)), j=1, NODES)]
      is_locked = floor(maxval(turned)/2) >= ceiling(minval(turned)/2) .and. maxval(turned) - minval(turned) > NEUTRAL
      if (is_locked) return
    end do
  end function is_locked

  !> The mean number of turns in a period along a curve.
  pure function mean_turns(curve) result(mean)
    type(curve_t), intent(in) :: curve !< curve from find_band
    real(dp) :: mean, shift(NODES), u, step, weight, weights
    integer :: period, j

    shift = curve%image(1, :) - [(node(j), j=1, NODES)]
    u = 0
    mean = 0
    weights = 0
    do period = 1, TURN_PERIODS
      step = shift_at(shift, u)
      u = modulo(u + step, 2.0_dp)
      weight = window_weight(period, TURN_PERIODS)
      weights = weights + weight
      mean = mean + weight*step/2
    end do
    mean = mean/weights
  end function mean_turns

  !> By how much a period turns the state of a curve at the angle u, from those of the nodes.
  pure function shift_at(shift, u) result(turned)
    real(dp), intent(in) :: shift(NODES), u !< half-turns
    real(dp) :: turned, x, y(4)
    integer :: i, k

    x = (u + 1)*(NODES/2)
    i = floor(x)
    y = [(shift(1 + modulo(i + k, NODES)), k=-1, 2)]
    turned = cubic([-1.0_dp, 0.0_dp, 1.0_dp, 2.0_dp], y, x - i)
  end function shift_at

end module kz_computed_curves
