!> What a handle of include/kapitza/dynamics.h points at.
module kz_api_handle
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_ptr, c_f_pointer
  use kz_lanes_map, only: flow_t
  use kz_lanes_step_table, only: numerics_t
  use kz_cycles_cycles, only: attractor_t
  use kz_grown_cell_images, only: images_t
  use kz_grown_grid, only: regions_t
  use kz_attractors_cycle_search, only: search_t
  use kz_labels_levels, only: levels_t
  use kz_labels_released, only: released_t
  use kz_model_release, only: release_t
  use kz_maps_map_table, only: table_t
  implicit none
  private
  public :: dynamics_t, of_handle

  type :: dynamics_t
    type(search_t) :: search
    type(numerics_t) :: numerics       !< of the scene
    class(flow_t), allocatable :: flow !< the scene's map
    type(attractor_t), allocatable :: attractors(:)
    type(regions_t) :: regions
    type(table_t) :: table
    type(levels_t) :: levels           !< what labels with errors need, once it is needed
    type(release_t), allocatable :: release   !< of starts whose drive has not its final form at once
    type(released_t), allocatable :: released !< what carries them, once it is needed
    type(images_t), allocatable :: images(:) !< of the cells of regions that grow
  end type dynamics_t

contains

  !> The dynamics behind a handle of C; null for a null handle.
  function of_handle(handle) result(d)
    type(c_ptr), intent(in) :: handle !< what kz_dynamics_create returned
    type(dynamics_t), pointer :: d

    call c_f_pointer(handle, d)
  end function of_handle

end module kz_api_handle
