!> Tables of the processed splitting in quad precision, for pairs of doubles.
module kz_processed_tables_r128
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t, exact_stiffness
  use kz_processed_harmonics, only: harmonic_polynomials
  use kz_processed_series_r64, only: series_r64_t => series_t, make_series_r64 => make_series, ORDER, HARMONICS
  use kz_processed_series_r128, only: series_r128_t => series_t, make_series_r128 => make_series, EXACT => ORDER
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_mixed_series, make_processed, ORDER, HARMONICS

  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use in pairs of doubles.
  integer, parameter, public :: MOST_PAIR_DRIFTS = ORDER/2 - 1, MOST_PAIR_KICKS = 22

  real(rk), parameter :: PI = 3.14159265358979323846264338327950288_rk

  include 'series_type.inc'

  include 'table_types.inc'

contains

  !> The series of a pendulum: its first grades in quad precision, those beyond in double, right to 1e-15 of the force itself. Grade q of a
  !> step h counts h**q, so little precision is enough for high ones.
  subroutine make_mixed_series(pendulum, series)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    !> what does not depend on the number of steps
    type(series_t), intent(out) :: series
    integer, parameter :: HALF = EXACT/2
    type(series_r64_t), allocatable :: rounded
    type(series_r128_t), allocatable :: leading

    allocate (rounded, leading)
    call make_series_r64(pendulum%k, pendulum%beta, pendulum%m, rounded)
    call make_series_r128(real(pendulum%k, rk), real(pendulum%beta, rk), real(pendulum%m, rk), leading)
    series%kick_cosine(:, :, EXACT + 1:) = rounded%kick_cosine(:, :, EXACT + 1:)
    series%kick_sine(:, :, EXACT + 1:) = rounded%kick_sine(:, :, EXACT + 1:)
    series%drift(:, EXACT + 1:) = rounded%drift(:, EXACT + 1:)
    series%to_kernel(:, :, EXACT - 1:, :) = rounded%to_kernel(:, :, EXACT - 1:, :)
    series%from_kernel(:, :, EXACT - 1:, :) = rounded%from_kernel(:, :, EXACT - 1:, :)
    series%residual = rounded%residual
    series%kick_cosine(:HALF, :HALF, :EXACT) = leading%kick_cosine
    series%kick_sine(:HALF, :HALF, :EXACT) = leading%kick_sine
    series%drift(:EXACT, :EXACT) = leading%drift
    series%to_kernel(:HALF, :EXACT, :EXACT - 2, :) = leading%to_kernel(:, :, :EXACT - 2, :)
    series%from_kernel(:HALF, :EXACT, :EXACT - 2, :) = leading%from_kernel(:, :, :EXACT - 2, :)
  end subroutine make_mixed_series

  include 'table_procedures.inc'

end module kz_processed_tables_r128
