!> All cycles of the stroboscopic map near a line of starts. The images of the line stretch and fold; pieces of it are halved until
!> those whose images pass near themselves are short. Where F^n(x) comes near x, the orbit of x closes by multiple shooting. A symmetric cycle
!> closes sooner: where mirror images of motions are motions, where -F^n(x) comes near x; where images half a period later are, where that of
!> F^n(x) does. It repels until then by a square root of what it does over all of its period, so that longer pieces show it. Without a limit of
!> the length of pieces F^n shows all.
module kz_saddles_lines
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_vector_step_table, only: numerics_t
  use kz_saddles_shooting, only: shoot, smallest_period, closed_orbit_t
  use kz_maps_states, only: separation, wrapped
  use kz_cycles_cycles, only: half_period_images
  use kz_model_pendulum, only: pendulum_t, pairing_symmetry, MIRROR, HALF_PERIOD
  implicit none
  private

  !> Steps with which cycles are found, as a part of those with which they are published: eight times fewer leave 1e-9.
  integer, parameter :: FEWER = 8

  !> rad: an image that passes so near its piece shows a cycle; a piece is short whose images are no longer than this.
  real(dp), parameter :: REACH = 0.25_dp, SHORT = 0.25_dp
  !> So far beyond its ends, in units of the piece, an image is taken as straight.
  real(dp), parameter :: BEYOND = 0.25_dp
  !> Length (rad) of the least piece that is halved: times the trace of the steepest cycles, and where these have no limit.
  real(dp), parameter :: STRETCH = 0.1_dp, SHORTEST = 1e-13_dp
  !> Pieces between the first starts that are halved together.
  integer, parameter :: CELLS = 16
  !> How often a piece is halved at most.
  integer, parameter :: HALVINGS = 45
  !> rad: when an orbit is closed, when two points of it are one, and how far outside a window its edge still is.
  real(dp), parameter :: CLOSE = 1e-7_dp, ONE = 1e-5_dp, EDGE = 1e-9_dp

