!> Spreads the errors of many orbits over a period. A file of its own: not inlined, its loop is vectorised.
module kz_labels_spread
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: WIDTH, CAPACITY
  implicit none
  private
  public :: spread_errors, add_ellipse, flag_between, flag_done

contains

  !> The matrices P of error ellipses after a period. The tangent T takes an ellipse to one of the matrix S = T P T'.
  !> The errors of the period add a vector of any direction: a disc of the matrix D. For any x > 0 the ellipse of (1 +
  !> 1/x) S + (1 + x) D holds all sums of a vector of each; its trace is least at x**2 = tr S/tr D.
  pure subroutine spread_errors(n, tangent, noise, nonlinear, p, trace)
    integer, intent(in) :: n !< lanes
    real(dp), intent(in) :: tangent(WIDTH, 4) !< (WIDTH, 4): d angle by angle and velocity, d velocity by both
    real(dp), intent(in) :: noise(WIDTH) !< noise of the period, rad
    real(dp), intent(in) :: nonlinear(WIDTH) !< nonlinear part of the period, rad
    real(dp), intent(inout) :: p(CAPACITY, 3) !< theta theta, theta v, v v: rad, rad per drive radian
    real(dp), intent(out) :: trace(WIDTH) !< trace of P; NaN for a lost orbit
    real(dp) :: s1, s2, s3, t1, t2, t3, t4, size, square, x
    integer :: i

    do i = 1, n
      t1 = tangent(i, 1)*p(i, 1) + tangent(i, 2)*p(i, 2)
      t2 = tangent(i, 1)*p(i, 2) + tangent(i, 2)*p(i, 3)
      t3 = tangent(i, 3)*p(i, 1) + tangent(i, 4)*p(i, 2)
      t4 = tangent(i, 3)*p(i, 2) + tangent(i, 4)*p(i, 3)
      s1 = t1*tangent(i, 1) + t2*tangent(i, 2)
      s2 = t3*tangent(i, 1) + t4*tangent(i, 2)
      s3 = t3*tangent(i, 3) + t4*tangent(i, 4)
      size = s1 + s3
      square = (noise(i) + nonlinear(i))**2
      x = sqrt(size/(2*square) + 1e-6_dp)
      square = (1 + x)*square
      x = 1 + 1/x
      p(i, 1) = x*s1 + square
      p(i, 2) = x*s2
      p(i, 3) = x*s3 + square
      trace(i) = p(i, 1) + p(i, 3)
    end do
  end subroutine spread_errors

  !> 1 for the lanes whose P has at least a trace but not another one; else 0.
  pure subroutine flag_between(n, p, least, most, between)
    integer, intent(in) :: n !< lanes
    real(dp), intent(in) :: p(CAPACITY, 3) !< as above
    real(dp), intent(in) :: least, most !< the bounds
    integer, intent(inout) :: between(WIDTH) !< flags
    integer :: i

    do i = 1, n
      between(i) = int(merge(1.0_dp, 0.0_dp, p(i, 1) + p(i, 3) < most) &
                       - merge(1.0_dp, 0.0_dp, p(i, 1) + p(i, 3) < least))
    end do
  end subroutine flag_between

  !> 1 for the lanes that are in a region, or whose P has at least a trace, or is lost; else 0.
  pure subroutine flag_done(n, region, trace, largest, done)
    integer, intent(in) :: n !< lanes
    integer, intent(in) :: region(WIDTH) !< 0 = in none
    real(dp), intent(in) :: trace(WIDTH) !< trace of P
    real(dp), intent(in) :: largest !< the bound
    integer, intent(inout) :: done(WIDTH) !< flags
    integer :: i

    do i = 1, n
      done(i) = min(1, region(i) + int(merge(0.0_dp, 1.0_dp, trace(i) < largest)))
    end do
  end subroutine flag_done

  !> The smallest ellipse that holds the sum of P and of a disc.
  pure subroutine add_ellipse(radius, p)
    real(dp), intent(in) :: radius !< rad
    real(dp), intent(inout) :: p(3) !< theta theta, theta v, v v
    real(dp) :: x

    if (.not. radius > 0) return
    if (.not. p(1) + p(3) > 0) then
      p = radius**2*[1, 0, 1]
      return
    end if
    x = sqrt((p(1) + p(3))/(2*radius**2) + 1e-6_dp)
    p = (1 + 1/x)*p + (1 + x)*radius**2*[1, 0, 1]
  end subroutine add_ellipse

end module kz_labels_spread
