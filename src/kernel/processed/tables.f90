!> The processed splitting in double precision: its tables, and its series, which is kept.
module kz_processed_tables
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, exact_stiffness, is_same
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_series_r64, only: series_t, make_series, ORDER, HARMONICS
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_processed_series, make_processed, ORDER, HARMONICS

  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use.
  integer, parameter, public :: MOST_DRIFTS = 4, MOST_KICKS = 11
  !> The velocity is carried as v exp(beta t) through a period: more damping than this would overflow.
  real(c_double), parameter, public :: MOST_DAMPING = 16/(2*3.14159265358979323846_c_double)

  !> The series that was made last, and its pendulum: a scene asks for it several times.
  type(series_t), allocatable, save :: made
  type(pendulum_t), save :: pendulum_made

  include 'tables.inc'

  !> The series of a pendulum, right to 1e-15 of the force itself.
  subroutine make_processed_series(pendulum, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(series_t), intent(out) :: series !< what does not depend on the number of steps

    if (allocated(made)) then
      if (.not. is_same(pendulum, pendulum_made)) deallocate (made)
    end if
    if (.not. allocated(made)) then
      allocate (made)
      call make_series(pendulum, made)
      pendulum_made = pendulum
    end if
    series = made
  end subroutine make_processed_series

end module kz_processed_tables
