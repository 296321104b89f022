!> Matrices of 2 rows and columns: derivatives of the map, axes of ellipses; larger systems of equations.
module kz_maps_matrices
  use, intrinsic :: iso_c_binding, only: dp => c_double
  implicit none
  private
  public :: inverse_of, solved, eigenvalues, eigenvector, axes_of, solve

  real(dp), parameter, public :: IDENTITY(2, 2) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [2, 2])

  !> The equations' pivots are of order 1 unless they are singular.
  real(dp), parameter :: SINGULAR = 1e-12_dp

contains

  !> The inverse of a regular matrix.
  pure function inverse_of(matrix) result(inverse)
    real(dp), intent(in) :: matrix(2, 2) !< a regular matrix
    real(dp) :: inverse(2, 2)

    inverse = reshape([matrix(2, 2), -matrix(2, 1), -matrix(1, 2), matrix(1, 1)], [2, 2]) &
              /(matrix(1, 1)*matrix(2, 2) - matrix(1, 2)*matrix(2, 1))
  end function inverse_of

  !> Solves (matrix - 1) step = residual.
  pure function solved(matrix, residual) result(step)
    real(dp), intent(in) :: matrix(2, 2) !< derivative of the map, 1 more than the matrix of the equations
    real(dp), intent(in) :: residual(2) !< their right-hand side
    real(dp) :: step(2), a, b, c, d

    a = matrix(1, 1) - 1
    b = matrix(1, 2)
    c = matrix(2, 1)
    d = matrix(2, 2) - 1
    step = [d*residual(1) - b*residual(2), a*residual(2) - c*residual(1)]/(a*d - b*c)
  end function solved

  !> Eigenvalues of a matrix of known determinant: the larger modulus first, then the positive imaginary part first.
  pure function eigenvalues(matrix, determinant) result(values)
    real(dp), intent(in) :: matrix(2, 2) !< derivative of the map, for (rad, rad per drive radian)
    real(dp), intent(in) :: determinant !< its determinant, which is known better than from the matrix
    complex(dp) :: values(2)
    real(dp) :: half, root

    half = 0.5_dp*(matrix(1, 1) + matrix(2, 2))
    root = half**2 - determinant
    if (root < 0) then
      values = [cmplx(half, sqrt(-root), dp), cmplx(half, -sqrt(-root), dp)]
    else
      half = half + sign(sqrt(root), half)
      values(1) = half
      values(2) = 0
      if (abs(half) > 0) values(2) = determinant/half
    end if
  end function eigenvalues

  !> An eigenvector, from the row of (matrix - mu) that is the larger.
  pure function eigenvector(matrix, mu) result(w)
    real(dp), intent(in) :: matrix(2, 2) !< any matrix
    complex(dp), intent(in) :: mu !< one of its eigenvalues
    complex(dp) :: w(2)

    if (abs(matrix(1, 1) - mu) + abs(matrix(1, 2)) >= abs(matrix(2, 2) - mu) + abs(matrix(2, 1))) then
      w = [cmplx(matrix(1, 2), 0, dp), mu - matrix(1, 1)]
    else
      w = [mu - matrix(2, 2), cmplx(matrix(2, 1), 0, dp)]
    end if
    if (abs(w(1)) + abs(w(2)) <= 0) w = 1
  end function eigenvector

  !> The ellipse x' P**-1 x <= 1 consists of the points (axes(1) c, axes(2) c + axes(3) s) with c**2 + s**2 <= 1.
  pure function axes_of(p) result(axes)
    real(dp), intent(in) :: p(3) !< entries 1 1, 1 2, 2 2 of the symmetric matrix P
    real(dp) :: axes(3)

    axes(1) = sqrt(p(1))
    axes(2) = merge(p(2)/axes(1), 0.0_dp, axes(1) > 0)
    axes(3) = sqrt(max(0.0_dp, p(3) - axes(2)**2))
  end function axes_of

  !> Solves matrix x = side by elimination with row pivots; x takes the place of side where the matrix is regular.
  pure subroutine solve(matrix, side, regular)
    real(dp), intent(inout) :: matrix(:, :) !< the equations; comes back in use
    real(dp), intent(inout) :: side(:, :) !< their right-hand sides, then the solutions
    logical, intent(out) :: regular !< whether all pivots are above SINGULAR
    integer :: n, i, j, pivot

    n = size(matrix, 1)
    regular = .true.
    do i = 1, n
      pivot = i - 1 + maxloc(abs(matrix(i:, i)), 1)
      regular = abs(matrix(pivot, i)) > SINGULAR
      if (.not. regular) return
      if (pivot /= i) then
        matrix([i, pivot], i:) = matrix([pivot, i], i:)
        side([i, pivot], :) = side([pivot, i], :)
      end if
      matrix(i + 1:, i) = matrix(i + 1:, i)/matrix(i, i)
      do j = i + 1, n
        matrix(i + 1:, j) = matrix(i + 1:, j) - matrix(i, j)*matrix(i + 1:, i)
      end do
      do j = 1, size(side, 2)
        side(i + 1:, j) = side(i + 1:, j) - side(i, j)*matrix(i + 1:, i)
      end do
    end do
    do i = n, 1, -1
      side(i, :) = side(i, :)/matrix(i, i)
      do j = 1, size(side, 2)
        side(:i - 1, j) = side(:i - 1, j) - side(i, j)*matrix(:i - 1, i)
      end do
    end do
  end subroutine solve

end module kz_maps_matrices
