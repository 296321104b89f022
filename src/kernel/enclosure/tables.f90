!> Constants of the enclosures in quad precision.
module kz_enclosure_tables
  use, intrinsic :: iso_c_binding, only: c_float128, c_int32_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_model_pendulum, only: pendulum_t
  use kz_model_series_r128, only: force_series
  implicit none
  private

  real(real128), parameter :: PI = 3.14159265358979323846264338327950288419716939937510582_real128

contains

  !> Steps of h = 2 pi / n_steps: h beta, h, h times the torque, and the first n powers of s = 0 .. 1 in h a(t + h s) and -h b(t + h s), t
  !> the beginning of a step.
  subroutine interval_tables(pendulum, n_steps, n, damping, step, push, along, across) bind(C, name='kz_interval_constants')
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: n_steps, n
    real(c_float128), intent(out) :: damping, step, push, along(n, n_steps), across(n, n_steps)
    integer :: i

    step = 2 * PI / n_steps
    damping = step * pendulum%beta
    push = step * pendulum%torque
    do i = 1, n_steps
      call force_series(pendulum, 2 * PI * (i - 1) / n_steps, step, step, along(:, i), across(:, i))
    end do
    across = -across
  end subroutine interval_tables

end module kz_enclosure_tables
