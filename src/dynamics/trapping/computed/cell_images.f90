!> Images of the cells of a grid of trapping regions after some drive periods: the convex hull of the images of a cell's
!> corners, widened by a bound on what bilinear interpolation misses: an eighth of the second differences, taken twice,
!> and 2 % of a cell. The corners show what lies between them only as long as the cell has stayed small: where an
!> earlier image was bent, a later one is not taken.
module kz_computed_cell_images
  use, intrinsic :: iso_c_binding, only: dp => c_double, int32 => c_int32_t
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_maps_states, only: midperiod_angle
  use kz_computed_grid, only: regions_t
  implicit none
  private
  public :: images_t, corners_t, make_images, corners_of, extent

  real(dp), parameter :: CURVATURE = 0.25_dp, SLACK = 0.02_dp
  !> Images over more cells than this are not followed.
  real(dp), parameter :: LARGEST_IMAGE = 2000
  !> A cell is bent where its slack is larger, rad and rad per drive radian.
  real(dp), parameter :: BENT = 0.1_dp
  !> After how many periods images are taken, the best first: what is still far away comes in with the longest.
  integer, parameter, public :: PERIODS(4) = [8, 4, 2, 1]

  !> Images after one number of periods, in units of cells: columns of the whole circle, not wrapped, and rows.
  type :: images_t
    real(dp), allocatable :: x(:, :)       !< angles of the images of the nodes (0 : n_theta, 0 : n_velocity)
    real(dp), allocatable :: y(:, :)
    real(dp), allocatable :: slack_x(:, :) !< angle to be added on both sides
    real(dp), allocatable :: slack_y(:, :)
    !> Boxes around the images of the cells (0 : n_theta - 1, 0 : n_velocity - 1), whole cells. left: column on the
    !> circle, from 0; n_columns = 0: the image is too large, or reaches beyond the grid's velocities
    integer(int32), allocatable :: left(:, :), n_columns(:, :), bottom(:, :), top(:, :)
  end type images_t

  !> Images of the corners of a cell, and what they may be off by between the corners, in cells.
  type :: corners_t
    real(dp) :: x(4), y(4), slack_x, slack_y
  end type corners_t

