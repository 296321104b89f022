!> A cycle of one pendulum as branches of a sweep hold it: include/kapitza/dynamics_cycles.h.
module kz_cycles_described
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr, c_associated, c_f_pointer, c_loc
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_model_pendulum, only: pendulum_t, is_same
  use kz_cycles_cycles, only: attractor_t
  use kz_cycles_features, only: find_features
  use kz_maps_matrices, only: eigenvalues, IDENTITY
  use kz_maps_states, only: angle_difference, separation
  implicit none
  private
  public :: attractor_row_t

  !> Memory of kz_attractor of dynamics.h.
  type, bind(C) :: attractor_row_t
    real(dp) :: theta, velocity
    integer(c_int32_t) :: period, winding, centre, symmetric, mirror, averaged
    real(dp) :: mean, mean_velocity, amplitude, multiplier_re(2), multiplier_im(2), lyapunov, lyapunov_error
  end type attractor_row_t

  !> rad: states nearer than this are one.
  real(dp), parameter :: ONE = 1e-7_dp
  !> One cycle has one multiplier: two that differ by more belong to two.
  real(dp), parameter :: ALIKE = 1e-2_dp

  type :: fine_map_t
    type(pendulum_t) :: pendulum
    class(flow_t), allocatable :: flow !< whose steps are not fused
  end type fine_map_t

  !> The object that kz_fine_maps of dynamics_cycles.h points at.
  type :: fine_maps_t
    type(fine_map_t), allocatable :: map(:)
    integer :: oldest = 1 !< the next map that is made takes its place
  end type fine_maps_t

contains

  type(c_ptr) function maps_create(n) bind(C, name='kz_fine_maps_create') result(handle)
    integer(c_int64_t), value :: n
    type(fine_maps_t), pointer :: maps

    allocate (maps)
    allocate (maps%map(n))
    handle = c_loc(maps)
  end function maps_create

  subroutine maps_free(handle) bind(C, name='kz_fine_maps_free')
    type(c_ptr), value :: handle
    type(fine_maps_t), pointer :: maps

    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, maps)
    deallocate (maps)
  end subroutine maps_free

  !> The map of a pendulum, kept or made.
  subroutine find_map(handle, pendulum, own, map)
    type(c_ptr), intent(in) :: handle !< kz_fine_maps; null = none are kept
    type(pendulum_t), intent(in) :: pendulum
    type(fine_map_t), intent(inout), target :: own !< serves where none are kept
    type(fine_map_t), intent(out), pointer :: map
    type(fine_maps_t), pointer :: maps
    integer :: i

    map => own
    if (c_associated(handle)) then
      call c_f_pointer(handle, maps)
      do i = 1, size(maps%map)
        map => maps%map(i)
        if (.not. allocated(map%flow)) exit
        if (is_same(map%pendulum, pendulum)) return
      end do
      if (i > size(maps%map)) map => maps%map(maps%oldest)
      if (i > size(maps%map)) maps%oldest = mod(maps%oldest, size(maps%map)) + 1
    end if
    map%pendulum = pendulum
    call make_flow(pendulum, fine_numerics(pendulum), .false., map%flow)
  end subroutine find_map

  subroutine describe(handle, pendulum, n, state, point) bind(C, name='kz_branch_describe')
    type(c_ptr), value :: handle
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n) !< strobe points, equally far apart: rad, rad per drive radian
    type(attractor_row_t), intent(inout) :: point !< period, in; the rest, out
    type(fine_map_t), target :: own
    type(fine_map_t), pointer :: map
    type(attractor_t) :: cycle
    complex(dp) :: multiplier(2)
    real(dp) :: matrix(2, 2), u(n)
    integer :: periods

    u = angle_difference(state(1, :)/PI, 0.0_dp)
    point%theta = PI*u(1)
    point%velocity = state(2, 1)
    periods = int(point%period/n)
    call find_map(handle, pendulum, own, map)
    call close_pieces(map%flow, periods, u, state(2, :), cycle%winding, matrix)
    call find_features(map%flow, pendulum, cycle, u, state(2, :), periods)
    multiplier = eigenvalues(matrix, exp(-2*PI*pendulum%beta*point%period))
    point%multiplier_re = real(multiplier, dp)
    point%multiplier_im = aimag(multiplier)
    point%winding = cycle%winding
    point%centre = cycle%centre
    point%amplitude = cycle%amplitude
  end subroutine describe

  !> Winding and monodromy of a closed orbit from pieces that are followed together. So the error of one does not grow
  !> along the others, which matters where the orbit repels.
  subroutine close_pieces(flow, periods, u, v, winding, matrix)
    class(flow_t), intent(inout) :: flow !< the map of one drive period, by integration
    integer, intent(in) :: periods !< drive periods of a piece
    real(dp), intent(in) :: u(:), v(:) !< their starts, in the order of time
    integer, intent(out) :: winding !< net turns
    real(dp), intent(out) :: matrix(2, 2) !< derivative of the map over all pieces
    real(dp) :: tangent(2, 2, WIDTH)
    integer :: i, n

    n = size(u)
    call flow%put_all(u, v)
    tangent = spread(IDENTITY, 3, WIDTH)
    do i = 1, periods
      call flow%advance_tangent(n, tangent)
    end do
    winding = nint(0.5_dp*sum(2*real(flow%turns(:n), dp) + flow%u(:n) - u))
    matrix = tangent(:, :, 1)
    do i = 2, n
      matrix = matmul(tangent(:, :, i), matrix)
    end do
  end subroutine close_pieces

  function same_cycle(handle, pendulum, a, b) bind(C, name='kz_branch_same') result(same)
    type(c_ptr), value :: handle
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m of both
    type(attractor_row_t), intent(in) :: a !< a cycle
    type(attractor_row_t), intent(in) :: b !< attractor to compare with a
    integer(c_int32_t) :: same
    type(fine_map_t), target :: own
    type(fine_map_t), pointer :: map
    integer :: i

    same = 0
    if (a%period /= b%period .or. a%winding /= b%winding .or. a%symmetric /= b%symmetric) return
    if (hypot(a%multiplier_re(1) - b%multiplier_re(1), abs(a%multiplier_im(1)) - abs(b%multiplier_im(1))) &
        > ALIKE*max(1.0_dp, abs(b%multiplier_re(1)))) return
    if (separation(a%theta/PI, a%velocity, b%theta/PI, b%velocity) < ONE) same = 1
    if (same == 1 .or. a%period == 1) return
    call find_map(handle, pendulum, own, map)
    associate (flow => map%flow)
      call flow%put(1, a%theta/PI, a%velocity)
      do i = 1, a%period - 1
        call flow%advance(1)
        if (separation(flow%u(1), flow%v(1), b%theta/PI, b%velocity) < ONE) same = 1
      end do
    end associate
  end function same_cycle

end module kz_cycles_described
