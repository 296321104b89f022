!> Trapping regions of one pendulum in the place of those of another one nearby: good enough for a picture that moves.
module kz_grown_aging
  use kz_grown_grid, only: regions_t, make_regions, fold_cell
  implicit none
  private
  public :: aged_regions

contains

  !> A grid in which a cell keeps its attractor only if all its neighbours have the same one. Ellipses are drawn anew.
  function aged_regions(old, number) result(regions)
    type(regions_t), intent(in) :: old !< regions of the other pendulum
    integer, intent(in) :: number(:) !< of each of its attractors, the number that it has now; 0 = it is there no more
    type(regions_t) :: regions
    integer :: i, l

    regions = make_regions(old%n_circle, old%n_velocity, old%top, old%mirrored)
    do l = 1, old%n_velocity - 2
      do i = 0, old%n_theta - 1
        if (old%label(i, l) <= 0) cycle
        if (is_surrounded(old, i, l)) regions%label(i, l) = number(old%label(i, l))
      end do
    end do
  end function aged_regions

  !> Whether all neighbours of a cell have its attractor.
  pure function is_surrounded(regions, i, l) result(surrounded)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: i, l
    logical :: surrounded
    integer :: x, y

    surrounded = .false.
    do y = l - 1, l + 1
      do x = i - 1, i + 1
        if (attractor_at(regions, x, y) /= regions%label(i, l)) return
      end do
    end do
    surrounded = .true.
  end function is_surrounded

  !> The attractor of a whole cell of the circle, in any column; 0 = none has all of it.
  pure function attractor_at(regions, column, row) result(a)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: column, row
    integer :: a
    integer :: i, l
    logical :: mirrored

    i = column
    l = row
    call fold_cell(regions, i, l, mirrored)
    a = max(regions%label(i, l), 0)
    if (a > 0 .and. mirrored) a = regions%mirror(a)
  end function attractor_at

end module kz_grown_aging