contains

  !> Integrates the nodes of the grid, and one more row and column on every side for the differences.
  subroutine make_images(regions, flow, images)
    type(regions_t), intent(in) :: regions !< the grid whose nodes are integrated
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    type(images_t), intent(out) :: images(size(PERIODS)) !< the images after each number of PERIODS
    real(dp), allocatable :: x(:, :, :), y(:, :, :)
    logical, allocatable :: straight(:, :)
    type(images_t) :: image
    integer :: period, k, j

    allocate (x(-1:regions%n_theta + 1, -1:regions%n_velocity + 1, maxval(PERIODS)))
    allocate (y, mold=x)
    allocate (straight(0:regions%n_theta, 0:regions%n_velocity), source=.true.)
    do j = -1, regions%n_velocity + 1
      call integrate_row(regions, flow, j, x(:, j, :), y(:, j, :))
    end do
    do period = 1, maxval(PERIODS)
      image = image_of(regions, x(:, :, period), y(:, :, period))
      k = findloc(PERIODS, period, 1)
      if (k > 0) then
        images(k) = image
        call set_boxes(regions, straight, images(k))
      end if
      straight = straight .and. image%slack_x <= BENT*(regions%n_circle/(2*PI)) &
                 .and. image%slack_y <= BENT*regions%per_v
    end do
  end subroutine make_images

  !> The nodes of row j after each period.
  subroutine integrate_row(regions, flow, j, x, y)
    type(regions_t), intent(in) :: regions
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: j
    real(dp), intent(out) :: x(-1:, :), y(-1:, :)
    real(dp) :: per_u, per_v, u, v, turns(WIDTH)
    integer :: first, n, lane, period

    per_u = regions%per_u
    per_v = regions%per_v
    v = j/per_v - regions%top
    do first = -1, regions%n_theta + 1, WIDTH
      n = min(WIDTH, regions%n_theta + 2 - first)
      do lane = 1, n
        u = (first + lane - 1)/per_u - midperiod_angle(0.0_dp, v)
        turns(lane) = anint(0.5_dp*u)
        call flow%put(lane, u - 2*turns(lane), v)
      end do
      do period = 1, maxval(PERIODS)
        call flow%advance(n)
        x(first:first + n - 1, period) = midperiod_angle(flow%u(:n) + 2*(turns(:n) + flow%turns(:n)), flow%v(:n))*per_u
        y(first:first + n - 1, period) = (flow%v(:n) + regions%top)*per_v
      end do
    end do
  end subroutine integrate_row

  !> The nodes' images and slack.
  function image_of(regions, x, y) result(image)
    type(regions_t), intent(in) :: regions
    real(dp), intent(in) :: x(-1:, -1:), y(-1:, -1:)
    type(images_t) :: image

    allocate (image%x(0:regions%n_theta, 0:regions%n_velocity))
    allocate (image%y, image%slack_x, image%slack_y, mold=image%x)
    image%x = x(0:regions%n_theta, 0:regions%n_velocity)
    image%y = y(0:regions%n_theta, 0:regions%n_velocity)
    call set_slack(regions%n_theta, regions%n_velocity, x, image%slack_x)
    call set_slack(regions%n_theta, regions%n_velocity, y, image%slack_y)
  end function image_of

  pure subroutine set_slack(n_theta, n_velocity, x, slack_of)
    integer, intent(in) :: n_theta, n_velocity
    real(dp), intent(in) :: x(-1:n_theta + 1, -1:n_velocity + 1)
    real(dp), intent(out) :: slack_of(0:n_theta, 0:n_velocity)
    integer :: i, j

    do j = 0, n_velocity
      do i = 0, n_theta
        slack_of(i, j) = SLACK + CURVATURE*(abs(x(i + 1, j) - 2*x(i, j) + x(i - 1, j)) &
                                            + abs(x(i, j + 1) - 2*x(i, j) + x(i, j - 1)))
      end do
    end do
  end subroutine set_slack

  !> The boxes of cells whose corners were straight in all images before.
  subroutine set_boxes(regions, straight, images)
    type(regions_t), intent(in) :: regions
    logical, intent(in) :: straight(0:, 0:)
    type(images_t), intent(inout) :: images
    integer :: n(2), l

    n = [regions%n_theta, regions%n_velocity]
    allocate (images%left(0:n(1) - 1, 0:n(2) - 1))
    allocate (images%n_columns, images%bottom, images%top, mold=images%left)
    call boxes(n(1), n(2), real(regions%n_circle, dp), images)
    do l = 0, n(2) - 1
      where (.not. (straight(:n(1) - 1, l) .and. straight(1:, l) .and. straight(:n(1) - 1, l + 1) &
                    .and. straight(1:, l + 1))) images%n_columns(:, l) = 0
    end do
  end subroutine set_boxes

  !> In vectors. NaN and numbers beyond integers fall out as too large.
  pure subroutine boxes(n_theta, n_velocity, circle, images)
    integer, intent(in) :: n_theta, n_velocity
    real(dp), intent(in) :: circle
    type(images_t), intent(inout) :: images
    real(dp) :: from, to, low, high, slack_max
    logical :: good
    integer :: i, l

    associate (x => images%x, y => images%y, slack_x => images%slack_x, slack_y => images%slack_y)
      do l = 0, n_velocity - 1
        do i = 0, n_theta - 1
          slack_max = max(slack_x(i, l), slack_x(i + 1, l), slack_x(i, l + 1), slack_x(i + 1, l + 1))
          from = aint_down(min(x(i, l), x(i + 1, l), x(i, l + 1), x(i + 1, l + 1)) - slack_max)
          to = aint_down(max(x(i, l), x(i + 1, l), x(i, l + 1), x(i + 1, l + 1)) + slack_max)
          slack_max = max(slack_y(i, l), slack_y(i + 1, l), slack_y(i, l + 1), slack_y(i + 1, l + 1))
          low = aint_down(min(y(i, l), y(i + 1, l), y(i, l + 1), y(i + 1, l + 1)) - slack_max)
          high = aint_down(max(y(i, l), y(i + 1, l), y(i, l + 1), y(i + 1, l + 1)) + slack_max)
          good = low >= 0 .and. high < n_velocity .and. to - from < circle &
                 .and. (to - from)*(high - low) < LARGEST_IMAGE
          images%left(i, l) = int(merge(from - circle*aint_down(from/circle), 0.0_dp, good), int32)
          images%n_columns(i, l) = int(merge(to - from + 1, 0.0_dp, good), int32)
          images%bottom(i, l) = int(merge(low, 0.0_dp, good), int32)
          images%top(i, l) = int(merge(high, 0.0_dp, good), int32)
        end do
      end do
    end associate
  contains
    !> The next integer below, as a real number: the intrinsic floor does not go over vectors.
    pure function aint_down(a) result(below)
      real(dp), intent(in) :: a
      real(dp) :: below

      below = aint(a)
      below = merge(below - 1, below, below > a)
    end function aint_down
  end subroutine boxes

  !> The images of the corners of cell (i, l), and its slack.
  pure type(corners_t) function corners_of(images, i, l) result(corners)
    type(images_t), intent(in) :: images !< images of all nodes
    integer, intent(in) :: i, l !< column and row of the cell, from 0

    corners%x = [images%x(i, l), images%x(i + 1, l), images%x(i, l + 1), images%x(i + 1, l + 1)]
    corners%y = [images%y(i, l), images%y(i + 1, l), images%y(i, l + 1), images%y(i + 1, l + 1)]
    corners%slack_x = maxval(images%slack_x(i:i + 1, l:l + 1))
    corners%slack_y = maxval(images%slack_y(i:i + 1, l:l + 1))
  end function corners_of

  !> Range of x, in cells, of the hull of four corners in a row of cells, with slack: from all segments between corners.
  pure subroutine extent(corners, row, from, to)
    type(corners_t), intent(in) :: corners !< corners of a cell
    integer, intent(in) :: row !< row of the grid, from 0
    real(dp), intent(out) :: from, to !< the range
    real(dp) :: x(4), y(4), low, high, s, t, slope
    integer :: a, b

    x = corners%x
    y = corners%y
    low = row - corners%slack_y
    high = row + 1 + corners%slack_y
    from = huge(1.0_dp)
    to = -huge(1.0_dp)
    do a = 1, 3
      do b = a + 1, 4
        s = min(max(low, min(y(a), y(b))), max(y(a), y(b)))
        t = min(max(high, min(y(a), y(b))), max(y(a), y(b)))
        if (s > high .or. t < low) cycle
        if (abs(y(b) - y(a)) <= 0) then
          from = min(from, x(a), x(b))
          to = max(to, x(a), x(b))
          cycle
        end if
        slope = (x(b) - x(a))/(y(b) - y(a))
        from = min(from, x(a) + slope*(s - y(a)), x(a) + slope*(t - y(a)))
        to = max(to, x(a) + slope*(s - y(a)), x(a) + slope*(t - y(a)))
      end do
    end do
    from = from - corners%slack_x
    to = to + corners%slack_x
  end subroutine extent

end module kz_computed_cell_images
