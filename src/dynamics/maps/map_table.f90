!> The map table of interpolated cell mapping: the displacement F(x) - x on a grid of nodes, and the map that
!> interpolates it.
!>
!> Its angle is that of a free flight at mid-period (`midperiod_angle`). The mirror symmetry halves the table: only
!> angles 0 .. pi are stored; a state is folded there, and its image unfolded.
module kz_maps_map_table
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_vector_map, only: map_t, flow_t, WIDTH
  use kz_maps_states, only: midperiod_angle, MIDPERIOD
  implicit none
  private
  public :: table_t, make_table, table_row, set_table_rows, inner_top, table_map_t, make_table_map

  integer, parameter :: GHOSTS = 2
  !> Adding it rounds to an integer.
  real(dp), parameter :: ROUND_TO_INTEGER = 1.5_dp*2.0_dp**52

  type :: table_t
    integer :: n_circle = 0   !< nodes on the whole circle of mid-period angles
    integer :: n_theta = 0    !< cells from angle 0 to pi (the last may reach beyond)
    integer :: n_own = 0      !< nodes from 0 to pi: 0 .. n_own
    integer :: n_velocity = 0 !< nodes of the velocity
    real(dp) :: top = 0       !< largest velocity; the smallest is -top
    !> Shift in a period (half-turns at mid-period, rad per radian), (2, -GHOSTS : n_theta + GHOSTS, n_velocity)
    real(dp), allocatable :: shift(:, :, :)
  end type table_t

  !> Where lanes lie in the table.
  type :: place_t
    real(dp) :: fold(WIDTH)   !< -1 where the mirror image is stored; 0 at the two rests, which are their own images
    integer(c_int32_t) :: i(WIDTH) !< cell of the angle, from 0
    integer(c_int32_t) :: j(WIDTH) !< cell of the velocity, from 0
    real(dp) :: x(WIDTH)      !< within the cell, [0, 1)
    real(dp) :: y(WIDTH)
    integer :: outside(WIDTH) !< the lanes that have no stencil; their cell is any
    integer :: n_outside
  end type place_t

  type, extends(map_t) :: table_map_t
    type(table_t), pointer :: table => null()
    integer :: points = 6     !< points of the stencil along an axis: 2, 6
    class(flow_t), allocatable :: flow !< integrates the periods that begin outside the table
  contains
    procedure :: advance => interpolate
    procedure :: to_map
  end type table_map_t

  interface
    !> sum_nodes.c
    subroutine sum_nodes(points, n, length, field, i, j, width, wu, wv, shift) bind(C, name='kz_sum_nodes')
      import :: c_int32_t, c_int64_t, dp
      integer(c_int32_t), value :: points, n
      integer(c_int64_t), value :: length
      real(dp), intent(in) :: field(*)
      integer(c_int32_t), intent(in) :: i(*), j(*)
      integer(c_int64_t), value :: width
      real(dp), intent(in) :: wu(*), wv(*)
      real(dp), intent(out) :: shift(*)
    end subroutine sum_nodes
  end interface

