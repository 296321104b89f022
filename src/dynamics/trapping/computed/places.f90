!> Where states lie in the grid of trapping regions, many at once. (A file of its own: called, not copied into a caller,
!> its loop goes over vectors.)
module kz_computed_places
  use, intrinsic :: iso_c_binding, only: dp => c_double, int32 => c_int32_t
  use kz_maps_states, only: MIDPERIOD
  implicit none
  private
  public :: grid_t, look_up, number_cells, wrapped_midperiod_angle, side, from_down, fold_cell

  !> Cells in a word of bits.
  integer, parameter, public :: WORD = bit_size(0_int32)
  !> Adding it rounds to an integer.
  real(dp), parameter :: ROUND_TO_INTEGER = 1.5_dp*2.0_dp**52

  !> The cells: over the half plane of mid-period angles 0 .. pi, or the whole one where there is no mirror symmetry.
  type :: grid_t
    integer :: n_circle = 0      !< cells on the whole circle
    integer :: n_theta = 0       !< cells from 0 to pi, or on the whole circle
    logical :: mirrored = .true. !< the half stands for the other one, too
    integer :: n_velocity = 0    !< cells from -top to top
    real(dp) :: top = 0          !< rad per drive radian
    real(dp) :: per_u = 0, per_v = 0 !< cells in a half-turn, in a rad per drive radian
  end type grid_t

contains

  !> The numbers of the cells that hold n states, as number_cells has them; 0 if the cell is open. Uses vectors.
  pure subroutine look_up(grid, closed, n, u, v, cell)
    type(grid_t), intent(in) :: grid !< grid of the regions
    integer(int32), intent(in) :: closed(0:) !< a bit for each cell, then one for the outside
    integer, intent(in) :: n !< states
    real(dp), intent(in) :: u(n), v(n) !< half-turns in [-1, 1], rad per drive radian
    integer, intent(out) :: cell(n) !< +- number of the cell, from 1; 0 = open
    integer :: i, number

    call number_cells(grid, n, u, v, cell)
    do i = 1, n
      number = abs(cell(i)) - 1
      cell(i) = iand(ishft(closed(ishft(number, -5)), -iand(number, WORD - 1)), 1)*cell(i)
    end do
  end subroutine look_up

  !> The numbers (from 1) of the cells that hold n states, negative where the stored half holds the mirror image;
  !> outside of the grid the number behind the last. Uses vectors.
  pure subroutine number_cells(grid, n, u, v, cell)
    type(grid_t), intent(in) :: grid !< grid of the regions
    integer, intent(in) :: n !< states
    real(dp), intent(in) :: u(n), v(n) !< half-turns in [-1, 1], rad per drive radian
    integer, intent(out) :: cell(n) !< +- number of the cell
    real(dp) :: w, y, c, fold, per_u, per_v, top, outside, columns, rows
    integer :: i

    columns = grid%n_theta
    rows = grid%n_velocity
    outside = columns*rows
    per_u = grid%per_u
    per_v = grid%per_v
    top = grid%top
    if (.not. grid%mirrored) then
      do i = 1, n
        cell(i) = 1 + whole_cell(grid, u(i), v(i))
      end do
    else
      do i = 1, n
        w = u(i) + MIDPERIOD*v(i)
        w = w - 2*((0.5_dp*w + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
        fold = side(w, v(i))
        y = (fold*v(i) + top)*per_v
        c = aint(abs(w)*per_u)
        c = merge(c, columns - 1, c < columns) + columns*aint(y)
        c = merge(c, outside, y >= 0)
        c = merge(c, outside, y < rows)
        cell(i) = int(fold*(1 + merge(c, outside, abs(w) <= 1))) ! a lost state is outside
      end do
    end if
  end subroutine number_cells

  !> The cell (from 0) of a grid over the whole circle that holds (u, v); the number of cells outside.
  pure function whole_cell(grid, u, v) result(cell)
    type(grid_t), intent(in) :: grid
    real(dp), intent(in) :: u, v
    integer :: cell
    real(dp) :: w, y

    cell = grid%n_theta*grid%n_velocity
    w = from_down(wrapped_midperiod_angle(u, v))
    y = (v + grid%top)*grid%per_v
    if (w >= 0 .and. w <= 2 .and. y >= 0 .and. y < grid%n_velocity) cell = min(int(w*grid%per_u), grid%n_theta - 1) &
        + grid%n_theta*int(y)
  end function whole_cell

  !> An angle in [-1, 1] as one in [0, 2).
  elemental function from_down(w) result(angle)
    real(dp), intent(in) :: w !< half-turns
    real(dp) :: angle

    angle = merge(w, w + 2, w >= 0)
  end function from_down

  !> The mid-period angle, wrapped to [-1, 1].
  elemental function wrapped_midperiod_angle(u, v) result(w)
    real(dp), intent(in) :: u, v !< half-turns, rad per drive radian
    real(dp) :: w

    w = u + MIDPERIOD*v
    w = w - 2*((0.5_dp*w + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
  end function wrapped_midperiod_angle

  !> 1 if (u, v) lies in the stored half, -1 if its mirror image does.
  elemental function side(u, v) result(fold)
    real(dp), intent(in) :: u, v !< half-turns, rad per drive radian
    real(dp) :: fold

    fold = merge(1.0_dp, -1.0_dp, merge(u, v, abs(u) > 0) >= 0)
  end function side

  !> Moves cell (i, l), for any integer i, to the stored half; `mirrored` = the stored cell is its mirror image.
  pure subroutine fold_cell(grid, i, l, mirrored)
    type(grid_t), intent(in) :: grid !< the cells
    integer, intent(inout) :: i !< column, any integer, in; from 0, out
    integer, intent(inout) :: l !< row, from 0
    logical, intent(out) :: mirrored !< whether the stored cell is its mirror image

    i = modulo(i, grid%n_circle)
    mirrored = i >= grid%n_theta
    if (.not. mirrored) return
    i = grid%n_circle - 1 - i
    l = grid%n_velocity - 1 - l
  end subroutine fold_cell

end module kz_computed_places
