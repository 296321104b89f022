!> The C interface of dynamics: the handle (include/kapitza/dynamics.h).
module kz_api_dynamics
  use, intrinsic :: iso_c_binding, only: c_int64_t, c_ptr, c_f_pointer, c_loc, c_null_ptr
  use kz_attractors_cycle_search, only: search_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_ellipses, only: rings_t
  use kz_computed_cell_images, only: images_t
  use kz_computed_grid, only: regions_t
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_vector_locks, only: create_lock, free_lock, take_lock, leave_lock
  use kz_labels_levels, only: levels_t
  use kz_labels_onset, only: onset_t
  use kz_vector_map, only: flow_t, WIDTH
  use kz_vector_step_table, only: numerics_t
  use kz_maps_map_table, only: table_t
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: dynamics_t, of_handle, make_dynamics, borrow_flow, return_flow

  !> Fraction 1/n of the fine steps that places cycles of a pendulum moved by a slider: to 1e-9 rad.
  integer, parameter :: MOVING_PART = 4
  type(rings_t), parameter :: MOVING_RINGS = rings_t(points=WIDTH/4, growth=4, halvings=4, between=4)

  !> Most idle copies of the scene's map that are kept.
  integer, parameter :: MOST_IDLE = 16

  type :: idle_t
    class(flow_t), allocatable :: flow
  end type idle_t

  !> The object that a handle points at.
  type :: dynamics_t
    type(c_ptr) :: lock = c_null_ptr !< held while something is made at first use, or an idle map is taken
    type(search_t) :: search
    class(flow_t), allocatable :: flow !< the scene's map
    type(idle_t) :: idle(MOST_IDLE)    !< copies of it, whose lanes hold what threads have left there
    integer :: n_idle = 0
    type(attractor_t), allocatable :: attractors(:)
    type(regions_t) :: regions
    type(table_t) :: table
    type(levels_t) :: levels           !< levels of labels with errors, made at first use
    class(onset_t), allocatable :: onset !< release of starts whose drive is not final at once
    type(images_t), allocatable :: images(:) !< images of the cells of growing regions
  end type dynamics_t

contains

  !> The dynamics behind a handle of C; null for a null handle.
  function of_handle(handle) result(d)
    type(c_ptr), intent(in) :: handle !< handle from kz_dynamics_create
    type(dynamics_t), pointer :: d

    call c_f_pointer(handle, d)
  end function of_handle

  !> Takes a map with lanes of its own for one thread: an idle one, or a copy, which costs as much as 10,000 steps.
  subroutine borrow_flow(d, flow)
    type(dynamics_t), intent(inout) :: d !< whose map it is
    class(flow_t), allocatable, intent(out) :: flow !< to be returned by return_flow

    call take_lock(d%lock)
    if (d%n_idle > 0) then
      call move_alloc(d%idle(d%n_idle)%flow, flow)
      d%n_idle = d%n_idle - 1
    end if
    call leave_lock(d%lock)
    if (.not. allocated(flow)) allocate (flow, source=d%flow)
  end subroutine borrow_flow

  subroutine return_flow(d, flow)
    type(dynamics_t), intent(inout) :: d
    class(flow_t), allocatable, intent(inout) :: flow !< map from borrow_flow

    call take_lock(d%lock)
    if (d%n_idle < MOST_IDLE) then
      d%n_idle = d%n_idle + 1
      call move_alloc(flow, d%idle(d%n_idle)%flow)
    end if
    call leave_lock(d%lock)
  end subroutine return_flow

  function create(pendulum, numerics, max_period) bind(C, name='kz_dynamics_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    integer(c_int64_t), value :: max_period
    type(c_ptr) :: handle

    handle = c_loc(make_dynamics(pendulum, numerics, int(max_period)))
  end function create

  !> Makes the maps of a pendulum, without attractors and regions.
  function make_dynamics(pendulum, numerics, max_period, sampling, moved) result(d)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(numerics_t), intent(in) :: numerics !< numerics of the map that labels
    integer, intent(in) :: max_period !< longest period of cycles that a search looks for
    !> Maps that are taken over: of fine_numerics, and of the numerics where a slider moves the pendulum; else made.
    class(flow_t), allocatable, intent(inout), optional :: sampling, moved
    type(dynamics_t), pointer :: d
    type(numerics_t) :: fine

    allocate (d)
    d%lock = create_lock()
    d%levels%pendulum = pendulum
    d%levels%numerics = numerics
    fine = fine_numerics(pendulum)
    if (present(moved)) then
      call move_alloc(sampling, d%search%sampling_flow)
      call move_alloc(moved, d%flow)
      d%search%rings = MOVING_RINGS
      fine%steps_per_period = fine%steps_per_period/MOVING_PART
    else
      call make_flow(pendulum, fine, .false., d%search%sampling_flow)
      call make_flow(pendulum, numerics, .true., d%flow, fallback=d%search%sampling_flow)
    end if
    d%search%pendulum = pendulum
    d%search%max_period = max_period
    allocate (d%search%flow, source=d%flow)
    call make_flow(pendulum, fine, .true., d%search%fine)
    allocate (d%attractors(0))
  end function make_dynamics

  subroutine destroy(handle) bind(C, name='kz_dynamics_free')
    type(c_ptr), value :: handle
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (.not. associated(d)) return
    call free_lock(d%lock)
    deallocate (d)
  end subroutine destroy

end module kz_api_dynamics
