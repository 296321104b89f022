!> Where states lie in the grid of trapping regions, many at once. (A file of its own: called, not copied into a caller, its loop goes
!> over vectors.)
module kz_grown_places
  use, intrinsic :: iso_c_binding, only: dp => c_double, int32 => c_int32_t
  use kz_maps_states, only: MIDPERIOD
  implicit none
  private
  public :: look_up, number_cells, wrapped_midperiod_angle, side, from_down

  !> Cells in a word of bits.
  integer, parameter, public :: WORD = bit_size(0_int32)
  !> Adding it rounds to an integer.
  real(dp), parameter :: ROUND_TO_INTEGER = 1.5_dp*2.0_dp**52

contains

  !> The numbers of the cells that hold n states, as number_cells has them; 0 if the cell is open. Uses vectors.
  pure subroutine look_up(mirrored, n_theta, n_velocity, per_u, top, closed, n, u, v, cell)
    logical, intent(in) :: mirrored !< whether the stored half stands for the other one, too
    integer, intent(in) :: n_theta !< stored columns of the grid
    integer, intent(in) :: n_velocity !< rows of the grid
    real(dp), intent(in) :: per_u !< columns in a half-turn
    real(dp), intent(in) :: top !< largest velocity of the grid, rad per drive radian
    integer(int32), intent(in) :: closed(0:n_theta*n_velocity/WORD) !< a bit for each cell, then one for the outside
    integer, intent(in) :: n !< states
    real(dp), intent(in) :: u(n) !< angles, half-turns in [-1, 1]
    real(dp), intent(in) :: v(n) !< velocities, rad per drive radian
    integer, intent(out) :: cell(n) !< +- number of the cell, from 1; 0 = open
    integer :: i, number

    call number_cells(mirrored, n_theta, n_velocity, per_u, top, n, u, v, cell)
    do i = 1, n
      number = abs(cell(i)) - 1
      cell(i) = iand(ishft(closed(ishft(number, -5)), -iand(number, WORD - 1)), 1)*cell(i)
    end do
  end subroutine look_up

  !> The numbers (from 1) of the cells that hold n states, negative where the stored half holds the mirror image; outside of the grid the number
  !> behind the last. Uses vectors.
  pure subroutine number_cells(mirrored, n_theta, n_velocity, per_u, top, n, u, v, cell)
    logical, intent(in) :: mirrored !< whether the stored half stands for the other one, too
    integer, intent(in) :: n_theta !< stored columns of the grid
    integer, intent(in) :: n_velocity !< rows of the grid
    real(dp), intent(in) :: per_u !< columns in a half-turn
    real(dp), intent(in) :: top !< largest velocity of the grid, rad per drive radian
    integer, intent(in) :: n !< states
    real(dp), intent(in) :: u(n) !< angles, half-turns in [-1, 1]
    real(dp), intent(in) :: v(n) !< velocities, rad per drive radian
    integer, intent(out) :: cell(n) !< +- number of the cell
    real(dp) :: w, y, c, fold, per_v, outside, columns, rows
    integer :: i

    columns = n_theta
    rows = n_velocity
    outside = columns*rows
    per_v = rows/(2*top)
    if (.not. mirrored) then
      do i = 1, n
        cell(i) = 1 + whole_cell(n_theta, n_velocity, per_u, top, u(i), v(i))
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
  pure function whole_cell(n_theta, n_velocity, per_u, top, u, v) result(cell)
    integer, intent(in) :: n_theta, n_velocity
    real(dp), intent(in) :: per_u, top, u, v
    integer :: cell
    real(dp) :: w, y

    cell = n_theta*n_velocity
    w = from_down(wrapped_midperiod_angle(u, v))
    y = (v + top)*(n_velocity/(2*top))
    if (w >= 0 .and. w <= 2 .and. y >= 0 .and. y < n_velocity) cell = min(int(w*per_u), n_theta - 1) + n_theta*int(y)
  end function whole_cell

  !> An angle in [-1, 1] as one in [0, 2).
  elemental function from_down(w) result(angle)
    real(dp), intent(in) :: w !< half-turns
    real(dp) :: angle

    angle = merge(w, w + 2, w >= 0)
  end function from_down

  !> The mid-period angle, wrapped to [-1, 1].
  elemental function wrapped_midperiod_angle(u, v) result(w)
    real(dp), intent(in) :: u !< angle, half-turns
    real(dp), intent(in) :: v !< velocity, rad per drive radian
    real(dp) :: w

    w = u + MIDPERIOD*v
    w = w - 2*((0.5_dp*w + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
  end function wrapped_midperiod_angle

  !> 1 if (u, v) lies in the stored half, -1 if its mirror image does.
  elemental function side(u, v) result(fold)
    real(dp), intent(in) :: u !< angle, half-turns
    real(dp), intent(in) :: v !< velocity, rad per drive radian
    real(dp) :: fold

    fold = merge(1.0_dp, -1.0_dp, merge(u, v, abs(u) > 0) >= 0)
  end function side

end module kz_grown_places
