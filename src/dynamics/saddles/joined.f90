!> The C interface of dynamics: cycles from elsewhere join a catalogue (include/kapitza/dynamics_saddles.h).
module kz_saddles_joined
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_attractors_cycle_search, only: search_t, add_with_image, append_with_image, join, known
  use kz_cycles_cycles, only: attractor_t, close_cycle, complete_attractor, enter_points, symmetrise
  use kz_cycles_features, only: find_features
  use kz_maps_matrices, only: eigenvalues
  use kz_maps_states, only: separation
  use kz_model_pendulum, only: pairing_symmetry, HALF_PERIOD
  use kz_saddles_shooting, only: shoot, smallest_period, closed_orbit_t
  use kz_vector_map, only: PI
  implicit none
  private
  public :: join_near

  !> rad: cycles are closed until steps are shorter, or rounding stops them; placed no better than that, they are none;
  !> nearer than that, they are one.
  real(dp), parameter :: CLOSE = 1e-13_dp, PLACED = 1e-8_dp, ONE = 1e-7_dp
  integer, parameter :: BATCH_SIZE = 64
  !> rad: a cycle that lies farther from the point is another one.
  real(dp), parameter :: FARTHEST = 0.2_dp

contains

  subroutine add_cycles(handle, max_period, n, found) bind(C, name='kz_dynamics_add_cycles')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: max_period, n
    real(dp), intent(in) :: found(2 + 2*max_period, n) !< as kz_dynamics_search_line gives them
    type(dynamics_t), pointer :: d
    type(attractor_t) :: new
    type(attractor_t), allocatable :: batch(:)
    logical :: is_placed
    integer :: i, period

    d => of_handle(handle)
    allocate (batch(0))
    do i = 1, int(n)
      period = nint(found(1, i))
      call place_cycle(d, reshape(found(3:2 + 2*period, i), [2, period]), new, is_placed)
      if (.not. is_placed) cycle
      if (is_known(d%attractors, new) .or. is_known(batch, new)) cycle
      new%symmetry = pairing_symmetry(d%search%pendulum)
      call symmetrise(d%search%sampling_flow, new)
      call enter_points(d%search%flow, new)
      call find_features(d%search%sampling_flow, d%search%pendulum, new, new%u(:1), new%v(:1), period)
      call append_with_image(d%search, new, batch)
      if (size(batch) >= BATCH_SIZE) call join_batch(d%attractors, batch)
    end do
    call join_batch(d%attractors, batch)
  end subroutine add_cycles

  !> The cycle of the map of published values near an orbit; `is_placed` where rounding leaves its place open by little.
  subroutine place_cycle(d, orbit, cycle, is_placed)
    type(dynamics_t), intent(inout) :: d
    real(dp), intent(in) :: orbit(:, :) !< half-turns, rad per drive radian
    type(attractor_t), intent(out) :: cycle !< its points, multipliers, winding
    logical, intent(out) :: is_placed
    real(dp) :: x(2, size(orbit, 2))
    type(closed_orbit_t) :: closed

    x = orbit
    call shoot(d%search%fine, CLOSE, x, closed)
    is_placed = max(closed%step, closed%blur) < PLACED
    if (is_placed) is_placed = smallest_period(x, ONE) == size(x, 2)
    if (.not. is_placed) return
    cycle%period = size(x, 2)
    cycle%winding = closed%winding
    cycle%u = x(1, :)
    cycle%v = x(2, :)
    allocate (cycle%form(3, cycle%period))
    cycle%form = 0
    cycle%multiplier = eigenvalues(closed%matrix, exp(-2*PI*d%search%pendulum%beta*cycle%period))
    cycle%lyapunov = log(abs(cycle%multiplier(1)))/cycle%period
  end subroutine place_cycle

  !> A batch joins the catalogue: lengthening it for every cycle would take a time quadratic in their number.
  subroutine join_batch(attractors, batch)
    type(attractor_t), allocatable, intent(inout) :: attractors(:)
    type(attractor_t), allocatable, intent(inout) :: batch(:) !< images numbered from its own first; empty afterwards

    batch%mirror = batch%mirror + size(attractors)
    call join(attractors, batch)
    deallocate (batch)
    allocate (batch(0))
  end subroutine join_batch

  !> Whether a cycle is the same as one of the last in a catalogue: equal periods and speeds come together.
  pure function is_known(attractors, cycle) result(known)
    type(attractor_t), intent(in) :: attractors(:), cycle
    logical :: known
    integer :: i, first

    known = .true.
    do i = size(attractors), 1, -1
      associate (a => attractors(i))
        if (a%period /= cycle%period) exit
        if (abs(maxval(abs(a%v)) - maxval(abs(cycle%v))) > ONE) then
          if (a%symmetry == HALF_PERIOD) cycle ! images have other speeds at the strobe
          exit
        end if
        do first = 1, a%period
          if (all(separation(a%u, a%v, cshift(cycle%u, first), cshift(cycle%v, first)) < ONE)) return
        end do
      end associate
    end do
    known = .false.
  end function is_known

  subroutine add_cycle(handle, period, theta, velocity) bind(C, name='kz_dynamics_add_cycle')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: period
    real(dp), value :: theta, velocity
    type(dynamics_t), pointer :: d
    integer :: number

    d => of_handle(handle)
    call join_near(d%search, int(period), theta/PI, velocity, d%attractors, number)
  end subroutine add_cycle

  !> Appends the cycle near a strobe point, and its image; number = 0 where none attracts, or none that is new.
  subroutine join_near(search, period, u, v, attractors, number)
    type(search_t), intent(inout) :: search
    integer, intent(in) :: period
    real(dp), intent(in) :: u, v !< half-turns, rad per drive radian
    type(attractor_t), allocatable, intent(inout) :: attractors(:)
    integer, intent(out) :: number
    type(attractor_t) :: new
    logical :: found, blurred

    number = 0
    found = close_cycle(search%fine, search%pendulum%beta, period, [u, v], FARTHEST, new, blurred)
    new%symmetry = pairing_symmetry(search%pendulum)
    if (found) call complete_attractor(search%sampling_flow, new, found)
    if (.not. found) return
    if (known(attractors, new%period, new%u, new%v)) return
    number = size(attractors) + 1
    call add_with_image(search, new, attractors)
  end subroutine join_near

end module kz_saddles_joined
