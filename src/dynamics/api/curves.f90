!> The C interface of curves: normal forms and orbits at a place (include/kapitza/dynamics_curves.h).
module kz_api_curves
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_curves, only: plane_t, curve_kind_t, system_t, make_system, linearise, images, POINTS, UNKNOWNS, COARSE
  use kz_cycles_normal_forms, only: normal_form
  use kz_splitting_jets, only: TERMS
  implicit none
  private

contains

  function form_at(plane, kind, y, coefficient, side, eigenvector) bind(C, name='kz_curve_form') result(found)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: y(2*kind%points + 2)
    real(dp), intent(out) :: coefficient, side(2), eigenvector(2)
    integer(c_int32_t) :: found
    real(dp) :: residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(system_t) :: system
    logical :: exists

    call make_system(plane, kind, 2, .true., system)
    call linearise(system, COARSE, 3, y, residual, matrix, exists)
    found = merge(1, 0, exists)
    if (exists) call normal_form(system, coefficient, side, eigenvector)
  end function form_at

  function orbit(plane, at, n, points_of) bind(C, name='kz_curve_orbit') result(exists)
    type(plane_t), intent(in) :: plane
    real(dp), intent(in) :: at(2)
    integer(c_int64_t), value :: n
    real(dp), intent(inout) :: points_of(2, 0:n)
    integer(c_int32_t) :: exists
    type(system_t) :: system
    type(curve_kind_t) :: kind
    real(dp) :: image(2, 0:TERMS, POINTS)
    logical :: found
    integer(c_int64_t) :: i

    kind = curve_kind_t(1, 1, 1, 0)
    call make_system(plane, kind, 0, .false., system)
    exists = 1
    do i = 1, n
      call images(system, COARSE, 0, points_of(:, i - 1), at, 1, 2, image, found)
      if (.not. found) exists = 0
      if (.not. found) return
      points_of(:, i) = image(:, 0, 1)
    end do
  end function orbit

  function half_period(plane, at, state) bind(C, name='kz_curve_half_period') result(exists)
    type(plane_t), intent(in) :: plane
    real(dp), intent(in) :: at(2)
    real(dp), intent(inout) :: state(2)
    integer(c_int32_t) :: exists
    type(system_t) :: system
    type(curve_kind_t) :: kind
    real(dp) :: image(2, 0:TERMS, POINTS)
    logical :: found

    kind = curve_kind_t(1, 1, 1, 0)
    call make_system(plane, kind, 0, .false., system)
    call images(system, COARSE, 0, state, at, 1, 1, image, found)
    if (found) state = image(:, 0, 1)
    exists = merge(1, 0, found)
  end function half_period

end module kz_api_curves
