!> The series of the processed splitting in quad precision: the grades that need more than double precision.
module kz_processed_series_r128
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t, sine_force, highest_harmonic
  implicit none
  private
  public :: series_t, make_series, ORDER

  integer, parameter :: ORDER = 8, HIGHEST = 14

  include 'series.inc'

end module kz_processed_series_r128
