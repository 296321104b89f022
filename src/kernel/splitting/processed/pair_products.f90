!> Products of matrices of quads by pairs of doubles, some 32 digits, in a fiftieth of the time: a product of quads is a library's.
module kz_processed_pair_products
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  implicit none
  private
  public :: right_factor_t, right_factor, set_right_factor, pair_product, pair_of

  integer, parameter :: qp = real128
  !> Columns of a right factor are a multiple of it: lanes of the longest vectors.
  integer, parameter :: COLUMNS = 8

  !> A matrix as the right factor of products.
  type :: right_factor_t
    integer :: n_columns = 0
    real(c_double), allocatable :: row(:, :, :) !< (n_columns and more, 2, rows): high and low parts
  end type right_factor_t

  interface
    !> pair_products.c
    pure subroutine multiply_pairs(rows, inner, columns, left, right, product) bind(C, name='kz_pair_product')
      import :: c_double, c_int64_t
      integer(c_int64_t), intent(in), value :: rows, inner, columns
      real(c_double), intent(in) :: left(*), right(*)
      real(c_double), intent(out) :: product(*)
    end subroutine multiply_pairs
  end interface

contains

  !> The sum of two doubles, high and low, that is nearest to a number.
  pure function pair_of(x) result(pair)
    real(qp), intent(in) :: x !< a number
    real(c_double) :: pair(2)

    pair(1) = real(x, c_double)
    pair(2) = real(x - pair(1), c_double)
  end function pair_of

  !> Space for a right factor; columns that fill it up are 0.
  pure subroutine right_factor(n_rows, n_columns, factor)
    integer, intent(in) :: n_rows, n_columns !< its size
    type(right_factor_t), intent(out) :: factor !< of zeros

    factor%n_columns = n_columns
    allocate (factor%row(COLUMNS*((n_columns + COLUMNS - 1)/COLUMNS), 2, n_rows), source=0.0_c_double)
  end subroutine right_factor

  !> A matrix as a right factor.
  pure subroutine set_right_factor(matrix, factor)
    real(qp), intent(in) :: matrix(:, :) !< its numbers
    type(right_factor_t), intent(out) :: factor !< the same as pairs
    integer :: i, j

    call right_factor(size(matrix, 1), size(matrix, 2), factor)
    do j = 1, size(matrix, 2)
      do i = 1, size(matrix, 1)
        factor%row(j, :, i) = pair_of(matrix(i, j))
      end do
    end do
  end subroutine set_right_factor

  !> The product of two matrices; the error of a number is at most some 2**-103 of the sum of the moduli of its terms.
  pure function pair_product(left, right) result(product)
    real(qp), intent(in) :: left(:, :) !< (rows, inner)
    type(right_factor_t), intent(in) :: right !< inner rows
    real(qp) :: product(size(left, 1), right%n_columns)
    real(c_double) :: pairs(2, size(left, 2), size(left, 1)), sums(size(right%row, 1), 2, size(left, 1))
    integer :: i, k

    do i = 1, size(left, 1)
      do k = 1, size(left, 2)
        pairs(:, k, i) = pair_of(left(i, k))
      end do
    end do
    call multiply_pairs(int(size(left, 1), c_int64_t), int(size(left, 2), c_int64_t), int(size(right%row, 1), c_int64_t), pairs, &
                        right%row, sums)
    do i = 1, size(left, 1)
      product(i, :) = real(sums(:right%n_columns, 1, i), qp) + sums(:right%n_columns, 2, i)
    end do
  end function pair_product

end module kz_processed_pair_products
