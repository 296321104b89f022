!> The reference as a stroboscopic map: states in quad precision, moved by Taylor series and seen by the trapping regions as
!> doubles.
module kz_labels_reference_map
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_maps_states, only: states_to_map
  use kz_vector_map, only: map_t, flow_t, put_state, move_state, WIDTH, CAPACITY, PI
  use kz_model_pendulum, only: pendulum_t
  use kz_maps_states, only: wrapped
  use kz_taylor_taylor, only: drive_t, make_drive, advance_period, qp, PI_QUAD
  implicit none
  private
  public :: reference_map_t, make_reference_map

  type, extends(map_t) :: reference_map_t
    private
    type(drive_t) :: drive
    real(qp) :: theta(CAPACITY) = 0    !< rad
    real(qp) :: velocity(CAPACITY) = 0 !< rad per drive radian
    real(qp), allocatable :: start(:, :) !< (2, n): exact starts, rad
    class(flow_t), allocatable :: flow !< in whose coordinates the trapping regions see the states
  contains
    procedure :: put_start
    procedure :: move
    procedure :: advance
    procedure :: to_map
  end type reference_map_t

contains

  !> A map of starts given in rad: they are put by their numbers and half-turns u, and moved as exact numbers.
  subroutine make_reference_map(map, pendulum, n_steps, flow, start, u, low)
    type(reference_map_t), intent(out) :: map !< the map
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    integer, intent(in) :: n_steps !< Steps a period where the motion is gentle
    class(flow_t), intent(in) :: flow !< in whose coordinates trapping regions are
    real(dp), intent(in) :: start(:, :) !< (2, n): rad, rad per drive radian
    real(dp), intent(out) :: u(:) !< [n] half-turns in [-1, 1]
    real(dp), intent(in), optional :: low(:, :) !< (2, n): what is to be added to the starts; nothing if left out

    call make_drive(map%drive, pendulum, n_steps)
    map%start = real(start, qp)
    if (present(low)) map%start = map%start + low
    u = wrapped(start(1, :)/PI)
    allocate (map%flow, source=flow)
  end subroutine make_reference_map

  subroutine put_start(self, lane, number, u, v)
    class(reference_map_t), intent(inout) :: self
    integer, intent(in) :: lane
    integer(c_int64_t), intent(in) :: number
    real(dp), intent(in) :: u, v

    call put_state(self, lane, u, v)
    self%theta(lane) = self%start(1, number)
    self%velocity(lane) = self%start(2, number)
  end subroutine put_start

  subroutine to_map(self, n, matrix, first)
    class(reference_map_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first
    integer :: from

    from = 1
    if (present(first)) from = first
    call states_to_map(self%flow, self%u(from:n), self%v(from:n))
    if (present(matrix)) return ! the states alone are entered
  end subroutine to_map

  subroutine move(self, from, to)
    class(reference_map_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call move_state(self, from, to)
    self%theta(to) = self%theta(from)
    self%velocity(to) = self%velocity(from)
  end subroutine move

  subroutine advance(self, n)
    class(reference_map_t), intent(inout) :: self
    integer, intent(in) :: n
    integer(c_int64_t) :: turns(WIDTH)

    turns = 0
    call advance_period(self%drive, self%theta(:n), self%velocity(:n), turns(:n))
    self%turns(:n) = self%turns(:n) + turns(:n)
    self%u(:n) = real(self%theta(:n)/PI_QUAD, dp)
    self%v(:n) = real(self%velocity(:n), dp)
    call states_to_map(self%flow, self%u(:n), self%v(:n))
  end subroutine advance

end module kz_labels_reference_map
