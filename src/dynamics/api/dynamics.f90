!> The C interface of dynamics: the handle (include/kapitza/dynamics.h).
module kz_api_dynamics
  use, intrinsic :: iso_c_binding, only: c_int64_t, c_ptr, c_loc
  use kz_kernel_flows, only: make_flow, make_moving_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t
  use kz_lanes_step_table, only: numerics_t
  use kz_api_handle, only: dynamics_t, of_handle
  implicit none
  private
  public :: make_dynamics

  !> Of the fine steps, what places the cycles of a pendulum that a slider moves: to 1e-9 rad.
  integer, parameter :: MOVING_PART = 4

contains

  function create(pendulum, numerics, max_period) bind(C, name='kz_dynamics_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    integer(c_int64_t), value :: max_period
    type(c_ptr) :: handle

    handle = c_loc(make_dynamics(pendulum, numerics, int(max_period), .false.))
  end function create

  !> Makes the maps of a pendulum, without attractors and regions.
  function make_dynamics(pendulum, numerics, max_period, moving) result(d)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(numerics_t), intent(in) :: numerics !< of the map that labels
    integer, intent(in) :: max_period !< of the cycles that a search looks for
    logical, intent(in) :: moving !< whether a slider moves the pendulum
    type(dynamics_t), pointer :: d
    type(numerics_t) :: fine

    allocate (d)
    d%numerics = numerics
    if (moving) then
      call make_moving_flow(pendulum, numerics, d%flow)
    else
      call make_flow(pendulum, numerics, .true., d%flow)
    end if
    d%search%pendulum = pendulum
    d%search%max_period = max_period
    allocate (d%search%flow, source=d%flow)
    fine = fine_numerics(pendulum)
    call make_flow(pendulum, fine, .false., d%search%sampling_flow)
    if (moving) fine%steps_per_period = fine%steps_per_period/MOVING_PART
    call make_flow(pendulum, fine, .true., d%search%fine)
    allocate (d%attractors(0))
  end function make_dynamics

  subroutine destroy(handle) bind(C, name='kz_dynamics_free')
    type(c_ptr), value :: handle
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (associated(d)) deallocate (d)
  end subroutine destroy

end module kz_api_dynamics
