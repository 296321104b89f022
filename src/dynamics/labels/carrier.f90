!> What carries orbits and all that their errors need through a period: the scene's map alone, or more precision beside it. Then the tangent
!> map is still that of the scene's map, which is enough for an error. Regions see the states in the coordinates of that map.
module kz_labels_carrier
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_labels_inner, only: inner_t
  use kz_labels_period_error, only: period_error_t, class_of, noise_at
  use kz_labels_spread, only: add_ellipse
  use kz_lanes_map, only: flow_t, WIDTH, CAPACITY, PI
  implicit none
  private
  public :: orbit_t, carrier_t, make_carrier

  !> An orbit at the end of a period.
  type :: orbit_t
    real(dp) :: u(3)  !< half-turns: the sum of three doubles
    real(dp) :: v(2)  !< rad per drive radian: the sum of two doubles
    real(dp) :: p(3)  !< what its state may be off: theta theta, theta v, v v (rad, rad per drive radian),
    real(dp) :: lost  !< and so much more in any direction
    integer(c_int64_t) :: age !< periods since it was released
  end type orbit_t

  type :: carrier_t
    !> states as regions see them: half-turns, rad per drive radian
    real(dp) :: u(CAPACITY) = 0
    real(dp) :: v(CAPACITY) = 0
    !> of the last period: derivatives of the angle by angle and velocity, of the velocity by both
    real(dp) :: tangent(WIDTH, 4) = 0
    !> what steps and rounding added in it, rad
    real(dp) :: noise(WIDTH) = 0
    !> how far the states may be from where regions see them, rad
    real(dp) :: region_error(CAPACITY) = 0
    class(flow_t), allocatable, private :: flow   !< the scene's map; between periods its lanes hold what regions see
    type(period_error_t), private :: error        !< of that map
    class(inner_t), allocatable, private :: inner !< more precision; not allocated: the map carries the orbits itself
  contains
    !> Puts an orbit into a lane; its error grows by what that costs.
    procedure :: put
    !> The physical state of a lane.
    procedure :: take
    !> Lanes first .. n become visible after they have been put.
    procedure :: to_map
    procedure :: move
    !> One period of the lanes 1 .. n.
    procedure :: advance
    !> How neighbours of some of them have moved in it: displace of flow_t.
    procedure :: displace
  end type carrier_t

contains

  !> Carries orbits by the scene's map, or in the precision of `inner`.
  subroutine make_carrier(flow, error, inner, carrier)
    class(flow_t), intent(in) :: flow !< the map of one drive period
    type(period_error_t), intent(in) :: error !< its errors
    class(inner_t), allocatable, intent(inout) :: inner !< it is taken over; not allocated: by the map
    type(carrier_t), intent(out) :: carrier !< the carrier

    allocate (carrier%flow, source=flow)
    carrier%error = error
    if (allocated(inner)) call move_alloc(inner, carrier%inner)
  end subroutine make_carrier

  !> The map leaves out what the state has below the last place of its doubles.
  subroutine put(self, lane, orbit)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit
    real(dp) :: noise

    if (allocated(self%inner)) then
      call self%inner%put(lane, orbit%u, orbit%v)
      noise = self%inner%noise(orbit%v(1))
    else
      call self%flow%put(lane, orbit%u(1), orbit%v(1))
      noise = self%error%noise(class_of(self%error, orbit%v(1))) + PI*abs(orbit%u(2)) + abs(orbit%v(2))
    end if
    call add_ellipse(orbit%lost + noise, orbit%p)
  end subroutine put

  subroutine take(self, lane, orbit)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    if (allocated(self%inner)) then
      call self%inner%take(lane, orbit%u, orbit%v)
    else
      orbit%u = [self%u(lane), 0.0_dp, 0.0_dp]
      orbit%v = [self%v(lane), 0.0_dp]
    end if
  end subroutine take

  subroutine to_map(self, first, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: first, n

    if (allocated(self%inner)) then
      call self%inner%to_map(first, n)
      call show(self, first, n)
    else
      call self%flow%to_map(n, first=first)
    end if
    self%u(first:n) = self%flow%u(first:n)
    self%v(first:n) = self%flow%v(first:n)
  end subroutine to_map

  !> Puts lanes first .. n, at most WIDTH, of the inner states into the map.
  subroutine show(self, first, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: first, n
    real(dp) :: u(CAPACITY), v(CAPACITY)
    integer :: lane

    call self%inner%show(first, n, u, v)
    do lane = first, n
      call self%flow%put(lane, u(lane), v(lane))
      self%region_error(lane) = self%error%noise(class_of(self%error, v(lane)))
    end do
    call self%flow%to_map(n, first=first)
  end subroutine show

  subroutine move(self, from, to)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: from, to

    if (allocated(self%inner)) call self%inner%move(from, to)
    call self%flow%move(from, to)
    self%u(to) = self%u(from)
    self%v(to) = self%v(from)
    self%region_error(to) = self%region_error(from)
  end subroutine move

  subroutine advance(self, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    if (allocated(self%inner)) then
      do lane = 1, n
        self%noise(lane) = self%inner%noise(self%v(lane))
      end do
    else
      call noise_at(self%error, n, self%v(:n), self%noise)
    end if
    call self%flow%advance_linear(n, self%tangent)
    if (allocated(self%inner)) then
      call self%inner%advance(n)
      call show(self, 1, n)
    end if
    self%u(:n) = self%flow%u(:n)
    self%v(:n) = self%flow%v(:n)
  end subroutine advance

  subroutine displace(self, lane, u, v, by)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: lane(:)
    real(dp), intent(in) :: u(:), v(:)
    real(dp), intent(inout) :: by(:, :, :)

    call self%flow%displace(lane, u, v, by)
  end subroutine displace

end module kz_labels_carrier