contains

  !> Makes an empty table. Its inner part, where every stencil fits, reaches the velocity `max_velocity`.
  function make_table(n_circle, n_velocity, max_velocity) result(table)
    integer, intent(in) :: n_circle !< nodes on the whole circle
    integer, intent(in) :: n_velocity !< nodes of the velocity
    real(dp), intent(in) :: max_velocity !< rad per drive radian
    type(table_t) :: table

    table%n_circle = n_circle
    table%n_theta = (n_circle + 1)/2
    table%n_own = n_circle/2
    table%n_velocity = n_velocity
    table%top = max_velocity*(n_velocity - 1)/(n_velocity - 1 - 2*GHOSTS)
    allocate (table%shift(2, -GHOSTS:table%n_theta + GHOSTS, n_velocity))
    table%shift = 0
  end function make_table

  !> The largest velocity at which every stencil fits into the table.
  pure function inner_top(table) result(v)
    type(table_t), intent(in) :: table !< the map table
    real(dp) :: v

    v = table%top*(table%n_velocity - 1 - 2*GHOSTS)/(table%n_velocity - 1)
  end function inner_top

  !> Velocity of node j = 1 .. n_velocity; node n + 1 - j has exactly the opposite one.
  pure function node_velocity(table, j) result(v)
    type(table_t), intent(in) :: table !< the map table
    integer, intent(in) :: j !< row, from 1
    real(dp) :: v

    v = (2*j - table%n_velocity - 1)*(table%top/(table%n_velocity - 1))
  end function node_velocity

  !> Integrates the nodes of row j: shift(2, 0 : n_own).
  subroutine table_row(table, flow, j, shift)
    type(table_t), intent(in) :: table !< the table whose nodes they are
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: j !< row, from 1
    real(dp), intent(out) :: shift(2, 0:table%n_own) !< displacements of its nodes
    real(dp) :: u, v
    integer :: first, n, i

    v = node_velocity(table, j)
    do first = 0, table%n_own, WIDTH
      n = min(WIDTH, table%n_own - first + 1)
      do i = 1, n
        call flow%put(i, 2*real(first + i - 1, dp)/table%n_circle - midperiod_angle(0.0_dp, v), v)
      end do
      call flow%advance(n)
      do i = 1, n
        u = 2*real(first + i - 1, dp)/table%n_circle
        shift(:, first + i - 1) = [midperiod_angle(flow%u(i) + 2*flow%turns(i), flow%v(i)) - u, flow%v(i) - v]
      end do
    end do
  end subroutine table_row

  !> Sets the table from all rows of table_row. Nodes below angle 0 and beyond pi mirror other nodes.
  subroutine set_table_rows(table, rows)
    type(table_t), intent(inout) :: table !< the map table
    real(dp), intent(in) :: rows(2, 0:table%n_own, table%n_velocity) !< displacements of all nodes
    integer :: i, n

    table%shift(:, 0:table%n_own, :) = rows
    n = table%n_velocity
    do i = -GHOSTS, -1
      table%shift(:, i, :) = -table%shift(:, -i, n:1:-1)
    end do
    do i = table%n_own + 1, table%n_theta + GHOSTS
      table%shift(:, i, :) = -table%shift(:, table%n_circle - i, n:1:-1)
    end do
  end subroutine set_table_rows

  !> The map that interpolates a table.
  function make_table_map(table, points, flow) result(map)
    type(table_t), target, intent(in) :: table !< the map table
    integer, intent(in) :: points !< nodes of the stencil along an axis: 2, 6
    class(flow_t), intent(in) :: flow !< integrates the periods that begin outside the table
    type(table_map_t) :: map

    map%table => table
    map%points = points
    allocate (map%flow, source=flow)
  end function make_table_map

  !> The coordinates of the table are those of the flow that made it.
  subroutine to_map(self, n, matrix, first)
    class(table_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first
    integer :: from, lane

    from = 1
    if (present(first)) from = first
    do lane = from, n
      call self%flow%put(lane, self%u(lane), self%v(lane))
    end do
    call self%flow%to_map(n, matrix, from)
    self%u(from:n) = self%flow%u(from:n)
    self%v(from:n) = self%flow%v(from:n)
  end subroutine to_map

  !> One period of n lanes.
  subroutine interpolate(self, n)
    class(table_map_t), intent(inout) :: self
    integer, intent(in) :: n
    type(place_t) :: place

    call locate(self, n, place)
    call displace(self, n, place)
  end subroutine interpolate

  !> Finds the cells of the table that hold the first n lanes.
  subroutine locate(self, n, place)
    class(table_map_t), intent(in) :: self !< the map
    integer, intent(in) :: n !< lanes
    type(place_t), intent(out) :: place !< where they lie
    real(dp) :: x(WIDTH), y(WIDTH), w, per_u, per_v, lowest, highest
    integer :: lane

    per_u = 0.5_dp*self%table%n_circle
    per_v = (self%table%n_velocity - 1)/(2*self%table%top)
    lowest = self%points/2 - 1
    highest = self%table%n_velocity - 1 - lowest
    do lane = 1, WIDTH
      w = self%u(lane) + MIDPERIOD*self%v(lane)
      w = w - 2*((0.5_dp*w + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
      place%fold(lane) = merge(1.0_dp, -1.0_dp, w > 0 .or. (.not. w < 0 .and. self%v(lane) >= 0))
      if (.not. abs(self%v(lane)) > 0 .and. (.not. abs(w) > 0 .or. abs(w) >= 1)) place%fold(lane) = 0
      x(lane) = abs(w)*per_u
      y(lane) = (place%fold(lane)*self%v(lane) + self%table%top)*per_v
    end do
    place%n_outside = 0
    do lane = 1, n
      if (y(lane) >= lowest .and. y(lane) < highest .and. x(lane) <= per_u) cycle
      place%n_outside = place%n_outside + 1
      place%outside(place%n_outside) = lane
      x(lane) = 0
      y(lane) = lowest
    end do
    do lane = 1, n
      place%i(lane) = min(int(x(lane)), self%table%n_theta - 1)
      place%j(lane) = int(y(lane))
      place%x(lane) = x(lane) - place%i(lane)
      place%y(lane) = y(lane) - place%j(lane)
    end do
  end subroutine locate

  !> Moves n lanes from their places by Lagrange interpolation over the nodes around each state.
  subroutine displace(self, n, place)
    class(table_map_t), intent(inout) :: self !< the map
    integer, intent(in) :: n !< lanes
    type(place_t), intent(in) :: place !< where they lie
    real(dp) :: x(WIDTH), y(WIDTH), shift(2, WIDTH), wu(WIDTH, 6), wv(WIDTH, 6), w
    integer :: lane

    associate (p => place)
      call lagrange(self%points, p%x, wu)
      call lagrange(self%points, p%y, wv)
      call sum_nodes(self%points, n, size(self%table%shift(:, :, 1), kind=c_int64_t), self%table%shift(1, 0, 1), p%i, &
                     p%j, int(WIDTH, c_int64_t), wu, wv, shift)
      do lane = 1, n
        x(lane) = self%u(lane) + p%fold(lane)*(shift(1, lane) - MIDPERIOD*shift(2, lane))
        y(lane) = self%v(lane) + p%fold(lane)*shift(2, lane)
      end do
    end associate
    if (place%n_outside > 0) call integrate(self, place%outside(:place%n_outside), x, y)
    do lane = 1, n
      w = (0.5_dp*x(lane) + ROUND_TO_INTEGER) - ROUND_TO_INTEGER
      self%turns(lane) = self%turns(lane) + int(w, c_int64_t)
      self%u(lane) = x(lane) - 2*w
      self%v(lane) = y(lane)
    end do
  end subroutine displace

  !> The lanes `outside` through one period by integration; x (unwrapped half-turns) and y (velocity) take the images.
  subroutine integrate(self, outside, x, y)
    class(table_map_t), intent(inout) :: self
    integer, intent(in) :: outside(:)
    real(dp), intent(inout) :: x(WIDTH), y(WIDTH)
    integer :: k

    do k = 1, size(outside)
      call self%flow%put(k, self%u(outside(k)), self%v(outside(k)))
    end do
    call self%flow%advance(size(outside))
    do k = 1, size(outside)
      x(outside(k)) = self%flow%u(k) + 2*self%flow%turns(k)
      y(outside(k)) = self%flow%v(k)
    end do
  end subroutine integrate

  !> Weights of Lagrange's polynomial for nodes 1 - points/2 .. points/2 at s in [0, 1).
  pure subroutine lagrange(points, s, w)
    integer, intent(in) :: points
    real(dp), intent(in) :: s(WIDTH)
    real(dp), intent(out) :: w(WIDTH, 6)

    select case (points)
    case (2)
      w(:, 1) = 1 - s
      w(:, 2) = s
    case default
      w(:, 1) = -(s + 1)*s*(s - 1)*(s - 2)*(s - 3)*(1/120.0_dp)
      w(:, 2) = (s + 2)*s*(s - 1)*(s - 2)*(s - 3)*(1/24.0_dp)
      w(:, 3) = -(s + 2)*(s + 1)*(s - 1)*(s - 2)*(s - 3)*(1/12.0_dp)
      w(:, 4) = (s + 2)*(s + 1)*s*(s - 2)*(s - 3)*(1/12.0_dp)
      w(:, 5) = -(s + 2)*(s + 1)*s*(s - 1)*(s - 3)*(1/24.0_dp)
      w(:, 6) = (s + 2)*(s + 1)*s*(s - 1)*(s - 2)*(1/120.0_dp)
    end select
  end subroutine lagrange

end module kz_maps_map_table
