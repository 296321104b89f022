!> The C interface of dynamics: starts followed until they are trapped (include/kapitza/dynamics_labels.h).
module kz_api_follow
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_maps_states, only: states_to_physical
  use kz_vector_map, only: flow_t
  use kz_api_dynamics, only: dynamics_t, of_handle, borrow_flow, return_flow
  use kz_cycles_cycles, only: attractor_t
  use kz_labels_label, only: starts_t
  use kz_labels_orbits, only: decision_t
  use kz_labels_turns, only: count_turns
  use kz_maps_map_table, only: table_map_t, make_table_map
  implicit none
  private

  !> Implements kz_stepper of dynamics_labels.h.
  integer(c_int32_t), parameter :: SPARSE = 1, SINGLE = 2, LINEAR = 3
  !> Periods between two looks at the regions of starts that take hundreds of them.
  integer, parameter :: PRIMES(6) = [5, 7, 11, 13, 17, 19]

contains

  subroutine follow_starts(handle, stepper, n, max_periods, state, label, periods, turns) &
      bind(C, name='kz_dynamics_follow')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: stepper
    integer(c_int64_t), value :: n, max_periods
    real(dp), intent(inout), target :: state(2, n)
    integer(c_int32_t), intent(out), target :: label(n)
    integer(c_int64_t), intent(out), target :: periods(n)
    integer(c_int64_t), intent(out), target, optional :: turns(n)
    type(dynamics_t), pointer :: d
    class(flow_t), allocatable, target :: flow
    type(table_map_t), target :: map
    type(starts_t) :: starts

    d => of_handle(handle)
    periods = max_periods
    call borrow_flow(d, flow)
    flow%single = stepper == SINGLE
    starts%map => flow
    if (stepper == SPARSE .or. stepper == SINGLE) starts%apart = apart(d%attractors)
    if (stepper > SINGLE) then
      map = make_table_map(d%table, merge(2, 6, stepper == LINEAR), flow)
      starts%map => map
    end if
    starts%regions => d%regions
    starts%attractors => d%attractors
    starts%state => state
    starts%label => label
    starts%periods => periods
    if (present(turns)) starts%turns => turns
    starts%items = n
    call starts%run()
    flow%single = .false.
    call leave_open(flow, state, label)
    call return_flow(d, flow)
  end subroutine follow_starts

  !> Periods from one look at the regions to the next: a prime that divides the period of no attractor, because a cycle
  !> may have a region at one of its strobe points alone. Covers are looked at in every period.
  pure function apart(attractors) result(periods)
    type(attractor_t), intent(in) :: attractors(:)
    integer :: periods, i

    periods = 1
    if (any(attractors%period <= 0)) return
    do i = 1, size(PRIMES)
      if (any(mod(attractors%period, PRIMES(i)) == 0)) cycle
      periods = PRIMES(i)
      return
    end do
  end function apart

  !> The states of the starts that have not settled, in physical coordinates again.
  subroutine leave_open(flow, state, label)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(inout) :: state(:, :)
    integer(c_int32_t), intent(in) :: label(:)
    real(dp), allocatable :: u(:), v(:)
    integer, allocatable :: open(:)
    integer :: i

    open = pack([(i, i=1, size(label))], label == 0)
    u = state(1, open)
    v = state(2, open)
    call states_to_physical(flow, u, v)
    state(1, open) = u
    state(2, open) = v
  end subroutine leave_open

  subroutine count_all_turns(handle, n, max_periods, decision) bind(C, name='kz_dynamics_count_turns')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n, max_periods
    type(decision_t), intent(inout) :: decision(n)
    type(dynamics_t), pointer :: d
    class(flow_t), allocatable :: flow, sampling_flow

    d => of_handle(handle)
    call borrow_flow(d, flow)
    allocate (sampling_flow, source=d%search%sampling_flow)
    call count_turns(flow, sampling_flow, d%attractors, max_periods, decision)
    call return_flow(d, flow)
  end subroutine count_all_turns

end module kz_api_follow
