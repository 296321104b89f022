!> Stroboscopic maps: one drive period of a batch of trajectories. The kernel extends them for each family of schemes,
!> the map table of the dynamics by interpolation. Angles are in half-turns, u = theta/pi: the wrap to [-1, 1] is exact,
!> and mirror images (-u, -v) of states have mirrored images, to the bit.
module kz_vector_map
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  implicit none
  private
  public :: map_t, flow_t, put_state, move_state, WIDTH, CAPACITY, PI

  !> Trajectories per batch; a multiple of every vector width.
  integer, parameter :: WIDTH = 64
  !> Lanes of a map: those that are advanced, and as many waiting states.
  integer, parameter :: CAPACITY = 2*WIDTH
  real(c_double), parameter :: PI = 3.14159265358979323846_c_double

  type, abstract :: map_t
    real(c_double) :: u(CAPACITY) = 0 !< Angles in half-turns, wrapped to [-1, 1]
    real(c_double) :: v(CAPACITY) = 0 !< Velocities in rad per drive radian
    integer(c_int64_t) :: turns(CAPACITY) = 0 !< Net turns, counterclockwise +
  contains
    !> Puts a state into a lane and sets its turns to 0.
    procedure :: put => put_state
    !> Puts states into the lanes 1 .. size(u).
    procedure :: put_all
    !> Copies lane `from` over lane `to`.
    procedure :: move => move_state
    !> Advances the lanes 1 .. n (or all) by one period.
    procedure(advance_i), deferred :: advance
    !> Changes the lanes first .. n (default 1; at most WIDTH lanes) from physical coordinates (angle, velocity) to
    !> those of the map, and back. The maps in both coordinates are conjugate: same cycles, multipliers, windings and
    !> basins. matrix(:, :, lane), if present, is multiplied by the derivative of the change (flows only).
    procedure :: to_map => same_coordinates
    procedure :: to_physical => same_coordinates
    !> Advances the lanes 1 .. n by one period, from physical states to physical states.
    procedure :: advance_physical
  end type map_t

  !> A map by integration, which also has its derivative and the states within the period.
  type, abstract, extends(map_t) :: flow_t
    logical :: single = .false. !< True: `advance` may work in single precision
  contains
    !> Advances the lanes 1 .. n by one period; matrix(:, :, lane) is multiplied by the derivative of (theta, v), rad.
    procedure(advance_tangent_i), deferred :: advance_tangent
    !> Advances the lanes 1 .. n by one period. tangent(lane, :): Jacobian of (theta, v) by rows, rad, about 3 digits.
    procedure :: advance_linear => linear_of_tangent
    !> Maps neighbours of states by one period, to three digits or better. by(:, j, i), in: neighbour j less state i
    !> before the period; out: its image less the image of the state; rad, rad per drive radian. The lanes do not
    !> change.
    procedure :: displace => displace_by_states
    !> Samples one period of the lanes 1 .. size(u, 2) at n equal times in physical coordinates; u(n, :) is not wrapped.
    procedure(sample_i), deferred :: sample
  end type flow_t

  abstract interface
    subroutine advance_i(self, n)
      import :: map_t
      class(map_t), intent(inout) :: self
      integer, intent(in) :: n
    end subroutine advance_i

    subroutine advance_tangent_i(self, n, matrix)
      import :: flow_t, c_double, WIDTH
      class(flow_t), intent(inout) :: self
      integer, intent(in) :: n
      real(c_double), intent(inout) :: matrix(2, 2, WIDTH)
    end subroutine advance_tangent_i

    subroutine sample_i(self, n, u, v)
      import :: flow_t, c_double
      class(flow_t), intent(inout) :: self
      integer, intent(in) :: n
      real(c_double), intent(out) :: u(:, :), v(:, :)
    end subroutine sample_i
  end interface

contains

  subroutine same_coordinates(self, n, matrix, first)
    class(map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(c_double), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first

    associate (unused => self, unused_too => n)
    end associate
    if (present(matrix) .or. present(first)) return
  end subroutine same_coordinates

  !> Default of advance_linear, by advance_tangent.
  subroutine linear_of_tangent(self, n, tangent)
    class(flow_t), intent(inout) :: self
    integer, intent(in) :: n
    real(c_double), intent(inout) :: tangent(WIDTH, 4)
    real(c_double) :: matrix(2, 2, WIDTH)
    integer :: lane

    do lane = 1, n
      matrix(:, :, lane) = reshape([1, 0, 0, 1], [2, 2])
    end do
    call self%advance_tangent(n, matrix)
    do lane = 1, n
      tangent(lane, :) = [matrix(1, :, lane), matrix(2, :, lane)]
    end do
  end subroutine linear_of_tangent

  !> Default of displace, by the map of the neighbours themselves.
  subroutine displace_by_states(self, lane, u, v, by)
    class(flow_t), intent(inout) :: self
    integer, intent(in) :: lane(:) !< [n] lanes of u and v
    real(c_double), intent(in) :: u(:), v(:) !< states before the period, half-turns; rad per drive radian
    real(c_double), intent(inout) :: by(:, :, :)
    real(c_double) :: old_u(CAPACITY), old_v(CAPACITY)
    integer(c_int64_t) :: old_turns(CAPACITY)
    integer :: first, last, each, own, i, j

    old_u = self%u
    old_v = self%v
    old_turns = self%turns
    each = 1 + size(by, 2)
    do first = 1, size(lane), WIDTH/each
      last = min(size(lane), first + WIDTH/each - 1)
      do i = first, last
        own = 1 + each*(i - first)
        call self%put(own, u(lane(i)), v(lane(i)))
        do j = 1, size(by, 2)
          call self%put(own + j, u(lane(i)) + by(1, j, i)/PI, v(lane(i)) + by(2, j, i))
        end do
      end do
      call self%advance(each*(last - first + 1))
      do i = first, last
        own = 1 + each*(i - first)
        do j = 1, size(by, 2)
          by(:, j, i) = [PI*(self%u(own + j) - self%u(own)), self%v(own + j) - self%v(own)]
        end do
        by(1, :, i) = by(1, :, i) - 2*PI*anint(by(1, :, i)/(2*PI))
      end do
    end do
    self%u = old_u
    self%v = old_v
    self%turns = old_turns
  end subroutine displace_by_states

  !> Puts a state into a lane.
  subroutine put_state(self, lane, u, v)
    class(map_t), intent(inout) :: self !< the map
    integer, intent(in) :: lane !< from 1 to CAPACITY
    real(c_double), intent(in) :: u, v !< angle, half-turns in [-1, 1]; velocity, rad per drive radian

    self%u(lane) = u
    self%v(lane) = v
    self%turns(lane) = 0
  end subroutine put_state

  subroutine put_all(self, u, v)
    class(map_t), intent(inout) :: self
    real(c_double), intent(in) :: u(:), v(:)
    integer :: lane

    do lane = 1, size(u)
      call self%put(lane, u(lane), v(lane))
    end do
  end subroutine put_all

  subroutine advance_physical(self, n)
    class(map_t), intent(inout) :: self
    integer, intent(in) :: n

    call self%to_map(n)
    call self%advance(n)
    call self%to_physical(n)
  end subroutine advance_physical

  !> Copies the state of a lane to another one.
  subroutine move_state(self, from, to)
    class(map_t), intent(inout) :: self !< the map
    integer, intent(in) :: from, to !< lane, from 1

    self%u(to) = self%u(from)
    self%v(to) = self%v(from)
    self%turns(to) = self%turns(from)
  end subroutine move_state

end module kz_vector_map
