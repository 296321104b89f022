!> The C interface of dynamics: the search for attractors (include/kapitza/dynamics.h).
module kz_api_search
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_attractors_catalogue, only: packed, packed_cycle_size, packed_chaos_size
  use kz_attractors_chaos, only: find_chaos
  use kz_attractors_cycle_search, only: find_cycle
  implicit none
  private

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

end module kz_api_search
