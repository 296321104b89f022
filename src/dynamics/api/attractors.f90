!> The C interface of dynamics: the search for attractors, and their catalogue (include/kapitza/dynamics.h).
module kz_api_attractors
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_attractors_catalogue, only: order_of, packed, packed_cycle_size, packed_chaos_size, unpack
  use kz_attractors_chaos, only: find_chaos
  use kz_attractors_cycle_search, only: append, find_cycle
  use kz_attractors_running, only: find_running
  use kz_cycles_cycles, only: attractor_t, enter_points, RUNNING
  use kz_cycles_described, only: attractor_row_t
  use kz_computed_bands, only: has_band
  use kz_vector_map, only: PI
  implicit none
  private
  public :: row_of

  !> Implements kz_find of dynamics.h.
  integer(c_int32_t), parameter :: OF_CYCLES = 0, OF_RUNNING = 1

contains

  function find_size(handle, what) bind(C, name='kz_dynamics_find_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: what
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = 1 + packed_chaos_size()
    if (what == OF_CYCLES) n = 1 + packed_cycle_size(d%search%max_period) + d%search%max_period
  end function find_size

  !> found: states looked at; the catalogue of what was found; of cycles how often each period was blurred.
  subroutine find(handle, what, n, state, number, found) bind(C, name='kz_dynamics_find')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: what
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n)
    real(dp), value :: number
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer, allocatable :: n_blurred(:)
    integer :: next, n_known, first, last

    d => of_handle(handle)
    n_known = size(d%attractors)
    select case (what)
    case (OF_CYCLES)
      last = int(find_size(handle, what))
      first = last - d%search%max_period + 1
      next = nint(found(1)) + 1
      n_blurred = nint(found(first:last))
      call find_cycle(d%search, state(1, :), state(2, :), number, next, n_blurred, d%attractors)
      found(1) = next - 1
      found(first:last) = n_blurred
    case (OF_RUNNING)
      call find_running(d%search, d%regions, state, number, d%attractors)
    case default
      call find_chaos(d%search, d%regions, state(1, 1), state(2, 1), d%attractors)
    end select
    associate (new => packed(d%attractors(n_known + 1:)))
      found(2:1 + size(new)) = new
    end associate
    d%attractors = d%attractors(:n_known)
  end subroutine find

  subroutine adopt(handle, found) bind(C, name='kz_dynamics_adopt')
    type(c_ptr), value :: handle
    real(dp), intent(in) :: found(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call append_known(d, found(2:1 + max(packed_cycle_size(d%search%max_period), packed_chaos_size())))
  end subroutine adopt

  function pack_catalogue(handle, n, flat) bind(C, name='kz_dynamics_pack') result(needed)
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(out) :: flat(n)
    integer(c_int64_t) :: needed
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    associate (all => packed(d%attractors))
      needed = size(all)
      if (needed <= n) flat(:needed) = all
    end associate
  end function pack_catalogue

  subroutine unpack_catalogue(handle, n, flat) bind(C, name='kz_dynamics_unpack')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: flat(n)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    deallocate (d%attractors)
    allocate (d%attractors(0))
    call append_known(d, flat)
  end subroutine unpack_catalogue

  !> Attractors that were found elsewhere; their strobe points in the coordinates of this map are found again.
  subroutine append_known(d, flat)
    type(dynamics_t), intent(inout) :: d
    real(dp), intent(in) :: flat(:)
    type(attractor_t), allocatable :: known(:)
    integer :: i

    call unpack(flat, known)
    do i = 1, size(known)
      if (known(i)%period > 0) call enter_points(d%search%flow, known(i))
      call append(d%attractors, known(i))
    end do
  end subroutine append_known

  function attractor_count(handle) bind(C, name='kz_dynamics_count') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = size(d%attractors)
  end function attractor_count

  subroutine attractor_row(handle, number, row) bind(C, name='kz_dynamics_attractor')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: number
    type(attractor_row_t), intent(out) :: row
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    row = row_of(d%attractors(number))
  end subroutine attractor_row

  !> An attractor as C has it.
  pure function row_of(a) result(row)
    type(attractor_t), intent(in) :: a !< its angles are half-turns
    type(attractor_row_t) :: row

    row = attractor_row_t(PI*a%mean, a%mean_velocity, max(a%period, 0), a%winding, a%centre, merge(1, 0, a%symmetric), &
                          a%mirror, merge(1, 0, a%period == RUNNING .and. .not. has_band(a)), PI*a%mean, &
                          a%mean_velocity, a%amplitude, real(a%multiplier, dp), aimag(a%multiplier), a%lyapunov, &
                          a%lyapunov_error)
    if (a%period <= 0) return
    row%theta = half_open(a%u(1))
    row%velocity = a%v(1) + 0.0_dp
  end function row_of

  subroutine attractor_points(handle, number, theta, velocity) bind(C, name='kz_dynamics_strobe')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: number
    real(dp), intent(inout) :: theta(*), velocity(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    associate (a => d%attractors(number))
      if (a%period <= 0) return
      theta(:a%period) = half_open(a%u)
      velocity(:a%period) = a%v + 0.0_dp
    end associate
  end subroutine attractor_points

  !> Half-turns to rad in [-pi, pi), never -0.
  elemental function half_open(u) result(theta)
    real(dp), intent(in) :: u
    real(dp) :: theta

    theta = PI*u + 0.0_dp
    if (theta >= PI) theta = -PI
  end function half_open

  subroutine attractor_order(handle, number) bind(C, name='kz_dynamics_order')
    type(c_ptr), value :: handle
    integer(c_int64_t), intent(out) :: number(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    number(:size(d%attractors)) = order_of(d%attractors)
  end subroutine attractor_order

end module kz_api_attractors
