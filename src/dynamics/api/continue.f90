!> The C interface of dynamics: what is known of a pendulum carried to one nearby (include/kapitza/dynamics.h).
module kz_api_continue
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr, c_loc
  use kz_lanes_step_table, only: numerics_t
  use kz_model_pendulum, only: pendulum_t, is_mirrored
  use kz_api_dynamics, only: make_dynamics
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_attractors_chaos, only: carry_chaos
  use kz_attractors_cycle_search, only: search_t, add_with_mirror, known
  use kz_cycles_cycles, only: attractor_t, close_cycle, complete_attractor
  use kz_grown_aging, only: aged_regions
  use kz_grown_grid, only: draw_attractors
  implicit none
  private

  !> rad: an attractor that moved farther counts as lost.
  real(dp), parameter :: FARTHEST = 0.2_dp

contains

  function continued(handle, pendulum, numerics, lost) bind(C, name='kz_dynamics_continue') result(moved)
    type(c_ptr), value :: handle
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    integer(c_int64_t), intent(out) :: lost !< attractors that are there no more, their mirror images not counted
    type(c_ptr) :: moved
    type(dynamics_t), pointer :: from, d
    integer, allocatable :: number(:)
    integer :: a, n_known

    from => of_handle(handle)
    d => make_dynamics(pendulum, numerics, from%search%max_period, .true.)
    allocate (number(size(from%attractors)), source=0)
    lost = 0
    do a = 1, size(from%attractors)
      if (from%attractors(a)%mirror < a .or. from%attractors(a)%period == 0) cycle
      call carry(d%search, from%attractors(a), d%attractors, number(a))
      if (number(a) == 0) lost = lost + 1
      if (number(a) > 0) number(from%attractors(a)%mirror) = d%attractors(number(a))%mirror
    end do
    d%regions = aged_regions(from%regions, number)
    call draw_attractors(d%regions, d%attractors)
    do a = 1, size(from%attractors)
      if (from%attractors(a)%mirror < a .or. from%attractors(a)%period > 0) cycle
      n_known = size(d%attractors)
      call carry_chaos(d%search, d%regions, from%attractors(a), d%attractors)
      if (size(d%attractors) == n_known) lost = lost + 1
    end do
    call draw_attractors(d%regions, d%attractors)
    moved = c_loc(d)
  end function continued

  !> Appends the cycle that continues `old`, and its mirror image; number = 0 where there is none, or none that is new.
  subroutine carry(search, old, attractors, number)
    type(search_t), intent(inout) :: search
    type(attractor_t), intent(in) :: old
    type(attractor_t), allocatable, intent(inout) :: attractors(:)
    integer, intent(out) :: number
    type(attractor_t) :: new
    logical :: found, blurred

    number = 0
    call close_cycle(search%fine, search%pendulum%beta, old%period, old%u(1), old%v(1), FARTHEST, new, found, blurred)
    new%mirrored = is_mirrored(search%pendulum) /= 0
    if (found) call complete_attractor(new, found)
    if (.not. found) return
    if (known(attractors, new%period, new%u, new%v)) return
    call add_with_mirror(search, new, attractors)
    number = size(attractors)
    if (.not. new%symmetric) number = number - 1
  end subroutine carry

end module kz_api_continue
