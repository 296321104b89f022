!> The hybrid map: orbits follow the map table while its error is small enough. The interpolation error of every period is added
!> to the orbit's error and stretched by the tangent map. Where the sum exceeds what a label tolerates, the orbit returns to its
!> last state without error, is integrated over the same periods, and continues on the table with error 0.
module kz_maps_hybrid_map
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_kernel_map, only: map_t, flow_t, put_state, move_state, WIDTH, PI
  use kz_attractors_cycles, only: attractor_t
  use kz_dynamics_label, only: follow, DOUBTFUL
  use kz_trapping_grid, only: regions_t
  use kz_maps_states, only: angle_difference, midperiod_angle
  use kz_maps_map_table, only: table_t, table_map_t, make_table_map, place_t, locate, displace
  implicit none
  private
  public :: measure_defects, hybrid_map_t, make_hybrid_map, follow_hybrid_map

  !> Cells along an axis that share one defect: an even number, for a block's middle is that of a cell.
  integer, parameter :: BLOCK = 4
  !> rad: the largest error of a state that a label tolerates.
  real(dp), parameter :: TOLERABLE = 0.1_dp

  type, extends(table_map_t) :: hybrid_map_t
    real(dp), pointer :: defect(:, :, :) => null() !< of measure_defects
    real(dp) :: error(2, WIDTH) = 0 !< of the state since the lane was put: half-turns at mid-period, rad per drive radian
  contains
    procedure :: put
    procedure :: move
    procedure :: advance
  end type hybrid_map_t

