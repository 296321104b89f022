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

  type :: lane_t
    integer(c_int64_t) :: start = 0 !< which start it carries
    integer(c_int64_t) :: age = 0   !< periods since its start
    integer :: guest_of = 0         !< chaotic attractor whose cover it is in
    integer :: stay = 0             !< for so many periods
  end type lane_t

contains

  !> Follows start i for periods(i) at most. label(i) = attractor (from 1) that it ends on, 0 where it has not settled, DOUBTFUL;
  !> periods(i) becomes its first period inside a trapping region, or the periods followed; (u, v) become the states where the
  !> orbits were left.
  subroutine follow(map, regions, attractors, u, v, label, periods)
    !> what moves the states by one period
    class(map_t), intent(inout) :: map
    !> the trapping regions
    type(regions_t), intent(in) :: regions
    !> the catalogue, numbered from 1
    type(attractor_t), intent(in) :: attractors(:)
    !> angles, half-turns in [-1, 1]; in and out
    real(dp), intent(inout) :: u(:)
    !> velocities, rad per drive radian; in and out
    real(dp), intent(inout) :: v(:)
    !> attractor from 1, 0 = not settled
    integer(c_int32_t), intent(out) :: label(:)
    !> most periods, in; first period inside a trapping region, out
    integer(c_int64_t), intent(inout) :: periods(:)
    type(lane_t) :: lanes(WIDTH)
    integer(c_int64_t) :: next
    integer :: region(WIDTH), active, lane

    call find_regions(regions, attractors, size(u), u, v, label)
    where (label > 0) periods = 0
    active = 0
    next = 1
    do
      do while (active < WIDTH .and. next <= size(u))
        if (label(next) == 0) then
          active = active + 1
          lanes(active) = lane_t(start=next)
          call map%put(active, u(next), v(next))
        end if
        next = next + 1
      end do
      if (active == 0) return
      call map%advance(active)
      call find_regions(regions, attractors, active, map%u, map%v, region)
      do lane = active, 1, -1
        lanes(lane)%age = lanes(lane)%age + 1
        if (map%straddling(lane)) region(lane) = merge(DOUBTFUL, 0, lanes(lane)%age >= periods(lanes(lane)%start))
        if (region(lane) /= 0) then
          lanes(lane)%guest_of = 0
        else if (size(regions%covered) > 0) then
          call visit(lanes(lane), lane)
        end if
        if (map%doubtful(lane) .and. lanes(lane)%guest_of == 0) region(lane) = DOUBTFUL
        if (region(lane) == 0 .and. lanes(lane)%age < periods(lanes(lane)%start)) cycle
        call leave(lanes(lane), lane)
        call map%move(active, lane)
        lanes(lane) = lanes(active)
        active = active - 1
      end do
    end do
  contains
    !> An orbit that has stayed in a cover for STAY periods counts as captured from the period in which it entered.
    subroutine visit(l, at)
      type(lane_t), intent(inout) :: l
      integer, intent(in) :: at
      integer :: host

      host = chaos_region(regions, map%u(at), map%v(at))
      l%stay = merge(l%stay + 1, 1, host == l%guest_of)
      l%guest_of = host
      if (host == 0 .or. l%stay < STAY) return
      region(at) = host
      l%age = l%age - STAY + 1
    end subroutine visit

    subroutine leave(l, at)
      type(lane_t), intent(in) :: l
      integer, intent(in) :: at

      label(l%start) = region(at)
      periods(l%start) = l%age
      u(l%start) = map%u(at)
      v(l%start) = map%v(at)
    end subroutine leave
  end subroutine follow

end module kz_dynamics_label
