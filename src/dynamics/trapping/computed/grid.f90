!> Where an orbit is known to be trapped: a grid of cells over the half plane of mid-period angles 0 .. pi (the whole
!> one where there is no mirror symmetry), each labelled with an attractor, overlapped by trapping ellipses, or open.
module kz_computed_grid
  use, intrinsic :: iso_c_binding, only: dp => c_double, int32 => c_int32_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_bands, only: has_band, in_band, band_holds, band_meets
  use kz_computed_ellipses, only: in_ellipse
  use kz_computed_places, only: grid_t, look_up, side, from_down, wrapped_midperiod_angle, WORD
  use kz_vector_map, only: WIDTH
  use kz_maps_states, only: angle_difference, midperiod_angle, MIDPERIOD
  implicit none
  private
  public :: regions_t, make_regions, draw_attractors, find_regions, note_closed, ellipse_at, cover_cell, chaos_region, &
            cell_holds

  !> An ellipse or a band that overlaps a cell, and the next one of that cell.
  type :: overlap_t
    integer :: attractor
    integer :: point !< strobe point of the ellipse; 0 = the band
    integer :: next
  end type overlap_t

  type, extends(grid_t) :: regions_t
    integer, allocatable :: label(:, :) !< (0 : n_theta - 1, 0 : n_velocity - 1): attractor, from 1; -overlap; 0 open
    integer(int32), allocatable :: closed(:) !< one bit for each cell, then one for the outside: may a region be there?
    integer, allocatable :: drawn(:, :) !< labels by ellipses and bands alone: cells grown since do not hide them
    type(overlap_t), allocatable :: overlaps(:)
    integer :: n_overlaps = 0
    integer :: n_drawn = 0    !< attractors that have been drawn
    integer, allocatable :: mirror(:) !< number of the mirror image of each attractor
    integer, allocatable :: covered(:) !< per cover cell: visiting aperiodic attractor (from 1) without a band; or empty
  end type regions_t

  !> Cells of a chaotic attractor's cover along an axis.
  integer, parameter, public :: COVER = 512

