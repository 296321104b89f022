!> The C interface of dynamics: one branch of a manifold of a saddle (include/kapitza/dynamics.h).
module kz_api_manifold
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_lanes_map, only: flow_t, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t
  use kz_saddles_manifold, only: grow_manifold
  implicit none
  private

  type, bind(C) :: branch_t
    real(dp) :: theta, velocity
    integer(c_int32_t) :: period, stable, side
    real(dp) :: spacing, length, fastest
  end type branch_t

contains

  function grow(pendulum, branch, most, point) bind(C, name='kz_manifold_grow') result(n)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(branch_t), intent(in) :: branch
    integer(c_int64_t), value :: most
    real(dp), intent(out) :: point(4, most) !< rad, rad per drive radian, rad, number of the part
    integer(c_int64_t) :: n
    class(flow_t), allocatable :: flow
    type(pendulum_t) :: turned
    real(dp) :: sign
    integer :: count

    turned = pendulum
    sign = 1
    if (branch%stable == 1) then ! time runs backwards: (theta, -v) obeys the equation with -beta
      turned%beta = -pendulum%beta
      turned%vertical(2, :) = -pendulum%vertical(2, :)
      turned%horizontal(2, :) = -pendulum%horizontal(2, :)
      sign = -1
    end if
    call make_flow(turned, fine_numerics(turned), .true., flow)
    call grow_manifold(flow, turned%beta, int(branch%period), [branch%theta/PI, sign*branch%velocity], int(branch%side), &
                       branch%spacing, branch%length, branch%fastest, count, point)
    n = count
    point(1, :n) = PI*point(1, :n) + 0.0_dp
    where (point(1, :n) >= PI) point(1, :n) = -PI
    point(2, :n) = sign*point(2, :n) + 0.0_dp
  end function grow

end module kz_api_manifold
