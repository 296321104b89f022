!> The C interface of dynamics: starts followed until they are trapped (include/kapitza/dynamics.h).
module kz_api_follow
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_associated, c_f_pointer, c_int32_t, c_int64_t, c_ptr
  use kz_maps_states, only: leave_states, half_turns
  use kz_lanes_map, only: map_t
  use kz_extended_pairs, only: pairs_t, make_pairs
  use kz_kernel_plan, only: make_flow
  use kz_lanes_step_table, only: numerics_t
  use kz_labels_covariant_map, only: covariant_map_t, make_covariant_map
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_labels_label, only: follow
  use kz_maps_map_table, only: table_map_t, make_table_map
  use kz_labels_precise_map, only: precise_map_t, make_precise_map
  use kz_labels_reference_map, only: reference_map_t, make_reference_map
  implicit none
  private

  !> Ways of dynamics.h; those that remain are the nodes of the table's stencil.
  integer(c_int32_t), parameter :: DIRECT = 0
  !> Levels of dynamics.h.
  integer(c_int32_t), parameter :: LEVEL_PAIRS_20 = 2, LEVEL_QUAD = 4
  !> Of a start and a period in quad precision, relative: ten times what the series misses (kernel.h).
  real(dp), parameter :: QUAD_ERROR = 1e-31_dp
  !> rad: of a period in pairs of doubles. Smaller ones cost as much as the cells that they would decide cost in quad precision.
  real(dp), parameter :: PAIRS_ERROR = 1e-28_dp
  !> Steps a period of the series.
  integer, parameter :: QUAD_STEPS = 18

  !> kz_start and kz_decision of dynamics.h.
  type, bind(C) :: start_t
    real(dp) :: theta(2)
    real(dp) :: velocity(2)
    integer(c_int64_t) :: periods
    real(dp) :: error(3)
  end type start_t
  type, bind(C) :: decision_t
    integer(c_int32_t) :: label
    integer(c_int32_t) :: other
    integer(c_int32_t) :: level
    integer(c_int64_t) :: periods
    real(dp) :: error
  end type decision_t

