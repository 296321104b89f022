!> All cycles of the stroboscopic map, attracting or not, that a grid of starts shows: the zeros of the displacement of F^n in
!> its cells, made exact by Newton's method.
module kz_saddles_scan
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: flow_t, WIDTH, PI
  use kz_cycles_newton, only: solved
  use kz_maps_states, only: angle_difference, separation
  use kz_saddles_zeros, only: triangle_zeros
  implicit none
  private
  public :: scan_strip, search_from

  !> Newton's method from a seed: most steps, the longest (rad), the one that is short enough, and speeds at which it is lost.
  integer, parameter :: STEPS = 16
  real(dp), parameter :: LONGEST = 0.3_dp, CLOSE = 1e-7_dp, FASTEST = 1e3_dp
  !> The method of R. L. Davidchack and Y.-C. Lai, Phys. Rev. E 60 (1999) 6172: a multiple of the displacement's length times each of
  !> these turns and reflections is added to the derivative, so that other seeds lead to a cycle than those beside it. Most steps, and
  !> the multiples for the first period and how they grow with it.
  integer, parameter :: STABILISED_STEPS = 150
  real(dp), parameter :: STRENGTHS(3) = [1, 8, 64], GROWTH = 1.3_dp
  real(dp), parameter :: TURNS(2, 2, 8) = reshape([1, 0, 0, 1, -1, 0, 0, -1, 1, 0, 0, -1, -1, 0, 0, 1, &
                                                   0, 1, 1, 0, 0, -1, -1, 0, 0, 1, -1, 0, 0, -1, 1, 0], [2, 2, 8])
  !> Derivatives by differences: a distance (rad), and how many seeds share a tile.
  real(dp), parameter :: BESIDE = 1e-7_dp
  integer, parameter :: SEEDS = (WIDTH - 1)/3
  !> Points nearer than this are one: an orbit's last points carry the first one's error, grown.
  real(dp), parameter :: ONE = 1e-5_dp

