!> The C interface of dynamics: starts from their release to the first strobe of the final drive (include/kapitza/dynamics.h).
module kz_api_release
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_api_label, only: start_t, begin_orbit
  use kz_extended_pairs, only: pair_of, quad_of
  use kz_extended_taylor, only: qp
  use kz_labels_carrier, only: orbit_t
  use kz_labels_levels, only: LEVEL_FINE
  use kz_labels_released, only: make_released, carry_released
  use kz_labels_spread, only: add_ellipse
  use kz_lanes_map, only: PI
  use kz_model_release, only: release_t, strobes_before
  implicit none
  private

  real(qp), parameter :: PI_QUAD = acos(-1.0_qp)

contains

  subroutine set_release(handle, release) bind(C, name='kz_dynamics_set_release')
    type(c_ptr), value :: handle
    type(release_t), intent(in) :: release
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (allocated(d%released)) deallocate (d%released)
    if (allocated(d%release)) deallocate (d%release)
    if (strobes_before(release) > 0) allocate (d%release, source=release)
  end subroutine set_release

  subroutine release_starts(handle, level, n, start) bind(C, name='kz_dynamics_release')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: level
    integer(c_int64_t), value :: n
    type(start_t), intent(inout) :: start(n)
    type(dynamics_t), pointer :: d
    type(orbit_t), allocatable :: orbit(:)
    integer(c_int64_t) :: i
    logical :: precisely

    d => of_handle(handle)
    if (.not. allocated(d%release) .or. n == 0) return
    if (.not. allocated(d%released)) then
      allocate (d%released)
      call make_released(d%released, d%release, d%search%pendulum, d%regions%top)
    end if
    precisely = level > LEVEL_FINE
    allocate (orbit(n))
    do i = 1, n
      call begin_orbit(start(i), precisely, orbit(i))
    end do
    call carry_released(d%released, d%search%pendulum, precisely, orbit)
    do i = 1, n
      start(i) = start_of(orbit(i), precisely)
    end do
  end subroutine release_starts

  !> Back to rad, which costs a rounding.
  pure function start_of(orbit, precisely) result(start)
    type(orbit_t), intent(in) :: orbit
    logical, intent(in) :: precisely
    type(start_t) :: start
    real(dp) :: error(3)

    start%theta = [PI*orbit%u(1), 0.0_dp]
    if (precisely) start%theta = pair_of(PI_QUAD*quad_of(orbit%u(:2)))
    start%velocity = orbit%v
    start%periods = orbit%age
    error = orbit%p
    call add_ellipse(merge(1e-31_dp, 2*epsilon(1.0_dp), precisely)*PI, error)
    start%error = error
  end function start_of

end module kz_api_release
