!> How long an orbit of the map table can be trusted: until the table's interpolation error, stretched period by period, has grown
!> to the size of a cell.
module kz_dynamics_trust
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: flow_t, WIDTH, PI
  use kz_dynamics_cycles, only: attractor_t, apart
  use kz_dynamics_regions, only: regions_t, captors
  use kz_dynamics_tables, only: table_map_t
  implicit none
  private
  public :: trust_horizon

  !> Tiles of sampled states.
  integer, parameter :: TILES = 16

contains

  !> Periods after which a label is no longer backed: ln(cell/defect)/ln(stretch), at least 1. The defect is the largest error of one
  !> period among states outside all trapping regions, the stretch the geometric mean of the tangent map's norm there.
  function trust_horizon(flow, map, regions, attractors, state) result(periods)
    class(flow_t), intent(inout) :: flow
    type(table_map_t), intent(inout) :: map
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    !> states spread over the table, (2, TILES*WIDTH)
    real(dp), intent(in) :: state(2, TILES*WIDTH)
    real(dp) :: periods
    real(dp) :: tangent(2, 2, WIDTH), defect, stretch, cell
    integer :: owner(WIDTH), tile, lane, n

    defect = 0
    stretch = 0
    n = 0
    do tile = 1, TILES
      associate (s => state(:, (tile - 1)*WIDTH + 1:tile*WIDTH))
        call captors(regions, attractors, WIDTH, s(1, :), s(2, :), owner)
        tangent = 0
        do lane = 1, WIDTH
          call flow%put(lane, s(1, lane), s(2, lane))
          call map%put(lane, s(1, lane), s(2, lane))
          tangent(1, 1, lane) = 1
          tangent(2, 2, lane) = 1
        end do
      end associate
      call flow%advance_tangent(WIDTH, tangent)
      call map%advance(WIDTH)
      do lane = 1, WIDTH
        if (owner(lane) > 0) cycle
        n = n + 1
        defect = max(defect, hypot(PI*apart(map%u(lane), flow%u(lane)), map%v(lane) - flow%v(lane)))
        stretch = stretch + log(norm2(tangent(:, :, lane)))
      end do
    end do
    cell = 2*map%table%top/map%table%n_velocity
    periods = huge(1.0_dp)
    if (n > 0) periods = max(1.0_dp, log(cell/max(defect, epsilon(1.0_dp)))/max(stretch/n, epsilon(1.0_dp)))
  end function trust_horizon

end module kz_dynamics_trust
