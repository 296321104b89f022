!> The tile in quad precision.
module kz_kernel_r128
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_kernel_map, only: flow_t, put_state, move_state, WIDTH, ROOM
  use kz_kernel_processed_tables, only: processed_t, processor_t, ORDER, HARMONICS
  use kz_kernel_step_table, only: period_t, INVERSE_PI_QUAD
  implicit none
  private
  public :: make_tile, make_processed_tile, sine, SINE_COEFFICIENTS

  integer, parameter :: ik = selected_int_kind(38)
  !> Quad arithmetic is done lane by lane, so only the lanes in use are advanced.
  integer, parameter :: VECTOR = 1

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 2.0e-37 (Remez exchange in 60 digits).
  real(rk), parameter :: SINE_COEFFICIENTS(15) = [ &
    3.141592653589793238462643383279502883532_rk, &
    -5.167712780049970029246052511183564701846_rk, &
    2.550164039877345443856177583694957089303_rk, &
    -0.5992645293207920768877393835068616642283_rk, &
    0.08214588661112822879880236315174708582035_rk, &
    -0.007370430945714350777259003326394741828258_rk, &
    0.0004663028057676125644185609747807883215079_rk, &
    -0.00002191535344783021579350146212009327079687_rk, &
    0.000000795205400147550885914096243557670141671_rk, &
    -0.0000000229484289972666061083754099127608399681_rk, &
    0.00000000053926646624120950522012910621786683528_rk, &
    -0.00000000001051847163286054698546474514157174850106_rk, &
    1.730216732436752987243058139843180217786e-13_rk, &
    -2.432063529208364844949906009765956065802e-15_rk, &
    2.898000241925418772355479264841694691025e-17_rk]

  include 'tile.inc'
  include 'tile_stages.inc'
  include 'processed_tile.inc'
  include 'processed_tangent.inc'
  include 'processor.inc'

  !> The stages of a period of the processed splitting for the lanes 1 .. n.
  subroutine stages(n_drift, n_kick, n_stages, row, n, u, v)
    integer(c_int32_t), value :: n_drift
    integer(c_int32_t), value :: n_kick
    integer(c_int64_t), value :: n_stages
    real(rk), intent(in) :: row(n_drift + n_kick, n_stages)
    integer(c_int64_t), value :: n
    real(rk), intent(inout) :: u(WIDTH)
    real(rk), intent(inout) :: v(WIDTH)
    real(rk) :: r
    integer(c_int64_t) :: s
    integer :: i

    do s = 1, n_stages
      do i = 1, int(n)
        u(i) = u(i) + v(i)*polynomial(row(:n_drift, s), v(i)**2)
        r = u(i) - 2*((0.5_rk*u(i) + MAGIC) - MAGIC)
        v(i) = v(i) - (r - r**3)*polynomial(row(n_drift + 1:, s), r**2)
      end do
    end do
  end subroutine stages

  !> c(1) + c(2) x + c(3) x**2 + ..
  pure function polynomial(c, x) result(y)
    real(rk), intent(in) :: c(:)
    real(rk), intent(in) :: x
    real(rk) :: y
    integer :: j

    y = 0
    do j = size(c), 1, -1
      y = y*x + c(j)
    end do
  end function polynomial

end module kz_kernel_r128
