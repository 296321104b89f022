!> Curves of bifurcations and branches of cycles followed by pseudo-arclength, and what happens on the way: include/kapitza/dynamics_curves.h.
module kz_cycles_tracing
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_curves, only: plane_t, curve_kind_t, system_t, make_system, newton, linearise, tangent_at, wrapped, UNKNOWNS, FINE
  use kz_cycles_normal_forms, only: normal_form
  use kz_cycles_walker, only: walker_t, parents_t, advance, begin, distance, passes, set_parents, meets, FOLD, FLIP, CLOSE, FAR
  implicit none
  private

  !> KZ_TRACE_... of dynamics_curves.h.
  integer, parameter :: LEFT = 0, CLOSED = 1, LONG = 2, MERGED = 3, STUCK = 4, NO_SEED = 5
  !> KZ_SPECIAL_...
  integer, parameter :: CUSP = 1, DEGENERATE = 2

contains

  function trace(plane, kind, seed, direction, longest, most, rows, most_special, special, n_special, ending) &
    bind(C, name='kz_curve_trace') result(n_rows)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: seed(2*kind%points + 2)
    integer(c_int32_t), value :: direction
    real(dp), value :: longest
    integer(c_int64_t), value :: most, most_special
    real(dp), intent(out) :: rows(8 + 2*kind%points, most), special(3 + 2*kind%points, most_special)
    integer(c_int64_t), intent(out) :: n_special
    integer(c_int32_t), intent(out) :: ending
    integer(c_int64_t) :: n_rows
    type(walker_t) :: walker
    real(dp) :: before(UNKNOWNS), heading(UNKNOWNS)
    type(parents_t) :: was, is
    real(dp) :: form, side(2), former, start(UNKNOWNS), length, eigenvector(2)
    logical :: found
    integer :: n

    n = 2*kind%points
    n_rows = 0
    n_special = 0
    ending = NO_SEED
    call make_system(plane, kind, 2, .true., walker%system)
    call begin(walker, seed, longest, found)
    if (.not. found) return
    walker%tangent = direction*walker%tangent
    start = walker%y
    call set_parents(walker%system, walker%y, was)
    call normal_form(walker%system, form, side, eigenvector)
    call put()
    length = 0
    ending = LONG
    do while (n_rows < most)
      before = walker%y
      heading = walker%tangent
      former = form
      ending = STUCK
      if (.not. advance(walker)) return
      call set_parents(walker%system, walker%y, is)
      call normal_form(walker%system, form, side, eigenvector)
      ending = MERGED
      if (kind%multiplier > 0 .and. meets(was, is, int(kind%points)) > 0) return
      if ((former > 0) .neqv. (form > 0)) &
        call locate_special(walker, before, heading, former, form, special, n_special)
      was = is
      length = length + distance(walker%system, walker%y, before)
      call put()
      ending = LEFT
      if (outside(plane, walker%y(n + 1:n + 2))) return
      ending = CLOSED
      if (length > 6*longest .or. n_rows > 40) then
        if (passes(walker%system, before, walker%y, start)) return
      end if
      ending = LONG
    end do
  contains
    subroutine put()
      n_rows = n_rows + 1
      rows(:2, n_rows) = walker%sharp(n + 1:n + 2)
      rows(3:4, n_rows) = walker%tangent(n + 1:n + 2)
      rows(5, n_rows) = form
      rows(6:7, n_rows) = side
      rows(8, n_rows) = minval(was%distance)
      rows(9:, n_rows) = walker%sharp(:n)
    end subroutine put
  end function trace

  pure logical function outside(plane, at)
    type(plane_t), intent(in) :: plane
    real(dp), intent(in) :: at(2)

    outside = any(at < plane%low .or. at > plane%high)
  end function outside

  !> Where the normal form changes its sign between two points of a curve, by secants and bisection.
  subroutine locate_special(there, from, heading, at_low, at_high, special, n_special)
    type(walker_t), intent(in) :: there !< at the second point
    real(dp), intent(in) :: from(:), heading(:) !< the first point and the tangent there
    real(dp), intent(in) :: at_low, at_high !< normal forms of both
    real(dp), intent(inout) :: special(:, :)
    integer(c_int64_t), intent(inout) :: n_special
    real(dp), parameter :: POLE = 1e3_dp
    integer, parameter :: MOST = 40
    type(walker_t) :: walker
    real(dp) :: low, high, middle, form_low, form_high, form, side(2), eigenvector(2), unused(UNKNOWNS), sharp(UNKNOWNS)
    integer :: n, i, iterations
    logical :: found

    if (n_special == size(special, 2)) return
    walker = there
    n = 2*walker%system%n
    low = 0
    high = distance(walker%system, there%y, from)
    form_low = at_low
    form_high = at_high
    found = .false.
    do i = 1, MOST
      middle = low - form_low*(high - low)/(form_high - form_low)
      if (mod(i, 3) == 0) middle = 0.5_dp*(low + high)
      walker%y(:n + 2) = from(:n + 2) + middle*heading(:n + 2)
      call newton(walker%system, 12, FAR, CLOSE, walker%y, iterations, heading)
      if (iterations == 0) exit
      call tangent_at(walker%system, walker%y, heading, unused, found, sharp)
      if (.not. found) exit
      call normal_form(walker%system, form, side, eigenvector)
      if ((form > 0) .eqv. (form_low > 0)) then
        low = middle
        form_low = form
      else
        high = middle
        form_high = form
      end if
      if (abs(form) < 1e-9_dp .or. high - low < 1e-13_dp) exit
    end do
    if (.not. found .or. abs(form) > POLE) return
    n_special = n_special + 1
    special(1, n_special) = merge(CUSP, DEGENERATE, walker%system%kind%multiplier > 0)
    special(2:3, n_special) = sharp(n + 1:n + 2)
    special(4:, n_special) = sharp(:n)
  end subroutine locate_special

  function branch(plane, kind, start, along, longest, most, rows, most_events, events, n_events, ending) &
    bind(C, name='kz_curve_branch') result(n_rows)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: start(2*kind%points + 2), along(2)
    real(dp), value :: longest
    integer(c_int64_t), value :: most, most_events
    real(dp), intent(out) :: rows(4 + 2*kind%points, most), events(3 + 2*kind%points, most_events)
    integer(c_int64_t), intent(out) :: n_events
    integer(c_int32_t), intent(out) :: ending
    integer(c_int64_t) :: n_rows
    type(walker_t) :: walker
    type(parents_t) :: was, is
    real(dp) :: numbers(2), last(2), before(UNKNOWNS), share, first(UNKNOWNS)
    logical :: found
    integer :: n, met

    n = 2*kind%points
    n_rows = 0
    n_events = 0
    ending = NO_SEED
    call make_system(plane, kind, 1, .false., walker%system)
    walker%system%basis(:, 1) = along
    walker%is_sharp = .false.
    call begin_branch(walker, start, longest, found)
    if (.not. found) return
    first = walker%y
    call set_parents(walker%system, walker%y, was)
    call put()
    do while (n_rows < most)
      last = numbers
      before = walker%y
      ending = STUCK
      if (.not. advance(walker)) return
      call set_parents(walker%system, walker%y, is)
      met = meets(was, is, int(kind%points))
      ending = MERGED
      if (met > 0) then
        share = was%distance(met)/(was%distance(met) + is%distance(met))
        call add_event(met, before + share*(walker%y - before))
        return
      end if
      numbers = 1 + walker%system%determinant + [-1, 1]*walker%system%trace
      if (last(1)*numbers(1) < 0) call cross(FOLD, 1, last(1)/(last(1) - numbers(1)))
      if (last(2)*numbers(2) < 0) call cross(FLIP, -1, last(2)/(last(2) - numbers(2)))
      was = is
      call put()
      ending = LEFT
      if (outside(plane, walker%y(n + 1:n + 2))) return
      ending = CLOSED
      if (n_rows > 10 .and. maxval(abs([wrapped(walker%y(1:n:2) - first(1:n:2)), walker%y(2:n:2) - first(2:n:2), &
                                        walker%y(n + 1:n + 2) - first(n + 1:n + 2)])) < walker%step) return
    end do
    ending = LONG
  contains
    subroutine put()
      n_rows = n_rows + 1
      numbers = 1 + walker%system%determinant + [-1, 1]*walker%system%trace
      rows(:2, n_rows) = walker%y(n + 1:n + 2)
      rows(3:4, n_rows) = [walker%system%trace, walker%system%determinant]
      rows(5:, n_rows) = walker%y(:n)
    end subroutine put

    subroutine cross(event, multiplier, part)
      integer, intent(in) :: event, multiplier
      real(dp), intent(in) :: part
      real(dp) :: y(UNKNOWNS)
      type(curve_kind_t) :: of_event

      y = before + part*(walker%y - before)
      of_event = kind
      of_event%multiplier = multiplier
      if (on_line(plane, of_event, y, along) /= 0) call add_event(event, y)
    end subroutine cross

    subroutine add_event(event, y)
      integer, intent(in) :: event
      real(dp), intent(in) :: y(:)

      if (n_events == most_events) return
      n_events = n_events + 1
      events(1, n_events) = event
      events(2:3, n_events) = y(n + 1:n + 2)
      events(4:, n_events) = y(:n)
    end subroutine add_event
  end function branch

  !> The cycle near the start, with a tangent in the direction of growing place.
  subroutine begin_branch(walker, start, longest, found)
    type(walker_t), intent(inout) :: walker
    real(dp), intent(in) :: start(:), longest
    logical, intent(out) :: found
    real(dp) :: numbers(2), guess(UNKNOWNS)
    integer :: n

    n = 2*walker%system%n
    walker%y(:n + 2) = start(:n + 2)
    found = at_place(walker%system%plane, walker%system%kind, walker%y, numbers) /= 0
    if (.not. found) return
    guess = 0
    guess(n + 1) = 1
    call tangent_at(walker%system, walker%y, guess, walker%tangent, found)
    walker%longest = longest
    walker%step = longest/8
  end subroutine begin_branch

  function at_place(plane, kind, y, numbers) bind(C, name='kz_curve_solve') result(found)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(inout) :: y(2*kind%points + 2)
    real(dp), intent(out) :: numbers(2)
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.5_dp
    real(dp) :: residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(system_t) :: system
    integer :: iterations
    logical :: exists

    found = 0
    numbers = 0
    call make_system(plane, kind, 0, .false., system)
    call newton(system, 25, LONGEST, 1e-12_dp, y, iterations)
    if (iterations == 0) return
    call linearise(system, FINE, 1, y, residual, matrix, exists)
    numbers = [system%trace, system%determinant]
    if (exists) found = 1
  end function at_place

  function on_line(plane, kind, y, along) bind(C, name='kz_curve_locate') result(found)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(inout) :: y(2*kind%points + 2)
    real(dp), intent(in) :: along(2)
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.3_dp
    type(system_t) :: system
    integer :: iterations

    call make_system(plane, kind, 1, .true., system)
    system%basis(:, 1) = along
    call newton(system, 20, LONGEST, 1e-12_dp, y, iterations)
    found = merge(1, 0, iterations > 0)
  end function on_line

end module kz_cycles_tracing
