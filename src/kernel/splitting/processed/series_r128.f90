!> The series of the processed splitting in quad precision, for the grades that need more than doubles.
module kz_processed_series_r128
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_processed_pair_products, only: matrix_t => right_factor_t, set_matrix => set_right_factor, pair_product, &
                                        factors_t => bracket_factor_t, set_bracket_factor, pair_bracket
  use kz_model_pendulum, only: pendulum_t, sine_force, highest_harmonic
  implicit none
  private
  public :: series_t, make_series, ORDER

  integer, parameter :: ORDER = 10, HIGHEST = 14

  !> Products of quads by pairs of doubles.
  interface matmul
    procedure product_of
  end interface matmul

  include 'series.inc'

  subroutine set_factors(part)
    type(part_t), intent(inout) :: part

    call set_bracket_factor(part%value, part%slope, part%factors)
  end subroutine set_factors

  !> Adds factor*{f, g} to total, {f, g} = f_v g_theta - f_theta g_v; powers of v beyond those of total are 0.
  subroutine add_bracket(f, g, factor, total)
    type(part_t), intent(in) :: f, g
    real(rk), intent(in) :: factor
    real(rk), intent(inout) :: total(:, 0:)

    if (.not. (allocated(f%value) .and. allocated(g%value))) return
    call pair_bracket(f%factors, g%factors, factor, total)
  end subroutine add_bracket

  pure function product_of(left, right) result(product)
    real(rk), intent(in) :: left(:, :), right(:, :)
    real(rk) :: product(size(left, 1), size(right, 2))
    type(matrix_t) :: factor

    call set_matrix(right, factor)
    product = pair_product(left, factor)
  end function product_of

  pure subroutine multiply_matrix(n, n_columns, matrix, columns, product)
    integer, intent(in) :: n, n_columns
    real(rk), intent(in) :: matrix(n, n), columns(n, n_columns)
    real(rk), intent(out) :: product(n, n_columns)

    product = matmul(matrix, columns)
  end subroutine multiply_matrix

  subroutine add_time_derivative(grid, n, value, factor, total)
    type(grid_t), intent(in) :: grid
    integer, intent(in) :: n
    real(rk), intent(in) :: value(n, grid%n_time), factor
    real(rk), intent(inout) :: total(n, grid%n_time)

    total = total + factor*pair_product(value, grid%time_derivative)
  end subroutine add_time_derivative

end module kz_processed_series_r128
