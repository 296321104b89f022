!> Orbits in more than double precision with their errors beside them. Their tangent map is the scene's own in double precision,
!> which is enough for an error.
module kz_labels_precise_map
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: map_t, flow_t, put_state, WIDTH, PI
  use kz_cycles_cycles, only: attractor_t
  use kz_grown_grid, only: regions_t
  use kz_labels_covariance, only: error_map_t, move_error
  use kz_maps_states, only: separation
  implicit none
  private
  public :: precise_map_t, make_precise_map

  type, extends(error_map_t) :: precise_map_t
    private
    class(map_t), allocatable :: inner !< shows its states in the coordinates of `flow`
    class(flow_t), allocatable :: flow !< the scene's map
    real(dp) :: error = 0              !< of a start and of a period of the inner map, relative to hypot(pi, v)
  contains
    procedure :: put
    procedure :: move
    procedure :: advance
    procedure :: enter
  end type precise_map_t

contains

  !> The map that carries the errors of a precise one.
  subroutine make_precise_map(inner, error, flow, regions, attractors, map)
    !> the precise map; its states are shown in the coordinates of the flow
    class(map_t), intent(in) :: inner
    !> of a start and of a period, relative to hypot(pi, v)
    real(dp), intent(in) :: error
    !> the scene's map
    class(flow_t), intent(in) :: flow
    !> the trapping regions
    type(regions_t), target, intent(in) :: regions
    !> the catalogue, numbered from 1
    type(attractor_t), target, intent(in) :: attractors(:)
    !> the map
    type(precise_map_t), intent(out) :: map

    allocate (map%inner, source=inner)
    allocate (map%flow, source=flow)
    map%error = error
    map%regions => regions
    map%attractors => attractors
  end subroutine make_precise_map

  subroutine put(self, lane, u, v)
    class(precise_map_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v

    call put_state(self, lane, u, v)
    call self%inner%put(lane, u, v)
    call self%start_error(lane, self%error*hypot(PI, v))
  end subroutine put

  subroutine enter(self, n, matrix, first)
    class(precise_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first

    call self%inner%enter(n, matrix, first)
    call show(self, n)
  end subroutine enter

  subroutine move(self, from, to)
    class(precise_map_t), intent(inout) :: self
    integer, intent(in) :: from
    integer, intent(in) :: to

    call move_error(self, from, to)
    call self%inner%move(from, to)
  end subroutine move

  !> One period of n lanes and of their errors. The regions are those of the scene's map: a state is seen as far from where it is
  !> as that map errs here.
  subroutine advance(self, n)
    class(precise_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp) :: tangent(2, 2, WIDTH), error(WIDTH), seen(WIDTH)
    integer :: lane

    do lane = 1, n
      tangent(:, :, lane) = reshape([1, 0, 0, 1], [2, 2])
      call self%flow%put(lane, self%u(lane), self%v(lane))
    end do
    call self%flow%advance_tangent(n, tangent)
    call self%inner%advance(n)
    call show(self, n)
    error(:n) = self%error*hypot(PI, self%v(:n))
    seen(:n) = separation(self%u(:n), self%v(:n), self%flow%u(:n), self%flow%v(:n))
    call self%classify_errors(n, tangent, error, seen)
  end subroutine advance

  !> What the inner map shows of its states.
  subroutine show(self, n)
    class(precise_map_t), intent(inout) :: self
    integer, intent(in) :: n

    self%u(:n) = self%inner%u(:n)
    self%v(:n) = self%inner%v(:n)
    self%turns(:n) = self%inner%turns(:n)
  end subroutine show

end module kz_labels_precise_map
