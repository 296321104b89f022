!> How far the image of an ellipse is from that of the tangent map: states on its rim are moved by the map itself.
module kz_labels_bending
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: flow_t, WIDTH, PI
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: measure_bending, SAFETY

  !> Ellipses are so many times as large as the error that is carried.
  real(dp), parameter :: SAFETY = 3
  !> The centre of an ellipse, and both ends of three diameters.
  integer, parameter :: POINTS = 7, TOGETHER = floor(WIDTH/real(POINTS))
  real(dp), parameter :: HALF = sqrt(0.5_dp)
  real(dp), parameter :: DIAMETERS(2, 3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, HALF, HALF], [2, 3])

contains

  !> What the image of the ellipse SAFETY**2 P has beyond that of the tangent map, in parts of SAFETY, rad. Along z of the unit disc it is
  !> q11 z1**2 + 2 q12 z1 z2 + q22 z2**2, at most |q11| + |q12| + |q22|, and half as much again stands for what is of higher order.
  subroutine measure_bending(flow, n, lane, u, v, tangent, p, bent)
    !> the map; its lanes are overwritten
    class(flow_t), intent(inout) :: flow
    !> ellipses
    integer, intent(in) :: n
    !> [n] their places in what follows
    integer, intent(in) :: lane(:)
    !> states before the period, half-turns
    real(dp), intent(in) :: u(:)
    !> rad per drive radian
    real(dp), intent(in) :: v(:)
    !> (:, 4): of the period
    real(dp), intent(in) :: tangent(:, :)
    !> (:, 3): before it
    real(dp), intent(in) :: p(:, :)
    !> rad
    real(dp), intent(inout) :: bent(:)
    integer :: first, last, i, k

    do first = 1, n, TOGETHER
      last = min(n, first + TOGETHER - 1)
      do i = first, last
        associate (k => lane(i))
          call put_points(flow, POINTS*(i - first), u(k), v(k), axes_of(p(k, :)))
        end associate
      end do
      call flow%advance(POINTS*(last - first + 1))
      do i = first, last
        k = lane(i)
        bent(k) = bending(flow, POINTS*(i - first), tangent(k, :), axes_of(p(k, :)))/SAFETY
      end do
    end do
  end subroutine measure_bending

  !> Two half-axes whose unit disc is the ellipse SAFETY**2 P, rad.
  pure function axes_of(p) result(axes)
    real(dp), intent(in) :: p(3)
    real(dp) :: axes(2, 2)

    axes(:, 1) = [sqrt(p(1)), p(2)/sqrt(p(1))]
    axes(:, 2) = [0.0_dp, sqrt(max(0.0_dp, p(3) - axes(2, 1)**2))]
    axes = SAFETY*axes
  end function axes_of

  subroutine put_points(flow, before, u, v, axes)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: before
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    real(dp), intent(in) :: axes(2, 2)
    real(dp) :: by(2)
    integer :: j

    call flow%put(before + 1, u, v)
    do j = 1, 3
      by = matmul(axes, DIAMETERS(:, j))
      call flow%put(before + 2*j, u + by(1)/PI, v + by(2))
      call flow%put(before + 2*j + 1, u - by(1)/PI, v - by(2))
    end do
  end subroutine put_points

  !> From the images of the points.
  function bending(flow, before, tangent, axes) result(bent)
    class(flow_t), intent(in) :: flow
    integer, intent(in) :: before
    real(dp), intent(in) :: tangent(4)
    real(dp), intent(in) :: axes(2, 2)
    real(dp) :: bent
    real(dp) :: q(2, 3), by(2), linear(2), ends(2, 2)
    integer :: j, side

    do j = 1, 3
      by = matmul(axes, DIAMETERS(:, j))
      linear = [dot_product(tangent(1:2), by), dot_product(tangent(3:4), by)]
      do side = 1, 2
        associate (i => before + 2*j + side - 1)
          ends(:, side) = [PI*angle_difference(flow%u(i), flow%u(before + 1)), flow%v(i) - flow%v(before + 1)] &
                          - merge(1, -1, side == 1)*linear
        end associate
      end do
      q(:, j) = ends(:, merge(1, 2, norm2(ends(:, 1)) > norm2(ends(:, 2))))
    end do
    bent = 1.5_dp*(norm2(q(:, 1)) + norm2(q(:, 2)) + norm2(q(:, 3) - 0.5_dp*(q(:, 1) + q(:, 2))))
  end function bending

end module kz_labels_bending
