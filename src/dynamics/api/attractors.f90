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
  use kz_grown_bands, only: has_band
  use kz_vector_map, only: PI
  implicit none
  private
  public :: row_of

contains

  function cycle_size(handle) bind(C, name='kz_dynamics_cycle_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = 1 + packed_cycle_size(d%search%max_period) + d%search%max_period
  end function cycle_size

  function chaos_size() bind(C, name='kz_dynamics_chaos_size') result(n)
    integer(c_int64_t) :: n

    n = packed_chaos_size()
  end function chaos_size

  !> found: states looked at; the catalogue of what was found; how often each period was blurred.
  subroutine search_cycle(handle, n, state, closeness, found) bind(C, name='kz_dynamics_find_cycle')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n)
    real(dp), value :: closeness
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer, allocatable :: n_blurred(:)
    integer :: next, n_known, first, last

    d => of_handle(handle)
    n_known = size(d%attractors)
    first = 2 + packed_cycle_size(d%search%max_period)
    last = first + d%search%max_period - 1
    next = nint(found(1)) + 1
    n_blurred = nint(found(first:last))
    call find_cycle(d%search, state(1, :), state(2, :), closeness, next, n_blurred, d%attractors)
    found(1) = next - 1
    found(first:last) = n_blurred
    call take_new(d, n_known, found(2))
  end subroutine search_cycle

  subroutine search_chaos(handle, state, found) bind(C, name='kz_dynamics_find_chaos')
    type(c_ptr), value :: handle
    real(dp), intent(in) :: state(2)
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer :: n_known

    d => of_handle(handle)
    n_known = size(d%attractors)
    call find_chaos(d%search, d%regions, state(1), state(2), d%attractors)
    call take_new(d, n_known, found)
  end subroutine search_chaos

  subroutine search_running(handle, n, state, age, found) bind(C, name='kz_dynamics_find_running')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n)
    integer(c_int64_t), value :: age
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer :: n_known

    d => of_handle(handle)
    n_known = size(d%attractors)
    call find_running(d%search, d%regions, state, real(age, dp), d%attractors)
    call take_new(d, n_known, found)
  end subroutine search_running

  !> Takes the attractors beyond the first n_known out of the catalogue, packed.
  subroutine take_new(d, n_known, flat)
    type(dynamics_t), intent(inout) :: d
    integer, intent(in) :: n_known
    real(dp), intent(inout) :: flat(*)

    associate (new => packed(d%attractors(n_known + 1:)))
      flat(:size(new)) = new
    end associate
    d%attractors = d%attractors(:n_known)
  end subroutine take_new

  subroutine adopt(handle, flat) bind(C, name='kz_dynamics_adopt')
    type(c_ptr), value :: handle
    real(dp), intent(in) :: flat(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call append_known(d, flat(:max(packed_cycle_size(d%search%max_period), packed_chaos_size())))
  end subroutine adopt

  function packed_size(handle) bind(C, name='kz_dynamics_packed_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = size(packed(d%attractors))
  end function packed_size

  subroutine pack_catalogue(handle, n, flat) bind(C, name='kz_dynamics_pack')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(out) :: flat(n)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    flat = packed(d%attractors)
  end subroutine pack_catalogue

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

  !> 1 if it is known of an attractor only by averages along orbits that it is one, else 0.
  function is_averaged(handle, number) bind(C, name='kz_dynamics_is_averaged') result(averaged)
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: number
    integer(c_int32_t) :: averaged
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    averaged = merge(1, 0, d%attractors(number)%period == RUNNING .and. .not. has_band(d%attractors(number)))
  end function is_averaged

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
                          a%mirror, PI*a%mean, &
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
