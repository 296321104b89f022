!> Tables of the processed splitting in quad precision, for pairs of doubles.
module kz_processed_tables_r128
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t, exact_stiffness
  use kz_processed_harmonics, only: harmonic_polynomials
  use kz_processed_series_r64, only: series_r64_t => series_t, make_series_r64 => make_series
  use kz_processed_series_r128, only: series_t, make_series, ORDER, HARMONICS
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_mixed_series, make_processed, ORDER, HARMONICS

  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use in pairs of doubles.
  integer, parameter, public :: MOST_PAIR_DRIFTS = ORDER/2 - 1, MOST_PAIR_KICKS = 22

  real(rk), parameter :: PI = 3.14159265358979323846264338327950288_rk

  include 'table_types.inc'

contains

  !> The series of a pendulum: grades up to `quad_grades` in quad precision (all of them: a second), those beyond in double, right to
  !> 1e-15 of the force itself. Grade q of a step h counts h**q, so little precision is enough for high ones.
  subroutine make_mixed_series(pendulum, quad_grades, series)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    !> even, at most ORDER
    integer, intent(in) :: quad_grades
    !> what does not depend on the number of steps
    type(series_t), intent(out) :: series
    type(series_r64_t), allocatable :: rounded
    type(series_t), allocatable :: exact

    allocate (rounded, exact)
    call make_series_r64(pendulum%k, pendulum%beta, pendulum%m, ORDER, rounded)
    series%kick_cosine = rounded%kick_cosine
    series%kick_sine = rounded%kick_sine
    series%drift = rounded%drift
    series%to_kernel = rounded%to_kernel
    series%from_kernel = rounded%from_kernel
    series%residual = rounded%residual
    call make_series(real(pendulum%k, rk), real(pendulum%beta, rk), real(pendulum%m, rk), quad_grades, exact)
    series%kick_cosine(:, :, :quad_grades) = exact%kick_cosine(:, :, :quad_grades)
    series%kick_sine(:, :, :quad_grades) = exact%kick_sine(:, :, :quad_grades)
    series%drift(:, :quad_grades) = exact%drift(:, :quad_grades)
    series%to_kernel(:, :, :quad_grades - 2, :) = exact%to_kernel(:, :, :quad_grades - 2, :)
    series%from_kernel(:, :, :quad_grades - 2, :) = exact%from_kernel(:, :, :quad_grades - 2, :)
  end subroutine make_mixed_series

  include 'table_procedures.inc'

end module kz_processed_tables_r128