contains

  !> kz_dynamics_search_line of dynamics.h.
  function search_line(pendulum, max_period, n_nodes, node, window, steepest, most_starts, most, found, work) &
    bind(C, name='kz_dynamics_search_line') result(n_found)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: max_period, n_nodes
    real(dp), intent(in) :: node(2, n_nodes), window(4)
    real(dp), value :: steepest
    integer(c_int64_t), value :: most_starts, most
    real(dp), intent(out) :: found(2 + 2*max_period, most)
    integer(c_int64_t), intent(out) :: work(2)
    integer(c_int64_t) :: n_found
    class(flow_t), allocatable :: flow
    type(numerics_t) :: numerics
    real(dp), allocatable :: waiting(:, :, :, :, :)
    real(dp) :: piece(2, 0:1, 0:max_period, 2, WIDTH), orbit(2, 0:1, 0:max_period, WIDTH)
    integer :: symmetry, least(0:1), last(0:1), n_waiting, lanes, first, i

    symmetry = merge(pairing_symmetry(pendulum), 0, steepest < huge(steepest))
    least = [1, merge(0, 1, symmetry == HALF_PERIOD)]
    last = [int(max_period), merge(int(max_period - 1 + least(1))/2, -1, symmetry /= 0)]
    numerics = fine_numerics(pendulum)
    numerics%steps_per_period = numerics%steps_per_period/FEWER
    call make_flow(pendulum, numerics, symmetry /= HALF_PERIOD, flow)
    work = 0
    allocate (waiting(2, 0:1, 0:max_period, 2, 2*WIDTH*HALVINGS))
    n_found = 0
    do first = 1, int(n_nodes) - 1, CELLS
      n_waiting = 0
      lanes = min(CELLS + 1, int(n_nodes) - first + 1)
      orbit(:, 0, 0, :lanes) = node(:, first:first + lanes - 1)
      call follow(flow, symmetry, orbit(:, :, :, :lanes))
      do i = 1, lanes - 1
        call look_between(orbit(:, :, :, i), orbit(:, :, :, i + 1))
      end do
      do while (n_waiting > 0 .and. n_found <= most .and. work(1) <= most_starts)
        lanes = min(n_waiting, WIDTH)
        n_waiting = n_waiting - lanes
        piece(:, :, :, :, :lanes) = waiting(:, :, :, :, n_waiting + 1:n_waiting + lanes)
        orbit(:, 0, 0, :lanes) = 0.5_dp*(piece(:, 0, 0, 1, :lanes) + piece(:, 0, 0, 2, :lanes))
        call follow(flow, symmetry, orbit(:, :, :, :lanes))
        work(1) = work(1) + lanes
        do i = 1, lanes
          call look_between(piece(:, :, :, 1, i), orbit(:, :, :, i))
          call look_between(orbit(:, :, :, i), piece(:, :, :, 2, i))
        end do
      end do
    end do
  contains
    !> The piece between two starts, given by their orbits, waits to be halved, or shows its cycles. (The newest wait on top: at most
    !> 2 WIDTH of each length.)
    subroutine look_between(a, b)
      real(dp), intent(in) :: a(2, 0:1, 0:max_period), b(2, 0:1, 0:max_period)
      integer :: n, image

      if (is_long(a, b)) then
        n_waiting = n_waiting + 1
        waiting(:, :, :, 1, n_waiting) = a
        waiting(:, :, :, 2, n_waiting) = b
        return
      end if
      do n = 0, int(max_period)
        do image = 0, 1
          if (n < least(image) .or. n > last(image)) cycle
          if (norm2(b(:, image, n) - a(:, image, n)) > SHORT) return
          call close_pass(a, b, image, n)
        end do
      end do
    end subroutine look_between

    !> Whether an image of the piece is too long to decide whether it passes near the piece.
    pure function is_long(a, b) result(long)
      real(dp), intent(in) :: a(2, 0:1, 0:max_period), b(2, 0:1, 0:max_period)
      logical :: long
      real(dp) :: length
      integer :: n, image

      long = .false.
      if (norm2(b(:, 0, 0) - a(:, 0, 0)) < max(SHORTEST, STRETCH/steepest)) return
      length = 0
      do n = 0, int(max_period)
        do image = 0, 1
          if (n < least(image) .or. n > last(image)) cycle
          length = max(length, norm2(b(:, image, n) - a(:, image, n)))
          if (length <= SHORT) cycle
          long = min(distance(a(:, 0, 0), a(:, image, n)), distance(b(:, 0, 0), b(:, image, n))) < REACH + length
          if (long) return
        end do
      end do
    end function is_long

    !> The cycle near the place where an image of a short piece passes near the piece: the second half of a symmetric one is the image of the first.
    subroutine close_pass(a, b, image, n)
      real(dp), intent(in) :: a(2, 0:1, 0:max_period), b(2, 0:1, 0:max_period)
      integer, intent(in) :: image, n
      real(dp) :: share, points(2, 0:1, 0:n)
      integer :: period
      logical :: near

      call find_pass(a(:, 0, 0), b(:, 0, 0), a(:, image, n), b(:, image, n), share, near)
      if (.not. near) return
      work(2) = work(2) + 1
      points = a(:, :, :n) + share*(b(:, :, :n) - a(:, :, :n))
      period = merge(n, 2*n + 1 - least(1), image == 0)
      call close_orbit(flow, symmetry, window, steepest, pendulum%beta, &
                       reshape([points(:, 0, :period - 1 - image*n), points(:, image, :n - 1)], [2, period]), n_found, found)
    end subroutine close_pass
  end function search_line

  !> Images of the starts orbit(:, 0, 0), rad, turns counted: orbit(:, 0, n) becomes F^n, orbit(:, 1, n) the image of that under a symmetry.
  subroutine follow(flow, symmetry, orbit)
    class(flow_t), intent(inout) :: flow !< its steps are not fused, where images are half a period later
    integer, intent(in) :: symmetry !< MIRROR, HALF_PERIOD or 0
    real(dp), intent(inout) :: orbit(:, 0:, 0:, :)
    real(dp) :: start(size(orbit, 4)), turns(size(orbit, 4)), u(2, size(orbit, 4)), v(2, size(orbit, 4))
    integer :: lanes, n

    lanes = size(orbit, 4)
    start = wrapped(orbit(1, 0, 0, :)/PI)
    orbit(:, 1, :, :) = 0
    call flow%put_all(start, orbit(2, 0, 0, :))
    do n = 1, ubound(orbit, 3)
      if (symmetry == HALF_PERIOD) then
        turns = real(flow%turns(:lanes), dp)
        call flow%sample(2, u, v)
        orbit(1, 1, n - 1, :) = -(orbit(1, 0, 0, :) + PI*(2*turns + (u(1, :) - start)))
        orbit(2, 1, n - 1, :) = -v(1, :)
      else
        call flow%advance(lanes)
      end if
      orbit(1, 0, n, :) = orbit(1, 0, 0, :) + PI*(2*real(flow%turns(:lanes), dp) + (flow%u(:lanes) - start))
      orbit(2, 0, n, :) = flow%v(:lanes)
    end do
    if (symmetry == MIRROR) orbit(:, 1, :, :) = -orbit(:, 0, :, :)
  end subroutine follow

  !> Does the image of a short piece pass near the piece, and where: its share of the piece from the first end on.
  pure subroutine find_pass(a, b, image_a, image_b, share, near)
    real(dp), intent(in) :: a(2), b(2), image_a(2), image_b(2)
    real(dp), intent(out) :: share
    logical, intent(out) :: near
    real(dp) :: shift(2), slope(2)

    shift = [PI*wrapped((image_a(1) - a(1))/PI), image_a(2) - a(2)]
    slope = (image_b - image_a) - (b - a)
    share = 0
    if (norm2(slope) > 0) share = -dot_product(shift, slope)/dot_product(slope, slope)
    near = share >= -BEYOND .and. share <= 1 + BEYOND .and. norm2(shift + share*slope) < REACH
  end subroutine find_pass

  !> From one state to another, rad.
  pure function distance(a, b) result(d)
    real(dp), intent(in) :: a(2), b(2)
    real(dp) :: d

    d = separation(a(1)/PI, a(2), b(1)/PI, b(2))
  end function distance

  !> The cycle near an orbit joins those that were found, if there is one that is not too steep and the window has a point of it.
  subroutine close_orbit(flow, symmetry, window, steepest, damping, orbit, n_found, found)
    class(flow_t), intent(inout) :: flow !< as `follow` has it
    integer, intent(in) :: symmetry
    real(dp), intent(in) :: window(4), steepest, damping
    real(dp), intent(in) :: orbit(:, :) !< rad
    integer(c_int64_t), intent(inout) :: n_found
    real(dp), intent(inout) :: found(:, :)
    real(dp) :: x(2, size(orbit, 2))
    type(closed_orbit_t) :: closed
    integer :: period

    x(1, :) = wrapped(orbit(1, :)/PI)
    x(2, :) = orbit(2, :)
    call shoot(flow, CLOSE, x, closed)
    if (.not. closed%step < CLOSE) return
    period = smallest_period(x, ONE)
    if (period == size(x, 2)) then
      if (steepness(closed%matrix, exp(-2*PI*damping*period), is_own_image(flow, symmetry, x)) > steepest) return
    end if
    if (.not. any(inside(window, x(1, :), x(2, :)))) return
    n_found = n_found + 1
    if (n_found > size(found, 2)) return
    found(:, n_found) = 0
    found(:2, n_found) = [real(period, dp), maxval(abs(x(2, :period)))]
    found(3:2 + 2*period, n_found) = reshape(x(:, :period), [2*period])
  end subroutine close_orbit

  !> Whether the image of a closed orbit under a symmetry is that orbit.
  function is_own_image(flow, symmetry, x) result(own)
    class(flow_t), intent(inout) :: flow !< as `follow` has it
    integer, intent(in) :: symmetry
    real(dp), intent(in) :: x(:, :) !< half-turns, rad per drive radian
    logical :: own
    real(dp) :: u(size(x, 2)), v(size(x, 2))
    integer :: n

    n = size(x, 2)
    own = symmetry /= 0 .and. mod(n, 2) == merge(1, 0, symmetry == HALF_PERIOD)
    if (.not. own) return
    u = x(1, :)
    v = x(2, :)
    if (symmetry == MIRROR) then
      u = -u
      v = -v
    else
      call half_period_images(flow, u, v)
    end if
    own = all(separation(x(1, :), x(2, :), cshift(u, n/2), cshift(v, n/2)) < ONE)
  end function is_own_image

  !> The trace of the map of which a closed orbit is a fixed point, in that of a multiplier of 1: of a symmetric one the map to its image, whose
  !> square the whole is.
  pure function steepness(matrix, determinant, symmetric)
    real(dp), intent(in) :: matrix(2, 2), determinant !< derivative over the whole orbit
    logical, intent(in) :: symmetric
    real(dp) :: steepness, trace, half

    trace = matrix(1, 1) + matrix(2, 2)
    steepness = abs(trace)/(1 + determinant)
    if (.not. symmetric) return
    half = sqrt(determinant)
    steepness = sqrt(max(0.0_dp, trace + 2*half))/(1 + half)
  end function steepness

  !> The states (half-turns, rad per drive radian) that lie in the window.
  pure function inside(window, u, v)
    real(dp), intent(in) :: window(4), u(:), v(:)
    logical :: inside(size(u))
    real(dp) :: middle

    middle = 0.5_dp*(window(1) + window(2))
    inside = abs(PI*wrapped(u - middle/PI)) <= 0.5_dp*(window(2) - window(1)) + EDGE .and. &
             v >= window(3) - EDGE .and. v <= window(4) + EDGE
  end function inside

end module kz_saddles_lines
