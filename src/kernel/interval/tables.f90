!> Constants of the enclosures as sums of two doubles, made in quad precision: off by at most 2^-106 of the number, the torque's by
!> 2^-105 of the largest of its power.
module kz_interval_tables
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use, intrinsic :: iso_fortran_env, only: real128
  implicit none
  private

  real(real128), parameter :: PI = 3.14159265358979323846264338327950288419716939937510582_real128

contains

  !> Steps of h = 2 pi / n_steps: h beta, h / n and 1 / n, and the powers of s = 0 .. 1 in h (k - m cos(t + h s)), t the beginning of a step.
  subroutine interval_tables(k, beta, m, n_steps, order, damping, step, inverse, torque) bind(C, name='kz_interval_constants')
    real(c_double), value :: k
    real(c_double), value :: beta
    real(c_double), value :: m
    integer(c_int32_t), value :: n_steps
    integer(c_int32_t), value :: order
    real(c_double), intent(out) :: damping(2)
    real(c_double), intent(out) :: step(2, order)
    real(c_double), intent(out) :: inverse(2, order)
    real(c_double), intent(out) :: torque(2, order, n_steps)
    real(real128) :: h, angle, factor, derivative(0:3), coefficient
    integer :: i, n

    h = 2 * PI / n_steps
    damping = pair_of(h * beta)
    do n = 1, order
      step(:, n) = pair_of(h / n)
      inverse(:, n) = pair_of(1 / real(n, real128))
    end do
    do i = 1, n_steps
      angle = 2 * PI * (i - 1) / n_steps
      derivative = [cos(angle), -sin(angle), -cos(angle), sin(angle)]
      factor = -m * h
      do n = 1, order
        coefficient = factor * derivative(mod(n - 1, 4))
        if (n == 1) coefficient = coefficient + h * k
        torque(:, n, i) = pair_of(coefficient)
        factor = factor * h / n
      end do
    end do
  end subroutine interval_tables

  pure function pair_of(x) result(pair)
    real(real128), intent(in) :: x
    real(c_double) :: pair(2)

    pair(1) = real(x, c_double)
    pair(2) = real(x - pair(1), c_double)
  end function pair_of

end module kz_interval_tables
