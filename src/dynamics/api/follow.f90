!> The C interface of dynamics: starts followed until they are trapped (include/kapitza/dynamics.h).
module kz_api_follow
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_maps_states, only: states_to_physical
  use kz_vector_map, only: map_t, flow_t, WIDTH
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_labels_label, only: follow
  use kz_labels_smooth, only: smooth_times
  use kz_maps_map_table, only: table_map_t, make_table_map
  use kz_labels_reference_map, only: reference_map_t, make_reference_map
  implicit none
  private

  !> Ways of dynamics.h; those that remain are the nodes of the table's stencil.
  integer(c_int32_t), parameter :: DIRECT = 0

contains

  subroutine follow_starts(handle, stepping, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_follow')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: stepping
    integer(c_int64_t), value :: n, max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    class(map_t), allocatable :: map !< own lanes: other threads may follow starts too

    d => of_handle(handle)
    periods = max_periods
    select case (stepping)
    case (DIRECT)
      allocate (map, source=d%flow)
    case default
      allocate (map, source=make_table_map(d%table, int(stepping), d%search%flow))
    end select
    call follow(map, d%regions, d%attractors, state, label, periods)
    call leave_open(d, state, label)
  end subroutine follow_starts

  !> The states of the starts that have not settled, in physical coordinates again.
  subroutine leave_open(d, state, label)
    type(dynamics_t), intent(in) :: d
    real(dp), intent(inout) :: state(:, :)
    integer(c_int32_t), intent(in) :: label(:)
    class(flow_t), allocatable :: flow
    real(dp), allocatable :: u(:), v(:)

    if (all(label /= 0)) return
    u = pack(state(1, :), label == 0)
    v = pack(state(2, :), label == 0)
    allocate (flow, source=d%search%flow)
    call states_to_physical(flow, u, v)
    state(1, :) = unpack(u, label == 0, state(1, :))
    state(2, :) = unpack(v, label == 0, state(2, :))
  end subroutine leave_open

  subroutine advance_states(handle, n, state) bind(C, name='kz_dynamics_advance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(inout) :: state(2, n)
    type(dynamics_t), pointer :: d
    integer :: first, lanes, i

    d => of_handle(handle)
    associate (flow => d%search%flow)
      do first = 0, int(n) - 1, WIDTH
        lanes = min(WIDTH, int(n) - first)
        do i = 1, lanes
          call flow%put(i, state(1, first + i), state(2, first + i))
        end do
        call flow%to_map(lanes)
        call flow%advance(lanes)
        call flow%to_physical(lanes)
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
    allocate (flow, source=d%flow)
    call smooth_times(flow, d%attractors, label, state, time)
  end subroutine smooth_settling

  subroutine follow_reference(handle, n_steps, n, max_periods, start, low, label, periods) &
    bind(C, name='kz_dynamics_follow_reference')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n, max_periods
    real(dp), intent(in) :: start(2, n)
    real(dp), intent(in), optional :: low(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    type(reference_map_t), allocatable :: map
    real(dp), allocatable :: state(:, :)

    d => of_handle(handle)
    allocate (map, state(2, n))
    if (present(low)) then
      call make_reference_map(map, d%search%pendulum, int(n_steps), d%search%flow, start, state(1, :), low)
    else ! gfortran would read the address that is not there
      call make_reference_map(map, d%search%pendulum, int(n_steps), d%search%flow, start, state(1, :))
    end if
    state(2, :) = start(2, :)
    periods = max_periods
    call follow(map, d%regions, d%attractors, state, label, periods)
  end subroutine follow_reference

end module kz_api_follow
