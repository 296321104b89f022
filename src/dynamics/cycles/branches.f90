!> Branches of cycles along a line by pseudo-arclength, and events on them: include/kapitza/dynamics_curves.h.
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

  type, bind(C) :: branch_way_t
    real(dp) :: along(2), longest, step
    integer(c_int64_t) :: most, most_events
    integer(c_int32_t) :: side
  end type branch_way_t

  type, bind(C) :: branch_end_t
    integer(c_int64_t) :: rows, events
    real(dp) :: step
    integer(c_int32_t) :: ending
  end type branch_end_t

  !> A branch that is followed: its last point, what was before it, and what was found.
  type :: branch_t
    type(branch_way_t) :: way
    type(branch_end_t) :: reached
    type(walker_t) :: walker
    type(parents_t) :: was
    real(dp), dimension(UNKNOWNS) :: first = 0, before = 0, heading = 0
    real(dp) :: numbers(2) = 0, last(2) = 0 !< test values at the last point and the one before: 0 at a fold, at a flip
    type(branch_row_t), pointer :: rows(:) => null()
    type(branch_event_t), pointer :: events(:) => null()
  contains
    procedure :: follow, put, merges, cross, add_event, is_closed
  end type branch_t

contains

  subroutine branch(plane, kind, start, way, rows, events, reached) bind(C, name='kz_curve_branch')
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: start(2*kind%points + 2)
    type(branch_way_t), intent(in) :: way
    type(branch_row_t), intent(out), target :: rows(way%most)
    type(branch_event_t), intent(out), target :: events(way%most_events)
    type(branch_end_t), intent(out) :: reached
    type(branch_t) :: self
    logical :: found

    self%way = way
    self%rows => rows
    self%events => events
    self%reached = branch_end_t(0, 0, way%step, NO_SEED)
    call make_system(plane, kind, 1, .false., self%walker%system)
    self%walker%system%basis(:, 1) = way%along
    self%walker%is_sharp = .false.
    call begin_branch(self%walker, start, int(way%side), way%longest, found)
    if (found) call self%follow()
    reached = self%reached
  end subroutine branch

  !> From the first point to where the branch ends.
  subroutine follow(self)
    class(branch_t), intent(inout) :: self
    type(parents_t) :: is

    associate (walker => self%walker, ending => self%reached%ending)
      if (self%way%step > 0) walker%step = min(self%way%step, self%way%longest)
      self%first = walker%y
      call set_parents(walker%system, walker%y, self%was)
      call self%put()
      if (self%way%side /= 0) self%numbers(FOLD) = 0
      do while (self%reached%rows < self%way%most)
        self%last = self%numbers
        self%before = walker%y
        self%heading = walker%tangent
        ending = STUCK
        if (.not. advance(walker)) return
        self%reached%step = walker%step
        call set_parents(walker%system, walker%y, is)
        ending = MERGED
        if (self%merges(is)) return
        self%numbers = numbers_of(walker)
        if (self%last(FOLD)*self%numbers(FOLD) < 0) call self%cross(FOLD, 1)
        if (self%last(FLIP)*self%numbers(FLIP) < 0) call self%cross(FLIP, -1)
        ending = LONG
        if (self%way%most_events > 0 .and. self%reached%events == self%way%most_events) return
        self%was = is
        call self%put()
        ending = LEFT
        if (outside(walker%system%plane, place_of(walker))) return
        ending = CLOSED
        if (self%is_closed()) return
      end do
      ending = LONG
    end associate
  end subroutine follow

  pure function numbers_of(walker) result(numbers)
    type(walker_t), intent(in) :: walker
    real(dp) :: numbers(2)

    numbers = 1 + walker%system%determinant + [-1, 1]*walker%system%trace
  end function numbers_of

  pure function place_of(walker) result(place)
    type(walker_t), intent(in) :: walker
    real(dp) :: place(2)

    place = walker%y(2*walker%system%n + 1:2*walker%system%n + 2)
  end function place_of

  subroutine put(self)
    class(branch_t), intent(inout) :: self

    self%reached%rows = self%reached%rows + 1
    self%numbers = numbers_of(self%walker)
    associate (system => self%walker%system)
      self%rows(self%reached%rows) = branch_row_t(cycle_of(system%n, self%walker%y), [system%trace, system%determinant])
    end associate
  end subroutine put

  !> Whether the branch meets what it grows out of, an event.
  logical function merges(self, is)
    class(branch_t), intent(inout) :: self
    type(parents_t), intent(in) :: is
    real(dp) :: share
    integer :: met

    met = meets(self%was, is, self%walker%system%n)
    if (met == 0) met = becomes(self%was, is)
    merges = met > 0
    if (.not. merges) return
    share = self%was%distance(met)/(self%was%distance(met) + is%distance(met))
    call self%add_event(met, self%before + share*(self%walker%y - self%before))
  end function merges

  !> The event between the two points: the nearest zero of its own equation, or what the zero of its number leads to.
  subroutine cross(self, event, multiplier)
    class(branch_t), intent(inout) :: self
    integer, intent(in) :: event, multiplier
    real(dp), parameter :: NEAR = 0.3_dp
    real(dp) :: y(UNKNOWNS), guess(UNKNOWNS), number, length
    type(curve_kind_t) :: of_event
    type(walker_t) :: between
    logical :: found

    associate (system => self%walker%system, was => self%last(event), is => self%numbers(event))
      of_event = system%kind
      of_event%multiplier = multiplier
      length = distance(system, self%walker%y, self%before)
      guess = self%before + was/(was - is)*(self%walker%y - self%before)
      y = guess
      found = on_line(system%plane, of_event, y, self%way%along) /= 0
      if (found) found = distance(system, y, guess) < NEAR*length
      if (.not. found) then
        between = self%walker
        call find_zero(between, self%before, self%heading, was, is, event, number, found)
        if (.not. found) return
        y = between%y
        if (on_line(system%plane, of_event, y, self%way%along) == 0) y = between%y
        if (distance(system, y, between%y) > NEAR*length) y = between%y
      end if
    end associate
    call self%add_event(event, y)
  end subroutine cross

  subroutine add_event(self, event, y)
    class(branch_t), intent(inout) :: self
    integer, intent(in) :: event
    real(dp), intent(in) :: y(:)

    if (self%reached%events == self%way%most_events) return
    self%reached%events = self%reached%events + 1
    self%events(self%reached%events) = branch_event_t(cycle_of(self%walker%system%n, y), int(event, c_int32_t))
  end subroutine add_event

  pure function cycle_of(n, y)
    integer, intent(in) :: n !< points
    real(dp), intent(in) :: y(:)
    real(dp) :: cycle_of(UNKNOWNS)

    cycle_of(:2*n + 2) = y(:2*n + 2)
    cycle_of(2*n + 3:) = 0
  end function cycle_of

  !> Whether the branch is at its first point again.
  pure logical function is_closed(self)
    class(branch_t), intent(in) :: self
    real(dp) :: moved(UNKNOWNS)
    integer :: n

    n = 2*self%walker%system%n
    moved = self%walker%y - self%first
    moved(1:n:2) = wrapped(moved(1:n:2))
    is_closed = self%reached%rows > 10 .and. maxval(abs(moved(:n + 2))) < self%walker%step
  end function is_closed

  !> The cycle near the start, its tangent towards growing place; or the fold at the start, tangent to one side.
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
