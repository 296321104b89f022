!> Where a map of the plane, known at the corners of a triangle, leaves a point in place: the zeros of its displacement, by linear
!> interpolation. Seeds for Newton's method.
module kz_saddles_zeros
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: PI
  implicit none
  private
  public :: triangle_zeros

  !> A zero may lie so far outside its triangle, in units of the triangle: the displacement is not linear.
  real(dp), parameter :: MARGIN = 0.3_dp

contains

  !> Appends the zeros of `shift` - (2 pi w, 0) over the triangle with the corners x for every whole w; at most what fits.
  pure subroutine triangle_zeros(x, shift, n, zero)
    !> corners: half-turns, rad per drive radian
    real(dp), intent(in) :: x(2, 3)
    !> displacement of each corner, not wrapped: rad, rad per drive radian
    real(dp), intent(in) :: shift(2, 3)
    !> zeros so far, in and out
    integer, intent(inout) :: n
    !> the zeros, as the corners
    real(dp), intent(inout) :: zero(:, :)
    real(dp) :: edge(2, 2), value(2), share(2), determinant, reach
    integer :: w

    edge(:, 1) = shift(:, 2) - shift(:, 1)
    edge(:, 2) = shift(:, 3) - shift(:, 1)
    determinant = edge(1, 1)*edge(2, 2) - edge(1, 2)*edge(2, 1)
    reach = 2*MARGIN*maxval(abs(edge(2, :)))
    if (minval(shift(2, :)) > reach .or. maxval(shift(2, :)) < -reach) return
    reach = 2*MARGIN*maxval(abs(edge(1, :)))
    do w = ceiling((minval(shift(1, :)) - reach)/(2*PI)), floor((maxval(shift(1, :)) + reach)/(2*PI))
      value = [2*PI*w, 0.0_dp] - shift(:, 1)
      share = [edge(2, 2)*value(1) - edge(1, 2)*value(2), edge(1, 1)*value(2) - edge(2, 1)*value(1)]/determinant
      if (.not. (all(share >= -MARGIN) .and. sum(share) <= 1 + MARGIN)) cycle
      if (n == size(zero, 2)) return
      n = n + 1
      zero(:, n) = x(:, 1) + share(1)*(x(:, 2) - x(:, 1)) + share(2)*(x(:, 3) - x(:, 1))
    end do
  end subroutine triangle_zeros

end module kz_saddles_zeros
