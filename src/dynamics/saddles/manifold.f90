!> The unstable manifold of a saddle of a map, grown by arcs: images of a short piece along the eigenvector, with as
!> many points as its bends need. (D. Hobson, J. Comput. Phys. 104 (1993) 14, has the measures of distance and angle.)
module kz_saddles_manifold
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_cycles_newton, only: newton, n_periods
  use kz_maps_matrices, only: eigenvalues, IDENTITY
  use kz_maps_states, only: angle_difference, separation
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private

  !> rad: the manifold leaves its tangent by the square of the distance from the saddle, so that nearer points lie on it
  !> to rounding. The first arc ends there.
  real(dp), parameter :: NEARBY = 1e-8_dp
  !> Two segments may bend so much (rad), unless they are shorter than this share of the spacing.
  real(dp), parameter :: BEND = 0.3_dp, SHORTEST = 1/32.0_dp
  !> Places nearer to each other differ in the last digits of a state alone.
  real(dp), parameter :: NEAREST = 1e-11_dp
  !> Points of the first arc; drive periods after which a branch ends that stays short.
  integer, parameter :: FIRST_POINTS = 33, MOST_PERIODS = 1000

  !> Memory of kz_branch of dynamics.h.
  type, bind(C) :: branch_t
    real(dp) :: theta, velocity
    integer(c_int32_t) :: period, stable, side
    real(dp) :: spacing, length, fastest
  end type branch_t

  !> The saddle, and what the beginning of the first arc becomes beside it: after j periods the point x(:, j) + t(:, j).
  !> Starts of any nearness to the saddle are so known without the periods that they spend beside it.
  type :: cycle_t
    integer :: q                        !< periods until the orbit, and the side, come back
    real(dp) :: multiplier              !< over q periods
    real(dp), allocatable :: x(:, :)    !< [2, 0:q-1]: half-turns, velocity
    real(dp), allocatable :: turned(:)  !< [0:q]: half-turns that are taken off x(:, j)
    real(dp), allocatable :: t(:, :)    !< [2, 0:q-1]: half-turns, velocity
  end type cycle_t

  !> The arc that is grown: places along the first piece, and where they are after the same number of periods.
  type :: arc_t
    real(dp), allocatable :: place(:)
    !> (half-turns, turns counted; velocity)
    real(dp), allocatable :: x(:, :)
  end type arc_t

