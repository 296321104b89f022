!> The image of a cell of the map table after some periods: the convex hull of its corners' images, widened by a bound on what
!> bilinear interpolation misses: an eighth of the second differences, taken twice, and 2 % of a cell.
module kz_trapping_cell_images
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_maps_map_table, only: table_t
  implicit none
  private
  public :: image_t, cell_image, extent

  real(dp), parameter :: CURVATURE = 0.25_dp, SLACK = 0.02_dp

  !> The image of one cell, in units of cells.
  type :: image_t
    real(dp) :: x(4)
    real(dp) :: y(4)
    real(dp) :: slack_x
    real(dp) :: slack_y
  end type image_t

contains

  !> Corners' images and slack of cell (i, l), from 0; far away at the rim, where differences are missing.
  pure function cell_image(table, field, i, l) result(image)
    type(table_t), intent(in) :: table
    real(dp), allocatable, intent(in) :: field(:, :, :)
    integer, intent(in) :: i
    integer, intent(in) :: l
    type(image_t) :: image
    real(dp) :: per_u, per_v, bend(2)
    integer :: a, b, j

    per_u = 0.5_dp*table%n_circle
    per_v = (table%n_velocity - 1)/(2*table%top)
    image%x = huge(1.0_dp)
    image%y = huge(1.0_dp)
    image%slack_x = 0
    image%slack_y = 0
    if (l < 1 .or. l > table%n_velocity - 3) return
    do b = 0, 1
      do a = 0, 1
        j = l + 1 + b
        image%x(1 + a + 2*b) = i + a + field(1, i + a, j)*per_u
        image%y(1 + a + 2*b) = l + b + field(2, i + a, j)*per_v
        bend = abs(field(:, i + a + 1, j) - 2*field(:, i + a, j) + field(:, i + a - 1, j)) &
               + abs(field(:, i + a, j + 1) - 2*field(:, i + a, j) + field(:, i + a, j - 1))
        image%slack_x = max(image%slack_x, CURVATURE*bend(1)*per_u + SLACK)
        image%slack_y = max(image%slack_y, CURVATURE*bend(2)*per_v + SLACK)
      end do
    end do
  end function cell_image

  !> Range of x of the hull of the image between y = low and y = high: all segments between corners, clipped.
  pure subroutine extent(image, low, high, from, to)
    type(image_t), intent(in) :: image
    real(dp), intent(in) :: low
    real(dp), intent(in) :: high
    real(dp), intent(out) :: from
    real(dp), intent(out) :: to
    real(dp) :: s, t, slope
    integer :: a, b

    from = huge(1.0_dp)
    to = -huge(1.0_dp)
    do a = 1, 3
      do b = a + 1, 4
        s = min(max(low, min(image%y(a), image%y(b))), max(image%y(a), image%y(b)))
        t = min(max(high, min(image%y(a), image%y(b))), max(image%y(a), image%y(b)))
        if (s > high .or. t < low) cycle
        if (abs(image%y(b) - image%y(a)) <= 0) then
          from = min(from, image%x(a), image%x(b))
          to = max(to, image%x(a), image%x(b))
          cycle
        end if
        slope = (image%x(b) - image%x(a))/(image%y(b) - image%y(a))
        from = min(from, image%x(a) + slope*(s - image%y(a)), image%x(a) + slope*(t - image%y(a)))
        to = max(to, image%x(a) + slope*(s - image%y(a)), image%x(a) + slope*(t - image%y(a)))
      end do
    end do
  end subroutine extent

end module kz_trapping_cell_images
