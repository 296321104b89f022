!> Curves of bifurcations followed by pseudo-arclength: include/kapitza/dynamics_trace.h.
module kz_curves_trace
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_corrector, only: newton, tangent_at
  use kz_cycles_curves, only: plane_t, curve_kind_t, system_t, make_system, images, wrapped, POINTS, UNKNOWNS, COARSE
  use kz_cycles_normal_forms, only: normal_form
  use kz_cycles_placed, only: at_place, on_line, outside, LEFT, CLOSED, LONG, MERGED, STUCK, NO_SEED, THIN
  use kz_cycles_walker, only: walker_t, parents_t, advance, distance, set_parents, meets, find_zero, thinness, &
                              OF_FORM, OF_WIDTH, CLOSE, FAR, HALVES, MIRROR, REST
  use kz_splitting_jets, only: TERMS
  use kz_vector_map, only: PI
  implicit none
  private

  !> KZ_SPECIAL_...
  integer, parameter :: CUSP = 1, DEGENERATE = 2

contains

  function trace(plane, kind, seed, direction, longest, most, rows, most_special, special, n_special, ending) &
    bind(C, name='kz_curve_trace') result(n_rows)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(in) :: seed(2*kind%points + 2)
    integer(c_int32_t), value :: direction
    real(dp), value :: longest
    integer(c_int64_t), value :: most, most_special
    real(dp), intent(out) :: rows(8 + 2*kind%points, most), special(3 + 2*kind%points, most_special)
    integer(c_int64_t), intent(out) :: n_special
    integer(c_int32_t), intent(out) :: ending
    integer(c_int64_t) :: n_rows
    type(walker_t) :: walker, turning
    real(dp) :: before(UNKNOWNS), heading(UNKNOWNS)
    type(parents_t) :: was, is
    real(dp) :: form, side(2), former, excess, former_excess, start(UNKNOWNS), length, eigenvector(2)
    logical :: found
    integer :: n

    n = 2*kind%points
    n_rows = 0
    n_special = 0
    ending = NO_SEED
    call make_system(plane, kind, 2, .true., walker%system)
    call begin(walker, seed, longest, found)
    if (.not. found) return
    walker%tangent = direction*walker%tangent
    start = walker%y
    call set_parents(walker%system, walker%y, was)
    call normal_form(walker%system, form, side, eigenvector)
    excess = thinness(walker%system, form, side)
    ending = THIN
    if (excess > 0) return
    call put(walker, form, side)
    length = 0
    ending = LONG
    do while (n_rows < most)
      before = walker%y
      heading = walker%tangent
      former = form
      former_excess = excess
      ending = STUCK
      if (.not. advance(walker)) return
      call set_parents(walker%system, walker%y, is)
      call normal_form(walker%system, form, side, eigenvector)
      excess = thinness(walker%system, form, side)
      if (excess > 0) then
        call put_last()
        return
      end if
      ending = MERGED
      ! Beside its parent the equations of a fold have that parent's own curve as a solution too
      if (kind%multiplier > 0) then
        if (meets(was, is, int(kind%points)) > 0) return
        if (on_parents_curve(walker%system, walker%y, was, is)) return
      end if
      if ((former > 0) .neqv. (form > 0)) then
        turning = walker
        call locate_special(turning, before, heading, former, form, special, n_special, found)
        ! A row of its own: what branches off attracts on one side of it alone
        if (found .and. kind%multiplier < 0 .and. n_rows + 1 < most) call put_turning()
      end if
      was = is
      length = length + distance(walker%system, walker%y, before)
      call put(walker, form, side)
      ending = LEFT
      if (outside(plane, walker%y(n + 1:n + 2))) return
      ending = CLOSED
      if (length > 6*longest .or. n_rows > 40) then
        if (passes(walker%system, before, walker%y, start)) return
      end if
      ending = LONG
    end do
  contains
    subroutine put(at, form, side)
      type(walker_t), intent(in) :: at
      real(dp), intent(in) :: form, side(2)

      n_rows = n_rows + 1
      rows(:2, n_rows) = at%sharp(n + 1:n + 2)
      rows(3:4, n_rows) = at%tangent(n + 1:n + 2)
      rows(5, n_rows) = form
      rows(6:7, n_rows) = side
      rows(8, n_rows) = minval(was%distance)
      rows(9:, n_rows) = at%sharp(:n)
    end subroutine put

    !> The point where the band is as narrow as the narrowest.
    subroutine put_last()
      real(dp) :: zero, unused(2)

      ending = THIN
      call find_zero(walker, before, heading, former_excess, excess, OF_WIDTH, zero, found)
      if (.not. found) return
      call normal_form(walker%system, form, side, unused)
      call put(walker, form, side)
    end subroutine put_last

    subroutine put_turning()
      real(dp) :: zero, beside(2), unused(2)

      call normal_form(turning%system, zero, beside, unused)
      call put(turning, 0.0_dp, beside)
    end subroutine put_turning
  end function trace

  !> Begins on a curve near the seed.
  subroutine begin(walker, seed, longest, found)
    type(walker_t), intent(inout) :: walker !< with the equations of a curve
    real(dp), intent(in) :: seed(:) !< unknowns near the curve
    real(dp), intent(in) :: longest !< step
    logical, intent(out) :: found !< whether Newton's method finds the curve beside the seed
    real(dp), parameter :: NEAR = 0.1_dp
    real(dp) :: normals(4, 4), guess(UNKNOWNS)
    integer :: n, try, iterations

    n = 2*walker%system%n
    normals = reshape([0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, &
                       0.0_dp, 0.0_dp, 0.7_dp, -0.7_dp, 1.0_dp, 0.3_dp, 0.0_dp, 0.0_dp], [4, 4])
    do try = 1, 4
      guess = 0
      guess(:2) = normals(:2, try)
      guess(n + 1:n + 2) = normals(3:, try)
      walker%y(:n + 2) = seed(:n + 2)
      call newton(walker%system, 12, FAR, CLOSE, walker%y, iterations, guess)
      found = iterations > 0 .and. maxval(abs(walker%y(:n + 2) - seed(:n + 2))) < NEAR
      if (found) call tangent_at(walker%system, walker%y, guess, walker%tangent, found, walker%sharp)
      if (found) exit
    end do
    walker%longest = longest
    walker%step = longest/8
  end subroutine begin

  !> Whether the step between two points passes the start of a closed curve, also with rotated points or mirrored.
  function passes(system, from, to, start) result(closed_now)
    type(system_t), intent(in) :: system !< the equations
    real(dp), intent(in) :: from(:) !< unknowns before the step
    real(dp), intent(in) :: to(:) !< unknowns after the step
    real(dp), intent(in) :: start(:) !< unknowns at the start of the curve
    logical :: closed_now
    real(dp) :: step(2), aside(2), share, least, length
    integer :: n, first, mirror_sign

    n = system%n
    closed_now = .false.
    step = to(2*n + 1:2*n + 2) - from(2*n + 1:2*n + 2)
    share = dot_product(start(2*n + 1:2*n + 2) - from(2*n + 1:2*n + 2), step)/sum(step**2)
    if (share < -0.001_dp .or. share > 1.001_dp) return
    aside = start(2*n + 1:2*n + 2) - from(2*n + 1:2*n + 2) - share*step
    if (norm2(aside) > 0.05_dp*norm2(step) + 1e-9_dp) return
    least = huge(least)
    length = sum(abs(to(:2*n) - from(:2*n)))
    do first = 0, n - 1
      do mirror_sign = 1 - 2*int(system%plane%mirrored), 1, 2
        least = min(least, apart(first, mirror_sign))
      end do
    end do
    closed_now = least < 0.1_dp*length + 1e-6_dp
  contains
    real(dp) function apart(first, mirror_sign)
      integer, intent(in) :: first, mirror_sign
      real(dp) :: x(2)
      integer :: i, k, sign_of

      apart = 0
      do i = 1, n
        k = mod(i - 1 + first, n) + 1
        sign_of = mirror_sign
        if (i + first > n) sign_of = sign_of*system%kind%side
        x = sign_of*(from(2*k - 1:2*k) + share*(to(2*k - 1:2*k) - from(2*k - 1:2*k)))
        apart = apart + abs(wrapped(start(2*i - 1) - x(1))) + abs(start(2*i) - x(2))
      end do
    end function apart
  end function passes

  !> Whether a fold comes so near to a parent that this one's own multiplier is -1: their distance alone does not show
  !> it, since it is small all along folds of strongly unstable cycles.
  function on_parents_curve(system, y, was, is) result(on)
    type(system_t), intent(inout) :: system
    real(dp), intent(in) :: y(:)
    type(parents_t), intent(in) :: was, is
    real(dp), parameter :: BESIDE = 1e-3_dp ! rad
    type(curve_kind_t) :: kind
    real(dp) :: parent(UNKNOWNS), next, later(2, 0:TERMS, POINTS)
    logical :: on, at_rest, half
    integer :: which, n

    on = .false.
    do which = HALVES, REST
      if (.not. is%distance(which) < min(BESIDE, was%distance(which))) cycle
      half = which == MIRROR .and. system%plane%half_period /= 0
      at_rest = which == REST .or. (which == MIRROR .and. system%n == 1 .and. .not. half)
      kind = system%kind
      kind%points = merge(1, (system%n + merge(1, 0, half))/2, at_rest)
      kind%side = merge(-1, 1, which == MIRROR)
      kind%half = merge(1, 0, half)
      n = 2*kind%points
      parent(:n) = y(:n)
      if (at_rest) parent(:n) = [PI*anint(y(1)/PI), 0.0_dp]
      parent(n + 1:n + 2) = y(2*system%n + 1:2*system%n + 2)
      if (half) call images(system, COARSE, 0, parent(n - 1:n), parent(n + 1:n + 2), 1, 1, later, on)
      next = merge(later(1, 0, 1), y(n + 1), half)
      if (at_rest) next = parent(1)
      kind%turns = nint((next - kind%side*parent(1))/(2*PI))
      kind%multiplier = -1
      on = is_on(system%plane, kind, parent) /= 0
      if (on) return
    end do
  end function on_parents_curve

  !> Where the normal form changes its sign between two points of a curve.
  subroutine locate_special(walker, from, heading, at_low, at_high, special, n_special, found)
    type(walker_t), intent(inout) :: walker !< at the second point, then at the special one
    real(dp), intent(in) :: from(:), heading(:) !< the first point and the tangent there
    real(dp), intent(in) :: at_low, at_high !< normal forms of both
    real(dp), intent(inout) :: special(:, :)
    integer(c_int64_t), intent(inout) :: n_special
    logical, intent(out) :: found !< a place of the list was left, and the normal form is 0 there
    real(dp), parameter :: POLE = 1e3_dp
    real(dp) :: form
    integer :: n

    found = .false.
    if (n_special == size(special, 2)) return
    n = 2*walker%system%n
    call find_zero(walker, from, heading, at_low, at_high, OF_FORM, form, found)
    found = found .and. abs(form) <= POLE
    if (.not. found) return
    n_special = n_special + 1
    special(1, n_special) = merge(CUSP, DEGENERATE, walker%system%kind%multiplier > 0)
    special(2:3, n_special) = walker%sharp(n + 1:n + 2)
    special(4:, n_special) = walker%sharp(:n)
  end subroutine locate_special

  !> By the trace; where that changes beyond its limit within a place's error, by where the multiplier is reached.
  function is_on(plane, kind, y) bind(C, name='kz_curve_is_on') result(on)
    type(plane_t), intent(in) :: plane
    type(curve_kind_t), intent(in) :: kind
    real(dp), intent(inout) :: y(2*kind%points + 2)
    integer(c_int32_t) :: on
    real(dp), parameter :: CROSSED = 1e-4_dp, SAME = 1e-9_dp, BESIDE = 1e-3_dp ! trace; sides of the plane; rad
    real(dp), parameter :: ALONG(2, 2) = reshape([1, 0, 0, 1], [2, 2])
    real(dp) :: found(2*kind%points + 2), numbers(2)
    integer :: n, axis

    n = 2*kind%points
    found = y
    on = at_place(plane, kind, found, numbers)
    if (abs(numbers(1) - kind%multiplier*(1 + numbers(2))) > CROSSED*(1 + numbers(2))) on = 0
    do axis = 1, 2
      if (on /= 0) exit
      found = y
      on = on_line(plane, kind, found, ALONG(:, axis))
      if (norm2(found(n + 1:) - y(n + 1:)) > SAME .or. maxval(abs(found(:n) - y(:n))) > BESIDE) on = 0
    end do
    if (on /= 0) y = found
  end function is_on

end module kz_curves_trace
