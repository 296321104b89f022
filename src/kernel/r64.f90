!> The tile in double precision.
module kz_kernel_r64
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_kernel_map, only: flow_t, put_state, move_state, WIDTH, ROOM
  use kz_kernel_processed_tables, only: processed_t, processor_t, ORDER, HARMONICS
  use kz_kernel_step_table, only: period_t, INVERSE_PI_QUAD
  implicit none
  private
  public :: make_tile, make_processed_tile, sine, SINE_COEFFICIENTS, MAGIC, SIGN_SHIFT, INVERSE_PI, VECTOR

  !> Vector loops run over the whole tile.
  integer, parameter :: VECTOR = 16

  interface
    !> The stages of a period for the lanes 1 .. n, or some more (processed_stages.c).
    subroutine stages(n_drift, n_kick, n_stages, row, n, u, v) bind(C, name='kz_processed_stages_r64')
      import :: c_double, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: n_drift
      integer(c_int32_t), value :: n_kick
      integer(c_int64_t), value :: n_stages
      real(c_double), intent(in) :: row(*)
      integer(c_int64_t), value :: n
      real(c_double), intent(inout) :: u(WIDTH)
      real(c_double), intent(inout) :: v(WIDTH)
    end subroutine stages
  end interface

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 3.0e-19 (Remez exchange in 60 digits).
  real(rk), parameter :: SINE_COEFFICIENTS(9) = [ &
    3.14159265358979323765_rk, &
    -5.16771278004996952865_rk, &
    2.55016403987729393818_rk, &
    -0.599264529318738216301_rk, &
    0.0821458865698926095193_rk, &
    -0.00737043047876246099464_rk, &
    0.000466299688773173555302_rk, &
    -0.0000219031854208053767726_rk, &
    7.69472732830679049614e-7_rk]

  include 'tile.inc'
  include 'tile_stages.inc'
  include 'processed_tile.inc'
  include 'processed_tangent.inc'
  include 'processor.inc'

end module kz_kernel_r64
