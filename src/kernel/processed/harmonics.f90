!> The harmonics of a kick as polynomials.
module kz_processed_harmonics
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_processed_series_r64, only: HARMONICS
  implicit none
  private
  public :: harmonic_polynomials

  integer, parameter :: qp = real128
  real(qp), parameter :: PI = 3.14159265358979323846264338327950288_qp

contains

  !> sin(pi j r)/(r (1 - r**2)) as polynomials in r**2 of n coefficients, interpolated at the Chebyshev nodes of [0, 1]: the
  !> kick is 0 at the two rest positions, exactly.
  pure function harmonic_polynomials(n) result(polynomial)
    !> coefficients
    integer, intent(in) :: n
    real(qp) :: polynomial(HARMONICS, n)
    real(qp) :: node(n), difference(n), root
    integer :: i, j, k

    node = [(0.5_qp*(1 + cos(PI*(2*i - 1)/(2*n))), i=1, n)]
    do j = 1, HARMONICS
      do i = 1, n
        root = sqrt(node(i))
        difference(i) = sin(PI*j*root)/(root*(1 - node(i)))
      end do
      do k = 1, n - 1
        difference(k + 1:) = (difference(k + 1:) - difference(k:n - 1))/(node(k + 1:) - node(:n - k))
      end do
      polynomial(j, :) = 0
      do k = n, 1, -1
        polynomial(j, 2:) = polynomial(j, :n - 1) - node(k)*polynomial(j, 2:)
        polynomial(j, 1) = difference(k) - node(k)*polynomial(j, 1)
      end do
    end do
  end function harmonic_polynomials

end module kz_processed_harmonics
