!> The error of an orbit as the covariance P of its state. A period carries it to J P J^T + d**2 1, with the tangent map J and the
!> error d that steps and rounding make within the period. An orbit whose error grows large is doubtful: its label is not decided.
!> It is trapped once a trapping region holds the whole ellipse of P.
module kz_labels_covariance
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: map_t, move_state, WIDTH, ROOM, PI
  use kz_cycles_cycles, only: attractor_t
  use kz_grown_grid, only: regions_t, find_regions
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: error_map_t, move_error, spread

  !> rad: the standard deviation of a state that a label bears. Of 1657 wrong labels (against quad precision; epsilon = 0.3 and 0.46, Q =
  !> 20, rk4, single precision) 0.03 found all and 0.1 all but one; twice as many labels are doubtful as are wrong.
  real(dp), parameter :: TOLERABLE = 0.03_dp
  !> Half-axes of the ellipse, in standard deviations, and points of its rim that must lie in the trapping region.
  real(dp), parameter :: DEVIATIONS = 3
  integer, parameter :: RIM = 8

  !> A map whose orbits carry their errors.
  type, abstract, extends(map_t) :: error_map_t
    type(regions_t), pointer :: regions => null()            !< the trapping regions
    type(attractor_t), pointer :: attractors(:) => null()    !< the catalogue, numbered from 1
    real(dp) :: p(3, ROOM) = 0 !< theta theta, theta v, v v: rad, rad per drive radian
  contains
    !> Starts the error of a lane, rad, in every direction alike.
    procedure :: start_error
    procedure :: classify_errors
    procedure :: reach
  end type error_map_t

contains

  subroutine start_error(self, lane, error)
    class(error_map_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: error

    self%p(:, lane) = [1, 0, 1]*error**2
  end subroutine start_error

  !> Copies the state of a lane and its error to another one.
  subroutine move_error(map, from, to)
    !> the map
    class(error_map_t), intent(inout) :: map
    !> lane, from 1
    integer, intent(in) :: from
    !> lane, from 1
    integer, intent(in) :: to

    call move_state(map, from, to)
    map%p(:, to) = map%p(:, from)
  end subroutine move_error

  !> The errors of n lanes over the period that they have just made: which are doubtful now, which straddle the edge of a region.
  subroutine classify_errors(self, n, tangent, error, seen)
    !> the map, whose states are in the coordinates of the regions
    class(error_map_t), intent(inout) :: self
    !> lanes 1 .. n
    integer, intent(in) :: n
    !> (2, 2, n): derivative of the period
    real(dp), intent(in) :: tangent(:, :, :)
    !> [n] that the period has added, rad
    real(dp), intent(in) :: error(:)
    !> [n] how far the states are from where the regions see them, rad
    real(dp), intent(in) :: seen(:)
    integer :: region(WIDTH), lane

    call find_regions(self%regions, self%attractors, n, self%u(:n), self%v(:n), region)
    do lane = 1, n
      call spread(tangent(:, :, lane), error(lane), self%p(:, lane))
      self%straddling(lane) = .false.
      if (.not. largest_error(self%p(:, lane)) <= TOLERABLE) then
        self%doubtful(lane) = .true.
        self%p(:, lane) = 0
      else if (region(lane) > 0) then
        self%straddling(lane) = .not. holds(self%regions, self%attractors, self%u(lane), self%v(lane), &
                                            self%p(:, lane) + [1, 0, 1]*seen(lane)**2, region(lane))
      end if
    end do
  end subroutine classify_errors

  !> Half the longer axis of the ellipse that a trapping region must hold.
  pure function reach(self, lane)
    class(error_map_t), intent(in) :: self
    integer, intent(in) :: lane
    real(dp) :: reach

    reach = DEVIATIONS*largest_error(self%p(:, lane))
  end function reach

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

  !> Does the trapping region of attractor a hold the rim of the ellipse of P around (u0, v0)?
  function holds(regions, attractors, u0, v0, p, a) result(inside)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    real(dp), intent(in) :: u0
    real(dp), intent(in) :: v0
    real(dp), intent(in) :: p(3)
    integer, intent(in) :: a
    logical :: inside
    real(dp) :: u(RIM), v(RIM), angle, along, across, slant
    integer :: label(RIM), i

    along = sqrt(p(1))
    slant = merge(p(2)/along, 0.0_dp, along > 0)
    across = sqrt(max(0.0_dp, p(3) - slant**2))
    do i = 1, RIM
      angle = 2*PI*i/RIM
      u(i) = angle_difference(u0 + DEVIATIONS*along*cos(angle)/PI, 0.0_dp)
      v(i) = v0 + DEVIATIONS*(slant*cos(angle) + across*sin(angle))
    end do
    call find_regions(regions, attractors, RIM, u, v, label)
    inside = all(label == a)
  end function holds

end module kz_labels_covariance
