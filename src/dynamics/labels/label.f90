!> Follows many starts with any map until each is trapped: another start takes the lane of one that has settled. Starts enter the
!> coordinates of the map many at a time, and wait.
module kz_labels_label
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_lanes_map, only: map_t, WIDTH, CAPACITY
  use kz_labels_lanes, only: queued_lanes_t, list_flagged
  use kz_cycles_cycles, only: attractor_t
  use kz_grown_grid, only: regions_t, find_regions, chaos_region
  implicit none
  private
  public :: follow

  !> What the lanes of the map carry.
  type, extends(queued_lanes_t) :: lanes_t
    integer(c_int64_t) :: start(CAPACITY)  !< which start
    integer(c_int64_t) :: most(CAPACITY)   !< periods that it is followed at most
  end type lanes_t

contains

  !> Follows start i for periods(i) at most. label(i) = attractor (from 1) that it ends on, 0 where it has not settled;
  !> periods(i) becomes its first period inside a trapping region, or the periods followed. state: physical starts (half-turns,
  !> rad per drive radian); it becomes the states where the orbits were left, in the map's coordinates.
  subroutine follow(map, regions, attractors, state, label, periods)
    class(map_t), intent(inout) :: map !< what moves the states by one period
    type(regions_t), intent(in) :: regions !< the trapping regions
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    real(dp), intent(inout) :: state(:, :) !< [2, n] in and out
    integer(c_int32_t), intent(out) :: label(:) !< attractor from 1, 0 = not settled
    integer(c_int64_t), intent(inout) :: periods(:) !< most periods, in; first period inside a trapping region, out
    type(lanes_t) :: lanes
    integer(c_int64_t) :: next
    integer :: region(WIDTH), done(WIDTH), list(WIDTH), n_done, lane, i

    next = 1
    do lane = 1, WIDTH
      call occupy(lane)
    end do
    do while (lanes%active > 0)
      call map%advance(lanes%active)
      lanes%age(:lanes%active) = lanes%age(:lanes%active) + 1
      call find_regions(regions, attractors, lanes%active, map%u(:lanes%active), map%v(:lanes%active), region)
      call visit_covers(map, regions, lanes, region)
      done(:lanes%active) = min(1, region(:lanes%active))
      if (maxval(lanes%age(:lanes%active) - lanes%most(:lanes%active)) >= 0) &
        where (lanes%age(:lanes%active) >= lanes%most(:lanes%active)) done(:lanes%active) = 1
      call list_flagged(lanes%active, done, list, n_done)
      do i = 1, n_done
        call settle(list(i), region(list(i)))
        call occupy(list(i))
      end do
    end do
  contains
    !> A start that waits, or else the last active one, moves into the free lane, which is at most the first behind the active ones.
    subroutine occupy(lane)
      integer, intent(in) :: lane
      integer :: from

      if (lanes%waiting == 0) call let_in
      call lanes%next(lane, from)
      if (from > 0) call move(map, lanes, from, lane)
    end subroutine occupy

    !> Puts the next starts into the lanes behind the first WIDTH. Those that lie inside a trapping region leave at once.
    subroutine let_in
      integer :: found(WIDTH), n, i

      do while (lanes%waiting == 0 .and. next <= size(label))
        n = int(min(int(WIDTH, c_int64_t), size(label) - next + 1))
        do i = WIDTH + 1, WIDTH + n
          lanes%start(i) = next
          lanes%most(i) = periods(next)
          call map%put_start(i, next, state(1, next), state(2, next))
          next = next + 1
        end do
        lanes%age(WIDTH + 1:) = 0
        lanes%guest_of(WIDTH + 1:) = 0
        call map%to_map(WIDTH + n, first=WIDTH + 1)
        call find_regions(regions, attractors, n, map%u(WIDTH + 1:WIDTH + n), map%v(WIDTH + 1:WIDTH + n), found)
        do i = n, 1, -1 ! the first start is to leave the queue first
          if (found(i) == 0 .and. lanes%most(WIDTH + i) > 0) then
            call lanes%wait(WIDTH + i)
          else
            call settle(WIDTH + i, found(i))
          end if
        end do
      end do
    end subroutine let_in

    subroutine settle(lane, a)
      integer, intent(in) :: lane, a

      label(lanes%start(lane)) = a
      periods(lanes%start(lane)) = lanes%age(lane)
      state(1, lanes%start(lane)) = map%u(lane)
      state(2, lanes%start(lane)) = map%v(lane)
    end subroutine settle
  end subroutine follow

  subroutine move(map, lanes, from, to)
    class(map_t), intent(inout) :: map
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: from, to

    call map%move(from, to)
    call lanes%copy(from, to)
    lanes%start(to) = lanes%start(from)
    lanes%most(to) = lanes%most(from)
  end subroutine move

  !> What chaotic attractors make of the regions in which the lanes are.
  subroutine visit_covers(map, regions, lanes, region)
    class(map_t), intent(in) :: map
    type(regions_t), intent(in) :: regions
    type(lanes_t), intent(inout) :: lanes
    integer, intent(inout) :: region(WIDTH)
    integer :: lane, host

    if (size(regions%covered) == 0) return
    do lane = 1, lanes%active
      if (region(lane) > 0) then
        lanes%guest_of(lane) = 0
      else
        host = chaos_region(regions, map%u(lane), map%v(lane))
        if (lanes%is_captured(lane, host)) region(lane) = host
      end if
    end do
  end subroutine visit_covers

end module kz_labels_label
