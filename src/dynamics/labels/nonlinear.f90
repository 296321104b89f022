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

contains

  !> What the image of the ellipse SAFETY**2 P has beyond that of the tangent map, in parts of SAFETY, rad. Along z of the unit disc it is
  !> q11 z1**2 + 2 q12 z1 z2 + q22 z2**2, at most |q11| + |q12| + |q22|, and half as much again stands for what is of higher order.
  subroutine measure_nonlinear(carrier, lane, u, v, p, nonlinear)
    type(carrier_t), intent(inout) :: carrier !< has just moved them by a period
    integer, intent(in) :: lane(:) !< [n] lanes of it, and of what follows
    real(dp), intent(in) :: u(:), v(:) !< states before the period, half-turns, rad per drive radian
    real(dp), intent(in) :: p(:, :) !< (:, 3): ellipses before it
    real(dp), intent(inout) :: nonlinear(:) !< rad
    real(dp) :: by(2, POINTS, size(lane)), start(2, POINTS, size(lane))
    integer :: i

    do i = 1, size(lane)
      start(:, :, i) = rim_of(p(lane(i), :))
    end do
    by = start
    call carrier%flow%displace(lane, u, v, by)
    do i = 1, size(lane)
      nonlinear(lane(i)) = nonlinear_of(carrier%tangent(lane(i), :), start(:, :, i), by(:, :, i))/SAFETY
    end do
  end subroutine measure_nonlinear

  !> The ends of the diameters of the ellipse SAFETY**2 P, rad.
  pure function rim_of(p) result(rim)
    real(dp), intent(in) :: p(3)
    real(dp) :: rim(2, POINTS)
    real(dp) :: axes(3)

    axes = axes_of(p)
    rim(1, 1:5:2) = SAFETY*axes(1)*DIAMETERS(1, :)
    rim(2, 1:5:2) = SAFETY*(axes(2)*DIAMETERS(1, :) + axes(3)*DIAMETERS(2, :))
    rim(:, 2:6:2) = -rim(:, 1:5:2)
  end function rim_of

  !> From the ends of the diameters before and after the period.
  pure function nonlinear_of(tangent, start, by) result(nonlinear)
    real(dp), intent(in) :: tangent(4), start(2, POINTS), by(2, POINTS)
    real(dp) :: nonlinear
    real(dp) :: rest(2, POINTS), size(POINTS), q(2, 3)
    integer :: j

    rest(1, :) = by(1, :) - (tangent(1)*start(1, :) + tangent(2)*start(2, :))
    rest(2, :) = by(2, :) - (tangent(3)*start(1, :) + tangent(4)*start(2, :))
    size = rest(1, :)**2 + rest(2, :)**2
    do j = 1, 3
      q(:, j) = rest(:, merge(2*j - 1, 2*j, size(2*j - 1) > size(2*j)))
    end do
    nonlinear = 1.5_dp*(length(q(:, 1)) + length(q(:, 2)) + length(q(:, 3) - 0.5_dp*(q(:, 1) + q(:, 2))))
  end function nonlinear_of

  pure real(dp) function length(x)
    real(dp), intent(in) :: x(2)

    length = sqrt(x(1)**2 + x(2)**2)
  end function length

end module kz_labels_nonlinear
