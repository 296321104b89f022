!> The C interface of dynamics: carries a pendulum's state to one nearby, for moving pictures (dynamics_live.h).
module kz_live_carried
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr, c_loc
  use kz_api_dynamics, only: dynamics_t, of_handle, make_dynamics, borrow_flow, return_flow
  use kz_attractors_chaos, only: carry_chaos
  use kz_computed_grid, only: draw_attractors
  use kz_kernel_flows, only: make_flow, make_processed_flow, fine_numerics
  use kz_live_moving, only: aged_regions, learn_regions
  use kz_live_series_interpolation, only: interpolate_series
  use kz_live_smooth, only: smooth_times
  use kz_model_pendulum, only: pendulum_t
  use kz_processed_tables, only: series_t
  use kz_saddles_joined, only: join_near
  use kz_vector_map, only: flow_t, WIDTH
  use kz_vector_schemes, only: SCHEMES, PROCESSED
  use kz_vector_step_table, only: numerics_t
  implicit none
  private

contains

  function continued(handle, pendulum, numerics, error, lost) bind(C, name='kz_dynamics_continue') result(moved)
    type(c_ptr), value :: handle
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    real(dp), value :: error
    integer(c_int64_t), intent(out) :: lost !< attractors that are there no more, their images not counted
    type(c_ptr) :: moved
    type(dynamics_t), pointer :: from, d
    class(flow_t), allocatable :: sampling, flow
    integer, allocatable :: number(:)
    integer :: a, n_known

    from => of_handle(handle)
    call make_flow(pendulum, fine_numerics(pendulum), .false., sampling)
    call make_moved_flow(pendulum, numerics, error/2, sampling, flow)
    d => make_dynamics(pendulum, numerics, from%search%max_period, sampling, flow)
    allocate (number(size(from%attractors)), source=0)
    lost = 0
    do a = 1, size(from%attractors)
      if (from%attractors(a)%mirror < a .or. from%attractors(a)%period <= 0) cycle
      associate (old => from%attractors(a))
        call join_near(d%search, old%period, old%u(1), old%v(1), d%attractors, number(a))
      end associate
      if (number(a) == 0) lost = lost + 1
      if (number(a) > 0) number(from%attractors(a)%mirror) = d%attractors(number(a))%mirror
    end do
    d%regions = aged_regions(from%regions, number)
    call draw_attractors(d%regions, d%attractors)
    do a = 1, size(from%attractors)
      if (from%attractors(a)%mirror < a .or. from%attractors(a)%period > 0) cycle
      n_known = size(d%attractors)
      call carry_chaos(d%search, d%regions, from%attractors(a), d%attractors)
      if (size(d%attractors) == n_known) lost = lost + 1
    end do
    call draw_attractors(d%regions, d%attractors)
    moved = c_loc(d)
  end function continued

  !> The scene's map of a pendulum that a slider moves: its series is interpolated from those of the pendulums before.
  subroutine make_moved_flow(pendulum, numerics, error, sampling, flow)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    real(dp), intent(in) :: error !< largest error of the series, rad
    class(flow_t), intent(in) :: sampling !< map of fine_numerics
    class(flow_t), allocatable, intent(out) :: flow
    type(series_t), allocatable :: series

    if (SCHEMES(numerics%scheme + 1)%form /= PROCESSED) then
      call make_flow(pendulum, numerics, .true., flow, fallback=sampling)
    else
      allocate (series)
      call interpolate_series(pendulum, error, numerics%series, series)
      call make_processed_flow(pendulum, series, numerics, flow, made_fallback=sampling)
    end if
  end subroutine make_moved_flow

  subroutine learn(handle, n, state, most, budget) bind(C, name='kz_dynamics_learn_regions')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n)
    integer(c_int64_t), value :: most, budget
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call learn_regions(d%regions, d%attractors, d%search%flow, state, int(most), int(budget))
  end subroutine learn

  subroutine advance_states(handle, n, state) bind(C, name='kz_dynamics_advance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(inout) :: state(2, n)
    type(dynamics_t), pointer :: d
    integer :: first, lanes

    d => of_handle(handle)
    associate (flow => d%search%flow)
      do first = 0, int(n) - 1, WIDTH
        lanes = min(WIDTH, int(n) - first)
        call flow%put_all(state(1, first + 1:first + lanes), state(2, first + 1:first + lanes))
        call flow%advance_physical(lanes)
        state(1, first + 1:first + lanes) = flow%u(:lanes)
        state(2, first + 1:first + lanes) = flow%v(:lanes)
      end do
    end associate
  end subroutine advance_states

  subroutine smooth_settling(handle, n, label, state, time) bind(C, name='kz_dynamics_smooth_times')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    integer(c_int32_t), intent(in) :: label(n)
    real(dp), intent(in) :: state(2, n)
    real(dp), intent(inout) :: time(n)
    type(dynamics_t), pointer :: d
    class(flow_t), allocatable :: flow

    d => of_handle(handle)
    call borrow_flow(d, flow)
    call smooth_times(flow, d%attractors, label, state, time)
    call return_flow(d, flow)
  end subroutine smooth_settling

end module kz_live_carried
