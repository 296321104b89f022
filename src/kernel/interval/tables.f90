!> Constants of the enclosures, made in quad precision. As sums of two doubles they are off by at most 2^-106 of the number, the torque's by
!> 2^-105 of the largest of its power.
module kz_interval_tables
  use, intrinsic :: iso_c_binding, only: c_double, c_float128, c_int32_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_model_pendulum, only: pendulum_t, force_series
  implicit none
  private

  real(real128), parameter :: PI = 3.14159265358979323846264338327950288419716939937510582_real128

contains

  !> Steps of h = 2 pi / n_steps: h beta, h / n and 1 / n, and the powers of s = 0 .. 1 in h a(t + h s), t the beginning of a step.
  subroutine interval_tables(pendulum, n_steps, order, damping, step, inverse, torque) bind(C, name='kz_interval_constants')
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: n_steps, order
    real(c_double), intent(out) :: damping(2), step(2, order), inverse(2, order), torque(2, order, n_steps)
    real(real128) :: h, along(order), across(order)
    integer :: i, n

    h = 2 * PI / n_steps
    damping = pair_of(h * pendulum%beta)
    do n = 1, order
      step(:, n) = pair_of(h / n)
      inverse(:, n) = pair_of(1 / real(n, real128))
    end do
    do i = 1, n_steps
      call force_series(pendulum, 2 * PI * (i - 1) / n_steps, h, h, along, across)
      do n = 1, order
        torque(:, n, i) = pair_of(along(n))
      end do
    end do
  end subroutine interval_tables

  !> kz_quad_constants_make of speed_class.c: h beta, h, powers of s as above, n of them.
  subroutine quad_constants(pendulum, n_steps, n, damping, step, torque) bind(C, name='kz_quad_constants_make')
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: n_steps, n
    real(c_float128), intent(out) :: damping, step, torque(n, n_steps)
    real(real128) :: across(n)
    integer :: i

    step = 2 * PI / n_steps
    damping = step * pendulum%beta
    do i = 1, n_steps
      call force_series(pendulum, 2 * PI * (i - 1) / n_steps, step, step, torque(:, i), across)
    end do
  end subroutine quad_constants

  pure function pair_of(x) result(pair)
    real(real128), intent(in) :: x
    real(c_double) :: pair(2)

    pair(1) = real(x, c_double)
    pair(2) = real(x - pair(1), c_double)
  end function pair_of

end module kz_interval_tables
