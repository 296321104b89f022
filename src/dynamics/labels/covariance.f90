!> Orbits with their errors. Beside each state goes the covariance P of its error: a period carries it to J P J^T + d**2 1, with
!> the tangent map J and the error d that steps and rounding make within the period. An orbit whose error grows large is
!> doubtful: its label is not decided. It is trapped once a trapping region holds the whole ellipse of P.
module kz_maps_covariance
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: map_t, flow_t, put_state, move_state, WIDTH, ROOM, PI
  use kz_attractors_cycles, only: attractor_t
  use kz_trapping_grid, only: regions_t, find_regions
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private
  public :: covariant_map_t, make_covariant_map, spread, largest_error

  !> rad: the standard deviation of a state that a label bears. Of 1657 wrong labels (quad truth; epsilon = 0.3 and 0.46, Q =
  !> 20, rk4, single precision) 0.03 found all and 0.1 all but one; twice as many labels are doubtful as are wrong.
  real(dp), parameter :: TOLERABLE = 0.03_dp
  !> Half-axes of the ellipse, in standard deviations, and points of its rim that must lie in the trapping region.
  real(dp), parameter :: DEVIATIONS = 3
  integer, parameter :: RIM = 8

  type, extends(map_t) :: covariant_map_t
    private
    class(flow_t), allocatable :: flow  !< the map
    class(flow_t), allocatable :: finer !< the same pendulum with smaller errors: it shows those of the map
    class(flow_t), allocatable :: shown !< the map's states in physical coordinates, in which the two are compared
    type(regions_t), pointer :: regions => null()
    type(attractor_t), pointer :: attractors(:) => null()
    real(dp) :: p(3, ROOM) = 0 !< theta theta, theta v, v v: rad, rad per drive radian
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
    self%p(:, lane) = [1, 0, 1]*(rounding(self)*hypot(PI*u, v))**2
  end subroutine put

  subroutine enter(self, n, matrix, first)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first

    call self%flow%enter(n, matrix, first)
    self%u(:n) = self%flow%u(:n)
    self%v(:n) = self%flow%v(:n)
  end subroutine enter

  subroutine move(self, from, to)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call move_state(self, from, to)
    call self%flow%move(from, to)
    self%p(:, to) = self%p(:, from)
  end subroutine move

  !> One period of n lanes and of their errors.
  subroutine advance(self, n)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp) :: tangent(2, 2, WIDTH), error
    integer :: region(WIDTH), lane

    do lane = 1, n
      tangent(:, :, lane) = reshape([1, 0, 0, 1], [2, 2])
    end do
    call show(self, n)
    do lane = 1, n
      call self%finer%put(lane, self%shown%u(lane), self%shown%v(lane))
    end do
    call self%finer%enter(n)
    call self%finer%advance(n)
    call self%finer%leave(n)
    call self%flow%advance_tangent(n, tangent)
    call show(self, n)
    self%u(:n) = self%flow%u(:n)
    self%v(:n) = self%flow%v(:n)
    self%turns(:n) = self%flow%turns(:n)
    call find_regions(self%regions, self%attractors, n, self%u(:n), self%v(:n), region)
    do lane = 1, n
      error = hypot(separation(self%shown%u(lane), self%shown%v(lane), self%finer%u(lane), self%finer%v(lane)), &
                    rounding(self)*hypot(PI, self%v(lane)))
      call spread(tangent(:, :, lane), error, self%p(:, lane))
      self%straddling(lane) = .false.
      if (.not. largest_error(self%p(:, lane)) <= TOLERABLE) then
        self%doubtful(lane) = .true.
        self%p(:, lane) = 0
      else if (region(lane) > 0) then
        self%straddling(lane) = .not. holds(self, lane, region(lane))
      end if
    end do
  end subroutine advance

  !> The lanes' present states in physical coordinates.
  subroutine show(self, n)
    class(covariant_map_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    do lane = 1, n
      call self%shown%put(lane, self%flow%u(lane), self%flow%v(lane))
    end do
    call self%shown%leave(n)
  end subroutine show

  !> Distance from 1 to the next number, as coarse as that of states that are put or compared.
  pure function rounding(self)
    class(covariant_map_t), intent(in) :: self
    real(dp) :: rounding

    rounding = max(self%flow%rounding, epsilon(1.0_dp))
  end function rounding

  !> P over a period with the tangent map `matrix` and an error of the period's own, in every direction alike.
  pure subroutine spread(matrix, error, p)
    !> derivative of the map
    real(dp), intent(in) :: matrix(2, 2)
    !> rad
    real(dp), intent(in) :: error
    !> theta theta, theta v, v v
    real(dp), intent(inout) :: p(3)

    associate (a => matrix(1, 1), b => matrix(1, 2), c => matrix(2, 1), d => matrix(2, 2))
      p = [a*a*p(1) + 2*a*b*p(2) + b*b*p(3) + error**2, &
           a*c*p(1) + (a*d + b*c)*p(2) + b*d*p(3), &
           c*c*p(1) + 2*c*d*p(2) + d*d*p(3) + error**2]
    end associate
  end subroutine spread

  !> The standard deviation along the longer axis of the ellipse of P, rad; not a number for one that is lost.
  pure function largest_error(p) result(deviation)
    !> covariance: of the angle, mixed, of the velocity
    real(dp), intent(in) :: p(3)
    real(dp) :: deviation

    deviation = sqrt(0.5_dp*(p(1) + p(3) + hypot(p(1) - p(3), 2*p(2))))
  end function largest_error

  !> Does the trapping region of attractor a hold the rim of the lane's ellipse?
  function holds(self, lane, a) result(inside)
    class(covariant_map_t), intent(in) :: self
    integer, intent(in) :: lane
    integer, intent(in) :: a
    logical :: inside
    real(dp) :: u(RIM), v(RIM), angle, along, across, slant
    integer :: label(RIM), i

    associate (p => self%p(:, lane))
      along = sqrt(p(1))
      slant = merge(p(2)/along, 0.0_dp, along > 0)
      across = sqrt(max(0.0_dp, p(3) - slant**2))
    end associate
    do i = 1, RIM
      angle = 2*PI*i/RIM
      u(i) = angle_difference(self%u(lane) + DEVIATIONS*along*cos(angle)/PI, 0.0_dp)
      v(i) = self%v(lane) + DEVIATIONS*(slant*cos(angle) + across*sin(angle))
    end do
    call find_regions(self%regions, self%attractors, RIM, u, v, label)
    inside = all(label == a)
  end function holds

end module kz_maps_covariance
