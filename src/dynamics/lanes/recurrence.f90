!> When a motion comes back to a strobe point of its own: the last points of every lane of a batch.
module kz_lanes_recurrence
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: map_t, WIDTH, PI
  implicit none
  private
  public :: past_t, make_past

  !> rad: a motion so near an earlier point of its own is near a cycle.
  real(dp), parameter :: NEAR = 1e-5_dp

  !> The points of the last periods, in a ring.
  type :: past_t
    integer :: longest = 0               !< periods that are remembered
    integer :: latest = 0                !< place of the newest points in the ring
    integer :: known(WIDTH) = 0          !< points of each lane
    real(dp), allocatable :: u(:, :), v(:, :)
  contains
    procedure :: begin, note, move, find
  end type past_t

contains

  !> Makes an empty past.
  subroutine make_past(longest, past)
    integer, intent(in) :: longest !< drive periods that it reaches back
    type(past_t), intent(out) :: past !< past of all lanes of a batch

    past%longest = longest
    past%latest = 1
    allocate (past%u(WIDTH, longest), past%v(WIDTH, longest))
    past%u = 0
    past%v = 0
  end subroutine make_past

  !> A lane begins anew with its present state.
  subroutine begin(self, lane, map)
    class(past_t), intent(inout) :: self
    integer, intent(in) :: lane
    class(map_t), intent(in) :: map !< the batch

    self%known(lane) = 1
    self%u(lane, self%latest) = map%u(lane)
    self%v(lane, self%latest) = map%v(lane)
  end subroutine begin

  !> Remembers the present states of the lanes 1 .. n.
  subroutine note(self, n, map)
    class(past_t), intent(inout) :: self
    integer, intent(in) :: n
    class(map_t), intent(in) :: map

    self%latest = mod(self%latest, self%longest) + 1
    self%u(:n, self%latest) = map%u(:n)
    self%v(:n, self%latest) = map%v(:n)
    self%known(:n) = min(self%known(:n) + 1, self%longest)
  end subroutine note

  subroutine move(self, from, to)
    class(past_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%known(to) = self%known(from)
    self%u(to, :) = self%u(from, :)
    self%v(to, :) = self%v(from, :)
  end subroutine move

  !> periods(i) = the fewest periods ago that lane i was where it is now; 0 = never.
  subroutine find(self, n, map, periods)
    class(past_t), intent(in) :: self
    integer, intent(in) :: n
    class(map_t), intent(in) :: map
    integer, intent(out) :: periods(WIDTH)
    real(dp), parameter :: ROUND_TO_INTEGER = 1.5_dp*2.0_dp**52
    real(dp) :: du
    integer :: ago, place, i

    periods = 0
    do ago = maxval(self%known(:n)), 1, -1
      place = modulo(self%latest - ago, self%longest) + 1
      do i = 1, n
        du = map%u(i) - self%u(i, place)
        du = du - 2*((0.5_dp*du + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
        if (PI*abs(du) + abs(map%v(i) - self%v(i, place)) < NEAR .and. self%known(i) >= ago) periods(i) = ago
      end do
    end do
  end subroutine find

end module kz_lanes_recurrence
