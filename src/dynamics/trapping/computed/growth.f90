!> Trapping regions grown outwards over the cells of their grid: a cell joins an attractor when the image of the whole
!> cell, after 1, 2, 4 or 8 periods, lies in one of its ellipses, or in cells that have joined it before.
!>
!> A cell that cannot join yet waits, with each of its images, for one open cell of the image. Cells that have joined
!> stay, so that the end result does not depend on the order.
module kz_computed_growth
  use, intrinsic :: iso_c_binding, only: dp => c_double, int8 => c_int8_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_bands, only: band_holds
  use kz_computed_ellipses, only: in_ellipse
  use kz_computed_cell_images, only: images_t, corners_t, PERIODS, corners_of, extent
  use kz_computed_grid, only: regions_t, note_closed
  use kz_computed_places, only: grid_t, fold_cell
  use kz_maps_states, only: midperiod_angle
  implicit none
  private
  public :: grow_regions

  !> Attractors beyond this number do not fit into a byte: their regions are not grown.
  integer, parameter :: MOST_GROWN = huge(1_int8)
  integer, parameter :: NEVER = -1

  !> The whole circle, twice, one byte a cell: no interval of columns wraps.
  type, extends(grid_t) :: circle_t
    integer(int8), allocatable :: label(:, :) !< (0 : 2 n_circle - 1, 0 : n_velocity - 1): attractor, from 1; 0 = open
    integer(int8), allocatable :: mirror(:)   !< mirror image of each attractor, from 1; 0 = not grown
  end type circle_t

  !> Lists of images that wait for each cell; a waiting image is numbered cell + n_cells (k - 1), k as in PERIODS.
  type :: waiting_t
    integer, allocatable :: first(:) !< first image that waits for each cell
    integer, allocatable :: next(:)  !< next image in the list of each
    integer, allocatable :: seen(:)  !< row below which each image is known to belong
  end type waiting_t

