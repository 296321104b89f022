!> One cycle carried from parameters to parameters: include/kapitza/dynamics.h.
module kz_cycles_continuation
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_vector_map, only: flow_t, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t, is_mirrored
  use kz_cycles_cycles, only: attractor_t, orbit_of
  use kz_cycles_newton, only: n_periods, minimal_period
  use kz_cycles_features, only: find_features
  use kz_maps_matrices, only: eigenvalues, solved
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private

  type, bind(C) :: branch_point_t
    real(dp) :: theta, velocity, amplitude, multiplier_re(2), multiplier_im(2), half_re(2), half_im(2)
    real(dp) :: halves_distance, mirror_distance
    integer(c_int32_t) :: period, winding, centre, symmetric
  end type branch_point_t

  !> A cycle nearer than this to its mirror image, or to one of half its period, is that one.
  real(dp), parameter :: MERGED = 1e-7_dp
  !> One cycle has one multiplier: two that differ by more belong to two.
  real(dp), parameter :: ALIKE = 1e-2_dp
  integer, parameter :: NEWTON_STEPS = 30

contains

  function continue_cycle(pendulum, from, max_distance, to) bind(C, name='kz_branch_continue') result(found)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(branch_point_t), intent(in) :: from !< the cycle at other parameters
    real(dp), value :: max_distance !< farthest that the new strobe point may lie from the old one, rad
    type(branch_point_t), intent(inout) :: to !< the cycle at these
    integer(c_int32_t) :: found
    class(flow_t), allocatable :: flow
    type(branch_point_t) :: point
    real(dp) :: x(2)

    found = 0
    call make_flow(pendulum, fine_numerics(pendulum), .true., flow)
    x = [from%theta/PI, from%velocity]
    if (.not. solves(flow, from, max_distance, x)) return
    if (minimal_period(flow, int(from%period), x) /= from%period) return
    point = from
    call describe(flow, pendulum, x, point)
    if (point%winding /= from%winding) return
    if (from%symmetric == 0 .and. point%mirror_distance < MERGED) return
    if (point%halves_distance < MERGED) return
    found = 1
    to = point
  end function continue_cycle

  function same_cycle(pendulum, a, b) bind(C, name='kz_branch_same') result(same)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m of both
    type(branch_point_t), intent(in) :: a !< a cycle
    type(branch_point_t), intent(in) :: b !< and perhaps the same
    integer(c_int32_t) :: same
    class(flow_t), allocatable :: flow
    integer :: i

    same = 0
    if (a%period /= b%period .or. a%winding /= b%winding .or. a%symmetric /= b%symmetric) return
    if (hypot(a%multiplier_re(1) - b%multiplier_re(1), abs(a%multiplier_im(1)) - abs(b%multiplier_im(1))) > ALIKE) return
    if (separation(a%theta/PI, a%velocity, b%theta/PI, b%velocity) < MERGED) same = 1
    if (same == 1 .or. a%period == 1) return
    call make_flow(pendulum, fine_numerics(pendulum), .true., flow)
    call flow%put(1, a%theta/PI, a%velocity)
    do i = 1, a%period - 1
      call flow%advance(1)
      if (separation(flow%u(1), flow%v(1), b%theta/PI, b%velocity) < MERGED) same = 1
    end do
  end function same_cycle

  !> Periods of the map that a cycle is a fixed point of.
  pure function map_periods(cycle) result(n)
    type(branch_point_t), intent(in) :: cycle
    integer :: n

    n = cycle%period
    if (cycle%symmetric == 1) n = max(1, n/2)
  end function map_periods

  !> x becomes the fixed point near it; true where the steps shrink by half at least until rounding.
  function solves(flow, cycle, max_distance, x) result(converged)
    class(flow_t), intent(inout) :: flow
    type(branch_point_t), intent(in) :: cycle
    real(dp), intent(in) :: max_distance
    real(dp), intent(inout) :: x(2)
    logical :: converged
    real(dp), parameter :: FLOOR = 1e-13_dp, ENOUGH = 1e-7_dp
    real(dp) :: start(2), residual(2), matrix(2, 2), step(2), length, before
    integer :: i

    start = x
    before = 2*max_distance
    converged = .false.
    do i = 1, NEWTON_STEPS
      call closing_error(flow, cycle, x, residual, matrix)
      step = solved(matrix, residual)
      if (.not. all(abs(step) < huge(1.0_dp))) return
      length = norm2(step)
      converged = length < ENOUGH
      if (length > 0.5_dp*before) exit
      x = x - [step(1)/PI, step(2)]
      before = length
      if (length < FLOOR) exit
    end do
    x(1) = angle_difference(x(1), 0.0_dp)
    converged = converged .and. separation(x(1), x(2), start(1), start(2)) <= max_distance
  end function solves

  !> residual = G(x) - x (rad) and G's derivative, G = F^n, or of symmetric cycles -F^(n/2).
  subroutine closing_error(flow, cycle, x, residual, matrix)
    class(flow_t), intent(inout) :: flow
    type(branch_point_t), intent(in) :: cycle
    real(dp), intent(in) :: x(2)
    real(dp), intent(out) :: residual(2), matrix(2, 2)

    call n_periods(flow, map_periods(cycle), x, residual, matrix)
    if (cycle%symmetric == 0) return
    residual = [PI*angle_difference(-flow%u(1), x(1)), -flow%v(1) - x(2)]
    matrix = -matrix
  end subroutine closing_error

  !> Everything about the cycle through x but its period and symmetry, which `point` holds.
  subroutine describe(flow, pendulum, x, point)
    class(flow_t), intent(inout) :: flow
    type(pendulum_t), intent(in) :: pendulum
    real(dp), intent(in) :: x(2)
    type(branch_point_t), intent(inout) :: point
    class(flow_t), allocatable :: sampled
    type(attractor_t) :: cycle
    complex(dp) :: multiplier(2)
    real(dp) :: residual(2), matrix(2, 2)
    integer :: n

    n = point%period
    point%theta = PI*x(1)
    point%velocity = x(2)
    call orbit_of(flow, n, x, cycle, matrix)
    multiplier = eigenvalues(matrix, exp(-2*PI*pendulum%beta*n))
    point%multiplier_re = real(multiplier, dp)
    point%multiplier_im = aimag(multiplier)
    call closing_error(flow, point, x, residual, matrix)
    multiplier = eigenvalues(matrix, exp(-2*PI*pendulum%beta*map_periods(point)))
    point%half_re = real(multiplier, dp)
    point%half_im = aimag(multiplier)
    call make_flow(pendulum, fine_numerics(pendulum), .false., sampled)
    call find_features(sampled, pendulum, cycle, x(1), x(2), n)
    point%winding = cycle%winding
    point%centre = cycle%centre
    point%amplitude = cycle%amplitude
    point%halves_distance = halves_distance(cycle)
    point%mirror_distance = 0
    if (is_mirrored(pendulum) == 0) point%mirror_distance = huge(1.0_dp)
    if (point%symmetric == 0 .and. is_mirrored(pendulum) /= 0) &
      point%mirror_distance = minval(separation(cycle%u, cycle%v, -x(1), -x(2)))
  end subroutine describe

  !> The strobe points of a cycle of even period that are half a period apart: how near the nearest such pair is, rad.
  function halves_distance(cycle) result(least)
    type(attractor_t), intent(in) :: cycle
    real(dp) :: least
    integer :: half

    least = huge(1.0_dp)
    half = cycle%period/2
    if (2*half /= cycle%period) return
    least = minval(separation(cycle%u(:half), cycle%v(:half), cycle%u(half + 1:), cycle%v(half + 1:)))
  end function halves_distance

end module kz_cycles_continuation
