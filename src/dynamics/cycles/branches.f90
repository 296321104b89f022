!> Branches of cycles followed along a line by pseudo-arclength, and what happens on the way: include/kapitza/dynamics_curves.h.
module kz_cycles_branches
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_curves, only: plane_t, curve_kind_t, system_t, make_system, linearise, wrapped, UNKNOWNS, COARSE
  use kz_cycles_corrector, only: newton, tangent_at
  use kz_cycles_normal_forms, only: normal_form
  use kz_cycles_placed, only: on_line, outside, LEFT, CLOSED, LONG, MERGED, STUCK, NO_SEED
  use kz_cycles_walker, only: walker_t, parents_t, advance, distance, set_parents, meets, becomes, find_zero, FOLD, FLIP
  use kz_splitting_jets, only: DX, DY
  implicit none
  private

  type, bind(C) :: branch_row_t
    real(dp) :: y(UNKNOWNS), number(2)
  end type branch_row_t

  type, bind(C) :: branch_event_t
    real(dp) :: y(UNKNOWNS)
    integer(c_int32_t) :: what
  end type branch_event_t

contains

  function branch(plane, kind, start, along, side, longest, step, most, rows, most_events, events, n_events, ending) &
    bind(C, name='kz_curve_branch') result(n_rows)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: start(2*kind%points + 2), along(2)
    integer(c_int32_t), value :: side
    real(dp), value :: longest
    real(dp), intent(inout), optional :: step
    integer(c_int64_t), value :: most, most_events
    type(branch_row_t), intent(out) :: rows(most)
    type(branch_event_t), intent(out) :: events(most_events)
    integer(c_int64_t), intent(out) :: n_events
    integer(c_int32_t), intent(out) :: ending
    integer(c_int64_t) :: n_rows
    type(walker_t) :: walker
    type(parents_t) :: was, is
    real(dp) :: numbers(2), last(2), before(UNKNOWNS), heading(UNKNOWNS), share, first(UNKNOWNS)
    logical :: found
    integer :: n, met

    n = 2*kind%points
    n_rows = 0
    n_events = 0
    ending = NO_SEED
    call make_system(plane, kind, 1, .false., walker%system)
    walker%system%basis(:, 1) = along
    walker%is_sharp = .false.
    call begin_branch(walker, start, int(side), longest, found)
    if (.not. found) return
    if (present(step)) walker%step = merge(min(step, longest), walker%step, step > 0)
    first = walker%y
    call set_parents(walker%system, walker%y, was)
    call put()
    if (side /= 0) numbers(FOLD) = 0
    do while (n_rows < most)
      last = numbers
      before = walker%y
      heading = walker%tangent
      ending = STUCK
      if (.not. advance(walker)) return
      if (present(step)) step = walker%step
      call set_parents(walker%system, walker%y, is)
      met = meets(was, is, int(kind%points))
      if (met == 0) met = becomes(was, is)
      ending = MERGED
      if (met > 0) then
        share = was%distance(met)/(was%distance(met) + is%distance(met))
        call add_event(met, before + share*(walker%y - before))
        return
      end if
      numbers = 1 + walker%system%determinant + [-1, 1]*walker%system%trace
      if (last(1)*numbers(1) < 0) call cross(FOLD, 1)
      if (last(2)*numbers(2) < 0) call cross(FLIP, -1)
      ending = LONG
      if (most_events > 0 .and. n_events == most_events) return
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
      rows(n_rows) = branch_row_t(cycle_of(walker%y), [walker%system%trace, walker%system%determinant])
    end subroutine put

    !> The event between the two points: the nearest zero of its own equation, or what the zero of its number leads to.
    subroutine cross(event, multiplier)
      integer, intent(in) :: event, multiplier
      real(dp), parameter :: NEAR = 0.3_dp
      real(dp) :: y(UNKNOWNS), guess(UNKNOWNS), number, length
      type(curve_kind_t) :: of_event
      type(walker_t) :: between
      logical :: found

      of_event = kind
      of_event%multiplier = multiplier
      length = distance(walker%system, walker%y, before)
      guess = before + last(event)/(last(event) - numbers(event))*(walker%y - before)
      y = guess
      if (on_line(plane, of_event, y, along) /= 0) then
        if (distance(walker%system, y, guess) < NEAR*length) then
          call add_event(event, y)
          return
        end if
      end if
      between = walker
      call find_zero(between, before, heading, last(event), numbers(event), event, number, found)
      if (.not. found) return
      y = between%y
      if (on_line(plane, of_event, y, along) == 0) y = between%y
      if (distance(walker%system, y, between%y) > NEAR*length) y = between%y
      call add_event(event, y)
    end subroutine cross

    subroutine add_event(event, y)
      integer, intent(in) :: event
      real(dp), intent(in) :: y(:)

      if (n_events == most_events) return
      n_events = n_events + 1
      events(n_events) = branch_event_t(cycle_of(y), int(event, c_int32_t))
    end subroutine add_event

    pure function cycle_of(y)
      real(dp), intent(in) :: y(:)
      real(dp) :: cycle_of(UNKNOWNS)

      cycle_of(:n + 2) = y(:n + 2)
      cycle_of(n + 3:) = 0
    end function cycle_of
  end function branch

  !> The cycle near the start, with a tangent in the direction of growing place; or the fold at the start, with that to one side.
  subroutine begin_branch(walker, start, side, longest, found)
    type(walker_t), intent(inout) :: walker
    real(dp), intent(in) :: start(:), longest
    integer, intent(in) :: side !< 0: the start is no fold
    logical, intent(out) :: found
    real(dp), parameter :: LONGEST_CORRECTION = 0.5_dp ! rad
    real(dp) :: guess(UNKNOWNS)
    integer :: n, iterations

    n = 2*walker%system%n
    walker%y(:n + 2) = start(:n + 2)
    guess = 0
    found = side /= 0
    if (side == 0) then
      walker%system%columns = 0
      call newton(walker%system, 25, LONGEST_CORRECTION, 1e-12_dp, walker%y, iterations)
      walker%system%columns = 1
      found = iterations > 0
      guess(n + 1) = 1
    else
      guess(:n) = side*tangent_of_fold(walker, start)
    end if
    if (.not. found) return
    call tangent_at(walker%system, walker%y, guess, walker%tangent, found)
    walker%longest = longest
    walker%step = longest/merge(8, 64, side == 0)
  end subroutine begin_branch

  !> The direction of both branches at a fold: the eigenvector of the multiplier 1, carried along the cycle.
  function tangent_of_fold(walker, fold) result(direction)
    type(walker_t), intent(in) :: walker
    real(dp), intent(in) :: fold(:)
    real(dp) :: direction(2*walker%system%n), residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS), form, side(2), vector(2)
    type(curve_kind_t) :: kind
    type(system_t) :: system
    integer :: i
    logical :: exists

    direction = 0
    kind = walker%system%kind
    kind%multiplier = 1
    call make_system(walker%system%plane, kind, 2, .true., system)
    call linearise(system, COARSE, 3, fold, residual, matrix, exists)
    if (.not. exists) return
    call normal_form(system, form, side, vector)
    do i = 1, system%n
      direction(2*i - 1:2*i) = vector
      vector = matmul(system%image(:, DX:DY, i), vector)
    end do
  end function tangent_of_fold

end module kz_cycles_branches
