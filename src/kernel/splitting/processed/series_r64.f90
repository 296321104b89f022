!> The series of the processed splitting in double precision.
module kz_processed_series_r64
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, sine_force, highest_harmonic
  implicit none
  private
  public :: series_t, make_series, ORDER, HARMONICS

  integer, parameter :: ORDER = 14, HIGHEST = ORDER

  !> A matrix of the grid.
  type :: matrix_t
    real(rk), allocatable :: entry(:, :)
  end type matrix_t

  !> No further form of a part for products.
  type :: factors_t
  end type factors_t

  include 'series.inc'

  pure subroutine set_factors(part)
    type(part_t), intent(inout) :: part

    part%factors = factors_t()
  end subroutine set_factors

  !> Adds factor*{f, g} to total, {f, g} = f_v g_theta - f_theta g_v; powers of v beyond those of total are 0.
  subroutine add_bracket(f, g, factor, total)
    type(part_t), intent(in) :: f, g
    real(rk), intent(in) :: factor
    real(rk), intent(inout) :: total(:, 0:)
    integer :: a, b, top

    if (.not. (allocated(f%value) .and. allocated(g%value))) return
    top = ubound(total, 2)
    do b = 0, ubound(g%value, 2)
      do a = 0, min(ubound(f%value, 2), top + 1 - b)
        if (a > 0) total(:, a + b - 1) = total(:, a + b - 1) + (factor*a)*f%value(:, a)*g%slope(:, b)
        if (b > 0) total(:, a + b - 1) = total(:, a + b - 1) - (factor*b)*f%slope(:, a)*g%value(:, b)
      end do
    end do
  end subroutine add_bracket

  pure subroutine set_matrix(entry, matrix)
    real(rk), intent(in) :: entry(:, :)
    type(matrix_t), intent(out) :: matrix

    matrix%entry = entry
  end subroutine set_matrix

  !> Multiplies matrix*columns, because the library's matmul is slow for matrices of this size.
  pure subroutine multiply_matrix(n, n_columns, matrix, columns, product)
    integer, intent(in) :: n, n_columns
    real(rk), intent(in) :: matrix(n, n), columns(n, n_columns)
    real(rk), intent(out) :: product(n, n_columns)
    integer :: i

    product = 0
    do i = 1, n_columns
      call add_columns(n, n, matrix, columns(:, i), product(:, i))
    end do
  end subroutine multiply_matrix

  !> Adds columns*factors to total. For both kinds of grid the compiler knows the size and keeps the sum in registers.
  pure subroutine add_columns(n, n_columns, columns, factors, total)
    integer, intent(in) :: n, n_columns
    real(rk), intent(in) :: columns(n, n_columns), factors(n_columns)
    real(rk), intent(inout) :: total(n)
    real(rk) :: half(HARMONICS + 1), whole(2*HARMONICS + 1)
    integer :: j

    if (n == size(half)) then
      half = total
      do j = 1, n_columns
        half = half + columns(:size(half), j)*factors(j)
      end do
      total = half
    else if (n == size(whole)) then
      whole = total
      do j = 1, n_columns
        whole = whole + columns(:size(whole), j)*factors(j)
      end do
      total = whole
    else
      total = total + matmul(columns, factors)
    end if
  end subroutine add_columns

  subroutine add_time_derivative(grid, n, value, factor, total)
    type(grid_t), intent(in) :: grid
    integer, intent(in) :: n
    real(rk), intent(in) :: value(n, grid%n_time), factor
    real(rk), intent(inout) :: total(n, grid%n_time)
    integer :: i

    do i = 1, grid%n_time
      call add_columns(n, grid%n_time, value, factor*grid%time_derivative%entry(:, i), total(:, i))
    end do
  end subroutine add_time_derivative

end module kz_processed_series_r64
