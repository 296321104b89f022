!> Trapping regions grown outwards over the cells of the map table: a cell joins an attractor when the image of the whole cell,
!> after 1, 2 or 4 periods, lies in cells that have joined it before, or in one of its ellipses.
!>
!> A cell that cannot join yet waits for one open cell of its image; the end result does not depend on the order.
module kz_trapping_growth
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: WIDTH
  use kz_attractors_cycles, only: attractor_t
  use kz_trapping_ellipses, only: in_ellipse
  use kz_trapping_cell_images, only: image_t, cell_image, extent
  use kz_trapping_grid, only: regions_t, fold_cell
  use kz_maps_states, only: midperiod_angle
  use kz_maps_map_table, only: table_t, table_map_t, fill_ghosts, node_velocity
  implicit none
  private
  public :: make_later, grow_regions

  !> Images over more cells than this are not followed.
  real(dp), parameter :: LARGEST_IMAGE = 2000
  integer, parameter :: NEVER = -1

  !> How far the cells of an image have been seen to belong to one attractor: they need not be looked at again.
  type :: progress_t
    integer :: answer = 0
    integer :: row = -huge(0)
    integer :: column = -huge(0)
  end type progress_t

contains

  !> Displacements of the nodes after 2 and 4 periods, by quintic interpolation of the table.
  subroutine make_later(map, two, four)
    type(table_map_t), intent(inout) :: map
    real(dp), allocatable, intent(out) :: two(:, :, :)
    real(dp), allocatable, intent(out) :: four(:, :, :)

    call later(map, map%table%shift, 1, two)
    call later(map, two, 2, four)
  end subroutine make_later

  !> Grows over the images of 4, 2 and 1 periods in turn.
  subroutine grow_regions(regions, attractors, table, two, four)
    type(regions_t), intent(inout) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    !> the table whose cells the regions have
    type(table_t), intent(in) :: table
    real(dp), allocatable, intent(in) :: two(:, :, :)
    real(dp), allocatable, intent(in) :: four(:, :, :)

    call grow(regions, attractors, table, four)
    call grow(regions, attractors, table, two)
    call grow(regions, attractors, table, table%shift)
  end subroutine grow_regions

  !> Displacement of every node after `periods` more than `field` has.
  subroutine later(map, field, periods, more)
    type(table_map_t), intent(inout) :: map
    real(dp), allocatable, intent(in) :: field(:, :, :)
    integer, intent(in) :: periods
    real(dp), allocatable, intent(out) :: more(:, :, :)
    real(dp) :: u, v, turns(WIDTH)
    integer :: first, n, i, j, lane, period

    allocate (more, source=field)
    do j = 1, map%table%n_velocity
      do first = 0, map%table%n_own, WIDTH
        n = min(WIDTH, map%table%n_own - first + 1)
        do lane = 1, n
          i = first + lane - 1
          v = node_velocity(map%table, j) + field(2, i, j)
          u = 2*real(i, dp)/map%table%n_circle + field(1, i, j) - midperiod_angle(0.0_dp, v)
          turns(lane) = anint(0.5_dp*u)
          call map%put(lane, u - 2*turns(lane), v)
        end do
        do period = 1, periods
          call map%advance(n)
        end do
        do lane = 1, n
          i = first + lane - 1
          u = midperiod_angle(map%u(lane) + 2*(turns(lane) + map%turns(lane)), map%v(lane))
          more(:, i, j) = [u - 2*real(i, dp)/map%table%n_circle, map%v(lane) - node_velocity(map%table, j)]
        end do
      end do
    end do
    call fill_ghosts(map%table, more)
  end subroutine later

  !> Tests every open cell; one whose image has an open cell is put on the waiting list of that cell.
  subroutine grow(regions, attractors, table, field)
    type(regions_t), intent(inout) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    type(table_t), intent(in) :: table
    real(dp), allocatable, intent(in) :: field(:, :, :)
    integer, allocatable :: waiting(:), next(:), stack(:)
    type(progress_t), allocatable :: progress(:)
    integer :: mirrors(0:size(attractors)), n_stack, cell, answer, blocker

    mirrors(0) = 0
    mirrors(1:) = attractors%mirror
    allocate (waiting(0:size(regions%label) - 1), next(0:size(regions%label) - 1), stack(size(regions%label)), &
              progress(0:size(regions%label) - 1))
    waiting = NEVER
    n_stack = 0
    do cell = size(regions%label) - 1, 0, -1
      n_stack = n_stack + 1
      stack(n_stack) = cell
    end do
    do while (n_stack > 0)
      cell = stack(n_stack)
      n_stack = n_stack - 1
      if (label_of(cell) > 0) cycle
      call first_corner(regions, mirrors, table, field, mod(cell, regions%n_theta), cell/regions%n_theta, answer, blocker)
      if (answer /= 0) &
        call ask(regions, attractors, mirrors, cell_image(table, field, mod(cell, regions%n_theta), cell/regions%n_theta), &
                 progress(cell), answer, blocker)
      if (answer > 0) then
        regions%label(mod(cell, regions%n_theta), cell/regions%n_theta) = answer
        do while (waiting(cell) /= NEVER)
          n_stack = n_stack + 1
          stack(n_stack) = waiting(cell)
          waiting(cell) = next(waiting(cell))
        end do
      else if (blocker /= NEVER) then
        next(cell) = waiting(blocker)
        waiting(blocker) = cell
      end if
    end do
  contains
    function label_of(number) result(a)
      integer, intent(in) :: number
      integer :: a

      a = regions%label(mod(number, regions%n_theta), number/regions%n_theta)
    end function label_of
  end subroutine grow

  !> Most cells that must wait are known by the image of their corner of lowest angle and velocity: answer = 0 and blocker = its
  !> open cell; answer = 0 and blocker = NEVER at the rim of the table; else answer is not 0 and the whole image must be tested.
  pure subroutine first_corner(regions, mirrors, table, field, i, l, answer, blocker)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: mirrors(0:)
    type(table_t), intent(in) :: table
    real(dp), allocatable, intent(in) :: field(:, :, :)
    integer, intent(in) :: i
    integer, intent(in) :: l
    integer, intent(out) :: answer
    integer, intent(out) :: blocker
    real(dp) :: y
    integer :: stored

    answer = 0
    blocker = NEVER
    y = l + field(2, i, l + 1)*((table%n_velocity - 1)/(2*table%top))
    if (.not. (y >= 0 .and. y < regions%n_velocity)) return
    call look(regions, mirrors, floor(i + field(1, i, l + 1)*(0.5_dp*table%n_circle)), int(y), answer, stored)
    if (answer == 0) blocker = stored
  end subroutine first_corner

  !> What is known of cell (column, row), any column: answer = its label, 0 open, -overlap; stored = the number of the stored
  !> cell.
  pure subroutine look(regions, mirrors, column, row, answer, stored)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: mirrors(0:)
    integer, intent(in) :: column
    integer, intent(in) :: row
    integer, intent(out) :: answer
    integer, intent(out) :: stored
    integer :: i, l
    logical :: mirrored

    i = column
    l = row
    call fold_cell(regions, i, l, mirrored)
    stored = i + regions%n_theta*l
    answer = regions%label(i, l)
    if (mirrored .and. answer > 0) answer = mirrors(answer)
  end subroutine look

  !> answer > 0: the attractor of the whole image. Else blocker: a stored cell that is open, or NEVER.
  subroutine ask(regions, attractors, mirrors, image, progress, answer, blocker)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    integer, intent(in) :: mirrors(0:)
    type(image_t), intent(in) :: image
    type(progress_t), intent(inout) :: progress
    integer, intent(out) :: answer
    integer, intent(out) :: blocker
    real(dp) :: low, high, from, to
    integer :: row, column, first, stored, a

    answer = 0
    blocker = NEVER
    low = minval(image%y) - image%slack_y
    high = maxval(image%y) + image%slack_y
    if (low < 0 .or. high >= regions%n_velocity) return
    if ((high - low)*(maxval(image%x) - minval(image%x) + 2*image%slack_x) > LARGEST_IMAGE) return
    if (touched(regions, image)) answer = ellipse_around(regions, attractors, image)
    if (answer > 0) return
    answer = progress%answer
    do row = max(int(low), progress%row), int(high)
      call extent(image, row - image%slack_y, row + 1 + image%slack_y, from, to)
      first = floor(from - image%slack_x)
      if (row == progress%row) first = max(first, progress%column)
      do column = first, floor(to + image%slack_x)
        call look(regions, mirrors, column, row, a, stored)
        if (a > 0 .and. (answer == 0 .or. a == answer)) then
          answer = a
          cycle
        end if
        if (a <= 0) blocker = stored
        progress = progress_t(answer, row, column)
        answer = 0
        return
      end do
    end do
  end subroutine ask

  !> Does an ellipse overlap the cell of the image's first corner?
  function touched(regions, image)
    type(regions_t), intent(in) :: regions
    type(image_t), intent(in) :: image
    logical :: touched
    integer :: i, l
    logical :: mirrored

    i = floor(image%x(1))
    l = int(image%y(1))
    call fold_cell(regions, i, l, mirrored)
    touched = regions%label(i, l) < 0
  end function touched

  !> The attractor one of whose ellipses holds the box around the image; 0 = none.
  function ellipse_around(regions, attractors, image) result(a)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    type(image_t), intent(in) :: image
    integer :: a, t, i, l
    logical :: mirrored

    i = floor(image%x(1))
    l = int(image%y(1))
    call fold_cell(regions, i, l, mirrored)
    t = -regions%label(i, l)
    do while (t > 0)
      a = regions%overlaps(t)%attractor
      if (holds(regions, attractors(a), regions%overlaps(t)%point, image, mirrored)) then
        if (mirrored) a = attractors(a)%mirror
        return
      end if
      t = regions%overlaps(t)%next
    end do
    a = 0
  end function ellipse_around

  !> Is the box around the image (or around its mirror image) in the ellipse of strobe point j?
  pure function holds(regions, attractor, j, image, mirrored) result(inside)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: j
    type(image_t), intent(in) :: image
    logical, intent(in) :: mirrored
    logical :: inside
    real(dp) :: u(2), v(2)
    integer :: a, b

    u = [minval(image%x) - image%slack_x, maxval(image%x) + image%slack_x]*2/regions%n_circle
    v = [minval(image%y) - image%slack_y, maxval(image%y) + image%slack_y]*(2*regions%top/regions%n_velocity) - regions%top
    if (mirrored) then
      u = -u
      v = -v
    end if
    inside = .true.
    do b = 1, 2
      do a = 1, 2
        inside = inside .and. in_ellipse(attractor, j, u(a) - midperiod_angle(0.0_dp, v(b)), v(b))
      end do
    end do
  end function holds

end module kz_trapping_growth
