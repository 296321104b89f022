!> Trapping regions for pictures that move; it is likely, not certain, that they trap. Those of a pendulum nearby serve
!> for another one. And where damping is weak, images of cells shrink too slowly for regions to grow; but orbits that
!> have been followed to their ends show where motions go: a cell joins an attractor if all orbits that visited it end
!> there, and visited only such cells from then on.
module kz_live_moving
  use, intrinsic :: iso_c_binding, only: dp => c_double, int32 => c_int32_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_grid, only: regions_t, make_regions, chaos_region, find_regions, note_closed
  use kz_computed_places, only: fold_cell, number_cells
  use kz_vector_map, only: flow_t, WIDTH
  use kz_maps_lanes, only: lanes_t
  implicit none
  private
  public :: aged_regions, learn_regions

  !> Orbits that visit a cell before it is believed.
  integer, parameter :: FEWEST_ORBITS = 4
  !> Mark of a cell whose orbits end on different attractors or on none, or leave the cells of their attractor again.
  integer, parameter :: MIXED = -1

  !> The visits of orbits, one orbit after the other.
  type :: visits_t
    integer(int32), allocatable :: cell(:) !< cells of the stored half, from 1; negative: mirrored; 0: outside the grid
    integer, allocatable :: last(:)        !< last visit of each orbit, from 0 = none
    integer, allocatable :: ends(:)        !< attractor of each orbit, 0 = none
    integer :: orbits = 0
  end type visits_t

  !> Orbits in the lanes of a flow.
  type, extends(lanes_t) :: visitors_t
    type(regions_t), pointer :: regions => null()
    type(attractor_t), pointer :: attractors(:) => null()
    class(flow_t), pointer :: flow => null()
    real(dp), pointer :: state(:, :) => null()
    integer :: budget = 0                    !< periods of all orbits
    integer :: next = 1                      !< start that enters next
    logical :: begun = .false.
    integer :: age(WIDTH) = 0                !< periods
    integer :: region(WIDTH) = 0, cell(WIDTH) = 0 !< where the orbits are
    integer(int32), allocatable :: path(:, :) !< cells visited so far
    type(visits_t) :: visits
  contains
    procedure :: fill, advance, is_done, move
  end type visitors_t