contains

  !> Implements kz_manifold_grow of dynamics.h.
  function grow(pendulum, branch, most, point) bind(C, name='kz_manifold_grow') result(n_points)
    type(pendulum_t), intent(in) :: pendulum
    type(branch_t), intent(in) :: branch
    integer(c_int64_t), value :: most
    real(dp), intent(out) :: point(4, most)
    integer(c_int64_t) :: n_points
    class(flow_t), allocatable :: flow
    type(pendulum_t) :: turned
    real(dp) :: sign
    integer :: n

    turned = pendulum
    sign = 1
    if (branch%stable == 1) then ! time runs backwards: (theta, -v) obeys the equation with -beta
      turned%beta = -pendulum%beta
      turned%vertical(2, :) = -pendulum%vertical(2, :)
      turned%horizontal(2, :) = -pendulum%horizontal(2, :)
      sign = -1
    end if
    call make_flow(turned, fine_numerics(turned), .true., flow)
    call grow_from(flow, turned%beta, [branch%theta/PI, sign*branch%velocity], branch, n, point)
    n_points = n
    point(1, :n) = PI*point(1, :n) + 0.0_dp
    where (point(1, :n) >= PI) point(1, :n) = -PI
    point(2, :n) = sign*point(2, :n) + 0.0_dp
  end function grow

  !> Points along the branch from the saddle on, until it is long enough, or the list is full, or all of it is too fast.
  subroutine grow_from(flow, beta, x, branch, n, point)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, or its inverse, in physical coordinates
    real(dp), intent(in) :: beta !< damping of the map, < 0 for an inverse one
    real(dp), intent(in) :: x(2) !< the saddle: half-turns, velocity
    type(branch_t), intent(in) :: branch
    integer, intent(out) :: n
    real(dp), intent(out) :: point(:, :) !< half-turns, velocity, arc length, number of the unbroken part
    real(dp) :: extent, before
    type(cycle_t) :: saddle
    type(arc_t) :: arc
    integer :: periods, i
    logical :: resolved

    call make_cycle(flow, beta, int(branch%period), x, int(branch%side), saddle)
    allocate (arc%place(FIRST_POINTS))
    arc%place = [((i - 1)/real(FIRST_POINTS - 1, dp), i=1, FIRST_POINTS)]
    extent = 0
    n = 1
    point(:, 1) = [x, 0.0_dp, 0.0_dp]
    do periods = 0, MOST_PERIODS, saddle%q
      call place_arc(flow, periods, saddle, arc)
      call refine(flow, periods, saddle, branch, branch%length - point(3, n), size(point, 2), arc)
      if (all(abs(arc%x(2, :)) > branch%fastest)) return
      before = extent
      extent = PI*(maxval(arc%x(1, :)) - minval(arc%x(1, :))) + maxval(arc%x(2, :)) - minval(arc%x(2, :))
      if (extent < min(before, SHORTEST*branch%spacing)) return ! it shrinks onto an attractor
      call append(arc, branch, n, point, resolved)
      if (n == size(point, 2) .or. point(3, n) >= branch%length .or. .not. resolved) return
    end do
  end subroutine grow_from

  !> Points of a saddle's orbit, each by Newton's method, and the image of a first step along the unstable direction.
  subroutine make_cycle(flow, beta, period, x, side, saddle)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: beta
    integer, intent(in) :: period
    real(dp), intent(in) :: x(2)
    integer, intent(in) :: side
    type(cycle_t), intent(out) :: saddle
    real(dp) :: here(2), beside(2), tangent(2, 2, WIDTH)
    integer :: j

    call find_direction(flow, beta, period, x, saddle%q, beside, saddle%multiplier)
    beside = side*beside*NEARBY/saddle%multiplier
    allocate (saddle%x(2, 0:saddle%q - 1), saddle%t(2, 0:saddle%q - 1), saddle%turned(0:saddle%q))
    here = x
    saddle%turned(0) = 0
    do j = 0, saddle%q - 1
      saddle%x(:, j) = here
      saddle%t(:, j) = beside/[PI, 1.0_dp]
      call flow%put(1, here(1), here(2))
      tangent(:, :, 1) = IDENTITY
      call flow%advance_tangent(1, tangent)
      beside = matmul(tangent(:, :, 1), beside)
      here = [flow%u(1) + 2*real(flow%turns(1), dp), flow%v(1)]
      call take_point(flow, period, x, mod(j + 1, period) == 0, here, saddle%turned(j + 1))
      saddle%turned(j + 1) = saddle%turned(j + 1) + saddle%turned(j)
    end do
  end subroutine make_cycle

  !> A state beside a point of a cycle becomes that point; `turned`: half-turns that are taken off.
  subroutine take_point(flow, period, x, is_first, here, turned)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: period
    real(dp), intent(in) :: x(2) !< the first point, which is known
    logical, intent(in) :: is_first
    real(dp), intent(inout) :: here(2)
    real(dp), intent(out) :: turned
    real(dp), parameter :: FARTHEST = 1e-3_dp
    real(dp) :: point(2)
    logical :: found, blurred

    point = [angle_difference(here(1), 0.0_dp), here(2)]
    call newton(flow, period, FARTHEST, point, found, blurred)
    if (.not. found) point = [angle_difference(here(1), 0.0_dp), here(2)]
    if (is_first) point = x
    turned = 2*anint((here(1) - point(1))/2)
    here = point
  end subroutine take_point

  !> The unit eigenvector (rad, rad per drive radian) of the multiplier that is larger than 1 over q periods: the period
  !> of the saddle, or twice that for a multiplier below -1.
  subroutine find_direction(flow, beta, period, x, q, direction, multiplier)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: beta
    integer, intent(in) :: period
    real(dp), intent(in) :: x(2)
    integer, intent(out) :: q
    real(dp), intent(out) :: direction(2), multiplier
    real(dp) :: residual(2), matrix(2, 2)
    complex(dp) :: values(2)

    call n_periods(flow, period, 1, x, residual, matrix)
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

  !> arc%x = the images after `periods` of the points t multiplier**place beside the saddle.
  subroutine place_arc(flow, periods, saddle, arc)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: periods
    type(cycle_t), intent(in) :: saddle
    type(arc_t), intent(inout) :: arc
    real(dp) :: start(2), turned(WIDTH)
    integer :: left(WIDTH), from, lanes, i, period

    if (allocated(arc%x)) deallocate (arc%x)
    allocate (arc%x(2, size(arc%place)))
    do from = 1, size(arc%place), WIDTH
      lanes = min(WIDTH, size(arc%place) - from + 1)
      do i = 1, lanes
        call find_start(saddle, periods, arc%place(from + i - 1), start, turned(i), left(i))
        call flow%put(i, start(1), start(2))
      end do
      do period = 0, maxval(left(:lanes))
        if (period > 0) call flow%advance(lanes)
        do i = 1, lanes
          if (left(i) == period) arc%x(:, from + i - 1) = [flow%u(i) + 2*real(flow%turns(i), dp) + turned(i), flow%v(i)]
        end do
      end do
    end do
  end subroutine place_arc

  !> The last state beside the saddle of the orbit that begins at t multiplier**place, and how many periods are left.
  subroutine find_start(saddle, periods, place, start, turned, left)
    type(cycle_t), intent(in) :: saddle
    integer, intent(in) :: periods
    real(dp), intent(in) :: place
    real(dp), intent(out) :: start(2) !< half-turns, velocity
    real(dp), intent(out) :: turned !< half-turns that the state has made before
    integer, intent(out) :: left !< remainder of `periods`
    real(dp) :: change(2), next(2)
    integer :: j

    change = saddle%t(:, 0)*saddle%multiplier**place
    do j = 1, periods
      next = saddle%t(:, mod(j, saddle%q))*saddle%multiplier**(place + j/saddle%q)
      if (norm2([PI, 1.0_dp]*next) > NEARBY) exit
      change = next
    end do
    j = j - 1
    start = saddle%x(:, mod(j, saddle%q)) + change
    turned = saddle%turned(saddle%q)*(j/saddle%q) + saddle%turned(mod(j, saddle%q)) + 2*anint(start(1)/2)
    start(1) = start(1) - 2*anint(start(1)/2)
    left = periods - j
  end subroutine find_start

  !> Halves the pieces of the arc until none is too long or bends too much, or there are `most` points. Pieces behind
  !> the length that is left to go stay as they are.
  subroutine refine(flow, periods, saddle, branch, left, most, arc)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: periods
    type(cycle_t), intent(in) :: saddle
    type(branch_t), intent(in) :: branch
    real(dp), intent(in) :: left
    integer, intent(in) :: most
    type(arc_t), intent(inout) :: arc
    type(arc_t) :: more
    logical, allocatable :: halve(:)
    integer :: i

    do
      allocate (halve, source=to_halve(arc, branch, left))
      if (.not. any(halve) .or. size(arc%place) + count(halve) > most) return
      more%place = pack([(0.5_dp*(arc%place(i) + arc%place(i + 1)), i=1, size(halve))], halve)
      call place_arc(flow, periods, saddle, more)
      call merge_arcs(halve, more, arc)
      deallocate (halve)
    end do
  end subroutine refine

  !> The pieces that are too long, or bend too much against a neighbour. Pieces outside the largest speed, and those
  !> behind the length that is left to go, never do.
  pure function to_halve(arc, branch, left) result(halve)
    type(arc_t), intent(in) :: arc
    type(branch_t), intent(in) :: branch
    real(dp), intent(in) :: left
    logical :: halve(size(arc%place) - 1)
    real(dp) :: piece(2, size(arc%place) - 1), long(size(arc%place) - 1), turn
    integer :: i, n

    n = size(halve)
    piece = arc%x(:, 2:) - arc%x(:, :n)
    piece(1, :) = PI*piece(1, :)
    long = norm2(piece, dim=1)
    halve = long > branch%spacing
    do i = 1, n - 1
      turn = abs(atan2(piece(1, i)*piece(2, i + 1) - piece(2, i)*piece(1, i + 1), &
                       dot_product(piece(:, i), piece(:, i + 1))))
      if (turn < BEND) cycle
      halve(i:i + 1) = halve(i:i + 1) .or. long(i:i + 1) > SHORTEST*branch%spacing
    end do
    halve = halve .and. min(abs(arc%x(2, :n)), abs(arc%x(2, 2:))) < branch%fastest
    halve = halve .and. arc%place(2:) - arc%place(:n) > NEAREST
    where (max(abs(arc%x(2, :n)), abs(arc%x(2, 2:))) > branch%fastest) long = 0 ! not counted
    do i = 2, n
      long(i) = long(i) + long(i - 1)
    end do
    halve(2:) = halve(2:) .and. long(:n - 1) < left + branch%spacing
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

  !> The points of the arc below the largest speed, but for its first, which ended the arc before. Neighbours that are
  !> too far apart end the branch: doubles do not resolve what lies between them.
  subroutine append(arc, branch, n, point, resolved)
    type(arc_t), intent(in) :: arc
    type(branch_t), intent(in) :: branch
    integer, intent(inout) :: n
    real(dp), intent(inout) :: point(:, :)
    logical, intent(out) :: resolved
    real(dp) :: arc_length, part, step
    integer :: i

    arc_length = point(3, n)
    part = point(4, n)
    resolved = .true.
    do i = 2, size(arc%place)
      if (abs(arc%x(2, i)) > branch%fastest) cycle
      if (n == size(point, 2) .or. arc_length >= branch%length) return
      if (abs(arc%x(2, i - 1)) > branch%fastest) then
        part = part + 1
      else
        step = separation(arc%x(1, i), arc%x(2, i), point(1, n), point(2, n))
        resolved = step <= 2*branch%spacing
        if (.not. resolved) return
        arc_length = arc_length + step
      end if
      n = n + 1
      point(:, n) = [angle_difference(arc%x(1, i), 0.0_dp), arc%x(2, i), arc_length, part]
    end do
  end subroutine append

end module kz_saddles_manifold
