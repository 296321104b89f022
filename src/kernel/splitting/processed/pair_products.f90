!> Products of matrices and polynomials of quads by pairs of doubles (32 digits), fifty times as fast as by quads.
module kz_processed_pair_products
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  implicit none
  private
  public :: right_factor_t, right_factor, set_right_factor, pair_product, bracket_factor_t, set_bracket_factor, &
            pair_bracket, pair_of

  integer, parameter :: qp = real128
  !> Lanes of the longest vectors, of which the columns of a right factor are a multiple.
  integer, parameter :: COLUMNS = 8

  !> A matrix as the right factor of products.
  type :: right_factor_t
    integer :: n_columns = 0
    real(c_double), allocatable :: row(:, :, :) !< (n_columns and more, 2, rows): high and low parts
  end type right_factor_t

  !> A polynomial in v at many points, and its derivative by theta, as brackets take them.
  type :: bracket_factor_t
    integer :: n_points = 0
    real(c_double), allocatable :: value(:, :, :) !< (n_points and more, 2, 0:degree): high and low parts
    real(c_double), allocatable :: slope(:, :, :)
  end type bracket_factor_t

  interface
    !> pair_products.c
    pure subroutine bracket_pairs(n, top_f, top_g, top, f, f_slope, g, g_slope, bracket) bind(C, name='kz_pair_bracket')
      import :: c_double, c_int64_t
      integer(c_int64_t), intent(in), value :: n, top_f, top_g, top
      real(c_double), intent(in) :: f(*), f_slope(*), g(*), g_slope(*)
      real(c_double), intent(out) :: bracket(*)
    end subroutine bracket_pairs

    !> pair_products.c
    pure subroutine split_bits(n, x, high, low) bind(C, name='kz_pairs_split')
      import :: c_double, c_int64_t
      integer(c_int64_t), intent(in), value :: n
      integer(c_int64_t), intent(in) :: x(2, *)
      real(c_double), intent(out) :: high(*), low(*)
    end subroutine split_bits

    !> pair_products.c
    pure subroutine join_bits(n, high, low, x) bind(C, name='kz_pairs_join')
      import :: c_double, c_int64_t
      integer(c_int64_t), intent(in), value :: n
      real(c_double), intent(in) :: high(*), low(*)
      integer(c_int64_t), intent(out) :: x(2, *)
    end subroutine join_bits

    !> pair_products.c
    pure subroutine multiply_pairs(rows, inner, columns, left, right, product) bind(C, name='kz_pair_product')
      import :: c_double, c_int64_t
      integer(c_int64_t), intent(in), value :: rows, inner, columns
      real(c_double), intent(in) :: left(*), right(*)
      real(c_double), intent(out) :: product(*)
    end subroutine multiply_pairs
  end interface