contains

  !> A grid in which a cell keeps its attractor only if all its neighbours have the same one. Ellipses are drawn anew.
  function aged_regions(old, number) result(regions)
    type(regions_t), intent(in) :: old !< regions of the other pendulum
    integer, intent(in) :: number(:) !< present numbers of its attractors; 0 = gone
    type(regions_t) :: regions
    integer :: around(-1:old%n_theta, 0:old%n_velocity - 1), unlike(0:old%n_theta - 1), i, l

    regions = make_regions(old%n_circle, old%n_velocity, old%top, old%mirrored)
    around(0:old%n_theta - 1, :) = max(old%label, 0)
    around(-1, :) = [(attractor_at(old, -1, l), l=0, old%n_velocity - 1)]
    around(old%n_theta, :) = [(attractor_at(old, old%n_theta, l), l=0, old%n_velocity - 1)]
    do l = 1, old%n_velocity - 2
      call compare(old%n_theta, around(:, l - 1:l + 1), unlike)
      do i = 0, old%n_theta - 1
        if (around(i, l) > 0 .and. unlike(i) == 0) regions%label(i, l) = number(around(i, l))
      end do
    end do
  end function aged_regions

  !> unlike = 0 where all neighbours of a cell of the row in the middle have its attractor. Uses vectors.
  pure subroutine compare(n, row, unlike)
    integer, intent(in) :: n, row(0:n + 1, 3)
    integer, intent(out) :: unlike(n)
    integer :: i, y

    unlike = 0
    do y = 1, 3
      do i = 1, n
        unlike(i) = ior(unlike(i), ior(ior(ieor(row(i - 1, y), row(i, 2)), ieor(row(i, y), row(i, 2))), &
                                       ieor(row(i + 1, y), row(i, 2))))
      end do
    end do
  end subroutine compare

  !> The attractor of a whole cell of the circle, in any column; 0 = none has all of it.
  pure function attractor_at(regions, column, row) result(a)
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: column, row
    integer :: a, i, l
    logical :: mirrored

    i = column
    l = row
    call fold_cell(regions%grid_t, i, l, mirrored)
    a = max(regions%label(i, l), 0)
    if (a > 0 .and. mirrored) a = regions%mirror(a)
  end function attractor_at

  !> Follows orbits until each is trapped, and extends the regions by the cells of which all end alike. It ends early
  !> when the orbits together have spent `budget` periods.
  subroutine learn_regions(regions, attractors, flow, state, most, budget)
    type(regions_t), intent(inout), target :: regions !< the trapping regions of all attractors
    type(attractor_t), intent(in), target :: attractors(:) !< the catalogue, numbered from 1
    class(flow_t), intent(inout), target :: flow !< the map of one drive period
    real(dp), intent(in), target :: state(:, :) !< [2, n] physical states: half-turns, rad per drive radian
    integer, intent(in) :: most !< most periods of an orbit
    integer, intent(in) :: budget !< most periods of all orbits
    type(visitors_t) :: visitors
    integer, allocatable :: label(:, :), orbits(:, :)

    allocate (label, mold=regions%label)
    visitors%regions => regions
    visitors%attractors => attractors
    visitors%flow => flow
    visitors%state => state
    visitors%budget = budget
    allocate (visitors%path(most, WIDTH))
    associate (visits => visitors%visits)
      allocate (visits%cell(budget), visits%last(0:size(state, 2)), visits%ends(size(state, 2)))
      visits%last(0) = 0
    end associate
    call visitors%run()
    allocate (orbits, mold=regions%label)
    call believe(visitors%visits, regions%mirror, size(label), label, orbits)
    call drop_leaks(visitors%visits, size(label), label)
    where (regions%label <= 0 .and. label > 0 .and. orbits >= FEWEST_ORBITS) regions%label = label
    call note_closed(regions)
  end subroutine learn_regions

  function fill(self, lane) result(yes)
    class(visitors_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    yes = self%next <= size(self%state, 2)
    if (.not. yes) return
    self%age(lane) = 0
    call self%flow%put(lane, self%state(1, self%next), self%state(2, self%next))
    call self%flow%to_map(lane, first=lane)
    self%next = self%next + 1
  end function fill

  !> The starts themselves are looked at first.
  subroutine advance(self, list, n)
    class(visitors_t), intent(inout) :: self
    integer, intent(out) :: list(WIDTH), n
    integer :: i

    n = self%active
    if (self%begun) call self%flow%advance(n)
    self%begun = .true.
    call find_regions(self%regions, self%attractors, n, self%flow%u(:n), self%flow%v(:n), self%region)
    call number_cells(self%regions%grid_t, n, self%flow%u(:n), self%flow%v(:n), self%cell)
    where (abs(self%cell(:n)) > size(self%regions%label)) self%cell(:n) = 0
    list(:n) = [(i, i=n, 1, -1)]
  end subroutine advance

  !> An untrapped orbit ends after its periods on the attractor whose cover it is in; all end when the budget is spent.
  function is_done(self, lane) result(yes)
    class(visitors_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes
    integer :: end

    end = self%region(lane)
    yes = self%next > size(self%state, 2) + 1 .or. end > 0 .or. self%age(lane) >= size(self%path, 1)
    if (.not. yes) then
      self%age(lane) = self%age(lane) + 1
      self%path(self%age(lane), lane) = self%cell(lane)
    else if (self%visits%last(self%visits%orbits) + self%age(lane) > self%budget) then
      self%next = size(self%state, 2) + 2 ! no more starts, and no more orbits
    else if (self%next <= size(self%state, 2) + 1) then
      if (end == 0 .and. size(self%regions%covered) > 0) &
        end = chaos_region(self%regions, self%flow%u(lane), self%flow%v(lane))
      call add_orbit(self%visits, self%path(:self%age(lane), lane), end)
    end if
  end function is_done

  subroutine move(self, from, to)
    class(visitors_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call self%flow%move(from, to)
    self%path(:self%age(from), to) = self%path(:self%age(from), from)
    self%age(to) = self%age(from)
  end subroutine move

  subroutine add_orbit(visits, path, end)
    type(visits_t), intent(inout) :: visits
    integer(int32), intent(in) :: path(:)
    integer, intent(in) :: end
    integer :: first

    first = visits%last(visits%orbits) + 1
    visits%orbits = visits%orbits + 1
    visits%last(visits%orbits) = first + size(path) - 1
    visits%cell(first:visits%last(visits%orbits)) = path
    visits%ends(visits%orbits) = end
  end subroutine add_orbit

  !> label(c) = the attractor of all orbits that visited cell c, if they are enough.
  subroutine believe(visits, mirror, n, label, orbits)
    type(visits_t), intent(in) :: visits
    integer, intent(in) :: mirror(:), n
    integer, intent(out) :: label(n), orbits(n)
    integer, allocatable :: latest(:)
    integer :: orbit, i, c, a

    allocate (latest(n), source=0)
    orbits = 0
    label = 0
    do orbit = 1, visits%orbits
      do i = visits%last(orbit - 1) + 1, visits%last(orbit)
        c = abs(visits%cell(i))
        if (c == 0) cycle
        if (latest(c) /= orbit) orbits(c) = orbits(c) + 1
        latest(c) = orbit
        a = visits%ends(orbit)
        if (a > 0 .and. visits%cell(i) < 0) a = mirror(a)
        if (a == 0 .or. (label(c) /= 0 .and. label(c) /= a)) a = MIXED
        label(c) = a
      end do
    end do
  end subroutine believe

  !> A cell from which an orbit comes to a mixed one is not believed.
  subroutine drop_leaks(visits, n, label)
    type(visits_t), intent(in) :: visits
    integer, intent(in) :: n
    integer, intent(inout) :: label(n)
    integer :: orbit, i, c
    logical :: open(0:n), leaks(0:n), leaking

    open(0) = .true.
    open(1:) = label == MIXED
    leaks = open
    do orbit = 1, visits%orbits
      leaking = .false.
      do i = visits%last(orbit), visits%last(orbit - 1) + 1, -1
        c = abs(visits%cell(i))
        leaking = leaking .or. open(c)
        leaks(c) = leaks(c) .or. leaking
      end do
    end do
    where (leaks(1:)) label = MIXED
  end subroutine drop_leaks

end module kz_live_moving
