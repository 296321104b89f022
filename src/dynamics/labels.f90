!> Follows many starts with any map until each is trapped: lanes are refilled as starts settle.
module kz_dynamics_labels
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_kernel_map, only: map_t, WIDTH
  use kz_dynamics_cycles, only: attractor_t
  use kz_dynamics_regions, only: regions_t, captor, coverer
  implicit none
  private
  public :: follow

  !> An orbit belongs to a chaotic attractor once it has stayed in its cover for so many periods.
  integer, parameter :: STAY = 64

  type :: lane_t
    integer(c_int64_t) :: start = 0 !< which start it carries
    integer(c_int64_t) :: age = 0   !< periods since its start
    integer :: guest_of = 0         !< chaotic attractor whose cover it is in
    integer :: stay = 0             !< for so many periods
  end type lane_t

contains

  !> owner(i) = attractor (from 1) that start i ends on, 0 where it has not settled within max_periods; periods(i) = its first
  !> period inside a trapping region (max_periods where none); (u, v) become the states where the orbits were left.
  subroutine follow(map, regions, attractors, max_periods, u, v, owner, periods)
    class(map_t), intent(inout) :: map
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    integer(c_int64_t), intent(in) :: max_periods
    real(dp), intent(inout) :: u(:)
    real(dp), intent(inout) :: v(:)
    integer(c_int32_t), intent(out) :: owner(:)
    integer(c_int64_t), intent(out) :: periods(:)
    type(lane_t) :: lanes(WIDTH)
    integer(c_int64_t) :: next, settled_at
    integer :: active, lane, a

    active = 0
    next = 1
    do
      do while (active < WIDTH .and. next <= size(u))
        a = captor(regions, attractors, u(next), v(next))
        owner(next) = a
        periods(next) = 0
        if (a == 0) then
          active = active + 1
          lanes(active) = lane_t(start=next)
          call map%put(active, u(next), v(next))
        end if
        next = next + 1
      end do
      if (active == 0) return
      call map%advance(active)
      lane = 1
      do while (lane <= active)
        lanes(lane)%age = lanes(lane)%age + 1
        call judge(lanes(lane), map%u(lane), map%v(lane), a, settled_at)
        if (a == 0 .and. lanes(lane)%age < max_periods) then
          lane = lane + 1
          cycle
        end if
        owner(lanes(lane)%start) = a
        periods(lanes(lane)%start) = settled_at
        u(lanes(lane)%start) = map%u(lane)
        v(lanes(lane)%start) = map%v(lane)
        call map%move(active, lane)
        lanes(lane) = lanes(active)
        active = active - 1
      end do
    end do
  contains
    !> Is the orbit in a trapping region, or long enough in a cover?
    subroutine judge(l, u_now, v_now, owner_now, since)
      type(lane_t), intent(inout) :: l
      real(dp), intent(in) :: u_now
      real(dp), intent(in) :: v_now
      integer, intent(out) :: owner_now
      integer(c_int64_t), intent(out) :: since
      integer :: host

      owner_now = captor(regions, attractors, u_now, v_now)
      since = l%age
      if (owner_now > 0 .or. size(regions%covered) == 0) return
      host = coverer(regions, u_now, v_now)
      l%stay = merge(l%stay + 1, 1, host == l%guest_of)
      l%guest_of = host
      if (host == 0 .or. l%stay < STAY) return
      owner_now = host
      since = l%age - STAY + 1
    end subroutine judge
  end subroutine follow

end module kz_dynamics_labels
