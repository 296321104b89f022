!> Branches of cycles along a line by pseudo-arclength, and events on them: include/kapitza/dynamics_curves.h.
module kz_cycles_branches
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_continuation, only: way_t, end_t, continuation_t, GOES_ON
  use kz_cycles_curves, only: plane_t, kind_t, cycle_t, system_t, make_system, linearise, wrapped, unknowns_of, &
                              cycle_of, UNKNOWNS, COARSE
  use kz_cycles_corrector, only: newton, tangent_at
  use kz_cycles_normal_forms, only: form_t, normal_form
  use kz_cycles_placed, only: on_line, LONG, MERGED
  use kz_cycles_walker, only: walker_t, parents_t, distance, set_parents, meets, becomes, find_zero, FOLD, FLIP
  use kz_splitting_jets, only: DX, DY
  implicit none
  private

  type, extends(continuation_t) :: branch_t
    real(dp) :: numbers(2) = 0 !< test values at the last point: 0 at a fold, at a flip
    type(cycle_t), pointer :: rows(:) => null(), events(:) => null()
  contains
    procedure :: ending, put, merges, cross, add_event, is_closed
  end type branch_t

contains

  subroutine branch(plane, start, way, rows, events, reached) bind(C, name='kz_cycle_continue')
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(in) :: start
    type(way_t), intent(in) :: way
    type(cycle_t), intent(out), target :: rows(way%most), events(way%most_events)
    type(end_t), intent(out) :: reached
    type(branch_t) :: self
    logical :: found

    self%way = way
    self%rows => rows
    self%events => events
    self%reached%step = way%step
    call make_system(plane, start%kind, 1, .false., self%walker%system)
    self%walker%system%basis(:, 1) = way%along
    self%walker%is_sharp = .false.
    call begin_branch(self%walker, unknowns_of(start), int(way%side), way%longest, found)
    if (found) then
      if (way%step > 0) self%walker%step = min(way%step, way%longest)
      self%first = self%walker%y
      call set_parents(self%walker%system, self%walker%y, self%was)
      call self%put()
      if (way%side /= 0) self%numbers(FOLD) = 0
      call self%follow()
    end if
    reached = self%reached
  end subroutine branch

  integer function ending(self, is)
    class(branch_t), intent(inout) :: self
    type(parents_t), intent(in) :: is
    real(dp) :: last(2)

    ending = MERGED
    if (self%merges(is)) return
    last = self%numbers
    self%numbers = numbers_of(self%walker)
    if (last(FOLD)*self%numbers(FOLD) < 0) call self%cross(FOLD, 1, last(FOLD))
    if (last(FLIP)*self%numbers(FLIP) < 0) call self%cross(FLIP, -1, last(FLIP))
    ending = merge(LONG, GOES_ON, self%way%most_events > 0 .and. self%reached%events == self%way%most_events)
  end function ending

  pure function numbers_of(walker) result(numbers)
    type(walker_t), intent(in) :: walker
    real(dp) :: numbers(2)

    numbers = 1 + walker%system%determinant + [-1, 1]*walker%system%trace
  end function numbers_of

  subroutine put(self)
    class(branch_t), intent(inout) :: self

    self%reached%rows = self%reached%rows + 1
    self%numbers = numbers_of(self%walker)
    self%rows(self%reached%rows) = cycle_of(self%walker%system, self%walker%y)
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
  subroutine cross(self, event, multiplier, was)
    class(branch_t), intent(inout) :: self
    integer, intent(in) :: event, multiplier
    real(dp), intent(in) :: was !< the number at the point before
    real(dp), parameter :: NEAR = 0.3_dp
    real(dp) :: y(UNKNOWNS), guess(UNKNOWNS), number, length
    type(walker_t) :: between

    associate (system => self%walker%system, is => self%numbers(event))
      length = distance(system, self%walker%y, self%before)
      guess = self%before + was/(was - is)*(self%walker%y - self%before)
      if (.not. is_near(guess)) then
        between = self%walker
        if (.not. find_zero(between, self%before, self%heading, [was, is], event, number)) return
        if (.not. is_near(between%y)) y = between%y
      end if
    end associate
    call self%add_event(event, y)
  contains
    !> Whether the equation of the event has a zero, y, near a point.
    logical function is_near(point)
      real(dp), intent(in) :: point(:)
      type(cycle_t) :: at

      at = cycle_of(self%walker%system, point)
      at%kind%multiplier = multiplier
      is_near = on_line(self%walker%system%plane, at, self%way%along) /= 0
      y = unknowns_of(at)
      if (is_near) is_near = distance(self%walker%system, y, point) < NEAR*length
    end function is_near
  end subroutine cross

  subroutine add_event(self, event, y)
    class(branch_t), intent(inout) :: self
    integer, intent(in) :: event
    real(dp), intent(in) :: y(:)

    if (self%reached%events == self%way%most_events) return
    self%reached%events = self%reached%events + 1
    associate (added => self%events(self%reached%events))
      added = cycle_of(self%walker%system, y)
      added%event = int(event, c_int32_t)
    end associate
  end subroutine add_event

  logical function is_closed(self)
    class(branch_t), intent(inout) :: self
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
    integer :: n

    n = 2*walker%system%n
    walker%y(:n + 2) = start(:n + 2)
    guess = 0
    found = side /= 0
    if (side == 0) then
      walker%system%columns = 0
      found = newton(walker%system, 25, LONGEST_CORRECTION, 1e-12_dp, walker%y) > 0
      walker%system%columns = 1
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
    real(dp) :: direction(2*walker%system%n), residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(form_t) :: form
    type(kind_t) :: kind
    type(system_t) :: system
    integer :: i
    logical :: exists

    direction = 0
    kind = walker%system%kind
    kind%multiplier = 1
    call make_system(walker%system%plane, kind, 2, .true., system)
    call linearise(system, COARSE, 3, fold, residual, matrix, exists)
    if (.not. exists) return
    call normal_form(system, form)
    do i = 1, system%n
      direction(2*i - 1:2*i) = form%vector
      form%vector = matmul(system%image(:, DX:DY, i), form%vector)
    end do
  end function tangent_of_fold

end module kz_cycles_branches
