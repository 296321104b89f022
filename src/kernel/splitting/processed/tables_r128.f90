!> Tables of the processed splitting in quad precision, for pairs of doubles.
module kz_processed_tables_r128
  use, intrinsic :: iso_c_binding, only: c_double, c_ptr
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t, exact_stiffness
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_tables, only: series_r64_t => series_t, make_processed_series, ORDER, HARMONICS
  use kz_processed_series_r128, only: series_t, make_series, EXACT => ORDER
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_mixed_series, make_processed, ORDER, HARMONICS

  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use in pairs of doubles.
  integer, parameter, public :: MOST_PAIR_DRIFTS = ORDER/2 - 1, MOST_PAIR_KICKS = 22

  !> Kicks sum their grades once for all steps: a product of quads takes long, and another order of the sums changes rounding alone.
  logical, parameter :: SUMS_GRADES = .true.

  include 'tables.inc'

  !> The series of a pendulum: its first grades in quad precision, those beyond in double, right to 1e-15 of the force itself. Grade q of a
  !> step h counts h**q, so little precision is enough for high ones.
  subroutine make_mixed_series(pendulum, kept, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(c_ptr), intent(in) :: kept !< series that are kept, kz_kept_series of kernel.h; null = none are
    type(series_t), intent(out) :: series !< what does not depend on the number of steps
    type(series_r64_t), allocatable :: rounded
    type(series_t), allocatable :: leading

    allocate (rounded, leading)
    call make_processed_series(pendulum, kept, rounded)
    call make_series(pendulum, leading)
    series%mirrored = rounded%mirrored
    series%times = rounded%times
    series%kick = rounded%kick
    series%slope = rounded%slope
    series%drift = rounded%drift
    series%processor = rounded%processor
    call put_exact(leading, series)
  end subroutine make_mixed_series

  !> Grades up to EXACT, of a processor up to EXACT - 2, and nothing beyond what they have.
  subroutine put_exact(leading, series)
    type(series_t), intent(in) :: leading
    type(series_t), intent(inout) :: series
    integer, parameter :: HALF = EXACT/2

    series%kick(:, :, :EXACT, :, :) = 0
    series%kick(:leading%times, :HALF, :EXACT, :, :) = leading%kick
    series%slope(:EXACT) = leading%slope(:EXACT)
    series%drift(:, :EXACT) = leading%drift(:, :EXACT)
    series%processor(:, :, :EXACT - 2, :, :, :) = 0
    series%processor(:HALF, :EXACT, :EXACT - 2, :, :, :) = leading%processor(:, :, :EXACT - 2, :, :, :)
  end subroutine put_exact

end module kz_processed_tables_r128
