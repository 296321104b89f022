!> All cycles of the stroboscopic map near a line of starts. The images of the line stretch and fold; pieces of it are
!> halved until those whose images pass near themselves are short. Where F^n(x) comes near x, the orbit of x closes by
!> multiple shooting. A symmetric cycle closes sooner: where mirror images of motions are motions, where -F^n(x) comes
!> near x; where images half a period later are, where that of F^n(x) does. It repels until then by a square root of
!> what it does over all of its period, so that longer pieces show it. Without a limit of the length of pieces F^n shows
!> all.
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
  !> Distance beyond its ends, in units of the piece, up to which an image counts as straight.
  real(dp), parameter :: BEYOND = 0.25_dp
  !> Least length (rad) of a piece that is halved: times the trace of the steepest cycles, and without limit on these.
  real(dp), parameter :: STRETCH = 0.1_dp, SHORTEST = 1e-13_dp
  !> Pieces between the first starts that are halved together.
  integer, parameter :: CELLS = 16
  !> How often a piece is halved at most.
  integer, parameter :: HALVINGS = 45
  !> rad: when an orbit is closed, when two points of it are one, and how far outside a window its edge still is.
  real(dp), parameter :: CLOSE = 1e-7_dp, ONE = 1e-5_dp, EDGE = 1e-9_dp

  !> Memory of kz_line_search of dynamics_saddles.h.
  type, bind(C) :: line_search_t
    integer(c_int64_t) :: max_period, most_starts, most
    real(dp) :: window(4), steepest
  end type line_search_t

  !> A search at work.
  type :: search_t
    type(line_search_t) :: asked
    class(flow_t), allocatable :: flow
    real(dp) :: damping
    integer :: symmetry, least(0:1), last(0:1) !< periods at which images of a piece are checked: map, symmetry
    real(dp), allocatable :: waiting(:, :, :, :, :)
    integer :: n_waiting = 0
    integer(c_int64_t) :: n_found = 0, work(2) = 0
  end type search_t

