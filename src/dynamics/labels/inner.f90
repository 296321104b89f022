!> Orbits in more than the scene's own precision: double precision with more steps, pairs of doubles, quad precision.
module kz_labels_inner
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_extended_pairs, only: pairs_t, pair_lanes_t, advance_pairs, pair_of, quad_of
  use kz_extended_taylor, only: drive_t, advance_period, doubles_of, qp, PI_QUAD
  use kz_labels_period_error, only: period_error_t, class_of
  use kz_lanes_map, only: flow_t, WIDTH, CAPACITY, PI
  implicit none
  private
  public :: inner_t, inner_fine_t, inner_pairs_t, inner_quad_t

  !> States of lanes in a precision of their own.
  type, abstract :: inner_t
  contains
    !> A state as sums of doubles: u half-turns, v rad per drive radian.
    procedure(put_i), deferred :: put
    procedure(take_i), deferred :: take
    !> Lanes first .. n have been put.
    procedure :: to_map => in_any_coordinates
    procedure(move_i), deferred :: move
    procedure(advance_i), deferred :: advance
    !> Lanes first .. n in double precision.
    procedure :: show => show_high_parts
    !> What a period adds to the error of a state of speed v, rad.
    procedure(noise_i), deferred :: noise
  end type inner_t

  abstract interface
    subroutine put_i(self, lane, u, v)
      import :: inner_t, dp
      class(inner_t), intent(inout) :: self
      integer, intent(in) :: lane
      real(dp), intent(in) :: u(3), v(2)
    end subroutine put_i

    subroutine take_i(self, lane, u, v)
      import :: inner_t, dp
      class(inner_t), intent(inout) :: self
      integer, intent(in) :: lane
      real(dp), intent(out) :: u(3), v(2)
    end subroutine take_i

    subroutine move_i(self, from, to)
      import :: inner_t
      class(inner_t), intent(inout) :: self
      integer, intent(in) :: from, to
    end subroutine move_i

    subroutine advance_i(self, n)
      import :: inner_t
      class(inner_t), intent(inout) :: self
      integer, intent(in) :: n
    end subroutine advance_i

    pure function noise_i(self, v) result(noise)
      import :: inner_t, dp
      class(inner_t), intent(in) :: self
      real(dp), intent(in) :: v
      real(dp) :: noise
    end function noise_i
  end interface

  !> Double precision with more steps.
  type, extends(inner_t) :: inner_fine_t
    class(flow_t), allocatable :: flow  !< the map
    class(flow_t), allocatable :: shown !< takes its states to physical coordinates
    type(period_error_t) :: error
  contains
    procedure :: put => fine_put
    procedure :: take => fine_take
    procedure :: to_map => fine_to_map
    procedure :: move => fine_move
    procedure :: advance => fine_advance
    procedure :: show => fine_show
    procedure :: noise => fine_noise
  end type inner_fine_t

  !> Pairs of doubles, physical coordinates.
  type, extends(inner_t) :: inner_pairs_t
    type(pairs_t), pointer :: tables => null()
    real(dp) :: u(CAPACITY, 2) = 0
    real(dp) :: v(CAPACITY, 2) = 0
  contains
    procedure :: put => pairs_put
    procedure :: take => pairs_take
    procedure :: move => pairs_move
    procedure :: advance => pairs_advance
    procedure :: noise => pairs_noise
  end type inner_pairs_t

  !> Quad precision, by Taylor series.
  type, extends(inner_t) :: inner_quad_t
    type(drive_t), pointer :: drive => null()
    real(qp) :: theta(CAPACITY) = 0    !< rad
    real(qp) :: velocity(CAPACITY) = 0 !< rad per drive radian
    real(dp) :: error = 0          !< of a period, relative to hypot(pi, v)
  contains
    procedure :: put => quad_put
    procedure :: take => quad_take
    procedure :: move => quad_move
    procedure :: advance => quad_advance
    procedure :: noise => quad_noise
  end type inner_quad_t