contains

  subroutine follow_starts(handle, way, n, max_periods, state, label, periods) bind(C, name='kz_dynamics_follow')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: way
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(inout) :: state(2, n)
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    class(map_t), allocatable :: map

    d => of_handle(handle)
    periods = max_periods
    select case (way)
    case (DIRECT)
      call follow(d%flow, d%regions, d%attractors, state, label, periods)
    case default
      allocate (map, source=make_table_map(d%table, int(way), d%search%flow))
      call follow(map, d%regions, d%attractors, state, label, periods)
    end select
    call leave_open(d, state, label)
  end subroutine follow_starts

  !> The states of the starts that have not settled, in physical coordinates again.
  subroutine leave_open(d, state, label)
    type(dynamics_t), intent(inout) :: d
    real(dp), intent(inout) :: state(:, :)
    integer(c_int32_t), intent(in) :: label(:)
    real(dp), allocatable :: u(:), v(:)

    if (all(label /= 0)) return
    u = pack(state(1, :), label == 0)
    v = pack(state(2, :), label == 0)
    call leave_states(d%search%flow, u, v)
    state(1, :) = unpack(u, label == 0, state(1, :))
    state(2, :) = unpack(v, label == 0, state(2, :))
  end subroutine leave_open

  subroutine follow_reference(handle, n_steps, n, max_periods, start, low, label, periods) &
    bind(C, name='kz_dynamics_follow_reference')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: max_periods
    real(dp), intent(in) :: start(2, n)
    type(c_ptr), value :: low
    integer(c_int32_t), intent(out) :: label(n)
    integer(c_int64_t), intent(out) :: periods(n)
    type(dynamics_t), pointer :: d
    type(reference_map_t), allocatable :: map
    real(dp), allocatable :: state(:, :)

    d => of_handle(handle)
    allocate (map, state(2, n))
    call make_reference_map(map, d%search%pendulum, int(n_steps), d%search%flow, start, state(1, :), low=matrix_of(low, n))
    state(2, :) = start(2, :)
    periods = max_periods
    call follow(map, d%regions, d%attractors, state, label, periods)
  end subroutine follow_reference

  subroutine label_starts(handle, level, n, start, max_periods, decision) bind(C, name='kz_dynamics_label')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: level
    integer(c_int64_t), value :: n
    type(start_t), intent(in) :: start(n)
    integer(c_int64_t), value :: max_periods
    type(decision_t), intent(out) :: decision(n)
    type(dynamics_t), pointer :: d
    class(map_t), allocatable :: map
    real(dp), allocatable :: state(:, :), whole(:, :), low(:, :), reach(:)
    integer(c_int32_t), allocatable :: label(:)
    integer(c_int64_t), allocatable :: periods(:)
    integer(c_int64_t) :: i

    d => of_handle(handle)
    allocate (state(2, n), whole(2, n), low(2, n), reach(n), label(n), periods(n))
    do i = 1, n
      whole(:, i) = [start(i)%theta(1), start(i)%velocity(1)]
      low(:, i) = [start(i)%theta(2), start(i)%velocity(2)]
      periods(i) = max_periods - start(i)%periods
    end do
    state = whole
    if (level < LEVEL_PAIRS_20) then
      state(1, :) = half_turns(whole(1, :))
      call make_covariant(d, map)
    else
      call make_precise(d, level, whole, state(1, :), map, low)
    end if
    call follow(map, d%regions, d%attractors, state, label, periods, reach)
    decision%label = label
    decision%other = 0
    decision%level = level
    decision%periods = periods + start%periods
    decision%error = reach
  end subroutine label_starts

  !> An array (2, n) of C. NULL is a disassociated pointer, which is absent as an optional argument.
  function matrix_of(array, n) result(matrix)
    type(c_ptr), intent(in) :: array
    integer(c_int64_t), intent(in) :: n
    real(dp), pointer :: matrix(:, :)

    matrix => null()
    if (c_associated(array)) call c_f_pointer(array, matrix, [2_c_int64_t, n])
  end function matrix_of

  subroutine make_covariant(d, map)
    type(dynamics_t), intent(inout) :: d
    class(map_t), allocatable, intent(out) :: map
    type(numerics_t) :: halved
    type(covariant_map_t), allocatable :: covariant

    if (.not. allocated(d%finer)) then
      halved = numerics_t(d%numerics%scheme, 2*d%numerics%steps_per_period, fastest=d%numerics%fastest)
      call make_flow(d%search%pendulum, halved, .true., d%finer)
    end if
    allocate (covariant)
    call make_covariant_map(d%flow, d%finer, d%regions, d%attractors, covariant)
    call move_alloc(covariant, map)
  end subroutine make_covariant

  subroutine make_precise(d, level, start, u, map, low)
    type(dynamics_t), intent(inout), target :: d
    integer(c_int32_t), intent(in) :: level
    real(dp), intent(in) :: start(:, :)
    real(dp), intent(out) :: u(:)
    class(map_t), allocatable, intent(out) :: map
    real(dp), intent(in), optional :: low(:, :)
    type(reference_map_t), allocatable :: quad
    type(precise_map_t), allocatable :: precise
    type(pairs_t), pointer :: pairs
    real(dp) :: error

    pairs => null()
    error = QUAD_ERROR
    if (level < LEVEL_QUAD) then
      pairs => d%pairs
      if (.not. allocated(pairs%level)) call make_pairs(d%search%pendulum, PAIRS_ERROR, d%regions%top, pairs)
      error = max(error, pairs%error)
    end if
    allocate (quad, precise)
    call make_reference_map(quad, d%search%pendulum, QUAD_STEPS, d%search%flow, start, u, pairs, low)
    call make_precise_map(quad, error, d%search%flow, d%regions, d%attractors, precise)
    call move_alloc(precise, map)
  end subroutine make_precise

end module kz_api_follow
