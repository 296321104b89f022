!> The stages of one period of split schemes and Runge-Kutta, and their tangents.
module kz_splitting_stages
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  use kz_vector_map, only: WIDTH
  use kz_vector_sine, only: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT, INVERSE_PI
  use kz_vector_step_table, only: period_t
  implicit none
  private
  public :: advance_steps, advance_tangents

contains

  !> Advances through steps of a period. The drift that ends a period belongs to its last step.
  subroutine advance_steps(self, from, to, n, u, v)
    type(period_t), intent(in) :: self !< tables of a period
    integer, intent(in) :: from !< step, from 1
    integer, intent(in) :: to !< step
    integer, intent(in) :: n !< lanes
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH) !< half-turns; rad per drive radian
    integer :: first, s

    if (.not. self%split) then
      call rk4_steps(self, from, to, n, u, v)
      return
    end if
    first = 1
    if (from > 1) first = self%step_end(from - 1) + 1
    do s = first, self%step_end(to)
      call drift_and_kick(self%drift_u(s), self%decay(s), self%kick(s))
    end do
    if (to < self%n_steps) return
    s = size(self%drift)
    u(:n) = u(:n) + self%drift_u(s)*v(:n)
    v(:n) = self%decay(s)*v(:n)
  contains
    !> Advances through a drift and a kick.
    subroutine drift_and_kick(drift, decay, strength)
      real(rk), intent(in) :: drift, decay, strength
      integer :: i

      if (self%mirrored) then
        do i = 1, n
          u(i) = u(i) + drift*v(i)
          v(i) = decay*v(i) - strength*sine(u(i))
        end do
      else
        do i = 1, n
          u(i) = u(i) + drift*v(i)
          v(i) = decay*v(i) - strength*sine(u(i) - self%shift(s)) + self%push(s)
        end do
      end if
    end subroutine drift_and_kick
  end subroutine advance_steps

  subroutine rk4_steps(self, from, to, n, u, v)
    type(period_t), intent(in) :: self
    integer, intent(in) :: from, to, n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)
    real(rk) :: h, half, f0, f1, f2, a1, a2, a3, a4, v2, v3, v4
    integer :: s, i

    h = self%step
    half = 0.5_rk*h
    do s = from, to
      f0 = self%kick(2*s - 1)
      f1 = self%kick(2*s)
      f2 = self%kick(2*s + 1)
      do i = 1, n
        a1 = -self%beta*v(i) - f0*sine(u(i))
        v2 = v(i) + half*a1
        a2 = -self%beta*v2 - f1*sine(u(i) + half*INVERSE_PI*v(i))
        v3 = v(i) + half*a2
        a3 = -self%beta*v3 - f1*sine(u(i) + half*INVERSE_PI*v2)
        v4 = v(i) + h*a3
        a4 = -self%beta*v4 - f2*sine(u(i) + h*INVERSE_PI*v3)
        u(i) = u(i) + h*INVERSE_PI/6*(v(i) + 2*v2 + 2*v3 + v4)
        v(i) = v(i) + h/6*(a1 + 2*a2 + 2*a3 + a4)
      end do
    end do
  end subroutine rk4_steps

  !> Advances a period with the derivative of the scheme itself.
  subroutine advance_tangents(self, n, u, v, c)
    type(period_t), intent(in) :: self !< tables of a period
    integer, intent(in) :: n !< lanes
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH) !< half-turns; rad per drive radian
    real(rk), intent(inout) :: c(WIDTH, 2, 2) !< c(i, :, j): column j of the tangent map of lane i
    integer :: s

    if (self%split) then
      do s = 1, size(self%kick)
        call kick_tangents(s)
      end do
      s = size(self%drift)
      u(:n) = u(:n) + self%drift_u(s)*v(:n)
      v(:n) = self%decay(s)*v(:n)
      c(:n, 1, :) = c(:n, 1, :) + self%drift(s)*c(:n, 2, :)
      c(:n, 2, :) = self%decay(s)*c(:n, 2, :)
    else
      do s = 1, self%n_steps
        call rk4_tangents(self, s, n, u, v, c)
      end do
    end if
  contains
    subroutine kick_tangents(s)
      integer, intent(in) :: s
      real(rk) :: drift, drift_u, decay, kick, slope(WIDTH)
      integer :: i

      drift = self%drift(s)
      drift_u = self%drift_u(s)
      decay = self%decay(s)
      kick = self%kick(s)
      if (self%mirrored) then
        do i = 1, n
          u(i) = u(i) + drift_u*v(i)
          v(i) = decay*v(i) - kick*sine(u(i))
          slope(i) = kick*sine(u(i) + 0.5_rk)
        end do
      else
        do i = 1, n
          u(i) = u(i) + drift_u*v(i)
          v(i) = decay*v(i) - kick*sine(u(i) - self%shift(s)) + self%push(s)
          slope(i) = kick*sine(u(i) - self%shift(s) + 0.5_rk)
        end do
      end if
      do i = 1, n
        c(i, 1, 1) = c(i, 1, 1) + drift*c(i, 2, 1)
        c(i, 1, 2) = c(i, 1, 2) + drift*c(i, 2, 2)
        c(i, 2, 1) = decay*c(i, 2, 1) - slope(i)*c(i, 1, 1)
        c(i, 2, 2) = decay*c(i, 2, 2) - slope(i)*c(i, 1, 2)
      end do
    end subroutine kick_tangents
  end subroutine advance_tangents

  !> Tangents of a step of Runge-Kutta, then the step.
  subroutine rk4_tangents(self, s, n, u, v, c)
    type(period_t), intent(in) :: self
    integer, intent(in) :: s, n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH), c(WIDTH, 2, 2)
    real(rk) :: half, half_u, f0, f1, f2, v2, v3, slope(WIDTH, 4)
    integer :: i, j

    half = 0.5_rk*self%step
    half_u = half*INVERSE_PI
    f0 = self%kick(2*s - 1)
    f1 = self%kick(2*s)
    f2 = self%kick(2*s + 1)
    do i = 1, n
      v2 = v(i) - half*(self%beta*v(i) + f0*sine(u(i)))
      v3 = v(i) - half*(self%beta*v2 + f1*sine(u(i) + half_u*v(i)))
      slope(i, 1) = f0*sine(u(i) + 0.5_rk)
      slope(i, 2) = f1*sine(u(i) + half_u*v(i) + 0.5_rk)
      slope(i, 3) = f1*sine(u(i) + half_u*v2 + 0.5_rk)
      slope(i, 4) = f2*sine(u(i) + 2*half_u*v3 + 0.5_rk)
    end do
    do j = 1, 2
      call rk4_column(n, self%step, self%beta, slope, c(:, 1, j), c(:, 2, j))
    end do
    call advance_steps(self, s, s, n, u, v)
  end subroutine rk4_tangents

  !> Advances x' = y, y' = -beta y - slope x of each lane by a step, with the slope of each stage.
  pure subroutine rk4_column(n, h, beta, slope, x, y)
    integer, intent(in) :: n
    real(rk), intent(in) :: h, beta, slope(WIDTH, 4)
    real(rk), intent(inout) :: x(WIDTH), y(WIDTH)
    real(rk) :: half, a1, a2, a3, a4, y2, y3, y4
    integer :: i

    half = 0.5_rk*h
    do i = 1, n
      a1 = -beta*y(i) - slope(i, 1)*x(i)
      y2 = y(i) + half*a1
      a2 = -beta*y2 - slope(i, 2)*(x(i) + half*y(i))
      y3 = y(i) + half*a2
      a3 = -beta*y3 - slope(i, 3)*(x(i) + half*y2)
      y4 = y(i) + h*a3
      a4 = -beta*y4 - slope(i, 4)*(x(i) + h*y3)
      x(i) = x(i) + h/6*(y(i) + 2*y2 + 2*y3 + y4)
      y(i) = y(i) + h/6*(a1 + 2*a2 + 2*a3 + a4)
    end do
  end subroutine rk4_column

  include 'vector/sine.inc'

end module kz_splitting_stages
