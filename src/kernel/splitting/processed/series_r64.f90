!> The series of the processed splitting in double precision.
module kz_processed_series_r64
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, sine_force, highest_harmonic
  implicit none
  private
  public :: series_t, make_series, ORDER, HARMONICS

  integer, parameter :: ORDER = 14, HIGHEST = ORDER

  include 'series.inc'

end module kz_processed_series_r64
