!> Harmonics of a kick as polynomials.
module kz_processed_harmonics
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_processed_series_r64, only: HARMONICS
  implicit none
  private
  public :: sine_polynomials, cosine_polynomials

  integer, parameter :: qp = real128
  real(qp), parameter :: PI = 3.14159265358979323846264338327950288_qp

contains

  !> sin(pi j r)/(r (1 - r**2)) as polynomials in r**2 of n coefficients, interpolated at the Chebyshev nodes of [0, 1],
  !> so that the kick is exactly 0 at the two equilibria.
  pure function sine_polynomials(n) result(polynomial)
    integer, intent(in) :: n !< coefficients
    real(qp) :: polynomial(HARMONICS, n), node(n), root(n)
    integer :: j

    node = nodes_of(n)
    root = sqrt(node)
    do j = 1, HARMONICS
      polynomial(j, :) = interpolating_polynomial(node, sin(PI*j*root)/(root*(1 - node)))
    end do
  end function sine_polynomials

  !> cos(pi j r) as polynomials in r**2 of n coefficients, interpolated likewise.
  pure function cosine_polynomials(n) result(polynomial)
    integer, intent(in) :: n !< coefficients
    real(qp) :: polynomial(0:HARMONICS, n), node(n)
    integer :: j

    node = nodes_of(n)
    do j = 0, HARMONICS
      polynomial(j, :) = interpolating_polynomial(node, cos(PI*j*sqrt(node)))
    end do
  end function cosine_polynomials

  !> The Chebyshev nodes of [0, 1].
  pure function nodes_of(n) result(node)
    integer, intent(in) :: n
    real(qp) :: node(n)
    integer :: i

    node = [(0.5_qp*(1 + cos(PI*(2*i - 1)/(2*n))), i=1, n)]
  end function nodes_of

  !> The polynomial with given values at the nodes, by divided differences.
  pure function interpolating_polynomial(node, value) result(polynomial)
    real(qp), intent(in) :: node(:), value(:)
    real(qp) :: polynomial(size(node)), difference(size(node))
    integer :: k, n

    n = size(node)
    difference = value
    do k = 1, n - 1
      difference(k + 1:) = (difference(k + 1:) - difference(k:n - 1))/(node(k + 1:) - node(:n - k))
    end do
    polynomial = 0
    do k = n, 1, -1
      polynomial(2:) = polynomial(:n - 1) - node(k)*polynomial(2:)
      polynomial(1) = difference(k) - node(k)*polynomial(1)
    end do
  end function interpolating_polynomial

end module kz_processed_harmonics