contains

  !> defect(:, i, j) = the error of one period from the middle cell of block (i, j), from 0: half-turns at mid-period, rad per
  !> drive radian.
  subroutine measure_defects(map, defect)
    !> the interpolating map
    type(table_map_t), intent(inout) :: map
    !> error of one period by blocks of cells (2, angle, velocity): half-turns at mid-period, rad per drive radian
    real(dp), allocatable, intent(out) :: defect(:, :, :)
    class(flow_t), allocatable :: flow
    real(dp) :: u, v
    integer :: n_blocks(2), first, n, lane, j

    allocate (flow, source=map%flow)
    n_blocks = [map%table%n_theta, map%table%n_velocity - 1]/BLOCK + 1
    allocate (defect(2, 0:n_blocks(1) - 1, 0:n_blocks(2) - 1))
    do j = 0, n_blocks(2) - 1
      v = (2*middle(j)/(map%table%n_velocity - 1) - 1)*map%table%top
      do first = 0, n_blocks(1) - 1, WIDTH
        n = min(WIDTH, n_blocks(1) - first)
        do lane = 1, n
          u = angle_difference(2*middle(first + lane - 1)/map%table%n_circle, midperiod_angle(0.0_dp, v))
          call flow%put(lane, u, v)
          call map%put(lane, u, v)
        end do
        call flow%advance(n)
        call map%advance(n)
        do lane = 1, n
          defect(2, first + lane - 1, j) = map%v(lane) - flow%v(lane)
          defect(1, first + lane - 1, j) = midperiod_angle(angle_difference(map%u(lane), flow%u(lane)), defect(2, first + lane - 1, j))
        end do
      end do
    end do
  contains
    !> In cells.
    pure function middle(b) result(x)
      integer, intent(in) :: b
      real(dp) :: x

      x = BLOCK*b + 0.5_dp*(BLOCK + 1)
    end function middle
  end subroutine measure_defects

  !> The map of a table that carries the error of each orbit beside it.
  subroutine make_hybrid_map(table, points, flow, defect, map)
    !> the map table
    type(table_t), target, intent(in) :: table
    !> nodes of the stencil along an axis: 2, 4, 6
    integer, intent(in) :: points
    !> integrates the periods that begin outside the table
    class(flow_t), intent(in) :: flow
    !> what measure_defects gave
    real(dp), target, intent(in) :: defect(:, 0:, 0:)
    !> the map
    type(hybrid_map_t), intent(out) :: map

    map%table_map_t = make_table_map(table, points, flow)
    map%defect(1:, 0:, 0:) => defect
  end subroutine make_hybrid_map

  subroutine put(self, lane, u, v)
    class(hybrid_map_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v

    call put_state(self, lane, u, v)
    self%error(:, lane) = 0
  end subroutine put

  subroutine move(self, from, to)
    class(hybrid_map_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call move_state(self, from, to)
    self%error(:, to) = self%error(:, from)
  end subroutine move

  !> One period of n lanes and of their errors: the tangent map, by differences of the nodes around each state, and the defect.
  !> Errors of mirror images are mirror images. The error of a doubtful lane is reset to 0.
  subroutine advance(self, n)
    class(hybrid_map_t), intent(inout) :: self
    integer, intent(in) :: n
    type(place_t) :: place
    real(dp) :: along(2), across(2), error(2)
    integer :: lane, i, j

    call locate(self, n, place)
    call displace(self, n, place)
    associate (table => self%table, shift => self%table%shift)
      do lane = 1, n
        i = place%i(lane)
        j = place%j(lane) + 1
        along = (shift(:, i + 1, j) - shift(:, i, j))*(0.5_dp*table%n_circle)
        across = (shift(:, i, j + 1) - shift(:, i, j))*((table%n_velocity - 1)/(2*table%top))
        error = self%error(:, lane)
        error = error + along*error(1) + across*error(2) + place%fold(lane)*self%defect(:, i/BLOCK, (j - 1)/BLOCK)
        if ((PI*error(1))**2 + error(2)**2 > TOLERABLE**2) then
          self%doubtful(lane) = .true.
          error = 0
        end if
        self%error(:, lane) = error
      end do
    end associate
  end subroutine advance

  !> As `follow`, for max_periods at most: with the table while its error is tolerable. integrated(i) = periods of start i that
  !> were integrated instead.
  subroutine follow_hybrid_map(map, flow, regions, attractors, max_periods, u, v, label, periods, integrated)
    !> the map of the table with its errors
    type(hybrid_map_t), intent(inout) :: map
    !> integrates where the errors are too large
    class(flow_t), intent(inout) :: flow
    !> the trapping regions
    type(regions_t), intent(in) :: regions
    !> the catalogue, numbered from 1
    type(attractor_t), intent(in) :: attractors(:)
    !> drive periods after which an orbit is given up
    integer(c_int64_t), intent(in) :: max_periods
    !> angles, half-turns in [-1, 1]; in and out
    real(dp), intent(inout) :: u(:)
    !> velocities, rad per drive radian; in and out
    real(dp), intent(inout) :: v(:)
    !> attractor from 1, 0 = not settled
    integer(c_int32_t), intent(out) :: label(:)
    !> first period inside a trapping region
    integer(c_int64_t), intent(out) :: periods(:)
    !> periods that were integrated
    integer(c_int64_t), intent(out) :: integrated(:)
    integer(c_int64_t), allocatable :: spent(:)
    integer, allocatable :: open(:)
    integer :: i

    label = 0
    periods = 0
    integrated = 0
    allocate (open, source=[(i, i=1, size(u))])
    do while (size(open) > 0)
      spent = max_periods - periods(open)
      call go_on(map)
      spent = pack(spent, label(open) == DOUBTFUL)
      open = pack(open, label(open) == DOUBTFUL)
      call go_on(flow)
      integrated(open) = integrated(open) + spent
      open = pack(open, label(open) == 0 .and. periods(open) < max_periods)
    end do
  contains
    !> The open starts for `spent` periods at most; a doubtful one stays where it was.
    subroutine go_on(with)
      class(map_t), intent(inout) :: with
      real(dp) :: x(size(open)), y(size(open))
      integer(c_int32_t) :: to(size(open))
      logical :: sure(size(open))

      x = u(open)
      y = v(open)
      call follow(with, regions, attractors, x, y, to, spent)
      sure = to /= DOUBTFUL
      label(open) = to
      u(open) = merge(x, u(open), sure)
      v(open) = merge(y, v(open), sure)
      periods(open) = periods(open) + merge(spent, 0_c_int64_t, sure)
    end subroutine go_on
  end subroutine follow_hybrid_map

end module kz_maps_hybrid_map