contains

  !> The cycles of up to max_period periods with a point in a strip of the grid, each once: periods and a point of each.
  subroutine scan_strip(flow, u, v, max_period, found)
    !> the map of one drive period in physical coordinates
    class(flow_t), intent(inout) :: flow
    !> angles of the nodes, half-turns
    real(dp), intent(in) :: u(:)
    !> velocities of the rows of nodes, rad per drive radian
    real(dp), intent(in) :: v(:)
    !> longest period of a cycle
    integer, intent(in) :: max_period
    !> for each cycle: period, half-turns, velocity; to 1e-7 or better
    real(dp), allocatable, intent(out) :: found(:, :)
    real(dp), allocatable :: shift(:, :, :, :), seed(:, :), points(:, :)
    integer :: n, n_seeds

    allocate (shift(2, max_period, size(u), size(v)), found(3, 0), points(3, 0))
    allocate (seed(2, 8*size(u)*size(v)))
    call displacements(flow, u, v, max_period, shift)
    do n = 1, max_period
      call find_seeds(u, v, shift(:, n, :, :), n_seeds, seed)
      call close_seeds(flow, n, seed(:, :n_seeds), points, found)
    end do
  end subroutine scan_strip

  !> The cycles of n periods to which Newton's method leads from the seeds, stabilised in all ways: points of other cycles are good
  !> ones, as long cycles pass by shorter ones.
  subroutine search_from(flow, n, seed, found)
    !> the map of one drive period in physical coordinates
    class(flow_t), intent(inout) :: flow
    !> periods
    integer, intent(in) :: n
    !> half-turns, rad per drive radian
    real(dp), intent(in) :: seed(:, :)
    !> for each cycle: period, half-turns, velocity; to 1e-7 or better
    real(dp), allocatable, intent(out) :: found(:, :)
    real(dp), allocatable :: points(:, :)
    integer :: i, j

    allocate (found(3, 0), points(3, 0))
    do j = 1, size(STRENGTHS)
      do i = 1, size(TURNS, 3)
        call close_seeds(flow, n, seed, points, found, STRENGTHS(j)*GROWTH**(n - 1)*TURNS(:, :, i))
      end do
    end do
  end subroutine search_from

  !> shift(:, n, i, j) = F^n(x) - x of node (i, j), turns counted: rad, rad per drive radian.
  subroutine displacements(flow, u, v, max_period, shift)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: u(:)
    real(dp), intent(in) :: v(:)
    integer, intent(in) :: max_period
    real(dp), intent(out) :: shift(:, :, :, :)
    integer :: first, lanes, i, j, n

    do j = 1, size(v)
      do first = 1, size(u), WIDTH
        lanes = min(WIDTH, size(u) - first + 1)
        do i = 1, lanes
          call flow%put(i, u(first + i - 1), v(j))
        end do
        do n = 1, max_period
          call flow%advance(lanes)
          do i = 1, lanes
            shift(:, n, first + i - 1, j) = [PI*(2*real(flow%turns(i), dp) + (flow%u(i) - u(first + i - 1))), flow%v(i) - v(j)]
          end do
        end do
      end do
    end do
  end subroutine displacements

  !> The zeros of one displacement in the two triangles of every cell.
  subroutine find_seeds(u, v, shift, n, seed)
    real(dp), intent(in) :: u(:)
    real(dp), intent(in) :: v(:)
    real(dp), intent(in) :: shift(:, :, :)
    integer, intent(out) :: n
    real(dp), intent(inout) :: seed(:, :)
    real(dp) :: x(2, 4), value(2, 4)
    integer :: i, j

    n = 0
    do j = 1, size(v) - 1
      do i = 1, size(u) - 1
        x = reshape([u(i), v(j), u(i + 1), v(j), u(i + 1), v(j + 1), u(i), v(j + 1)], [2, 4])
        value(:, 1:2) = shift(:, i:i + 1, j)
        value(:, 3) = shift(:, i + 1, j + 1)
        value(:, 4) = shift(:, i, j + 1)
        call triangle_zeros(x(:, [1, 2, 3]), value(:, [1, 2, 3]), n, seed)
        call triangle_zeros(x(:, [3, 4, 1]), value(:, [3, 4, 1]), n, seed)
      end do
    end do
  end subroutine find_seeds

  !> Newton's method from all seeds of one period, a tile at a time; new cycles join `found`, their points `points`.
  subroutine close_seeds(flow, n, seed, points, found, turn)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    real(dp), intent(in) :: seed(:, :)
    !> points of known cycles: period, half-turns, velocity
    real(dp), allocatable, intent(inout) :: points(:, :)
    real(dp), allocatable, intent(inout) :: found(:, :)
    !> stabilises the method
    real(dp), intent(in), optional :: turn(2, 2)
    real(dp) :: x(2, SEEDS), orbit(2, n, SEEDS)
    logical :: closed(SEEDS)
    integer :: first, lanes, period, i, j

    do first = 1, size(seed, 2), SEEDS
      lanes = min(SEEDS, size(seed, 2) - first + 1)
      x(:, :lanes) = seed(:, first:first + lanes - 1)
      call close_lanes(flow, n, lanes, x, closed, turn)
      if (.not. any(closed(:lanes))) cycle
      call follow_lanes(flow, n, lanes, x, orbit)
      do i = 1, lanes
        if (.not. closed(i)) cycle
        if (contain(points, n, x(1, i), x(2, i))) cycle
        period = smallest_period(orbit(:, :, i))
        points = reshape([points, (real(period, dp), orbit(:, j, i), j=1, period)], [3, size(points, 2) + period])
        found = reshape([found, real(period, dp), x(:, i)], [3, size(found, 2) + 1])
      end do
    end do
  end subroutine close_seeds

  !> Fixed points of F^n by Newton's method in all lanes at once; x = the last iterate of each.
  subroutine close_lanes(flow, n, lanes, x, closed, turn)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    integer, intent(in) :: lanes
    real(dp), intent(inout) :: x(2, SEEDS)
    logical, intent(out) :: closed(SEEDS)
    real(dp), intent(in), optional :: turn(2, 2)
    real(dp) :: step(2)
    integer :: open(SEEDS), n_open, left, iteration, lane, i

    closed = .false.
    open = [(i, i=1, SEEDS)]
    n_open = lanes
    do iteration = 1, merge(STABILISED_STEPS, STEPS, present(turn))
      do lane = 1, n_open
        call put_neighbours(flow, lane, x(:, open(lane)))
      end do
      do i = 1, n
        call flow%advance(3*n_open)
      end do
      left = 0
      do lane = 1, n_open
        i = open(lane)
        step = newton_step(flow, lane, x(:, i), turn)
        closed(i) = norm2(step) < CLOSE
        if (norm2(step) > LONGEST) step = step*(LONGEST/norm2(step))
        x(:, i) = [angle_difference(x(1, i), step(1)/PI), x(2, i) - step(2)]
        if (closed(i) .or. .not. abs(x(2, i)) < FASTEST) cycle
        left = left + 1
        open(left) = i
      end do
      n_open = left
      if (n_open == 0) return
    end do
  end subroutine close_lanes

  !> A state and its neighbours in angle and in velocity.
  subroutine put_neighbours(flow, lane, x)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: lane
    real(dp), intent(in) :: x(2)

    call flow%put(3*lane - 2, x(1), x(2))
    call flow%put(3*lane - 1, x(1) + BESIDE/PI, x(2))
    call flow%put(3*lane, x(1), x(2) + BESIDE)
  end subroutine put_neighbours

  !> The step of Newton's method at x, from its image and those of its neighbours: rad.
  function newton_step(flow, lane, x, turn) result(step)
    class(flow_t), intent(in) :: flow
    integer, intent(in) :: lane
    real(dp), intent(in) :: x(2)
    real(dp), intent(in), optional :: turn(2, 2)
    real(dp) :: step(2)
    real(dp) :: matrix(2, 2), shift(2)
    integer :: i, j

    i = 3*lane - 2
    do j = 1, 2
      matrix(:, j) = [PI*angle_difference(flow%u(i + j), flow%u(i)), flow%v(i + j) - flow%v(i)]/BESIDE
    end do
    shift = [PI*angle_difference(flow%u(i), x(1)), flow%v(i) - x(2)]
    if (present(turn)) matrix = matrix - norm2(shift)*turn
    step = solved(matrix, shift)
  end function newton_step

  !> The first n points of the orbits from x.
  subroutine follow_lanes(flow, n, lanes, x, orbit)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    integer, intent(in) :: lanes
    real(dp), intent(in) :: x(2, SEEDS)
    real(dp), intent(out) :: orbit(2, n, SEEDS)
    integer :: i, j

    do i = 1, lanes
      call flow%put(i, x(1, i), x(2, i))
    end do
    do j = 1, n
      orbit(1, j, :lanes) = flow%u(:lanes)
      orbit(2, j, :lanes) = flow%v(:lanes)
      call flow%advance(lanes)
    end do
  end subroutine follow_lanes

  !> The smallest divisor of the period of a closed orbit after which it is back.
  pure function smallest_period(orbit) result(period)
    real(dp), intent(in) :: orbit(:, :)
    integer :: period

    do period = 1, size(orbit, 2) - 1
      if (mod(size(orbit, 2), period) /= 0) cycle
      if (separation(orbit(1, 1 + period), orbit(2, 1 + period), orbit(1, 1), orbit(2, 1)) < ONE) return
    end do
    period = size(orbit, 2)
  end function smallest_period

  !> Does (u, v) belong to a known cycle whose period divides n?
  pure function contain(points, n, u, v) result(inside)
    real(dp), intent(in) :: points(:, :)
    integer, intent(in) :: n
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    logical :: inside
    integer :: i

    inside = .true.
    do i = 1, size(points, 2)
      if (abs(points(3, i) - v) > ONE) cycle
      if (mod(n, nint(points(1, i))) == 0 .and. separation(points(2, i), points(3, i), u, v) < ONE) return
    end do
    inside = .false.
  end function contain

end module kz_saddles_scan
