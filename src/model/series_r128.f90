!> The series of the force in time, in real128.
module kz_model_series_r128
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: force_series

contains

  include 'force_series.inc'

end module kz_model_series_r128
