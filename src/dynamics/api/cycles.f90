!> The C interface of dynamics: the cycle near a state (include/kapitza/dynamics_cycles.h).
module kz_api_cycles
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_vector_map, only: flow_t, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  use kz_api_attractors, only: row_of
  use kz_cycles_described, only: attractor_row_t
  use kz_cycles_cycles, only: attractor_t, close_cycle
  use kz_cycles_features, only: find_features
  use kz_maps_states, only: states_to_map, states_to_physical
  implicit none
  private

contains

  subroutine close_near(pendulum, numerics, n, max_distance, theta, velocity, row) &
      bind(C, name='kz_dynamics_close_cycle')
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(numerics_t), intent(in) :: numerics !< numerics of the strobe map
    integer(c_int64_t), value :: n !< a period that closes the cycle
    real(dp), value :: max_distance !< farthest that the cycle may lie from the start
    real(dp), intent(inout) :: theta(n), velocity(n) !< in: start at 1; out: the cycle; rad, rad per drive radian
    type(attractor_row_t), intent(out) :: row !< the cycle; period 0: there is none
    class(flow_t), allocatable :: flow, sampled
    type(attractor_t) :: cycle
    real(dp) :: u(1), v(1)
    logical :: blurred

    call make_flow(pendulum, numerics, .true., flow)
    u = theta(1)/PI
    v = velocity(1)
    call states_to_map(flow, u, v)
    if (close_cycle(flow, pendulum%beta, int(n), [u, v], max_distance, cycle, blurred)) then
      call states_to_physical(flow, cycle%u, cycle%v)
      call make_flow(pendulum, fine_numerics(pendulum), .false., sampled)
      call find_features(sampled, pendulum, cycle, cycle%u(:1), cycle%v(:1), cycle%period)
      theta(:cycle%period) = PI*cycle%u
      velocity(:cycle%period) = cycle%v
    end if
    row = row_of(cycle)
  end subroutine close_near

end module kz_api_cycles
