!> The unstable manifold of a saddle of a map, grown by arcs: images of a short piece along the eigenvector, with as many points as
!> its bends need. (D. Hobson, J. Comput. Phys. 104 (1993) 14, has the measures of distance and angle.)
module kz_saddles_manifold
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: flow_t, WIDTH, PI
  use kz_cycles_newton, only: n_periods, eigenvalues
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private
  public :: grow_manifold

  !> rad: where a branch begins; the manifold leaves its tangent there by the square of that.
  real(dp), parameter :: FIRST = 1e-6_dp
  !> Two segments may bend so much (rad), unless they are shorter than this share of the spacing.
  real(dp), parameter :: BEND = 0.3_dp, SHORTEST = 1/32.0_dp
  !> Points of the first arc; drive periods after which a branch ends that stays short.
  integer, parameter :: FIRST_POINTS = 33, MOST_PERIODS = 1000

  !> The arc that is grown: places along the first piece, and where they are after the same number of periods.
  type :: arc_t
    real(dp), allocatable :: place(:)
    !> (half-turns, turns counted; velocity)
    real(dp), allocatable :: x(:, :)
  end type arc_t

contains

  !> Computes one branch: points along it from the saddle on, until its length is `length`, or the list is full, or all of it is too
  !> fast.
  subroutine grow_manifold(flow, beta, period, x, side, spacing, length, fastest, n, point)
    !> the map of one drive period, or its inverse, in physical coordinates
    class(flow_t), intent(inout) :: flow
    !> damping of the map, < 0 for an inverse one
    real(dp), intent(in) :: beta
    !> of the saddle, drive periods
    integer, intent(in) :: period
    !> the saddle: half-turns, velocity
    real(dp), intent(in) :: x(2)
    !> 1 or -1: along the eigenvector or against it
    integer, intent(in) :: side
    !> farthest that neighbours may be apart, rad
    real(dp), intent(in) :: spacing
    !> of the branch below the largest speed, rad
    real(dp), intent(in) :: length
    !> parts at larger speeds are left out
    real(dp), intent(in) :: fastest
    !> number of points
    integer, intent(out) :: n
    !> half-turns, velocity, arc length, number of the unbroken part
    real(dp), intent(out) :: point(:, :)
    real(dp) :: direction(2), multiplier, extent, before
    type(arc_t) :: arc
    integer :: q, periods, i

    call find_direction(flow, beta, period, x, q, direction, multiplier)
    allocate (arc%place(FIRST_POINTS))
    arc%place = [((i - 1)/real(FIRST_POINTS - 1, dp), i=1, FIRST_POINTS)]
    extent = 0
    n = 1
    point(:, 1) = [x, 0.0_dp, 0.0_dp]
    do periods = 0, MOST_PERIODS, q
      call place_arc(flow, periods, x, side*FIRST*direction, multiplier, arc)
      call refine(flow, periods, x, side*FIRST*direction, multiplier, spacing, fastest, size(point, 2), arc)
      if (all(abs(arc%x(2, :)) > fastest)) return
      before = extent
      extent = PI*(maxval(arc%x(1, :)) - minval(arc%x(1, :))) + maxval(arc%x(2, :)) - minval(arc%x(2, :))
      if (extent < min(before, SHORTEST*spacing)) return ! it shrinks onto an attractor
      call append(arc, fastest, length, n, point)
      if (n == size(point, 2) .or. point(3, n) >= length) return
    end do
  end subroutine grow_manifold

  !> The unit eigenvector (rad, rad per drive radian) of the multiplier that is larger than 1 over q periods: the period of the
  !> saddle, or twice that for a multiplier below -1.
  subroutine find_direction(flow, beta, period, x, q, direction, multiplier)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: beta
    integer, intent(in) :: period
    real(dp), intent(in) :: x(2)
    integer, intent(out) :: q
    real(dp), intent(out) :: direction(2)
    real(dp), intent(out) :: multiplier
    real(dp) :: residual(2), matrix(2, 2)
    complex(dp) :: values(2)

    call n_periods(flow, period, x, residual, matrix)
    values = eigenvalues(matrix, exp(-2*PI*beta*period))
    multiplier = real(values(1), dp)
    direction = [matrix(1, 2), multiplier - matrix(1, 1)]
    if (norm2(direction) < abs(multiplier - matrix(2, 2))) direction = [multiplier - matrix(2, 2), matrix(2, 1)]
    direction = direction/norm2(direction)
    q = period
    if (multiplier > 0) return
    q = 2*period
    multiplier = multiplier**2
  end subroutine find_direction

  !> arc%x = the images after `periods` of the states x + first multiplier**place.
  subroutine place_arc(flow, periods, x, first, multiplier, arc)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: periods
    real(dp), intent(in) :: x(2)
    real(dp), intent(in) :: first(2)
    real(dp), intent(in) :: multiplier
    type(arc_t), intent(inout) :: arc
    real(dp) :: start(2)
    integer :: from, lanes, i, period

    if (allocated(arc%x)) deallocate (arc%x)
    allocate (arc%x(2, size(arc%place)))
    do from = 1, size(arc%place), WIDTH
      lanes = min(WIDTH, size(arc%place) - from + 1)
      do i = 1, lanes
        start = x + [first(1)/PI, first(2)]*multiplier**arc%place(from + i - 1)
        call flow%put(i, start(1), start(2))
      end do
      do period = 1, periods
        call flow%advance(lanes)
      end do
      do i = 1, lanes
        arc%x(:, from + i - 1) = [flow%u(i) + 2*real(flow%turns(i), dp), flow%v(i)]
      end do
    end do
  end subroutine place_arc

  !> Halves the pieces of the arc until none is too long or bends too much, or there are `most` points.
  subroutine refine(flow, periods, x, first, multiplier, spacing, fastest, most, arc)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: periods
    real(dp), intent(in) :: x(2)
    real(dp), intent(in) :: first(2)
    real(dp), intent(in) :: multiplier
    real(dp), intent(in) :: spacing
    real(dp), intent(in) :: fastest
    integer, intent(in) :: most
    type(arc_t), intent(inout) :: arc
    type(arc_t) :: more
    logical, allocatable :: halve(:)
    integer :: i

    do
      allocate (halve, source=to_halve(arc, spacing, fastest))
      if (.not. any(halve) .or. size(arc%place) + count(halve) > most) return
      more%place = pack([(0.5_dp*(arc%place(i) + arc%place(i + 1)), i=1, size(halve))], halve)
      call place_arc(flow, periods, x, first, multiplier, more)
      call merge_arcs(halve, more, arc)
      deallocate (halve)
    end do
  end subroutine refine

  !> The pieces that are too long, or bend too much against a neighbour. Pieces outside the largest speed never do.
  pure function to_halve(arc, spacing, fastest) result(halve)
    type(arc_t), intent(in) :: arc
    real(dp), intent(in) :: spacing
    real(dp), intent(in) :: fastest
    logical :: halve(size(arc%place) - 1)
    real(dp) :: piece(2, size(arc%place) - 1), long(size(arc%place) - 1), turn
    integer :: i, n

    n = size(halve)
    piece = arc%x(:, 2:) - arc%x(:, :n)
    piece(1, :) = PI*piece(1, :)
    long = norm2(piece, dim=1)
    halve = long > spacing
    do i = 1, n - 1
      turn = abs(atan2(piece(1, i)*piece(2, i + 1) - piece(2, i)*piece(1, i + 1), dot_product(piece(:, i), piece(:, i + 1))))
      if (turn < BEND) cycle
      halve(i:i + 1) = halve(i:i + 1) .or. long(i:i + 1) > SHORTEST*spacing
    end do
    halve = halve .and. min(abs(arc%x(2, :n)), abs(arc%x(2, 2:))) < fastest
    halve = halve .and. arc%place(2:) - arc%place(:n) > 1e-13_dp
  end function to_halve

  !> The points of `more` between those of `arc`, each in the middle of a piece that was halved.
  subroutine merge_arcs(halve, more, arc)
    logical, intent(in) :: halve(:)
    type(arc_t), intent(in) :: more
    type(arc_t), intent(inout) :: arc
    type(arc_t) :: all
    integer :: i, j, added

    allocate (all%place(size(arc%place) + size(more%place)), all%x(2, size(arc%place) + size(more%place)))
    j = 0
    added = 0
    do i = 1, size(arc%place)
      j = j + 1
      all%place(j) = arc%place(i)
      all%x(:, j) = arc%x(:, i)
      if (i > size(halve)) exit
      if (.not. halve(i)) cycle
      j = j + 1
      added = added + 1
      all%place(j) = more%place(added)
      all%x(:, j) = more%x(:, added)
    end do
    arc = all
  end subroutine merge_arcs

  !> The points of the arc below the largest speed, but for its first, which ended the arc before.
  subroutine append(arc, fastest, length, n, point)
    type(arc_t), intent(in) :: arc
    real(dp), intent(in) :: fastest
    real(dp), intent(in) :: length
    integer, intent(inout) :: n
    real(dp), intent(inout) :: point(:, :)
    real(dp) :: arc_length, part
    integer :: i

    arc_length = point(3, n)
    part = point(4, n)
    do i = 2, size(arc%place)
      if (abs(arc%x(2, i)) > fastest) cycle
      if (n == size(point, 2) .or. arc_length >= length) return
      if (abs(arc%x(2, i - 1)) > fastest) then
        part = part + 1
      else
        arc_length = arc_length + separation(arc%x(1, i), arc%x(2, i), point(1, n), point(2, n))
      end if
      n = n + 1
      point(:, n) = [angle_difference(arc%x(1, i), 0.0_dp), arc%x(2, i), arc_length, part]
    end do
  end subroutine append

end module kz_saddles_manifold