contains

  !> Makes an open grid with an even number of columns.
  function make_regions(n_circle, n_velocity, top, mirrored) result(regions)
    integer, intent(in) :: n_circle !< cells on the whole circle
    integer, intent(in) :: n_velocity !< cells of the velocity
    real(dp), intent(in) :: top !< largest velocity, rad per drive radian
    logical, intent(in) :: mirrored !< whether mirror images of motions are motions
    type(regions_t) :: regions

    regions%n_circle = n_circle
    regions%mirrored = mirrored
    regions%n_theta = merge(n_circle/2, n_circle, mirrored)
    regions%n_velocity = n_velocity
    regions%top = top
    regions%per_u = 0.5_dp*n_circle
    regions%per_v = n_velocity/(2*top)
    allocate (regions%label(0:regions%n_theta - 1, 0:n_velocity - 1), source=0)
    allocate (regions%drawn, source=regions%label)
    allocate (regions%overlaps(64), regions%covered(0))
    allocate (regions%closed(0:size(regions%label)/WORD))
    call note_closed(regions)
  end function make_regions

  !> Adds the ellipses and covers of the attractors that are new since the last call.
  subroutine draw_attractors(regions, attractors)
    type(regions_t), intent(inout) :: regions !< the trapping regions
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    integer :: a, j, turn

    do a = regions%n_drawn + 1, size(attractors)
      do j = 1, attractors(a)%period
        do turn = -2, 2, 2
          call draw(regions, attractors(a), a, j, turn)
        end do
      end do
      if (attractors(a)%period > 0) cycle
      if (has_band(attractors(a))) then
        call draw_band(regions, attractors(a), a)
        cycle
      end if
      if (size(regions%covered) == 0) then
        deallocate (regions%covered)
        allocate (regions%covered(COVER**2), source=0)
      end if
      regions%covered(attractors(a)%cover) = a
    end do
    where (regions%label <= 0) regions%label = regions%drawn
    call note_closed(regions)
    regions%n_drawn = size(attractors)
    regions%mirror = attractors%mirror
  end subroutine draw_attractors

  !> Sets the bits of all cells from their labels: a small map of open cells that stays in the cache.
  subroutine note_closed(regions)
    type(regions_t), intent(inout) :: regions !< the trapping regions
    integer :: cell

    regions%closed = 0
    call set_bit(size(regions%label))
    do cell = 0, size(regions%label) - 1
      if (regions%label(mod(cell, regions%n_theta), cell/regions%n_theta) /= 0) call set_bit(cell)
    end do
  contains
    subroutine set_bit(cell)
      integer, intent(in) :: cell

      regions%closed(cell/WORD) = ibset(regions%closed(cell/WORD), mod(cell, WORD))
    end subroutine set_bit
  end subroutine note_closed

  !> Number (from 1) of the cover's cell with (u, v); 0 = outside. Cells n and COVER**2 + 1 - n are mirror images.
  pure function cover_cell(regions, u, v) result(cell)
    type(regions_t), intent(in) :: regions !< the trapping regions
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    integer :: cell
    real(dp) :: fold, y

    fold = side(u, v)
    cell = 0
    y = (fold*v/regions%top + 1)*(COVER/2)
    if (.not. (y >= 0 .and. y < COVER .and. abs(u) <= 1)) return
    cell = 1 + min(int((fold*u + 1)*(COVER/2)), COVER - 1) + COVER*int(y)
    if (fold < 0) cell = COVER**2 + 1 - cell
  end function cover_cell

  !> The chaotic attractor whose cover holds (u, v); 0 = none.
  pure function chaos_region(regions, u, v) result(a)
    type(regions_t), intent(in) :: regions !< the trapping regions
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    integer :: a

    a = cover_cell(regions, u, v)
    if (a > 0) a = regions%covered(a)
  end function chaos_region

  !> Draws the ellipse of strobe point j, moved by `turn` half-turns.
  subroutine draw(regions, attractor, a, j, turn)
    type(regions_t), intent(inout) :: regions
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: a, j, turn
    real(dp) :: form(3), slope, half_u, half_v, per_u, per_v, u, v
    integer :: i, l

    form = attractor%form(:, j)
    if (form(1) <= 0) return
    slope = midperiod_angle(0.0_dp, 1.0_dp)
    form = [form(1), form(2) - slope*form(1), form(3) - 2*slope*form(2) + slope**2*form(1)]
    half_u = sqrt(form(3)/(form(1)*form(3) - form(2)**2))
    half_v = sqrt(form(1)/(form(1)*form(3) - form(2)**2))
    per_u = regions%per_u
    per_v = regions%per_v
    u = angle_difference(midperiod_angle(attractor%kernel_u(j), attractor%kernel_v(j)), 0.0_dp) + turn
    v = attractor%kernel_v(j)
    do l = max(0, floor((v - half_v + regions%top)*per_v)), &
           min(regions%n_velocity - 1, floor((v + half_v + regions%top)*per_v))
      do i = max(0, floor((u - half_u)*per_u)), min(regions%n_theta - 1, floor((u + half_u)*per_u))
        if (within(form, [i/per_u - u, (i + 1)/per_u - u], &
                   [l/per_v - regions%top - v, (l + 1)/per_v - regions%top - v])) then
          regions%drawn(i, l) = a
        else if (regions%drawn(i, l) <= 0) then
          call add_overlap(regions, overlap_t(a, j, -regions%drawn(i, l)))
          regions%drawn(i, l) = -regions%n_overlaps
        end if
      end do
    end do
  end subroutine draw

  !> Draws the band of a running state.
  subroutine draw_band(regions, attractor, a)
    type(regions_t), intent(inout) :: regions
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: a
    real(dp) :: u(2), v(2)
    integer :: i, l

    do l = 0, regions%n_velocity - 1
      v = [l, l + 1]/regions%per_v - regions%top
      do i = 0, regions%n_theta - 1
        u = [i, i + 1]/regions%per_u - midperiod_angle(0.0_dp, v(2:1:-1))
        if (.not. band_meets(attractor, u, v)) cycle
        if (band_holds(attractor, u, v)) then
          regions%drawn(i, l) = a
        else if (regions%drawn(i, l) <= 0) then
          call add_overlap(regions, overlap_t(a, 0, -regions%drawn(i, l)))
          regions%drawn(i, l) = -regions%n_overlaps
        end if
      end do
    end do
  end subroutine draw_band

  !> Whether all four corners of a cell lie in the ellipse.
  pure function within(form, du, dv) result(inside)
    real(dp), intent(in) :: form(3), du(2), dv(2)
    logical :: inside
    integer :: a, b

    inside = .true.
    do b = 1, 2
      do a = 1, 2
        inside = inside .and. form(1)*du(a)**2 + 2*form(2)*du(a)*dv(b) + form(3)*dv(b)**2 < 1
      end do
    end do
  end function within

  subroutine add_overlap(regions, overlap)
    type(regions_t), intent(inout) :: regions
    type(overlap_t), intent(in) :: overlap

    if (regions%n_overlaps == size(regions%overlaps)) regions%overlaps = [regions%overlaps, regions%overlaps] ! doubled
    regions%n_overlaps = regions%n_overlaps + 1
    regions%overlaps(regions%n_overlaps) = overlap
  end subroutine add_overlap

  !> label(i) = the attractor (from 1) whose trapping region holds (u(i), v(i)), u in [-1, 1]; 0 = none.
  subroutine find_regions(regions, attractors, n, u, v, label)
    type(regions_t), intent(in) :: regions !< the trapping regions
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    integer, intent(in) :: n !< states, at most WIDTH
    real(dp), intent(in) :: u(n), v(n) !< half-turns in [-1, 1], rad per drive radian
    integer, intent(out) :: label(n) !< attractor from 1, 0 = none
    integer :: closed(WIDTH), n_closed, i

    call look_up(regions%grid_t, regions%closed, n, u, v, label)
    n_closed = 0
    do i = 1, n ! without a branch: which cells are closed cannot be foreseen
      closed(n_closed + 1) = i
      n_closed = n_closed + merge(1, 0, label(i) /= 0)
    end do
    do i = 1, n_closed
      associate (at => closed(i))
        label(at) = find_region(regions, regions%label, attractors, label(at), u(at), v(at))
      end associate
    end do
  end subroutine find_regions

  !> The attractor whose region holds (u, v), which lies in the cell of that number of look_up.
  function find_region(regions, label, attractors, number, u, v) result(a)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: label(*) !< labels of the regions, in the order of numbers
    type(attractor_t), intent(in) :: attractors(:)
    integer, intent(in) :: number
    real(dp), intent(in) :: u, v
    integer :: a
    real(dp) :: fold

    fold = sign(1, number)
    if (abs(number) > size(regions%label)) then
      a = ellipse_at(attractors(:regions%n_drawn), fold*u, fold*v)
    else
      a = label(abs(number))
      if (a < 0) a = overlap_at(regions, attractors, -a, fold*u, fold*v)
    end if
    if (a > 0 .and. number < 0) a = regions%mirror(a)
  end function find_region

  !> True if one trapped cell holds all states within (du, dv) of (u, v).
  pure function cell_holds(regions, u, v, du, dv) result(inside)
    type(regions_t), intent(in) :: regions !< the trapping regions
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    real(dp), intent(in) :: du, dv !< half-turns, rad per drive radian
    logical :: inside
    real(dp) :: w, x, y, margin_x, margin_y

    w = wrapped_midperiod_angle(u, v)
    x = regions%per_u*merge(abs(w), from_down(w), regions%mirrored)
    y = (merge(side(w, v), 1.0_dp, regions%mirrored)*v + regions%top)*regions%per_v
    margin_x = regions%per_u*(du + MIDPERIOD*dv)
    margin_y = regions%per_v*dv
    inside = .false.
    if (.not. (x < regions%n_theta .and. y >= 0 .and. y < regions%n_velocity)) return
    if (x - aint(x) <= margin_x .or. aint(x) + 1 - x <= margin_x .or. y - aint(y) <= margin_y .or. aint(y) + 1 &
        - y <= margin_y) return
    inside = regions%label(int(x), int(y)) > 0
  end function cell_holds

  !> Attractor of the first ellipse or band that holds (u, v), in the list from overlap `first` on; 0 = none.
  function overlap_at(regions, attractors, first, u, v) result(a)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    integer, intent(in) :: first
    real(dp), intent(in) :: u, v
    integer :: a, t

    t = first
    do while (t > 0)
      a = regions%overlaps(t)%attractor
      if (regions%overlaps(t)%point == 0) then
        if (in_band(attractors(a), u, v)) return
      else
        if (in_ellipse(attractors(a), regions%overlaps(t)%point, u, v)) return
      end if
      t = regions%overlaps(t)%next
    end do
    a = 0
  end function overlap_at

  !> The attractor that has an ellipse or a band around (u, v); 0 = none. It tests every one.
  pure function ellipse_at(attractors, u, v) result(a)
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    integer :: a, j

    do a = 1, size(attractors)
      do j = 1, attractors(a)%period
        if (in_ellipse(attractors(a), j, u, v)) return
      end do
      if (in_band(attractors(a), u, v)) return
    end do
    a = 0
  end function ellipse_at

end module kz_computed_grid
