!> The tile in single precision.
module kz_kernel_r32
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real32, ik => int32
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_kernel_map, only: flow_t, put_state, move_state, WIDTH
  use kz_kernel_tables, only: period_t, INVERSE_PI_QUAD
  implicit none
  private
  public :: tile_t, make_tile, sine

  !> Vector loops run over the whole tile.
  integer, parameter :: VECTOR = 16

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 2.0e-11 (Remez exchange in 60 digits).
  real(rk), parameter :: SINE_COEFFICIENTS(6) = [ &
    3.14159265352_rk, &
    -5.16771276212_rk, &
    2.55016324034_rk, &
    -0.599251330259_rk, &
    0.0820464793682_rk, &
    -0.00702216420632_rk]

  include 'tile.inc'

end module kz_kernel_r32
