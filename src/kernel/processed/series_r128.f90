!> The series of the processed splitting in quad precision.
module kz_processed_series_r128
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: sine_force
  implicit none
  private
  public :: series_t, make_series, ORDER, HARMONICS

  include 'series.inc'

end module kz_processed_series_r128
