!> A cycle of one pendulum as branches of a sweep hold it: include/kapitza/dynamics.h.
module kz_cycles_described
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_vector_map, only: flow_t, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t
  use kz_cycles_cycles, only: attractor_t, orbit_of
  use kz_cycles_features, only: find_features
  use kz_maps_matrices, only: eigenvalues
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private

  type, bind(C) :: branch_point_t
    real(dp) :: theta, velocity, amplitude, multiplier_re(2), multiplier_im(2)
    integer(c_int32_t) :: period, winding, centre, symmetric
  end type branch_point_t

  !> rad: states nearer than this are one.
  real(dp), parameter :: ONE = 1e-7_dp
  !> One cycle has one multiplier: two that differ by more belong to two.
  real(dp), parameter :: ALIKE = 1e-2_dp

contains

  subroutine describe(pendulum, point) bind(C, name='kz_branch_describe')
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(branch_point_t), intent(inout) :: point !< strobe point and period, in; the rest, out
    class(flow_t), allocatable :: flow
    type(attractor_t) :: cycle
    complex(dp) :: multiplier(2)
    real(dp) :: matrix(2, 2), u

    u = angle_difference(point%theta/PI, 0.0_dp)
    point%theta = PI*u
    call make_flow(pendulum, fine_numerics(pendulum), .false., flow)
    call orbit_of(flow, int(point%period), [u, point%velocity], cycle, matrix)
    multiplier = eigenvalues(matrix, exp(-2*PI*pendulum%beta*point%period))
    point%multiplier_re = real(multiplier, dp)
    point%multiplier_im = aimag(multiplier)
    call find_features(flow, pendulum, cycle, u, point%velocity, int(point%period))
    point%winding = cycle%winding
    point%centre = cycle%centre
    point%amplitude = cycle%amplitude
  end subroutine describe

  function same_cycle(pendulum, a, b) bind(C, name='kz_branch_same') result(same)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m of both
    type(branch_point_t), intent(in) :: a !< a cycle
    type(branch_point_t), intent(in) :: b !< and perhaps the same
    integer(c_int32_t) :: same
    class(flow_t), allocatable :: flow
    integer :: i

    same = 0
    if (a%period /= b%period .or. a%winding /= b%winding .or. a%symmetric /= b%symmetric) return
    if (hypot(a%multiplier_re(1) - b%multiplier_re(1), abs(a%multiplier_im(1)) - abs(b%multiplier_im(1))) &
        > ALIKE*max(1.0_dp, abs(b%multiplier_re(1)))) return
    if (separation(a%theta/PI, a%velocity, b%theta/PI, b%velocity) < ONE) same = 1
    if (same == 1 .or. a%period == 1) return
    call make_flow(pendulum, fine_numerics(pendulum), .true., flow)
    call flow%put(1, a%theta/PI, a%velocity)
    do i = 1, a%period - 1
      call flow%advance(1)
      if (separation(flow%u(1), flow%v(1), b%theta/PI, b%velocity) < ONE) same = 1
    end do
  end function same_cycle

end module kz_cycles_described
