!> Newton's method for the equations of cycles and of curves of bifurcations, and the tangents of their solutions.
module kz_cycles_corrector
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_cycles_curves, only: system_t, linearise, inner, metric, moved, POINTS, UNKNOWNS, COARSE, FINE
  use kz_maps_matrices, only: solve
  use kz_splitting_jets, only: TERMS
  implicit none
  private
  public :: newton, tangent_at

contains

  !> y becomes the solution near it: with a normal, on the plane through y across it. Its steps shrink until rounding
  !> stops them, or until the next one, if they go on to square, is below SMALL: in narrow bands they square below 1e-7
  !> rad alone.
  function newton(system, most, longest, close, y, normal, tangent) result(iterations)
    type(system_t), intent(inout) :: system !< the equations
    integer, intent(in) :: most !< iterations until a step is shorter than `close`; a few more may follow
    real(dp), intent(in) :: longest !< longer steps are shortened to it, rad
    real(dp), intent(in) :: close !< the last step is shorter, rad
    real(dp), intent(inout) :: y(:) !< the unknowns: a guess, then the solution
    real(dp), intent(in), optional :: normal(:) !< normal of the plane, by the unknowns
    real(dp), intent(out), optional :: tangent(:) !< unit vector on the normal's side, at the begin of the last step
    integer :: iterations !< until a step was shorter than `close`; 0: no solution
    real(dp), parameter :: SMALL = 1e-9_dp
    integer, parameter :: MORE = 3
    real(dp) :: matrix(UNKNOWNS, UNKNOWNS), side(UNKNOWNS, 2), start(UNKNOWNS), last, size_now, next
    integer :: n, unknown, columns, i
    logical :: regular, stops

    n = 2*system%n
    unknown = n + system%columns
    start(:n + 2) = y(:n + 2)
    last = huge(last)
    iterations = 0
    columns = merge(2, 1, present(tangent))
    do i = 1, most + MORE
      if (i > most .and. iterations == 0) exit
      call linearise(system, COARSE, merge(2, 1, system%on_curve), y, side(:unknown, 1), matrix(:unknown, :unknown), &
                     regular)
      if (.not. regular) exit
      if (present(normal)) then
        matrix(unknown, :unknown) = metric(system, normal(:unknown))
        side(unknown, 1) = dot_product(matrix(unknown, :unknown), moved(system, y, start))
        side(:unknown, 2) = 0
        side(unknown, 2) = 1
      end if
      call solve(matrix(:unknown, :unknown), side(:unknown, :columns), regular)
      if (.not. regular) exit
      size_now = maxval(abs(side(:unknown, 1)))
      if (.not. size_now < 1e3_dp) exit
      side(:unknown, 1) = side(:unknown, 1)*(longest/max(longest, size_now)) ! the step is 0 exactly at rest
      y(:n) = y(:n) - side(:n, 1)
      y(n + 1:n + 2) = y(n + 1:n + 2) - matmul(system%basis(:, :system%columns), side(n + 1:unknown, 1))
      next = size_now
      if (i > 1) next = size_now*(size_now/last)**2
      stops = size_now < SMALL .and. size_now > 0.3_dp*last
      if (iterations == 0 .and. (size_now < close .or. stops)) iterations = i
      if (iterations > 0 .and. present(tangent)) &
        tangent(:unknown) = side(:unknown, 2)/sqrt(inner(system, side(:unknown, 2), side(:unknown, 2)))
      if (iterations > 0 .and. (next < SMALL .or. stops)) return
      if (i > 4 .and. present(normal) .and. size_now > last) exit
      last = size_now
    end do
    iterations = 0
  end function newton

  !> The unit tangent of the branch or curve at its point y, on the side of `guess`, and the same point with FINE steps.
  subroutine tangent_at(system, y, guess, tangent, regular, sharp)
    type(system_t), intent(inout) :: system !< takes images of third order of a curve
    real(dp), intent(in) :: y(:) !< a solution
    real(dp), intent(in) :: guess(:) !< a direction near the tangent's
    real(dp), intent(out) :: tangent(:) !< by the unknowns
    logical, intent(out) :: regular !< whether it is defined
    real(dp), intent(out), optional :: sharp(:) !< y with FINE steps
    real(dp) :: matrix(UNKNOWNS, UNKNOWNS), side(UNKNOWNS, 2), unused(UNKNOWNS, UNKNOWNS), kept(2, 0:TERMS, POINTS), &
        numbers(2), length
    integer :: n, unknown

    n = 2*system%n
    unknown = n + system%columns
    side = 0
    regular = .true.
    if (present(sharp)) call linearise(system, FINE, 1, y, side(:unknown, 2), unused(:unknown, :unknown), regular)
    if (regular) call linearise(system, COARSE, merge(3, 1, system%on_curve), y, side(:unknown, 1), &
                                matrix(:unknown, :unknown), regular)
    if (.not. regular) return
    kept = system%image
    numbers = [system%trace, system%determinant]
    matrix(unknown, :unknown) = metric(system, guess(:unknown))
    side(:unknown, 1) = 0
    side(unknown, :) = [1, 0]
    call solve(matrix(:unknown, :unknown), side(:unknown, :), regular)
    if (.not. regular) return
    system%image = kept
    system%trace = numbers(1)
    system%determinant = numbers(2)
    length = sqrt(inner(system, side(:unknown, 1), side(:unknown, 1)))
    regular = length < 1e12_dp
    tangent(:unknown) = side(:unknown, 1)/length
    if (.not. present(sharp)) return
    sharp(:n) = y(:n) - side(:n, 2)
    sharp(n + 1:n + 2) = y(n + 1:n + 2) - matmul(system%basis(:, :system%columns), side(n + 1:unknown, 2))
  end subroutine tangent_at

end module kz_cycles_corrector
