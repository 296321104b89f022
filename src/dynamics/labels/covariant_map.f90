!> Orbits of the scene's map with their errors beside them.
module kz_labels_covariant_map
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: flow_t, put_state, WIDTH, PI
  use kz_cycles_cycles, only: attractor_t
  use kz_grown_grid, only: regions_t
  use kz_labels_covariance, only: error_map_t, move_error
  use kz_maps_states, only: separation
  implicit none
  private
  public :: covariant_map_t, make_covariant_map

  type, extends(error_map_t) :: covariant_map_t
    private
    class(flow_t), allocatable :: flow  !< the map
    class(flow_t), allocatable :: finer !< the same pendulum with smaller errors: it shows those of the map
    class(flow_t), allocatable :: shown !< the map's states in physical coordinates, in which the two are compared
  contains
    procedure :: put
    procedure :: move
    procedure :: advance
    procedure :: enter
  end type covariant_map_t

contains

  !> The map that carries the error of each orbit beside it.
  subroutine make_covariant_map(flow, finer, regions, attractors, map)
    !> the map of one drive period, by integration
    class(flow_t), intent(in) :: flow
    !> the same with twice the steps: their difference is the error of a period
    class(flow_t), intent(in) :: finer
    !> the trapping regions
    type(regions_t), target, intent(in) :: regions
    !> the catalogue, numbered from 1
    type(attractor_t), target, intent(in) :: attractors(:)
    !> the map
    type(covariant_map_t), intent(out) :: map

    allocate (map%flow, source=flow)
    allocate (map%finer, source=finer)
    allocate (map%shown, source=flow)
    map%regions => regions
    map%attractors => attractors
  end subroutine make_covariant_map

  !> A start is known to its last place.
  subroutine put(self, lane, u, v)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v

    call put_state(self, lane, u, v)
    call self%flow%put(lane, u, v)
    call self%start_error(lane, epsilon(1.0_dp)*hypot(PI*u, v))
  end subroutine put

  !> What the change of coordinates misses, as the way back shows it, is an error of the start.
  subroutine enter(self, n, matrix, first)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first
    integer :: lane, from

    from = 1
    if (present(first)) from = first
    call self%flow%enter(n, matrix, first)
    call show(self, from, n)
    do lane = from, n
      self%p([1, 3], lane) = self%p([1, 3], lane) &
                             + separation(self%shown%u(lane), self%shown%v(lane), self%u(lane), self%v(lane))**2
    end do
    self%u(from:n) = self%flow%u(from:n)
    self%v(from:n) = self%flow%v(from:n)
  end subroutine enter

  subroutine move(self, from, to)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call move_error(self, from, to)
    call self%flow%move(from, to)
  end subroutine move

  !> One period of n lanes and of their errors.
  subroutine advance(self, n)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp) :: tangent(2, 2, WIDTH), error(WIDTH)
    real(dp), parameter :: SEEN(WIDTH) = 0
    integer :: lane

    do lane = 1, n
      tangent(:, :, lane) = reshape([1, 0, 0, 1], [2, 2])
    end do
    call show(self, 1, n)
    do lane = 1, n
      call self%finer%put(lane, self%shown%u(lane), self%shown%v(lane))
    end do
    call self%finer%enter(n)
    call self%finer%advance(n)
    call self%finer%leave(n)
    call self%flow%advance_tangent(n, tangent)
    call show(self, 1, n)
    self%u(:n) = self%flow%u(:n)
    self%v(:n) = self%flow%v(:n)
    self%turns(:n) = self%flow%turns(:n)
    error(:n) = hypot(separation(self%shown%u(:n), self%shown%v(:n), self%finer%u(:n), self%finer%v(:n)), &
                      epsilon(1.0_dp)*hypot(PI, self%v(:n)))
    call self%classify_errors(n, tangent, error, SEEN)
  end subroutine advance

  !> The present states of lanes first .. n in physical coordinates.
  subroutine show(self, first, n)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: first
    integer, intent(in) :: n
    integer :: lane

    do lane = first, n
      call self%shown%put(lane, self%flow%u(lane), self%flow%v(lane))
    end do
    call self%shown%leave(n, first=first)
  end subroutine show

end module kz_labels_covariant_map
