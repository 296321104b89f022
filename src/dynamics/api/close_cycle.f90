!> One cycle near one state, for C: include/kapitza/dynamics.h.
module kz_api_close_cycle
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_lanes_map, only: flow_t, PI
  use kz_kernel_flows, only: make_flow
  use kz_model_pendulum, only: pendulum_t
  use kz_lanes_step_table, only: numerics_t
  use kz_cycles_cycles, only: attractor_t, close_cycle
  use kz_maps_states, only: states_to_map, states_to_physical
  implicit none
  private

contains

  function close_near(pendulum, numerics, n, max_distance, theta, velocity, re, im) &
    bind(C, name='kz_dynamics_close_cycle') result(period)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(numerics_t), intent(in) :: numerics !< of the strobe map
    integer(c_int64_t), value :: n !< a period that closes the cycle
    real(dp), value :: max_distance !< farthest that the cycle may lie from the start
    real(dp), intent(inout) :: theta !< start, then the cycle's point; rad
    real(dp), intent(inout) :: velocity !< the same, rad per drive radian
    real(dp), intent(out) :: re(2) !< real parts of the multipliers
    real(dp), intent(out) :: im(2) !< imaginary parts
    integer(c_int64_t) :: period
    class(flow_t), allocatable :: flow
    type(attractor_t) :: cycle
    real(dp) :: u(1), v(1)
    logical :: found, blurred

    call make_flow(pendulum, numerics, .true., flow)
    u = theta/PI
    v = velocity
    call states_to_map(flow, u, v)
    call close_cycle(flow, pendulum%beta, int(n), u(1), v(1), max_distance, cycle, found, blurred)
    period = 0
    if (.not. found) return
    period = cycle%period
    call states_to_physical(flow, cycle%u, cycle%v)
    theta = PI*cycle%u(1)
    velocity = cycle%v(1)
    re = real(cycle%multiplier, dp)
    im = aimag(cycle%multiplier)
  end function close_near

end module kz_api_close_cycle
