!> What carries orbits and all that their errors need through a period. Regions see the states in the coordinates of the scene's map.
module kz_labels_carrier
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_labels_period_error, only: period_error_t, class_of
  use kz_labels_spread, only: add_ellipse
  use kz_lanes_map, only: flow_t, WIDTH, CAPACITY, PI
  implicit none
  private
  public :: orbit_t, carrier_t, plain_carrier_t, make_plain_carrier

  !> An orbit at the end of a period.
  type :: orbit_t
    real(dp) :: u(2) = 0  !< half-turns: the sum of two doubles
    real(dp) :: v(2) = 0  !< rad per drive radian: the sum of two doubles
    real(dp) :: p(3) = 0  !< what its state may be off: theta theta, theta v, v v (rad, rad per drive radian),
    real(dp) :: lost = 0  !< and so much more in any direction
    integer(c_int64_t) :: age = 0 !< periods since it was released
  end type orbit_t

  type, abstract :: carrier_t
    !> states as regions see them: half-turns, rad per drive radian
    real(dp) :: u(CAPACITY) = 0
    real(dp) :: v(CAPACITY) = 0
    !> of the last period: derivatives of the angle by angle and velocity, of the velocity by both
    real(dp) :: tangent(WIDTH, 4) = 0
    !> what steps and rounding added in it, rad
    real(dp) :: noise(WIDTH) = 0
    !> how far the states may be from where regions see them, rad
    real(dp) :: region_error(CAPACITY) = 0
  contains
    !> Puts an orbit into a lane; its error grows by what that costs.
    procedure(put_i), deferred :: put
    !> The physical state of a lane.
    procedure(take_i), deferred :: take
    !> Lanes first .. n become visible after they have been put.
    procedure(to_map_i), deferred :: to_map
    procedure(move_i), deferred :: move
    !> One period of the lanes 1 .. n.
    procedure(advance_i), deferred :: advance
  end type carrier_t

  abstract interface
    subroutine put_i(self, lane, orbit)
      import :: carrier_t, orbit_t
      class(carrier_t), intent(inout) :: self
      integer, intent(in) :: lane
      type(orbit_t), intent(inout) :: orbit
    end subroutine put_i

    subroutine take_i(self, lane, orbit)
      import :: carrier_t, orbit_t
      class(carrier_t), intent(inout) :: self
      integer, intent(in) :: lane
      type(orbit_t), intent(inout) :: orbit
    end subroutine take_i

    subroutine to_map_i(self, first, n)
      import :: carrier_t
      class(carrier_t), intent(inout) :: self
      integer, intent(in) :: first
      integer, intent(in) :: n
    end subroutine to_map_i

    subroutine move_i(self, from, to)
      import :: carrier_t
      class(carrier_t), intent(inout) :: self
      integer, intent(in) :: from
      integer, intent(in) :: to
    end subroutine move_i

    subroutine advance_i(self, n)
      import :: carrier_t
      class(carrier_t), intent(inout) :: self
      integer, intent(in) :: n
    end subroutine advance_i
  end interface

  !> The scene's map alone.
  type, extends(carrier_t) :: plain_carrier_t
    private
    class(flow_t), allocatable :: flow
    type(period_error_t) :: error
  contains
    procedure :: put
    procedure :: take
    procedure :: to_map
    procedure :: move
    procedure :: advance
  end type plain_carrier_t

contains

  !> Carries orbits by the scene's map.
  subroutine make_plain_carrier(flow, error, carrier)
    !> the map of one drive period
    class(flow_t), intent(in) :: flow
    !> its errors
    type(period_error_t), intent(in) :: error
    !> the carrier
    type(plain_carrier_t), intent(out) :: carrier

    allocate (carrier%flow, source=flow)
    carrier%error = error
  end subroutine make_plain_carrier

  !> What the state has below the last place of its doubles is left out.
  subroutine put(self, lane, orbit)
    class(plain_carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    call self%flow%put(lane, orbit%u(1), orbit%v(1))
    call add_ellipse(orbit%lost + self%error%noise(class_of(self%error, orbit%v(1))) + PI*abs(orbit%u(2)) + abs(orbit%v(2)), orbit%p)
  end subroutine put

  subroutine take(self, lane, orbit)
    class(plain_carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    orbit%u = [self%u(lane), 0.0_dp]
    orbit%v = [self%v(lane), 0.0_dp]
  end subroutine take

  subroutine to_map(self, first, n)
    class(plain_carrier_t), intent(inout) :: self
    integer, intent(in) :: first
    integer, intent(in) :: n

    call self%flow%to_map(n, first=first)
    self%u(first:n) = self%flow%u(first:n)
    self%v(first:n) = self%flow%v(first:n)
  end subroutine to_map

  subroutine move(self, from, to)
    class(plain_carrier_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call self%flow%move(from, to)
    self%u(to) = self%u(from)
    self%v(to) = self%v(from)
  end subroutine move

  subroutine advance(self, n)
    class(plain_carrier_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    do lane = 1, n
      self%noise(lane) = self%error%noise(class_of(self%error, self%v(lane)))
    end do
    call self%flow%advance_linear(n, self%tangent)
    self%u(:n) = self%flow%u(:n)
    self%v(:n) = self%flow%v(:n)
  end subroutine advance

end module kz_labels_carrier