contains

  !> Implements kz_dynamics_search_line of dynamics_saddles.h.
  function search_line(pendulum, asked, n_nodes, node, found, work) bind(C, name='kz_dynamics_search_line') &
      result(n_found)
    type(pendulum_t), intent(in) :: pendulum
    type(line_search_t), intent(in) :: asked
    integer(c_int64_t), value :: n_nodes
    real(dp), intent(in) :: node(2, n_nodes)
    real(dp), intent(out) :: found(2 + 2*asked%max_period, asked%most)
    integer(c_int64_t), intent(out) :: work(2)
    integer(c_int64_t) :: n_found
    type(search_t) :: search
    real(dp) :: orbit(2, 0:1, 0:asked%max_period, WIDTH)
    integer :: lanes, first, i

    call make_search(pendulum, asked, search)
    do first = 1, int(n_nodes) - 1, CELLS
      search%n_waiting = 0
      lanes = min(CELLS + 1, int(n_nodes) - first + 1)
      orbit(:, 0, 0, :lanes) = node(:, first:first + lanes - 1)
      call follow_images(search%flow, search%symmetry, orbit(:, :, :, :lanes))
      do i = 1, lanes - 1
        call look_between(search, orbit(:, :, :, i), orbit(:, :, :, i + 1), found)
      end do
      call halve_pieces(search, found)
    end do
    n_found = search%n_found
    work = search%work
  end function search_line

  subroutine make_search(pendulum, asked, search)
    type(pendulum_t), intent(in) :: pendulum
    type(line_search_t), intent(in) :: asked
    type(search_t), intent(out) :: search
    type(numerics_t) :: numerics

    search%asked = asked
    search%damping = pendulum%beta
    search%symmetry = merge(pairing_symmetry(pendulum), 0, asked%steepest < huge(asked%steepest))
    search%least = [1, merge(0, 1, search%symmetry == HALF_PERIOD)]
    search%last = [int(asked%max_period), &
                   merge(int(asked%max_period - 1 + search%least(1))/2, -1, search%symmetry /= 0)]
    numerics = fine_numerics(pendulum)
    numerics%steps_per_period = numerics%steps_per_period/FEWER
    call make_flow(pendulum, numerics, search%symmetry /= HALF_PERIOD, search%flow)
    allocate (search%waiting(2, 0:1, 0:asked%max_period, 2, 2*WIDTH*HALVINGS))
  end subroutine make_search

  !> Halves the pieces that wait, the newest first, until none waits or enough is found.
  subroutine halve_pieces(search, found)
    type(search_t), intent(inout) :: search
    real(dp), intent(inout) :: found(:, :)
    real(dp), dimension(2, 0:1, 0:search%asked%max_period, WIDTH) :: before, after, orbit
    integer :: lanes, i

    do while (search%n_waiting > 0 .and. search%n_found <= search%asked%most &
              .and. search%work(1) <= search%asked%most_starts)
      lanes = min(search%n_waiting, WIDTH)
      search%n_waiting = search%n_waiting - lanes
      associate (piece => search%waiting(:, :, :, :, search%n_waiting + 1:search%n_waiting + lanes))
        before(:, :, :, :lanes) = piece(:, :, :, 1, :)
        after(:, :, :, :lanes) = piece(:, :, :, 2, :)
      end associate
      orbit(:, 0, 0, :lanes) = 0.5_dp*(before(:, 0, 0, :lanes) + after(:, 0, 0, :lanes))
      call follow_images(search%flow, search%symmetry, orbit(:, :, :, :lanes))
      search%work(1) = search%work(1) + lanes
      do i = 1, lanes
        call look_between(search, before(:, :, :, i), orbit(:, :, :, i), found)
        call look_between(search, orbit(:, :, :, i), after(:, :, :, i), found)
      end do
    end do
  end subroutine halve_pieces

  !> The piece between two starts, given by their orbits, waits to be halved, or shows its cycles. (The newest wait on
  !> top: at most 2 WIDTH of each length.)
  subroutine look_between(search, a, b, found)
    type(search_t), intent(inout) :: search
    real(dp), intent(in) :: a(:, 0:, 0:), b(:, 0:, 0:)
    real(dp), intent(inout) :: found(:, :)
    integer :: n, image

    if (is_long(search, a, b)) then
      search%n_waiting = search%n_waiting + 1
      search%waiting(:, :, :, 1, search%n_waiting) = a
      search%waiting(:, :, :, 2, search%n_waiting) = b
      return
    end if
    do n = 0, int(search%asked%max_period)
      do image = 0, 1
        if (n < search%least(image) .or. n > search%last(image)) cycle
        if (norm2(b(:, image, n) - a(:, image, n)) > SHORT) return
        call close_pass(search, a, b, [image, n], found)
      end do
    end do
  end subroutine look_between

  !> Whether an image of the piece is too long to decide whether it passes near the piece.
  pure function is_long(search, a, b) result(long)
    type(search_t), intent(in) :: search
    real(dp), intent(in) :: a(:, 0:, 0:), b(:, 0:, 0:)
    logical :: long
    real(dp) :: length
    integer :: n, image

    long = .false.
    if (norm2(b(:, 0, 0) - a(:, 0, 0)) < max(SHORTEST, STRETCH/search%asked%steepest)) return
    length = 0
    do n = 0, int(search%asked%max_period)
      do image = 0, 1
        if (n < search%least(image) .or. n > search%last(image)) cycle
        length = max(length, norm2(b(:, image, n) - a(:, image, n)))
        if (length <= SHORT) cycle
        long = min(distance(a(:, 0, 0), a(:, image, n)), distance(b(:, 0, 0), b(:, image, n))) < REACH + length
        if (long) return
      end do
    end do
  end function is_long

  !> Cycle near the place where a short piece's image passes it; a symmetric one's second half is the first's image.
  subroutine close_pass(search, a, b, at, found)
    type(search_t), intent(inout) :: search
    real(dp), intent(in) :: a(:, 0:, 0:), b(:, 0:, 0:)
    integer, intent(in) :: at(2) !< 1 = image under a symmetry, else 0; periods
    real(dp), intent(inout) :: found(:, :)
    real(dp) :: share, points(2, 0:1, 0:at(2))
    integer :: period
    logical :: near

    associate (image => at(1), n => at(2))
      call find_pass(a(:, 0, 0), b(:, 0, 0), a(:, image, n), b(:, image, n), share, near)
      if (.not. near) return
      search%work(2) = search%work(2) + 1
      points = a(:, :, :n) + share*(b(:, :, :n) - a(:, :, :n))
      period = merge(n, 2*n + 1 - search%least(1), image == 0)
      call close_orbit(search, reshape([points(:, 0, :period - 1 - image*n), points(:, image, :n - 1)], [2, period]), &
                       found)
    end associate
  end subroutine close_pass

  !> Images of the starts orbit(:, 0, 0), rad, turns counted: orbit(:, 0, n) = F^n, orbit(:, 1, n) its symmetric image.
  subroutine follow_images(flow, symmetry, orbit)
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
  end subroutine follow_images

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

  !> The cycle near an orbit joins those found, if it exists, is not too steep and has a point in the window.
  subroutine close_orbit(search, orbit, found)
    type(search_t), intent(inout) :: search
    real(dp), intent(in) :: orbit(:, :) !< rad
    real(dp), intent(inout) :: found(:, :)
    real(dp) :: x(2, size(orbit, 2))
    type(closed_orbit_t) :: closed
    integer :: period

    x(1, :) = wrapped(orbit(1, :)/PI)
    x(2, :) = orbit(2, :)
    call shoot(search%flow, CLOSE, x, closed)
    if (.not. closed%step < CLOSE) return
    period = smallest_period(x, ONE)
    if (period == size(x, 2)) then
      if (steepness(closed%matrix, exp(-2*PI*search%damping*period), is_own_image(search%flow, search%symmetry, x)) &
          > search%asked%steepest) return
    end if
    if (.not. any(inside(search%asked%window, x(1, :), x(2, :)))) return
    search%n_found = search%n_found + 1
    if (search%n_found > size(found, 2)) return
    associate (row => found(:, search%n_found))
      row = 0
      row(:2) = [real(period, dp), maxval(abs(x(2, :period)))]
      row(3:2 + 2*period) = reshape(x(:, :period), [2*period])
    end associate
  end subroutine close_orbit

  !> Whether the image of a closed orbit under a symmetry is that orbit.
  function is_own_image(flow, symmetry, x) result(own)
    class(flow_t), intent(inout) :: flow !< as `follow_images` has it
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

  !> The trace of the map of which a closed orbit is a fixed point, in that of a multiplier of 1: of a symmetric one the
  !> map to its image, whose square the whole is.
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
