!> Tables of the processed splitting in double precision.
module kz_processed_tables_r64
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, exact_stiffness
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_series_r64, only: series_t, ORDER, HARMONICS
  implicit none
  private
  public :: processed_t, processor_t, make_processed

  real(rk), parameter :: PI = 3.14159265358979323846264338327950288_rk

  include 'table_types.inc'

contains

  include 'table_procedures.inc'

end module kz_processed_tables_r64
