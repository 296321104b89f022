!> The C interface of dynamics: starts followed until they are trapped (include/kapitza/dynamics.h).
module kz_api_follow
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_kernel_map, only: map_t
  use kz_kernel_plan, only: make_flow, DOUBLE
  use kz_kernel_step_table, only: numerics_t
  use kz_maps_covariance, only: covariant_map_t, make_covariant_map
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_dynamics_label, only: follow
  use kz_maps_map_table, only: table_map_t, make_table_map
  use kz_maps_hybrid_map, only: hybrid_map_t, measure_defects, make_hybrid_map, follow_hybrid_map
  use kz_maps_reference_map, only: reference_map_t, make_reference_map
  implicit none
  private

contains

  subroutine settle(handle, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_settle')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call follow_with(d%search%flow, d, max_periods, state, label, periods)
  end subroutine settle

  subroutine follow_directly(handle, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_follow')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call follow_with(d%flow, d, max_periods, state, label, periods)
  end subroutine follow_directly

  subroutine follow_table(handle, points, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_follow_table')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: points
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    type(table_map_t) :: map

    d => of_handle(handle)
    map = make_table_map(d%table, int(points), d%search%flow)
    call follow_with(map, d, max_periods, state, label, periods)
  end subroutine follow_table

  subroutine measure_table(handle, points) bind(C, name='kz_dynamics_measure_table')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: points
    type(dynamics_t), pointer :: d
    type(table_map_t) :: map

    d => of_handle(handle)
    if (allocated(d%defect)) return
    map = make_table_map(d%table, int(points), d%search%flow)
    call measure_defects(map, d%defect)
  end subroutine measure_table

  subroutine follow_hybrid(handle, points, n, max_periods, state, label, periods, integrated) &
    bind(C, name='kz_dynamics_follow_hybrid')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: points
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    integer(c_int64_t), intent(out) :: integrated(n)
    type(dynamics_t), pointer :: d
    type(hybrid_map_t) :: map

    d => of_handle(handle)
    call measure_table(handle, points)
    call make_hybrid_map(d%table, int(points), d%search%flow, d%defect, map)
    call follow_hybrid_map(map, d%flow, d%regions, d%attractors, max_periods, state(1, :), state(2, :), label, &
                        periods, integrated)
  end subroutine follow_hybrid

  subroutine follow_covariance(handle, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_follow_covariance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    type(numerics_t) :: halved
    type(covariant_map_t), allocatable :: map

    d => of_handle(handle)
    halved = numerics_t(d%numerics%scheme, 2*d%numerics%steps_per_period, DOUBLE)
    if (.not. allocated(d%finer)) call make_flow(d%search%pendulum, halved, .true., d%finer)
    allocate (map)
    call make_covariant_map(d%flow, d%finer, d%regions, d%attractors, map)
    call follow_with(map, d, max_periods, state, label, periods)
  end subroutine follow_covariance

  subroutine follow_reference(handle, n_steps, n, max_periods, start, label, periods) bind(C, name='kz_dynamics_follow_reference')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(in) :: start(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    type(reference_map_t), allocatable :: map
    real(dp), allocatable :: u(:), v(:)

    d => of_handle(handle)
    allocate (map, u(n))
    allocate (v, source=start(2, :))
    call make_reference_map(map, d%search%pendulum, int(n_steps), start, u)
    periods = max_periods
    call follow(map, d%regions, d%attractors, u, v, label, periods)
  end subroutine follow_reference

  subroutine follow_with(map, d, max_periods, state, label, periods)
    class(map_t), intent(inout) :: map
    type(dynamics_t), intent(in) :: d
    integer(c_int64_t), intent(in) :: max_periods
    real(dp), intent(inout) :: state(:, :)
    integer(c_int32_t), intent(out) :: label(:)
    integer(c_int64_t), intent(out) :: periods(:)

    periods = max_periods
    call follow(map, d%regions, d%attractors, state(1, :), state(2, :), label, periods)
  end subroutine follow_with

end module kz_api_follow
