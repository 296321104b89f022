!> Follows many starts with any map until each is trapped: lanes are refilled as starts settle.
module kz_dynamics_label
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_kernel_map, only: map_t, WIDTH
  use kz_attractors_cycles, only: attractor_t
  use kz_trapping_grid, only: regions_t, find_regions, chaos_region
  implicit none
  private
  public :: follow, DOUBTFUL

  !> Label of a start whose error on the map has become too large.
  integer, parameter :: DOUBTFUL = -1
  !> An orbit belongs to a chaotic attractor once it has stayed in its cover for so many periods.
  integer, parameter :: STAY = 64

  !> What the lanes of the map carry.
  type :: lanes_t
    integer :: active = 0               !< lanes 1 .. active are in use
    integer(c_int64_t) :: start(WIDTH)  !< which start
    integer(c_int64_t) :: age(WIDTH)    !< periods since then
    integer(c_int64_t) :: most(WIDTH)   !< periods that it is followed at most
    integer :: guest_of(WIDTH)          !< chaotic attractor whose cover it is in
    integer :: stay(WIDTH)              !< for so many periods
  end type lanes_t

contains

  !> Follows start i for periods(i) at most. label(i) = attractor (from 1) that it ends on, 0 where it has not settled, DOUBTFUL;
  !> periods(i) becomes its first period inside a trapping region, or the periods followed. state: physical starts (half-turns,
  !> rad per drive radian); it becomes the states where the orbits were left, in the map's coordinates.
  subroutine follow(map, regions, attractors, state, label, periods)
    !> what moves the states by one period
    class(map_t), intent(inout) :: map
    !> the trapping regions
    type(regions_t), intent(in) :: regions
    !> the catalogue, numbered from 1
    type(attractor_t), intent(in) :: attractors(:)
    !> [2, n] in and out
    real(dp), intent(inout) :: state(:, :)
    !> attractor from 1, 0 = not settled
    integer(c_int32_t), intent(out) :: label(:)
    !> most periods, in; first period inside a trapping region, out
    integer(c_int64_t), intent(inout) :: periods(:)
    type(lanes_t) :: lanes
    integer(c_int64_t) :: next
    integer :: region(WIDTH)

    next = 1
    do
      do while (lanes%active < WIDTH .and. next <= size(label))
        call refill(next)
      end do
      if (lanes%active == 0) return
      call map%advance(lanes%active)
      lanes%age(:lanes%active) = lanes%age(:lanes%active) + 1
      call find_regions(regions, attractors, lanes%active, map%u, map%v, region)
      call judge(map, regions, lanes, region)
      call take_settled(1)
    end do
  contains
    !> Puts the next starts into the free lanes. Those that lie inside a trapping region leave at once.
    subroutine refill(next)
      integer(c_int64_t), intent(inout) :: next
      integer :: first, lane

      first = lanes%active + 1
      do lane = first, int(min(int(WIDTH, c_int64_t), lanes%active + size(label) - next + 1))
        lanes%start(lane) = next
        lanes%most(lane) = periods(next)
        call map%put(lane, state(1, next), state(2, next))
        next = next + 1
        lanes%active = lane
      end do
      lanes%age(first:) = 0
      lanes%guest_of(first:) = 0
      call map%enter(lanes%active, first=first)
      call find_regions(regions, attractors, lanes%active - first + 1, map%u(first:), map%v(first:), region(first:))
      call take_settled(first)
    end subroutine refill

    !> The lanes first .. active whose region is not 0, or whose time is up, leave; the last ones move into their places.
    subroutine take_settled(first)
      integer, intent(in) :: first
      integer :: lane

      do lane = lanes%active, first, -1
        if (region(lane) == 0 .and. lanes%age(lane) < lanes%most(lane)) cycle
        label(lanes%start(lane)) = region(lane)
        periods(lanes%start(lane)) = lanes%age(lane)
        state(:, lanes%start(lane)) = [map%u(lane), map%v(lane)]
        if (lane < lanes%active) call move(map, lanes, lanes%active, lane)
        lanes%active = lanes%active - 1
      end do
    end subroutine take_settled
  end subroutine follow

  subroutine move(map, lanes, from, to)
    class(map_t), intent(inout) :: map
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: from
    integer, intent(in) :: to

    call map%move(from, to)
    lanes%start(to) = lanes%start(from)
    lanes%age(to) = lanes%age(from)
    lanes%most(to) = lanes%most(from)
    lanes%guest_of(to) = lanes%guest_of(from)
    lanes%stay(to) = lanes%stay(from)
  end subroutine move

  !> What errors and chaotic attractors make of the regions in which the lanes are.
  subroutine judge(map, regions, lanes, region)
    class(map_t), intent(in) :: map
    type(regions_t), intent(in) :: regions
    type(lanes_t), intent(inout) :: lanes
    integer, intent(inout) :: region(WIDTH)
    logical :: with_covers
    integer :: lane

    with_covers = size(regions%covered) > 0
    if (.not. (with_covers .or. any(map%straddling(:lanes%active)) .or. any(map%doubtful(:lanes%active)))) return
    do lane = 1, lanes%active
      if (map%straddling(lane)) region(lane) = merge(DOUBTFUL, 0, lanes%age(lane) >= lanes%most(lane))
      if (region(lane) /= 0) then
        lanes%guest_of(lane) = 0
      else if (with_covers) then
        call visit(lanes, lane, chaos_region(regions, map%u(lane), map%v(lane)), region(lane))
      end if
      if (map%doubtful(lane) .and. lanes%guest_of(lane) == 0) region(lane) = DOUBTFUL
    end do
  end subroutine judge

  !> An orbit that has stayed in a cover for STAY periods counts as captured from the period in which it entered.
  subroutine visit(lanes, lane, host, region)
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: lane
    !> the chaotic attractor whose cover it is in, or 0
    integer, intent(in) :: host
    integer, intent(inout) :: region

    lanes%stay(lane) = merge(lanes%stay(lane) + 1, 1, host == lanes%guest_of(lane))
    lanes%guest_of(lane) = host
    if (host == 0 .or. lanes%stay(lane) < STAY) return
    region = host
    lanes%age(lane) = lanes%age(lane) - STAY + 1
  end subroutine visit

end module kz_dynamics_label