contains

  !> Rounds a number to the nearest sum of two doubles, high and low.
  pure function pair_of(x) result(pair)
    real(qp), intent(in) :: x !< a number
    real(c_double) :: pair(2)

    pair(1) = real(x, c_double)
    pair(2) = real(x - pair(1), c_double)
  end function pair_of

  !> Splits numbers into sums of two doubles.
  pure subroutine split_quads(x, high, low)
    real(qp), intent(in) :: x(:)
    real(c_double), intent(inout) :: high(:), low(:)

    call split_bits(size(x, kind=c_int64_t), reshape(transfer(x, [0_c_int64_t]), [2, size(x)]), high, low)
  end subroutine split_quads

  !> Joins sums of two doubles to numbers.
  pure function join_quads(n, high, low) result(x)
    integer, intent(in) :: n
    real(c_double), intent(in) :: high(:), low(:)
    real(qp) :: x(n)
    integer(c_int64_t) :: bits(2, n)

    call join_bits(int(n, c_int64_t), high, low, bits)
    x = transfer(bits, x)
  end function join_quads

  !> Rounds up to a multiple of COLUMNS.
  pure integer function padded_columns(n)
    integer, intent(in) :: n

    padded_columns = COLUMNS*((n + COLUMNS - 1)/COLUMNS)
  end function padded_columns

  !> Allocates a right factor of zeros.
  pure subroutine right_factor(n_rows, n_columns, factor)
    integer, intent(in) :: n_rows, n_columns !< its size
    type(right_factor_t), intent(out) :: factor !< Factor of zeros

    factor%n_columns = n_columns
    allocate (factor%row(padded_columns(n_columns), 2, n_rows), source=0.0_c_double)
  end subroutine right_factor

  !> Converts a matrix to a right factor.
  pure subroutine set_right_factor(matrix, factor)
    real(qp), intent(in) :: matrix(:, :) !< its numbers
    type(right_factor_t), intent(out) :: factor !< Pairs of its numbers
    integer :: i

    call right_factor(size(matrix, 1), size(matrix, 2), factor)
    do i = 1, size(matrix, 1)
      call split_quads(matrix(i, :), factor%row(:, 1, i), factor%row(:, 2, i))
    end do
  end subroutine set_right_factor

  !> Multiplies two matrices; errors are at most some 2**-103 of the sum of the moduli of the terms.
  pure function pair_product(left, right) result(product)
    real(qp), intent(in) :: left(:, :) !< (rows, inner)
    type(right_factor_t), intent(in) :: right !< inner rows
    real(qp) :: product(size(left, 1), right%n_columns)
    real(c_double) :: pairs(size(left, 2), 2, size(left, 1)), sums(size(right%row, 1), 2, size(left, 1))
    integer :: i

    do i = 1, size(left, 1)
      call split_quads(left(i, :), pairs(:, 1, i), pairs(:, 2, i))
    end do
    call multiply_pairs(int(size(left, 1), c_int64_t), int(size(left, 2), c_int64_t), &
                        int(size(right%row, 1), c_int64_t), pairs, right%row, sums)
    do i = 1, size(left, 1)
      product(i, :) = join_quads(right%n_columns, sums(:, 1, i), sums(:, 2, i))
    end do
  end function pair_product

  !> Converts a polynomial to a factor of brackets.
  subroutine set_bracket_factor(value, slope, factor)
    real(qp), intent(in) :: value(:, 0:) !< (points, 0:degree): coefficients of powers of v
    real(qp), intent(in) :: slope(:, 0:) !< their derivatives by theta
    type(bracket_factor_t), intent(inout) :: factor !< Pairs of its coefficients
    integer :: n

    factor%n_points = size(value, 1)
    if (allocated(factor%value)) deallocate (factor%value, factor%slope)
    allocate (factor%value(padded_columns(size(value, 1)), 2, 0:ubound(value, 2)), source=0.0_c_double)
    allocate (factor%slope, source=factor%value)
    do n = 0, ubound(value, 2)
      call split_quads(value(:, n), factor%value(:, 1, n), factor%value(:, 2, n))
      call split_quads(slope(:, n), factor%slope(:, 1, n), factor%slope(:, 2, n))
    end do
  end subroutine set_bracket_factor

  !> total += weight*(f_v g_theta - f_theta g_v); powers of v beyond those of total are left out.
  subroutine pair_bracket(f, g, weight, total)
    type(bracket_factor_t), intent(in) :: f, g
    real(qp), intent(in) :: weight !< 1 or -1
    real(qp), intent(inout) :: total(:, 0:) !< (points, 0:degree)
    real(c_double) :: bracket(size(f%value, 1), 2, 0:ubound(f%value, 3) + ubound(g%value, 3))
    real(qp) :: coefficient(f%n_points)
    integer :: n, top

    top = min(ubound(total, 2), ubound(f%value, 3) + ubound(g%value, 3) - 1)
    call bracket_pairs(int(size(f%value, 1), c_int64_t), int(ubound(f%value, 3), c_int64_t), &
                       int(ubound(g%value, 3), c_int64_t), int(top, c_int64_t), &
                       f%value, f%slope, g%value, g%slope, bracket)
    do n = 0, top
      coefficient = join_quads(f%n_points, bracket(:, 1, n), bracket(:, 2, n))
      if (weight > 0) total(:, n) = total(:, n) + coefficient
      if (weight < 0) total(:, n) = total(:, n) - coefficient
    end do
  end subroutine pair_bracket

end module kz_processed_pair_products
