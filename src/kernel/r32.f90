!> The tile in single precision.
module kz_kernel_r32
  use, intrinsic :: iso_c_binding, only: c_double, c_float, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real32, ik => int32
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_lanes_map, only: flow_t, put_state, move_state, WIDTH, ROOM
  use kz_processed_tables, only: processed_t, processor_t, ORDER, HARMONICS
  use kz_lanes_step_table, only: period_t, INVERSE_PI_QUAD
  implicit none
  private
  public :: make_tile, make_processed_tile, sine

  !> Vector loops run over the whole tile.
  integer, parameter :: VECTOR = 16

  interface
    !> The stages of a period for the lanes 1 .. n, or some more (processed/stages.c).
    subroutine stages(n_drift, n_kick, n_stages, row, n, u, v) bind(C, name='kz_processed_stages_r32')
      import :: c_float, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: n_drift
      integer(c_int32_t), value :: n_kick
      integer(c_int64_t), value :: n_stages
      real(c_float), intent(in) :: row(*)
      integer(c_int64_t), value :: n
      real(c_float), intent(inout) :: u(WIDTH)
      real(c_float), intent(inout) :: v(WIDTH)
    end subroutine stages
  end interface

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 2.0e-11 (Remez exchange in 60 digits).
  real(rk), parameter :: SINE_COEFFICIENTS(6) = [ &
    3.14159265352_rk, &
    -5.16771276212_rk, &
    2.55016324034_rk, &
    -0.599251330259_rk, &
    0.0820464793682_rk, &
    -0.00702216420632_rk]

  include 'split/tile.inc'
  include 'split/tile_stages.inc'
  include 'processed/tile.inc'
  include 'processed/tangent.inc'
  include 'processed/processor.inc'

end module kz_kernel_r32
