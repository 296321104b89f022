!> Orbits in more than the scene's own precision with their errors beside them. Their tangent map is that of the scene's map, which is enough
!> for an error, and in whose coordinates trapping regions see them.
module kz_labels_precise_carrier
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_labels_carrier, only: carrier_t, orbit_t
  use kz_labels_inner, only: inner_t
  use kz_labels_period_error, only: period_error_t, class_of
  use kz_labels_spread, only: add_ellipse
  use kz_lanes_map, only: flow_t, WIDTH, CAPACITY
  implicit none
  private
  public :: precise_carrier_t, make_precise_carrier

  type, extends(carrier_t) :: precise_carrier_t
    private
    class(inner_t), allocatable :: inner
    class(flow_t), allocatable :: flow !< the scene's map; between periods its lanes hold what regions see
    type(period_error_t) :: error      !< of the scene's map
  contains
    procedure :: put
    procedure :: take
    procedure :: to_map
    procedure :: move
    procedure :: advance
  end type precise_carrier_t

contains

  !> Carries orbits in the precision of `inner`.
  subroutine make_precise_carrier(inner, flow, error, carrier)
    !> it is taken over
    class(inner_t), allocatable, intent(inout) :: inner
    !> the scene's map
    class(flow_t), intent(in) :: flow
    !> its errors
    type(period_error_t), intent(in) :: error
    !> the carrier
    type(precise_carrier_t), intent(out) :: carrier

    call move_alloc(inner, carrier%inner)
    allocate (carrier%flow, source=flow)
    carrier%error = error
  end subroutine make_precise_carrier

  subroutine put(self, lane, orbit)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    call self%inner%put(lane, orbit%u, orbit%v)
    call add_ellipse(orbit%lost + self%inner%noise(orbit%v(1)), orbit%p)
  end subroutine put

  subroutine take(self, lane, orbit)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    call self%inner%take(lane, orbit%u, orbit%v)
  end subroutine take

  subroutine to_map(self, first, n)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: first
    integer, intent(in) :: n

    call self%inner%to_map(first, n)
    call see(self, first, n)
  end subroutine to_map

  !> Shows lanes first .. n, at most WIDTH, to the regions.
  subroutine see(self, first, n)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: first
    integer, intent(in) :: n
    real(dp) :: u(CAPACITY), v(CAPACITY)
    integer :: lane

    call self%inner%show(first, n, u, v)
    do lane = first, n
      call self%flow%put(lane, u(lane), v(lane))
      self%region_error(lane) = self%error%noise(class_of(self%error, v(lane)))
    end do
    call self%flow%to_map(n, first=first)
    self%u(first:n) = self%flow%u(first:n)
    self%v(first:n) = self%flow%v(first:n)
  end subroutine see

  subroutine move(self, from, to)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call self%inner%move(from, to)
    call self%flow%move(from, to)
    self%u(to) = self%u(from)
    self%v(to) = self%v(from)
    self%region_error(to) = self%region_error(from)
  end subroutine move

  subroutine advance(self, n)
    class(precise_carrier_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    do lane = 1, n
      self%noise(lane) = self%inner%noise(self%v(lane))
    end do
    call self%flow%advance_linear(n, self%tangent)
    call self%inner%advance(n)
    call see(self, 1, n)
  end subroutine advance

end module kz_labels_precise_carrier
