!> The stages of split schemes for a pendulum without mirror symmetry: each kick is a sine shifted by an angle of its own, and a push.
module kz_split_shifted
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  use kz_lanes_map, only: WIDTH
  use kz_lanes_sine, only: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT
  use kz_split_stages, only: steps_t, last_drift
  implicit none
  private
  public :: shifted_stages, shifted_tangent

contains

  !> Stages with a shift and a push.
  subroutine shifted_stages(self, first, last, n, u, v)
    !> tables of a period
    type(steps_t), intent(in) :: self
    !> stage, from 1
    integer, intent(in) :: first
    !> stage
    integer, intent(in) :: last
    !> lanes
    integer, intent(in) :: n
    !> half-turns
    real(rk), intent(inout) :: u(WIDTH)
    !> rad per drive radian
    real(rk), intent(inout) :: v(WIDTH)
    real(rk) :: drift, decay, kick, shift, push
    integer :: s, i

    do s = first, last
      drift = self%drift_u(s)
      decay = self%decay(s)
      kick = self%kick(s)
      shift = self%shift(s)
      push = self%push(s)
      do i = 1, n
        u(i) = u(i) + drift*v(i)
        v(i) = decay*v(i) - kick*sine(u(i) - shift) + push
      end do
    end do
  end subroutine shifted_stages

  !> split_tangent with a shift and a push.
  subroutine shifted_tangent(self, n, u, v, c)
    !> tables of a period
    type(steps_t), intent(in) :: self
    !> lanes
    integer, intent(in) :: n
    !> half-turns
    real(rk), intent(inout) :: u(WIDTH)
    !> rad per drive radian
    real(rk), intent(inout) :: v(WIDTH)
    !> c(i, :, j): column j of the tangent map of lane i
    real(rk), intent(inout) :: c(WIDTH, 2, 2)
    real(rk) :: slope
    integer :: s, i

    do s = 1, size(self%kick)
      do i = 1, n
        u(i) = u(i) + self%drift_u(s)*v(i)
        v(i) = self%decay(s)*v(i) - self%kick(s)*sine(u(i) - self%shift(s)) + self%push(s)
        slope = self%kick(s)*sine(u(i) - self%shift(s) + 0.5_rk)
        c(i, 1, :) = c(i, 1, :) + self%drift(s)*c(i, 2, :)
        c(i, 2, :) = self%decay(s)*c(i, 2, :) - slope*c(i, 1, :)
      end do
    end do
    call last_drift(self, n, u, v)
    s = size(self%drift)
    c(:n, 1, :) = c(:n, 1, :) + self%drift(s)*c(:n, 2, :)
    c(:n, 2, :) = self%decay(s)*c(:n, 2, :)
  end subroutine shifted_tangent

  include 'lanes/sine.inc'

end module kz_split_shifted
