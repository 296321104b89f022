!> The C interface of dynamics: all cycles of the stroboscopic map (include/kapitza/dynamics.h).
module kz_api_saddles
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_kernel_map, only: flow_t, PI
  use kz_kernel_plan, only: make_flow, fine_numerics
  use kz_kernel_step_table, only: pendulum_t, numerics_t
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_attractors_cycle_search, only: known, append_with_mirror
  use kz_cycles_cycles, only: attractor_t, close_cycle, enter_points, symmetrise
  use kz_cycles_features, only: find_features
  use kz_saddles_scan, only: scan_strip, search_from
  implicit none
  private

  !> Steps with which cycles are found, as a part of those with which they are published: four times fewer leave 1e-11.
  integer, parameter :: FEWER = 4

contains

  function scan_cycles(pendulum, max_period, n_theta, theta, n_velocity, velocity, most, cycle) &
    bind(C, name='kz_dynamics_scan_cycles') result(n)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: max_period
    integer(c_int64_t), value :: n_theta
    !> of the nodes, rad
    real(dp), intent(in) :: theta(n_theta)
    integer(c_int64_t), value :: n_velocity
    !> of the rows of nodes, rad per drive radian
    real(dp), intent(in) :: velocity(n_velocity)
    !> cycles that fit
    integer(c_int64_t), value :: most
    !> period, half-turns, velocity
    real(dp), intent(out) :: cycle(3, most)
    integer(c_int64_t) :: n
    class(flow_t), allocatable :: flow
    real(dp), allocatable :: found(:, :)

    call make_flow(pendulum, scan_numerics(pendulum), .true., flow)
    call scan_strip(flow, theta/PI, velocity, int(max_period), found)
    n = size(found, 2)
    cycle(:, :min(n, most)) = found(:, :min(n, most))
  end function scan_cycles

  function stabilised_cycles(pendulum, period, n_seeds, seed, most, cycle) bind(C, name='kz_dynamics_stabilised_cycles') result(n)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: period
    integer(c_int64_t), value :: n_seeds
    !> half-turns, rad per drive radian
    real(dp), intent(in) :: seed(2, n_seeds)
    !> cycles that fit
    integer(c_int64_t), value :: most
    !> period, half-turns, velocity
    real(dp), intent(out) :: cycle(3, most)
    integer(c_int64_t) :: n
    class(flow_t), allocatable :: flow
    real(dp), allocatable :: found(:, :)

    call make_flow(pendulum, scan_numerics(pendulum), .true., flow)
    call search_from(flow, int(period), seed, found)
    n = size(found, 2)
    cycle(:, :min(n, most)) = found(:, :min(n, most))
  end function stabilised_cycles

  !> What cycles are found with.
  pure function scan_numerics(pendulum) result(numerics)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t) :: numerics

    numerics = fine_numerics(pendulum)
    numerics%steps_per_period = numerics%steps_per_period/FEWER
  end function scan_numerics

  function add_cycle(handle, given) bind(C, name='kz_dynamics_add_cycle') result(n)
    type(c_ptr), value :: handle
    !> period, half-turns, velocity, as kz_dynamics_scan_cycles gives them
    real(dp), intent(in) :: given(3)
    integer(c_int64_t) :: n
    real(dp), parameter :: MOVED = 1e-3_dp !< rad: farther than Newton's method moves what a scan has found
    type(dynamics_t), pointer :: d
    type(attractor_t) :: cycle
    logical :: found, blurred

    d => of_handle(handle)
    n = size(d%attractors)
    if (known(d%attractors, nint(given(1)), given(2:2), given(3:3))) return
    call close_cycle(d%search%fine, d%search%pendulum%beta, nint(given(1)), given(2), given(3), MOVED, cycle, found, blurred)
    if (.not. found) return
    if (known(d%attractors, cycle%period, cycle%u, cycle%v)) return
    call symmetrise(cycle)
    call enter_points(d%search%flow, cycle)
    cycle%lyapunov = log(abs(cycle%multiplier(1)))/cycle%period
    call find_features(d%search%sampling_flow, d%search%pendulum, cycle, cycle%u(1), cycle%v(1), cycle%period)
    call append_with_mirror(cycle, d%attractors)
    n = size(d%attractors)
  end function add_cycle

end module kz_api_saddles
