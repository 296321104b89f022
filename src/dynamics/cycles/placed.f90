!> Cycles at a place or on a line: include/kapitza/dynamics_curves.h.
module kz_cycles_placed
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_curves, only: plane_t, cycle_t, system_t, make_system, linearise, unknowns_of, cycle_of, UNKNOWNS, FINE
  use kz_cycles_corrector, only: newton
  implicit none
  private
  public :: at_place, on_line, outside, LEFT, CLOSED, LONG, MERGED, STUCK, NO_SEED, THIN

  !> KZ_TRACE_... of dynamics_curves.h.
  integer, parameter :: LEFT = 0, CLOSED = 1, LONG = 2, MERGED = 3, STUCK = 4, NO_SEED = 5, THIN = 6

contains

  !> Whether a place lies outside of the plane.
  pure logical function outside(plane, at)
    type(plane_t), intent(in) :: plane !< with its limits
    real(dp), intent(in) :: at(2) !< the place

    outside = any(at < plane%low .or. at > plane%high)
  end function outside

  function at_place(plane, cycle) bind(C, name='kz_cycle_solve') result(found)
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(inout) :: cycle
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.5_dp
    real(dp) :: y(UNKNOWNS), residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(system_t) :: system
    logical :: exists

    call make_system(plane, cycle%kind, 0, .false., system)
    y = unknowns_of(cycle)
    exists = newton(system, 25, LONGEST, 1e-12_dp, y) > 0
    if (exists) call linearise(system, FINE, 1, y, residual, matrix, exists)
    found = merge(1, 0, exists)
    if (exists) cycle = cycle_of(system, y)
  end function at_place

  function on_line(plane, cycle, along) bind(C, name='kz_cycle_locate') result(found)
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(inout) :: cycle
    real(dp), intent(in) :: along(2)
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.3_dp
    real(dp) :: y(UNKNOWNS)
    type(system_t) :: system

    call make_system(plane, cycle%kind, 1, .true., system)
    system%basis(:, 1) = along
    y = unknowns_of(cycle)
    found = merge(1, 0, newton(system, 20, LONGEST, 1e-12_dp, y) > 0)
    if (found == 1) cycle = cycle_of(system, y)
  end function on_line

end module kz_cycles_placed
