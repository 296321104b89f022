!> What all that follows states in lanes shares: which lane takes which state, and how long a state stays in a chaotic attractor's cover.
module kz_labels_lanes
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use kz_lanes_map, only: WIDTH, CAPACITY
  implicit none
  private
  public :: queued_lanes_t, list_flagged

  !> A state belongs to a chaotic attractor once it has stayed in its cover for so many periods.
  integer, parameter :: STAY = 64

  type :: queued_lanes_t
    integer :: active = 0                  !< lanes 1 .. active are advanced
    integer :: waiting = 0                 !< states that wait for a lane:
    integer :: queue(WIDTH) = 0            !< in these, the last first
    integer(c_int64_t) :: age(CAPACITY) = 0 !< periods since the release
    integer :: guest_of(CAPACITY) = 0      !< chaotic attractor whose cover it is in, 0 = none
    integer :: stay(CAPACITY) = 0          !< for so many periods
  contains
    !> Lane `lane` waits.
    procedure :: wait
    !> The lane whose state moves into a free one, which is at most the first behind the active ones: a waiting one, else the last active one;
    !> 0 = none, the lane is no longer active.
    procedure :: next
    !> Copies what is known of a lane to another one.
    procedure :: copy
    !> Whether the state of a lane, in the cover of attractor `host` (0 = none) now, counts as captured; then since its age STAY - 1
    !> periods ago, which becomes its age.
    procedure :: is_captured
  end type queued_lanes_t

contains

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

  subroutine wait(self, lane)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: lane

    self%waiting = self%waiting + 1
    self%queue(self%waiting) = lane
  end subroutine wait

  subroutine next(self, lane, from)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: lane
    integer, intent(out) :: from

    from = 0
    if (self%waiting > 0) then
      self%active = max(self%active, lane)
      from = self%queue(self%waiting)
      self%waiting = self%waiting - 1
    else if (lane <= self%active) then
      if (lane < self%active) from = self%active
      self%active = self%active - 1
    end if
  end subroutine next

  subroutine copy(self, from, to)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%age(to) = self%age(from)
    self%guest_of(to) = self%guest_of(from)
    self%stay(to) = self%stay(from)
  end subroutine copy

  function is_captured(self, lane, host) result(captured)
    class(queued_lanes_t), intent(inout) :: self
    integer, intent(in) :: lane, host
    logical :: captured

    self%stay(lane) = merge(self%stay(lane) + 1, 1, host == self%guest_of(lane))
    self%guest_of(lane) = host
    captured = host > 0 .and. self%stay(lane) >= STAY
    if (captured) self%age(lane) = self%age(lane) - STAY + 1
  end function is_captured

end module kz_labels_lanes
