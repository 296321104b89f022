!> Cycles at a place or on a line: include/kapitza/dynamics_curves.h.
module kz_cycles_placed
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_curves, only: plane_t, curve_kind_t, system_t, make_system, linearise, UNKNOWNS, FINE
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

  function at_place(plane, kind, y, numbers) bind(C, name='kz_curve_solve') result(found)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(inout) :: y(2*kind%points + 2)
    real(dp), intent(out), optional :: numbers(2)
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.5_dp
    real(dp) :: residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(system_t) :: system
    integer :: iterations
    logical :: exists

    call make_system(plane, kind, 0, .false., system)
    call newton(system, 25, LONGEST, 1e-12_dp, y, iterations)
    found = merge(1, 0, iterations > 0)
    if (.not. present(numbers)) return
    numbers = 0
    if (found == 0) return
    call linearise(system, FINE, 1, y, residual, matrix, exists)
    numbers = [system%trace, system%determinant]
    if (.not. exists) found = 0
  end function at_place

  function on_line(plane, kind, y, along) bind(C, name='kz_curve_locate') result(found)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(inout) :: y(2*kind%points + 2)
    real(dp), intent(in) :: along(2)
    integer(c_int32_t) :: found
    real(dp), parameter :: LONGEST = 0.3_dp
    type(system_t) :: system
    integer :: iterations

    call make_system(plane, kind, 1, .true., system)
    system%basis(:, 1) = along
    call newton(system, 20, LONGEST, 1e-12_dp, y, iterations)
    found = merge(1, 0, iterations > 0)
  end function on_line

end module kz_cycles_placed
