!> The C interface of dynamics: trapping regions (include/kapitza/dynamics.h).
module kz_api_regions
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_computed_cell_images, only: PERIODS, make_images
  use kz_computed_grid, only: make_regions, draw_attractors
  use kz_computed_growth, only: grow_regions
  use kz_model_pendulum, only: is_mirrored
  implicit none
  private

  !> Cells of the coarse grid along an axis.
  integer, parameter :: COARSE_CELLS = 256

contains

  subroutine make_grid(handle, cells, top) bind(C, name='kz_dynamics_regions')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: cells
    real(dp), value :: top
    type(dynamics_t), pointer :: d
    integer :: n

    d => of_handle(handle)
    if (allocated(d%images)) deallocate (d%images)
    n = merge(int(cells), COARSE_CELLS, cells > 0)
    d%regions = make_regions(2*((n + 1)/2), n, top, is_mirrored(d%search%pendulum) /= 0)
    if (cells == 0) return
    allocate (d%images(size(PERIODS)))
    call make_images(d%regions, d%search%flow, d%images)
    call update_regions(handle)
  end subroutine make_grid

  subroutine update_regions(handle) bind(C, name='kz_dynamics_update')
    type(c_ptr), value :: handle
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (d%regions%n_drawn == size(d%attractors)) return
    call draw_attractors(d%regions, d%attractors)
    if (allocated(d%images)) call grow_regions(d%regions, d%attractors, d%images)
  end subroutine update_regions

  function trapped_share(handle) bind(C, name='kz_dynamics_trapped_share') result(share)
    type(c_ptr), value :: handle
    real(dp) :: share
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    share = count(d%regions%label > 0)/real(size(d%regions%label), dp)
  end function trapped_share

end module kz_api_regions