contains

  !> Grows the regions over the images, which belong to the same grid.
  subroutine grow_regions(regions, attractors, images)
    type(regions_t), intent(inout) :: regions !< the trapping regions
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    type(images_t), intent(in) :: images(:) !< images of the cells after each number of PERIODS
    type(circle_t) :: circle
    type(waiting_t) :: waiting
    integer :: k, i, l, a

    circle = make_circle(regions)
    do l = 0, regions%n_velocity - 1
      do i = 0, regions%n_theta - 1
        do k = 1, size(PERIODS)
          if (circle%label(i, l) > 0) exit
          a = ellipse_around(regions, attractors, images(k), i, l)
          if (a > 0) call set(circle, i, l, a)
        end do
      end do
    end do
    allocate (waiting%first(0:size(regions%label) - 1), source=NEVER)
    allocate (waiting%next(0:size(PERIODS)*size(regions%label) - 1))
    allocate (waiting%seen(0:size(PERIODS)*size(regions%label) - 1), source=0)
    call grow(circle, images, waiting)
    where (regions%label <= 0 .and. circle%label(:regions%n_theta - 1, :) > 0) &
      regions%label = circle%label(:regions%n_theta - 1, :)
    call note_closed(regions)
  end subroutine grow_regions

  function make_circle(regions) result(circle)
    type(regions_t), intent(in) :: regions
    type(circle_t) :: circle
    integer :: i, l

    circle%grid_t = regions%grid_t
    allocate (circle%label(0:2*regions%n_circle - 1, 0:regions%n_velocity - 1), source=0_int8)
    circle%mirror = int(merge(regions%mirror, 0, regions%mirror <= MOST_GROWN), int8)
    do l = 0, regions%n_velocity - 1
      do i = 0, regions%n_theta - 1
        if (regions%label(i, l) > 0) call set(circle, i, l, regions%label(i, l))
      end do
    end do
  end function make_circle

  !> Cell (i, l) of the stored half joins attractor a, and its mirror image the mirror image.
  pure subroutine set(circle, i, l, a)
    type(circle_t), intent(inout) :: circle
    integer, intent(in) :: i, l, a
    integer :: column, row

    if (a > MOST_GROWN) return
    if (circle%mirror(a) == 0) return
    column = circle%n_circle - 1 - i
    row = circle%n_velocity - 1 - l
    circle%label([i, i + circle%n_circle], l) = int(a, int8)
    if (circle%mirrored) circle%label([column, column + circle%n_circle], row) = circle%mirror(a)
  end subroutine set

  !> The attractor one of whose ellipses holds the image of cell (i, l); 0 = none. The ellipses drawn where the image of
  !> the cell's first corner lies are tried.
  function ellipse_around(regions, attractors, images, i, l) result(a)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    type(images_t), intent(in) :: images
    integer, intent(in) :: i, l
    integer :: a, t, column, row
    type(corners_t) :: corners
    logical :: mirrored

    a = 0
    if (images%n_columns(i, l) == 0) return
    column = floor(images%x(i, l))
    row = floor(images%y(i, l))
    call fold_cell(regions%grid_t, column, row, mirrored)
    t = -regions%drawn(column, row)
    if (t <= 0) return
    corners = corners_of(images, i, l)
    do while (t > 0)
      a = regions%overlaps(t)%attractor
      if (holds(regions, attractors(a), regions%overlaps(t)%point, corners, mirrored)) then
        if (mirrored) a = regions%mirror(a)
        return
      end if
      t = regions%overlaps(t)%next
    end do
    a = 0
  end function ellipse_around

  !> Whether four corners with their slack, and so their hull, or its mirror image, lie in the ellipse of strobe point
  !> j; j = 0: whether the box around them lies in the band.
  pure function holds(regions, attractor, j, corners, mirrored) result(inside)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: j
    type(corners_t), intent(in) :: corners
    logical, intent(in) :: mirrored
    logical :: inside
    real(dp) :: u, v, box_u(2), box_v(2)
    integer :: a, b, corner

    inside = .true.
    box_u = [huge(u), -huge(u)]
    box_v = box_u
    do corner = 1, 4
      do b = -1, 1, 2
        do a = -1, 1, 2
          u = (corners%x(corner) + a*corners%slack_x)*2/regions%n_circle
          v = (corners%y(corner) + b*corners%slack_y)*(2*regions%top/regions%n_velocity) - regions%top
          if (mirrored) u = -u
          if (mirrored) v = -v
          u = u - midperiod_angle(0.0_dp, v)
          if (j > 0) inside = inside .and. in_ellipse(attractor, j, u, v)
          box_u = [min(box_u(1), u), max(box_u(2), u)]
          box_v = [min(box_v(1), v), max(box_v(2), v)]
        end do
      end do
    end do
    if (j == 0) inside = band_holds(attractor, box_u, box_v)
  end function holds

  !> Tests every open cell; an image with an open cell is put on the waiting list of that cell.
  subroutine grow(circle, images, waiting)
    type(circle_t), intent(inout) :: circle
    type(images_t), intent(in) :: images(:)
    type(waiting_t), intent(inout) :: waiting
    integer, allocatable :: stack(:)
    integer :: n_cells, n_stack, image

    n_cells = circle%n_theta*circle%n_velocity
    allocate (stack(size(waiting%next)))
    do image = 0, size(waiting%next) - 1
      n_stack = 1
      stack(1) = image
      do while (n_stack > 0)
        n_stack = n_stack - 1
        call visit(stack(n_stack + 1))
      end do
    end do
  contains
    subroutine visit(number)
      integer, intent(in) :: number
      integer :: cell, i, l, answer, blocker

      cell = mod(number, n_cells)
      i = mod(cell, circle%n_theta)
      l = cell/circle%n_theta
      if (circle%label(i, l) /= 0) return
      call ask(circle, images(1 + number/n_cells), i, l, waiting%seen(number), answer, blocker)
      if (answer > 0) then
        call set(circle, i, l, answer)
        do while (waiting%first(cell) /= NEVER)
          n_stack = n_stack + 1
          stack(n_stack) = waiting%first(cell)
          waiting%first(cell) = waiting%next(waiting%first(cell))
        end do
      else if (blocker /= NEVER) then
        waiting%next(number) = waiting%first(blocker)
        waiting%first(blocker) = number
      end if
    end subroutine visit
  end subroutine grow

  !> Sets answer > 0: attractor of the whole image of cell (i, l); else blocker: an open stored cell of it, or NEVER.
  subroutine ask(circle, images, i, l, seen, answer, blocker)
    type(circle_t), intent(in) :: circle
    type(images_t), intent(in) :: images
    integer, intent(in) :: i, l
    integer, intent(inout) :: seen
    integer, intent(out) :: answer, blocker
    type(corners_t) :: corners
    real(dp) :: from, to
    integer(int8) :: a
    integer :: column, row, left, n, shift

    answer = 0
    blocker = NEVER
    n = images%n_columns(i, l)
    if (n == 0) return
    left = images%left(i, l)
    column = modulo(floor(images%x(i, l)), circle%n_circle) ! column of the image of a corner
    row = int(images%y(i, l))
    a = circle%label(column, row)
    if (a == 0) blocker = stored(circle, column, row)
    if (a == 0) return
    blocker = other_corner(circle, images, i, l, a)
    if (blocker /= 0) return
    do row = max(images%bottom(i, l), seen), images%top(i, l)
      if (one_label(n, circle%label(left:, row), a)) cycle
      corners = corners_of(images, i, l)
      call extent(corners, row, from, to)
      shift = left - floor(minval(corners%x) - corners%slack_x)
      call first_other(circle, max(left, floor(from) + shift), min(left + n - 1, floor(to) + shift), row, a, blocker)
      seen = row
      if (blocker /= 0) return
    end do
    blocker = NEVER
    answer = a
  end subroutine ask

  !> As first_other, for the cells of the images of the other corners: cheaper than the rows of the image.
  pure function other_corner(circle, images, i, l, a) result(blocker)
    type(circle_t), intent(in) :: circle
    type(images_t), intent(in) :: images
    integer, intent(in) :: i, l
    integer(int8), intent(in) :: a
    integer :: blocker, corner, x, y, column, row

    blocker = 0
    do corner = 1, 3
      x = i + mod(corner, 2)
      y = l + corner/2
      column = modulo(floor(images%x(x, y)), circle%n_circle)
      row = int(images%y(x, y))
      call first_other(circle, column, column, row, a, blocker)
      if (blocker /= 0) return
    end do
  end function other_corner

  !> Whether n cells all have the label a.
  pure function one_label(n, label, a) result(all_have)
    integer, intent(in) :: n
    integer(int8), intent(in) :: label(n), a
    logical :: all_have
    integer(int8) :: unlike
    integer :: c

    unlike = 0
    do c = 1, n
      unlike = ior(unlike, ieor(label(c), a))
    end do
    all_have = unlike == 0
  end function one_label

  !> Looks along a row for a cell without label a. blocker: the stored cell, if it is open; NEVER if another attractor
  !> has it; 0 if there is none.
  pure subroutine first_other(circle, first, last, row, a, blocker)
    type(circle_t), intent(in) :: circle
    integer, intent(in) :: first, last, row
    integer(int8), intent(in) :: a
    integer, intent(out) :: blocker
    integer :: column

    do column = first, last
      if (circle%label(column, row) == a) cycle
      blocker = merge(stored(circle, column, row), NEVER, circle%label(column, row) == 0)
      return
    end do
    blocker = 0
  end subroutine first_other

  !> Number of the stored cell that is cell (column, row) of the doubled circle, or its mirror image.
  pure function stored(circle, column, row) result(cell)
    type(circle_t), intent(in) :: circle
    integer, intent(in) :: column, row
    integer :: cell, i

    i = modulo(column, circle%n_circle)
    cell = i + circle%n_theta*row
    if (i >= circle%n_theta) cell = circle%n_circle - 1 - i + circle%n_theta*(circle%n_velocity - 1 - row)
  end function stored

end module kz_computed_growth
