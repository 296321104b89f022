!> The tile in quad precision.
module kz_kernel_r128
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_lanes_map, only: flow_t, put_state, move_state, WIDTH, ROOM
  use kz_processed_tables, only: processed_t, processor_t, ORDER, HARMONICS
  use kz_extended_pairs_level, only: SINE_COEFFICIENTS
  use kz_lanes_step_table, only: period_t, INVERSE_PI_QUAD
  implicit none
  private
  public :: make_tile, make_processed_tile, sine

  integer, parameter :: ik = selected_int_kind(38)
  !> Quad arithmetic is done lane by lane, so only the lanes in use are advanced.
  integer, parameter :: VECTOR = 1

  include 'split/tile.inc'
  include 'split/tile_stages.inc'
  include 'processed/tile.inc'
  include 'processed/tangent.inc'
  include 'processed/processor.inc'

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
