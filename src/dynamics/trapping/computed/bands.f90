!> Trapping regions of running states: bands round the cylinder between two curves, each of which the map carries inside
!> the band.
!>
!> The map is a homeomorphism that keeps the ends of the cylinder apart: where the image of a curve round it lies below
!> that curve, so do the images of all states below. Every pair of curves is tried from one tiny distance of the
!> attracting curve on, so that this is the only invariant set between them. Distances are in units of the density with
!> which motions visit the angles: by that measure the map shrinks the distance from the curve by exp(-2 pi beta)
!> everywhere.
module kz_computed_bands
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_curves, only: curve_t, find_curve, carry_curve, resample, node, NODES
  implicit none
  private
  public :: find_band, mirrored_band, states_in_band, has_band, in_band, band_holds, band_meets

  !> Distances tried, rad per drive radian at the mean density; if none up to LATEST is carried inside, none beyond.
  real(dp), parameter :: SMALLEST = 1e-7_dp, LATEST = 1e-2_dp, LARGEST = 8, GROWTH = 2
  integer, parameter :: HALVINGS = 4
  integer, parameter :: LOW = 1, HIGH = 2

contains

  !> The band of the closed curve that some states are on, in the coordinates of the flow: band(1:2, j), the lowest and
  !> highest velocity at the angle -1 + 2 (j - 1)/n; n = 0 where no band was found.
  subroutine find_band(flow, beta, u, v, others, band, curve)
    class(flow_t), intent(inout) :: flow !< the map whose orbits are to be trapped
    real(dp), intent(in) :: beta !< damping
    real(dp), intent(in) :: u(:), v(:) !< [n <= WIDTH] half-turns in [-1, 1], rad per drive radian
    type(attractor_t), intent(in) :: others(:) !< attractors whose strobe points no band may contain
    real(dp), allocatable, intent(out) :: band(:, :)
    type(curve_t), intent(out) :: curve !< the curve itself
    logical :: found
    integer :: a, j

    allocate (band(2, 0))
    call find_curve(flow, beta, u, v, curve, found)
    if (.not. found) return
    band = reshape([curve%v, curve%v], [2, NODES], order=[2, 1])
    call widen(flow, curve, LOW, band)
    call widen(flow, curve, HIGH, band)
    found = minval(curve%v - band(LOW, :)) > 0 .and. minval(band(HIGH, :) - curve%v) > 0
    do a = 1, size(others)
      do j = 1, others(a)%period
        found = found .and. .not. is_between(band, others(a)%kernel_u(j), others(a)%kernel_v(j))
      end do
    end do
    if (.not. found) band = reshape([real(dp) ::], [2, 0])
  end subroutine find_band

  !> Moves one side of a band as far from the curve as the map carries it inside.
  subroutine widen(flow, curve, which, band)
    class(flow_t), intent(inout) :: flow
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: which !< LOW or HIGH
    real(dp), intent(inout) :: band(:, :)
    real(dp) :: tried, last
    integer :: i

    tried = SMALLEST
    last = 0
    do while (tried < LARGEST)
      if (is_carried_inside(flow, curve, which, tried)) then
        last = tried
      else if (last > 0 .or. tried > LATEST) then
        exit
      end if
      tried = tried*GROWTH
    end do
    if (last <= 0) return
    do i = 1, HALVINGS
      tried = last*(1 + (GROWTH - 1)*0.5_dp**i)
      if (is_carried_inside(flow, curve, which, tried)) last = tried
    end do
    band(which, :) = side_of(curve, which, last)
    do while (.not. sides_are_inside(flow, band, which))
      last = last/GROWTH
      band(which, :) = side_of(curve, which, last)
      if (last < SMALLEST) band(which, :) = curve%v ! its polygon is not carried inside
      if (last < SMALLEST) return
    end do
  end subroutine widen

  pure function side_of(curve, which, distance) result(v)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: which
    real(dp), intent(in) :: distance
    real(dp) :: v(NODES)

    v = curve%v + merge(-distance, distance, which == LOW)*curve%density
  end function side_of

  !> Whether the map carries a curve at this distance to a smaller one: by half of what damping says, or by 5 %.
  function is_carried_inside(flow, curve, which, distance) result(inside)
    class(flow_t), intent(inout) :: flow
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: which
    real(dp), intent(in) :: distance
    logical :: inside
    real(dp) :: image(2, NODES), moved(NODES), goal(NODES)

    call carry_curve(flow, side_of(curve, which, distance), image)
    call resample(image(1, :), image(2, :), moved, inside)
    if (.not. inside) return
    goal = side_of(curve, which, distance*(1 - min(0.05_dp, 0.5_dp*(1 - curve%shrinking))))
    inside = all(merge(moved > goal, moved < goal, which == LOW))
  end function is_carried_inside

  !> Whether images of the nodes of one side, and of middles, lie inside it, as straight pieces join its nodes.
  function sides_are_inside(flow, band, which) result(inside)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: band(:, :)
    integer, intent(in) :: which
    logical :: inside
    real(dp) :: u(NODES), v(NODES), side(2)
    integer :: part, first, n, j

    inside = .true.
    do part = 0, 1
      u = [(node(j) + part/real(NODES, dp), j=1, NODES)]
      v = band(which, :)
      if (part == 1) v = 0.5_dp*(v + cshift(v, 1))
      do first = 1, NODES, WIDTH
        n = min(WIDTH, NODES - first + 1)
        call flow%put_all(u(first:first + n - 1), v(first:first + n - 1))
        call flow%advance(n)
        do j = 1, n
          side = sides_at(band, flow%u(j))
          inside = inside .and. merge(-1, 1, which == LOW)*(flow%v(j) - side(which)) < 0
        end do
      end do
    end do
  end function sides_are_inside

  !> The velocities of both sides of a band at an angle, on straight pieces between nodes.
  pure function sides_at(band, u) result(v)
    real(dp), intent(in) :: band(:, :), u !< half-turns in [-1, 1]
    real(dp) :: v(2), x
    integer :: i, j, n

    n = size(band, 2)
    x = (u + 1)*0.5_dp*n
    i = int(x)
    x = x - i
    j = 1 + modulo(i + 1, n)
    i = 1 + modulo(i, n)
    v = band(:, i) + x*(band(:, j) - band(:, i))
  end function sides_at

  !> Whether a state lies in a band.
  pure function is_between(band, u, v) result(inside)
    real(dp), intent(in) :: band(:, :), u, v !< half-turns in [-1, 1], rad per drive radian
    logical :: inside
    real(dp) :: side(2)

    side = sides_at(band, u)
    inside = v > side(LOW) .and. v < side(HIGH)
  end function is_between

  !> The band of the mirror image.
  pure function mirrored_band(band) result(image)
    real(dp), intent(in) :: band(:, :) !< band from find_band
    real(dp) :: image(2, size(band, 2))
    integer :: j, n

    n = size(band, 2)
    do j = 1, n
      image([HIGH, LOW], j) = -band([LOW, HIGH], 1 + modulo(1 - j, n))
    end do
  end function mirrored_band

  !> True if the band of a running state holds (u, v).
  pure function in_band(attractor, u, v) result(inside)
    type(attractor_t), intent(in) :: attractor !< any attractor
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    logical :: inside

    inside = .false.
    if (has_band(attractor)) inside = is_between(attractor%band, u, v)
  end function in_band

  !> States in the middle of a band, evenly round the circle.
  pure subroutine states_in_band(band, u, v)
    real(dp), intent(in) :: band(:, :) !< band from find_band
    real(dp), intent(out) :: u(:), v(:) !< half-turns in [-1, 1], rad per drive radian
    integer :: i, j

    do i = 1, size(u)
      j = 1 + size(band, 2)*(i - 1)/size(u)
      u(i) = node(j)
      v(i) = 0.5_dp*sum(band(:, j))
    end do
  end subroutine states_in_band

  !> True if an attractor has a band.
  pure function has_band(attractor) result(has)
    type(attractor_t), intent(in) :: attractor !< any attractor
    logical :: has

    has = .false.
    if (allocated(attractor%band)) has = size(attractor%band) > 0
  end function has_band

  !> True if the band holds all states of a box.
  pure function band_holds(attractor, u, v) result(holds)
    type(attractor_t), intent(in) :: attractor !< a running state with a band
    real(dp), intent(in) :: u(2), v(2) !< least and largest: half-turns, not wrapped, rad per drive radian
    logical :: holds

    holds = v(1) > extreme(attractor%band(LOW, :), u, 1) .and. v(2) < -extreme(attractor%band(HIGH, :), u, -1)
  end function band_holds

  !> False if the band holds no state of a box.
  pure function band_meets(attractor, u, v) result(meets)
    type(attractor_t), intent(in) :: attractor !< a running state with a band
    real(dp), intent(in) :: u(2), v(2) !< least and largest: half-turns, not wrapped, rad per drive radian
    logical :: meets

    meets = v(2) > -extreme(attractor%band(LOW, :), u, -1) .and. v(1) < extreme(attractor%band(HIGH, :), u, 1)
  end function band_meets

  !> The largest value of sign*curve at the nodes on and beside an interval.
  pure function extreme(curve, u, sign) result(most)
    real(dp), intent(in) :: curve(:), u(2)
    integer, intent(in) :: sign
    real(dp) :: most
    integer :: j, n

    n = size(curve)
    most = -huge(most)
    do j = floor((u(1) + 1)*0.5_dp*n), ceiling((u(2) + 1)*0.5_dp*n)
      most = max(most, sign*curve(1 + modulo(j, n)))
    end do
  end function extreme

end module kz_computed_bands
