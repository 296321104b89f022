!> How far the image of an ellipse is from that of the tangent map: states on its rim are moved by the map itself.
module kz_labels_nonlinear
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_labels_carrier, only: carrier_t
  use kz_maps_matrices, only: axes_of
  implicit none
  private
  public :: measure_nonlinear, SAFETY

  !> Ellipses are so many times as large as the error that is carried.
  real(dp), parameter :: SAFETY = 3
  !> Both ends of three diameters.
  integer, parameter :: POINTS = 6
  real(dp), parameter :: HALF = sqrt(0.5_dp)
  real(dp), parameter :: DIAMETERS(2, 3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, HALF, HALF], [2, 3])
  !> Aspect ratio of an ellipse above which only the major axis is sampled: others add less by this factor.
  real(dp), parameter :: NARROW = 1000
  !> Terms beyond second order are at most half of the second-order terms.
  real(dp), parameter :: HIGHER = 1.5_dp

contains

  !> Nonlinear part of the image of the ellipse SAFETY**2 P, in units of SAFETY, rad. Along z of the unit disc it is q11
  !> z1**2 + 2 q12 z1 z2 + q22 z2**2, at most |q11| + |q12| + |q22|, and half as much again stands for higher orders.
  !> Errors that have grown lie along a line: then q11 is all of it.
  subroutine measure_nonlinear(carrier, lane, u, v, p, nonlinear)
    type(carrier_t), intent(inout) :: carrier !< has just moved them by a period
    integer, intent(in) :: lane(:) !< [n] lanes of it, and of what follows
    real(dp), intent(in) :: u(:), v(:) !< states before the period, half-turns, rad per drive radian
    real(dp), intent(in) :: p(:, :) !< (:, 3): ellipses before it
    real(dp), intent(inout) :: nonlinear(:) !< rad
    real(dp) :: rim(2, POINTS, size(lane)), by(2, 2, size(lane)), along(2, size(lane))
    integer :: wide(size(lane)), i, n

    n = 0
    do i = 1, size(lane)
      rim(:, :, i) = rim_of(p(lane(i), :))
      if (norm2(rim(:, 1, i)) > NARROW*norm2(rim(:, 3, i))) cycle
      n = n + 1
      wide(n) = i
    end do
    by = rim(:, :2, :)
    call carrier%flow%displace(lane, u, v, by)
    do i = 1, size(lane)
      along(:, i) = quadratic_of(carrier%tangent(lane(i), :), rim(:, :2, i), by(:, :, i))
      nonlinear(lane(i)) = HIGHER/SAFETY*length(along(:, i))
    end do
    if (n > 0) call add_across(carrier, lane(wide(:n)), u, v, rim(:, 3:, wide(:n)), along(:, wide(:n)), nonlinear)
  end subroutine measure_nonlinear

  !> Adds the other diameters' parts in some lanes.
  subroutine add_across(carrier, lane, u, v, rim, along, nonlinear)
    type(carrier_t), intent(inout) :: carrier
    integer, intent(in) :: lane(:)
    real(dp), intent(in) :: u(:), v(:), rim(:, :, :), along(:, :)
    real(dp), intent(inout) :: nonlinear(:)
    real(dp) :: by(2, POINTS - 2, size(lane)), across(2), oblique(2)
    integer :: i

    by = rim
    call carrier%flow%displace(lane, u, v, by)
    do i = 1, size(lane)
      across = quadratic_of(carrier%tangent(lane(i), :), rim(:, :2, i), by(:, :2, i))
      oblique = quadratic_of(carrier%tangent(lane(i), :), rim(:, 3:, i), by(:, 3:, i)) - 0.5_dp*(along(:, i) + across)
      nonlinear(lane(i)) = nonlinear(lane(i)) + HIGHER/SAFETY*(length(across) + length(oblique))
    end do
  end subroutine add_across

  !> The ends of the diameters of the ellipse SAFETY**2 P, rad.
  pure function rim_of(p) result(rim)
    real(dp), intent(in) :: p(3)
    real(dp) :: rim(2, POINTS), axes(3)

    axes = axes_of(p)
    rim(1, 1:5:2) = SAFETY*axes(1)*DIAMETERS(1, :)
    rim(2, 1:5:2) = SAFETY*(axes(2)*DIAMETERS(1, :) + axes(3)*DIAMETERS(2, :))
    rim(:, 2:6:2) = -rim(:, 1:5:2)
  end function rim_of

  !> Distance of a diameter's ends from their images by the tangent map; the larger one.
  pure function quadratic_of(tangent, start, by) result(q)
    real(dp), intent(in) :: tangent(4), start(2, 2), by(2, 2)
    real(dp) :: q(2), rest(2, 2)

    rest(1, :) = by(1, :) - (tangent(1)*start(1, :) + tangent(2)*start(2, :))
    rest(2, :) = by(2, :) - (tangent(3)*start(1, :) + tangent(4)*start(2, :))
    q = rest(:, merge(1, 2, sum(rest(:, 1)**2) > sum(rest(:, 2)**2)))
  end function quadratic_of

  pure real(dp) function length(x)
    real(dp), intent(in) :: x(2)

    length = sqrt(x(1)**2 + x(2)**2)
  end function length

end module kz_labels_nonlinear
