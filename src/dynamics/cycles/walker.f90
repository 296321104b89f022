!> The way along a branch of cycles or a curve of bifurcations by pseudo-arclength, and what is met there.
module kz_cycles_walker
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_cycles_normal_forms, only: form_t, normal_form
  use kz_cycles_corrector, only: newton, tangent_at
  use kz_cycles_curves, only: system_t, images, inner, moved, wrapped, POINTS, UNKNOWNS, COARSE
  use kz_splitting_jets, only: TERMS
  implicit none
  private
  public :: walker_t, parents_t, advance, distance, set_parents, meets, becomes, find_zero, thinness, &
            OF_FORM, OF_WIDTH, CLOSE, FAR, FOLD, FLIP, HALVES, MIRROR, REST

  !> Steps of Newton's method end below it, which square them, and below this part of a short step along a branch; steps
  !> longer than that are shortened: rad.
  real(dp), parameter :: CLOSE = 1e-5_dp, OF_STEP = 0.1_dp, FAR = 1e3_dp
  !> KZ_EVENT_... of dynamics_curves.h: multiplier 1, -1; meeting with the cycle of half the period, the image, rest.
  integer, parameter :: FOLD = 1, FLIP = 2, HALVES = 3, MIRROR = 4, REST = 5
  !> Quantities whose sign may change on a curve: normal form, width.
  integer, parameter :: OF_FORM = 0, OF_WIDTH = -1

  !> A point on its way along a branch or a curve.
  type :: walker_t
    type(system_t) :: system
    real(dp) :: y(UNKNOWNS) = 0, sharp(UNKNOWNS) = 0, tangent(UNKNOWNS) = 0
    real(dp) :: step = 0, longest = 0
    logical :: is_sharp = .true.
  end type walker_t

  !> How a cycle differs from what it may grow out of: the cycle of half its period, its image, rest.
  type :: parents_t
    logical :: there(HALVES:REST) = .false.
    real(dp) :: distance(HALVES:REST) = huge(1.0_dp), difference(2*POINTS, HALVES:REST) = 0
  end type parents_t