contains

  subroutine in_any_coordinates(self, first, n)
    class(inner_t), intent(inout) :: self
    integer, intent(in) :: first, n

    associate (unused => self, unused_first => first, unused_last => n)
    end associate
  end subroutine in_any_coordinates

  subroutine show_high_parts(self, first, n, u, v)
    class(inner_t), intent(inout) :: self
    integer, intent(in) :: first, n
    real(dp), intent(inout) :: u(CAPACITY), v(CAPACITY)
    real(dp) :: angle(3), speed(2)
    integer :: lane

    do lane = first, n
      call self%take(lane, angle, speed)
      u(lane) = angle(1)
      v(lane) = speed(1)
    end do
  end subroutine show_high_parts

  subroutine fine_put(self, lane, u, v)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u(3), v(2)

    call self%flow%put(lane, u(1), v(1))
  end subroutine fine_put

  subroutine fine_take(self, lane, u, v)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(out) :: u(3), v(2)

    call self%shown%put(lane, self%flow%u(lane), self%flow%v(lane))
    call self%shown%to_physical(lane, first=lane)
    u = [self%shown%u(lane), 0.0_dp, 0.0_dp]
    v = [self%shown%v(lane), 0.0_dp]
  end subroutine fine_take

  subroutine fine_to_map(self, first, n)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: first, n

    call self%flow%to_map(n, first=first)
  end subroutine fine_to_map

  subroutine fine_move(self, from, to)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call self%flow%move(from, to)
  end subroutine fine_move

  subroutine fine_advance(self, n)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: n

    call self%flow%advance(n)
  end subroutine fine_advance

  subroutine fine_show(self, first, n, u, v)
    class(inner_fine_t), intent(inout) :: self
    integer, intent(in) :: first, n
    real(dp), intent(inout) :: u(CAPACITY), v(CAPACITY)
    integer :: lane

    do lane = first, n
      call self%shown%put(lane, self%flow%u(lane), self%flow%v(lane))
    end do
    call self%shown%to_physical(n, first=first)
    u(first:n) = self%shown%u(first:n)
    v(first:n) = self%shown%v(first:n)
  end subroutine fine_show

  pure function fine_noise(self, v) result(noise)
    class(inner_fine_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp) :: noise

    noise = self%error%noise(class_of(self%error, v))
  end function fine_noise

  subroutine pairs_put(self, lane, u, v)
    class(inner_pairs_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u(3), v(2)

    self%u(lane, :) = u(:2)
    self%v(lane, :) = v
  end subroutine pairs_put

  subroutine pairs_take(self, lane, u, v)
    class(inner_pairs_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(out) :: u(3), v(2)

    u = [self%u(lane, :), 0.0_dp]
    v = self%v(lane, :)
  end subroutine pairs_take

  subroutine pairs_move(self, from, to)
    class(inner_pairs_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%u(to, :) = self%u(from, :)
    self%v(to, :) = self%v(from, :)
  end subroutine pairs_move

  subroutine pairs_advance(self, n)
    class(inner_pairs_t), intent(inout) :: self
    integer, intent(in) :: n
    type(pair_lanes_t) :: lanes
    integer(c_int64_t) :: turns(WIDTH)

    turns = 0
    lanes%u = self%u(:WIDTH, :)
    lanes%v = self%v(:WIDTH, :)
    call advance_pairs(self%tables, n, lanes, turns)
    self%u(:n, :) = lanes%u(:n, :)
    self%v(:n, :) = lanes%v(:n, :)
  end subroutine pairs_advance

  pure function pairs_noise(self, v) result(noise)
    class(inner_pairs_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp) :: noise

    noise = max(self%tables%error, 1e-31_dp*hypot(PI, v))
    if (abs(v) > self%tables%fastest) noise = max(noise, self%tables%series_error*hypot(PI, v))
  end function pairs_noise

  subroutine quad_put(self, lane, u, v)
    class(inner_quad_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u(3), v(2)

    self%theta(lane) = PI_QUAD*(u(1) + quad_of(u(2:)))
    self%velocity(lane) = quad_of(v)
  end subroutine quad_put

  subroutine quad_take(self, lane, u, v)
    class(inner_quad_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(out) :: u(3), v(2)

    u = doubles_of(self%theta(lane)/PI_QUAD, 3)
    v = pair_of(self%velocity(lane))
  end subroutine quad_take

  subroutine quad_move(self, from, to)
    class(inner_quad_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%theta(to) = self%theta(from)
    self%velocity(to) = self%velocity(from)
  end subroutine quad_move

  subroutine quad_advance(self, n)
    class(inner_quad_t), intent(inout) :: self
    integer, intent(in) :: n
    integer(c_int64_t) :: turns(WIDTH)

    turns = 0
    call advance_period(self%drive, self%theta(:n), self%velocity(:n), turns(:n))
  end subroutine quad_advance

  pure function quad_noise(self, v) result(noise)
    class(inner_quad_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp) :: noise

    noise = self%error*hypot(PI, v)
  end function quad_noise

end module kz_labels_inner
