!> The scheduler of all that follows states in lanes. What the lanes carry, where further states come from and when one
!> is done belong to the type that extends it.
module kz_maps_lanes
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use kz_vector_locks, only: look
  use kz_vector_map, only: WIDTH, CAPACITY
  implicit none
  private
  public :: lanes_t, queued_lanes_t, list_flagged

  !> A state belongs to an attractor with a cover once it has stayed there for so many periods.
  integer, parameter :: STAY = 64

  type, abstract :: lanes_t
    integer :: active = 0 !< lanes 1 .. active are advanced
  contains
    !> Follows states until none is left. A finished lane takes the next state, else that of the last active lane.
    procedure :: run
    !> Puts a further state into a lane that is free; false = there is none.
    procedure(of_lane_i), deferred :: fill
    !> Advances the active lanes by a period, and lists those that may be done, the last first.
    procedure(advance_i), deferred :: advance
    !> Whether a listed lane, or one that waits to be followed, is done; then its end has been noted.
    procedure(of_lane_i), deferred :: is_done
    !> Copies all that a lane carries to another one.
    procedure(move_i), deferred :: move
  end type lanes_t

  !> Lanes whose states enter many at a time: those behind the first WIDTH wait there for a free one.
  type, abstract, extends(lanes_t) :: queued_lanes_t
    integer, private :: waiting = 0        !< states that wait:
    integer, private :: queue(WIDTH) = 0   !< in these lanes, the last first
    integer(c_int64_t) :: items = 0        !< states that are followed in all
    integer(c_int64_t) :: next = 1         !< number of the item that enters next
    integer(c_int64_t) :: number(CAPACITY) = 0 !< number of the item in each lane
    integer :: region(CAPACITY) = 0        !< trapping region that holds it, 0 = none
    integer(c_int64_t) :: age(CAPACITY) = 0 !< periods since the release
    integer :: in_cover(CAPACITY) = 0      !< attractor whose cover it is in, 0 = none
    integer, private :: stay(CAPACITY) = 0 !< for so many periods
  contains
    procedure :: fill => fill_from_queue
    !> Puts the states number(WIDTH + 1 .. WIDTH + n) into these lanes, and finds their regions.
    procedure(admit_i), deferred :: admit
    !> Copies what is known of a lane to another one.
    procedure :: copy
    !> Whether the state of a lane, in the cover of attractor `owner` (0 = none) now, counts as captured; then since its
    !> age STAY - 1 periods ago, which becomes its age.
    procedure :: is_captured
  end type queued_lanes_t

  abstract interface
    function of_lane_i(self, lane) result(yes)
      import :: lanes_t
      class(lanes_t), intent(inout) :: self
      integer, intent(in) :: lane
      logical :: yes
    end function of_lane_i

    subroutine advance_i(self, list, n)
      import :: lanes_t, WIDTH
      class(lanes_t), intent(inout) :: self
      integer, intent(out) :: list(WIDTH), n
    end subroutine advance_i

    subroutine move_i(self, from, to)
      import :: lanes_t
      class(lanes_t), intent(inout) :: self
      integer, intent(in) :: from, to
    end subroutine move_i

    subroutine admit_i(self, n)
      import :: queued_lanes_t
      class(queued_lanes_t), intent(inout) :: self
      integer, intent(in) :: n
    end subroutine admit_i
  end interface

contains

  subroutine run(self)
    class(lanes_t), intent(inout) :: self
    integer :: list(WIDTH), n, i

    do
      do while (self%active < WIDTH)
        if (.not. self%fill(self%active + 1)) exit
        self%active = self%active + 1
      end do
      if (self%active == 0) return
      call look()
      call self%advance(list, n)
      do i = 1, n
        if (.not. self%is_done(list(i))) cycle
        if (self%fill(list(i))) cycle
        if (list(i) < self%active) call self%move(self%active, list(i))
        self%active = self%active - 1
      end do
    end do
  end subroutine run

  !> Lists the lanes of 1 .. n that are flagged, the last first. (Without a branch: which they are cannot be foreseen.)
  pure subroutine list_flagged(n, flag, lane, n_flagged)
    integer, intent(in) :: n !< lanes
    integer, intent(in) :: flag(WIDTH) !< 1 for those lanes, else 0
    integer, intent(out) :: lane(WIDTH) !< their numbers
    integer, intent(out) :: n_flagged !< how many there are
    integer :: i

    n_flagged = 0
    do i = n, 1, -1
      lane(n_flagged + 1) = i
      n_flagged = n_flagged + flag(i)
    end do
  end subroutine list_flagged

  function fill_from_queue(self, lane) result(yes)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    if (self%waiting == 0) call fill_queue(self)
    yes = self%waiting > 0
    if (.not. yes) return
    call self%move(self%queue(self%waiting), lane)
    self%waiting = self%waiting - 1
  end function fill_from_queue

  !> Lets states enter until one is to be followed. The first one is to leave the queue first.
  subroutine fill_queue(self)
    class(queued_lanes_t), intent(inout) :: self
    integer :: n, lane

    do while (self%waiting == 0 .and. self%next <= self%items)
      n = int(min(int(WIDTH, c_int64_t), self%items - self%next + 1))
      self%number(WIDTH + 1:WIDTH + n) = [(self%next + lane, lane=0, n - 1)]
      self%next = self%next + n
      self%in_cover(WIDTH + 1:) = 0
      call self%admit(n)
      do lane = WIDTH + n, WIDTH + 1, -1
        if (self%is_done(lane)) cycle
        self%waiting = self%waiting + 1
        self%queue(self%waiting) = lane
      end do
    end do
  end subroutine fill_queue

  subroutine copy(self, from, to)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%number(to) = self%number(from)
    self%age(to) = self%age(from)
    self%in_cover(to) = self%in_cover(from)
    self%stay(to) = self%stay(from)
  end subroutine copy

  function is_captured(self, lane, owner) result(captured)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: lane, owner
    logical :: captured

    self%stay(lane) = merge(self%stay(lane) + 1, 1, owner == self%in_cover(lane))
    self%in_cover(lane) = owner
    captured = owner > 0 .and. self%stay(lane) >= STAY
    if (captured) self%age(lane) = self%age(lane) - STAY + 1
  end function is_captured

end module kz_maps_lanes