contains

  !> The next point; false if no step is short enough.
  function advance(walker) result(found)
    type(walker_t), intent(inout) :: walker !< at a point, then at the next one
    logical :: found
    real(dp), parameter :: SHORTEST = 1e-8_dp, BENT = 0.2_dp, CORRECTED = 0.1_dp, CHANGED = 0.8_dp
    integer, parameter :: MOST = 6
    real(dp) :: y(UNKNOWNS), guess(UNKNOWNS), sharp(UNKNOWNS), tangent(UNKNOWNS), angle, correction, trace
    integer :: n, unknown, iterations

    n = 2*walker%system%n
    unknown = n + walker%system%columns
    found = .false.
    angle = 0
    correction = 0
    trace = walker%system%trace
    do while (walker%step > SHORTEST)
      guess = walker%y
      guess(:n) = guess(:n) + walker%step*walker%tangent(:n)
      guess(n + 1:n + 2) = guess(n + 1:n + 2) + matmul(walker%system%basis(:, :walker%system%columns), &
                                    walker%step*walker%tangent(n + 1:unknown))
      y = guess
      iterations = newton(walker%system, MOST, FAR, min(CLOSE, OF_STEP*walker%step), y, walker%tangent, tangent)
      found = iterations > 0
      if (found) then
        correction = distance(walker%system, y, guess)/walker%step
        found = correction < CORRECTED
      end if
      if (found .and. walker%is_sharp) call tangent_at(walker%system, y, walker%tangent, tangent, found, sharp)
      if (found) then
        angle = acos(min(1.0_dp, max(-1.0_dp, inner(walker%system, walker%tangent(:unknown), tangent(:unknown)))))
        found = angle < BENT
      end if
      ! Two multipliers of 1 or -1 within one step would not be seen
      if (found .and. .not. walker%system%on_curve) found = abs(asinh(walker%system%trace) - asinh(trace)) < CHANGED
      if (found) exit
      walker%step = 0.5_dp*walker%step
    end do
    if (.not. found) return
    walker%y = y
    walker%tangent = tangent
    walker%sharp = sharp
    if (iterations <= 3 .and. angle < 0.5_dp*BENT .and. correction < 0.3_dp*CORRECTED) then
      walker%step = min(walker%longest, 1.5_dp*walker%step)
    else if (angle > 0.75_dp*BENT .or. correction > 0.6_dp*CORRECTED) then
      walker%step = 0.7_dp*walker%step
    end if
  end function advance

  !> Finds where a number changes its sign between two points of a branch or curve, by secants and bisection; false if
  !> Newton's method does not converge on the way.
  function find_zero(walker, from, heading, at, which, number) result(found)
    type(walker_t), intent(inout) :: walker !< at the second point, then where the sign changes
    real(dp), intent(in) :: from(:), heading(:) !< the first point and the tangent there
    real(dp), intent(in) :: at(2) !< the number at both
    integer, intent(in) :: which !< OF_FORM, OF_WIDTH, FOLD, FLIP
    real(dp), intent(out) :: number !< where it was found
    logical :: found
    integer, parameter :: MOST = 40
    real(dp), parameter :: ZERO(OF_WIDTH:FLIP) = [1e-6_dp, 1e-9_dp, 1e-9_dp, 1e-9_dp]
    type(form_t) :: form
    real(dp) :: place(2), numbers(2), middle
    integer :: n, i

    n = 2*walker%system%n
    place = [0.0_dp, distance(walker%system, walker%y, from)]
    numbers = at
    number = at(2)
    found = .false.
    do i = 1, MOST
      middle = place(1) - numbers(1)*(place(2) - place(1))/(numbers(2) - numbers(1))
      if (mod(i, 3) == 0) middle = 0.5_dp*(place(1) + place(2))
      walker%y(:n) = from(:n) + middle*heading(:n)
      walker%y(n + 1:n + 2) = from(n + 1:n + 2) + matmul(walker%system%basis(:, :walker%system%columns), &
                                                         middle*heading(n + 1:n + walker%system%columns))
      found = newton(walker%system, 12, FAR, CLOSE, walker%y, heading) > 0
      if (found .and. which <= OF_FORM) &
        call tangent_at(walker%system, walker%y, heading, walker%tangent, found, walker%sharp)
      if (.not. found) return
      if (which <= OF_FORM) call normal_form(walker%system, form)
      if (which == OF_FORM) number = form%coefficient
      if (which == OF_WIDTH) number = thinness(walker%system, form)
      if (which == FOLD) number = 1 + walker%system%determinant - walker%system%trace
      if (which == FLIP) number = 1 + walker%system%determinant + walker%system%trace
      associate (end => merge(1, 2, (number > 0) .eqv. (numbers(1) > 0)))
        place(end) = middle
        numbers(end) = number
      end associate
      if (abs(number) < ZERO(which) .or. place(2) - place(1) < 1e-13_dp) return
      if (which > OF_FORM .and. place(2) - place(1) < 1e-7_dp) return ! the equations of the curve find the rest
    end do
  end function find_zero

  !> The logarithm of how many times narrower than THINNEST the band of attractors beside a curve is, where rounding
  !> hides it.
  pure real(dp) function thinness(system, form)
    type(system_t), intent(in) :: system !< at a point of the curve
    type(form_t), intent(in) :: form
    real(dp), parameter :: THINNEST = 1e-10_dp ! sides of the plane
    real(dp) :: gradient

    gradient = max(norm2(form%side), tiny(1.0_dp))
    associate (d => system%determinant)
      thinness = log(THINNEST*gradient/(1 + d))
      if (system%kind%multiplier > 0) &
        thinness = log(THINNEST*max(gradient*abs(form%coefficient), tiny(1.0_dp))*((1 - d)/(1 + d))**2)
    end associate
  end function thinness

  !> How far two values of the unknowns lie apart.
  function distance(system, a, b) result(length)
    type(system_t), intent(in) :: system !< the equations
    real(dp), intent(in) :: a(:) !< unknowns
    real(dp), intent(in) :: b(:) !< others
    real(dp) :: length, step(2*system%n + system%columns)

    step = moved(system, a, b)
    length = sqrt(inner(system, step, step))
  end function distance

  !> Sets how a cycle differs from its parents.
  subroutine set_parents(system, y, parents)
    type(system_t), intent(inout) :: system !< the equations, of which the tables serve
    real(dp), intent(in) :: y(:) !< the cycle
    type(parents_t), intent(out) :: parents !< how it differs from them
    real(dp) :: later(2, 0:TERMS, POINTS) ! midpoints: each point half a point further
    integer :: n, i, other

    n = system%n
    parents%there(HALVES) = system%kind%side > 0 .and. mod(n, 2) == 0
    if (system%plane%mirrored /= 0) then
      parents%there(MIRROR) = system%kind%side > 0 .and. system%kind%turns == 0 .and. (n == 1 .or. mod(n, 2) == 0)
      parents%there(REST) = system%kind%side < 0 .and. n == 1
    else if (system%plane%half_period /= 0) then
      if (system%kind%side > 0 .and. system%kind%turns == 0 .and. mod(n*system%stride, 2) == 1) &
        parents%there(MIRROR) = images(system, COARSE, 0, y(:2*n + 2), system%stride, later)
    end if
    do i = 1, n
      other = mod(i - 1 + n/2, n) + 1
      if (parents%there(HALVES)) call put(HALVES, -1, y(2*other - 1:2*other))
      if (parents%there(MIRROR)) then
        if (system%plane%mirrored /= 0) call put(MIRROR, 1, y(2*other - 1:2*other))
        if (system%plane%mirrored == 0) call put(MIRROR, 1, later(:, 0, other))
      end if
    end do
    if (parents%there(REST)) parents%difference(:2, REST) = [0.5_dp*wrapped(2*y(1)), y(2)]
    do i = HALVES, REST
      if (parents%there(i)) parents%distance(i) = norm2(parents%difference(:2*n, i))/sqrt(real(n, dp))
    end do
  contains
    subroutine put(which, sign_of, x)
      integer, intent(in) :: which, sign_of
      real(dp), intent(in) :: x(2)

      parents%difference(2*i - 1, which) = wrapped(y(2*i - 1) + sign_of*x(1))
      parents%difference(2*i, which) = y(2*i) + sign_of*x(2)
    end subroutine put
  end subroutine set_parents

  !> Parent that a cycle meets between two points of a branch, where the difference from it reverses; 0 = none.
  integer function meets(from, to, n) result(which)
    type(parents_t), intent(in) :: from !< at the first point
    type(parents_t), intent(in) :: to !< at the second one
    integer, intent(in) :: n !< points of the cycle
    real(dp), parameter :: NEAR = 0.7_dp
    integer :: i

    which = 0
    do i = HALVES, REST
      if (.not. from%there(i) .or. from%distance(i) > NEAR .or. to%distance(i) > NEAR) cycle
      if (dot_product(from%difference(:2*n, i), to%difference(:2*n, i)) < -0.5_dp*n*from%distance(i)*to%distance(i)) &
        which = i
    end do
  end function meets

  !> Parent that a cycle has become between two points of a branch: the equations have the parent as a solution too, and
  !> a long step beside the meeting may end on it. 0 = none.
  integer function becomes(from, to) result(which)
    type(parents_t), intent(in) :: from !< at the first point
    type(parents_t), intent(in) :: to !< at the second one
    real(dp), parameter :: SAME = 1e-6_dp ! largest remaining part of the distance before
    integer :: i

    which = 0
    do i = HALVES, REST
      if (from%there(i) .and. to%distance(i) < SAME*from%distance(i)) which = i
    end do
  end function becomes

end module kz_cycles_walker
