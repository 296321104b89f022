!> Curves of bifurcations followed by pseudo-arclength: include/kapitza/dynamics_trace.h.
module kz_curves_trace
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_continuation, only: way_t, end_t, continuation_t, GOES_ON
  use kz_cycles_corrector, only: newton, tangent_at
  use kz_cycles_curves, only: plane_t, cycle_t, system_t, make_system, images, wrapped, unknowns_of, cycle_of, POINTS, &
                              UNKNOWNS, COARSE
  use kz_cycles_normal_forms, only: form_t, normal_form
  use kz_cycles_placed, only: at_place, on_line, MERGED, THIN
  use kz_cycles_walker, only: walker_t, parents_t, distance, set_parents, meets, find_zero, thinness, OF_FORM, &
                              OF_WIDTH, CLOSE, FAR, HALVES, MIRROR, REST
  use kz_splitting_jets, only: TERMS
  use kz_vector_map, only: PI
  implicit none
  private

  !> Memory of kz_curve_row of dynamics_trace.h.
  type, bind(C) :: row_t
    type(cycle_t) :: at
    real(dp) :: tangent(2)
    type(form_t) :: form
  end type row_t

  type, extends(continuation_t) :: trace_t
    type(form_t) :: form         !< at the last point
    real(dp) :: excess, length = 0 !< thinness there; length of the curve
    type(row_t), pointer :: rows(:) => null()
    type(cycle_t), pointer :: special(:) => null()
  contains
    procedure :: ending, put, put_row, put_last, put_special, is_closed
  end type trace_t

contains

  subroutine trace(plane, seed, way, rows, special, reached) bind(C, name='kz_curve_trace')
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(in) :: seed
    type(way_t), intent(in) :: way
    type(row_t), intent(out), target :: rows(way%most)
    type(cycle_t), intent(out), target :: special(way%most_events)
    type(end_t), intent(out) :: reached
    type(trace_t) :: self
    logical :: found

    self%way = way
    self%rows => rows
    self%special => special
    call make_system(plane, seed%kind, 2, .true., self%walker%system)
    call begin(self%walker, unknowns_of(seed), way%longest, found)
    if (found) then
      self%walker%tangent = way%side*self%walker%tangent
      self%first = self%walker%y
      call set_parents(self%walker%system, self%walker%y, self%was)
      call normal_form(self%walker%system, self%form)
      self%excess = thinness(self%walker%system, self%form)
      self%reached%ending = THIN
      if (self%excess <= 0) call self%put()
      if (self%excess <= 0) call self%follow()
    end if
    reached = self%reached
  end subroutine trace

  integer function ending(self, is)
    class(trace_t), intent(inout) :: self
    type(parents_t), intent(in) :: is
    type(form_t) :: form
    real(dp) :: excess

    associate (system => self%walker%system)
      call normal_form(system, form)
      excess = thinness(system, form)
      ending = THIN
      if (excess > 0) then
        call self%put_last(excess)
        return
      end if
      ending = MERGED
      ! Beside its parent the equations of a fold have that parent's own curve as a solution too
      if (system%kind%multiplier > 0) then
        if (meets(self%was, is, system%n) > 0) return
        if (on_parents_curve(system, self%walker%y, self%was, is)) return
      end if
      ending = GOES_ON
      if ((self%form%coefficient > 0) .neqv. (form%coefficient > 0)) call self%put_special(form)
      self%form = form
      self%excess = excess
    end associate
  end function ending

  subroutine put(self)
    class(trace_t), intent(inout) :: self

    call self%put_row(self%walker, self%form)
  end subroutine put

  subroutine put_row(self, at, form)
    class(trace_t), intent(inout) :: self
    type(walker_t), intent(in) :: at
    type(form_t), intent(in) :: form
    integer :: n

    n = 2*at%system%n
    self%reached%rows = self%reached%rows + 1
    self%rows(self%reached%rows) = row_t(cycle_of(at%system, at%sharp), at%tangent(n + 1:n + 2), form)
  end subroutine put_row

  !> The point where the band is as narrow as the narrowest.
  subroutine put_last(self, excess)
    class(trace_t), intent(inout) :: self
    real(dp), intent(in) :: excess !< at the last point
    real(dp) :: zero

    if (.not. find_zero(self%walker, self%before, self%heading, [self%excess, excess], OF_WIDTH, zero)) return
    call normal_form(self%walker%system, self%form)
    call self%put()
  end subroutine put_last

  !> The place where the normal form changes its sign: with the multiplier -1 a row of its own, as what branches off
  !> attracts on one side of it alone.
  subroutine put_special(self, form)
    class(trace_t), intent(inout) :: self
    type(form_t), intent(in) :: form !< at the last point
    real(dp), parameter :: POLE = 1e3_dp
    type(walker_t) :: turning
    type(form_t) :: at
    real(dp) :: number, ends(2)

    ends = [self%form%coefficient, form%coefficient]
    if (self%reached%events == self%way%most_events) return
    turning = self%walker
    if (.not. find_zero(turning, self%before, self%heading, ends, OF_FORM, number)) return
    if (abs(number) > POLE) return
    self%reached%events = self%reached%events + 1
    self%special(self%reached%events) = cycle_of(turning%system, turning%sharp)
    if (turning%system%kind%multiplier > 0 .or. self%reached%rows + 1 >= self%way%most) return
    call normal_form(turning%system, at)
    at%coefficient = 0
    call self%put_row(turning, at)
  end subroutine put_special

  logical function is_closed(self)
    class(trace_t), intent(inout) :: self

    self%length = self%length + distance(self%walker%system, self%walker%y, self%before)
    is_closed = self%length > 6*self%way%longest .or. self%reached%rows > 40
    if (is_closed) is_closed = passes(self%walker%system, self%before, self%walker%y, self%first)
  end function is_closed

  !> Begins on a curve near the seed.
  subroutine begin(walker, seed, longest, found)
    type(walker_t), intent(inout) :: walker !< with the equations of a curve
    real(dp), intent(in) :: seed(:) !< unknowns near the curve
    real(dp), intent(in) :: longest !< step
    logical, intent(out) :: found !< whether Newton's method finds the curve beside the seed
    real(dp), parameter :: NEAR = 0.1_dp
    real(dp) :: normals(4, 4), guess(UNKNOWNS)
    integer :: n, try

    n = 2*walker%system%n
    normals = reshape([0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, &
                       0.0_dp, 0.0_dp, 0.7_dp, -0.7_dp, 1.0_dp, 0.3_dp, 0.0_dp, 0.0_dp], [4, 4])
    do try = 1, 4
      guess = 0
      guess(:2) = normals(:2, try)
      guess(n + 1:n + 2) = normals(3:, try)
      walker%y(:n + 2) = seed(:n + 2)
      found = newton(walker%system, 12, FAR, CLOSE, walker%y, guess) > 0
      if (found) found = maxval(abs(walker%y(:n + 2) - seed(:n + 2))) < NEAR
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
    type(cycle_t) :: parent
    real(dp) :: next, later(2, 0:TERMS, POINTS)
    logical :: on, at_rest, half
    integer :: which

    on = .false.
    do which = HALVES, REST
      if (.not. is%distance(which) < min(BESIDE, was%distance(which))) cycle
      half = which == MIRROR .and. system%plane%half_period /= 0
      at_rest = which == REST .or. (which == MIRROR .and. system%n == 1 .and. .not. half)
      parent = cycle_of(system, y)
      associate (kind => parent%kind, first => parent%point(:, 1))
        kind%points = merge(1, (system%n + merge(1, 0, half))/2, at_rest)
        kind%side = merge(-1, 1, which == MIRROR)
        kind%half = merge(1, 0, half)
        kind%multiplier = -1
        next = parent%point(1, kind%points + 1)
        if (at_rest) first = [PI*anint(y(1)/PI), 0.0_dp]
        if (half) on = images(system, COARSE, 0, [parent%point(:, kind%points), parent%place], 1, later)
        if (half) next = later(1, 0, 1)
        if (at_rest) next = first(1)
        kind%turns = nint((next - kind%side*first(1))/(2*PI))
      end associate
      on = is_on(system%plane, parent) /= 0
      if (on) return
    end do
  end function on_parents_curve

  !> By the trace; where that changes beyond its limit within a place's error, by where the multiplier is reached.
  function is_on(plane, cycle) bind(C, name='kz_cycle_is_on') result(on)
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(inout) :: cycle
    integer(c_int32_t) :: on
    real(dp), parameter :: CROSSED = 1e-4_dp, SAME = 1e-9_dp, BESIDE = 1e-3_dp ! trace; sides of the plane; rad
    real(dp), parameter :: ALONG(2, 2) = reshape([1, 0, 0, 1], [2, 2])
    type(cycle_t) :: found
    integer :: n, axis

    n = cycle%kind%points
    found = cycle
    on = at_place(plane, found)
    associate (trace => found%number(1), determinant => found%number(2))
      if (abs(trace - cycle%kind%multiplier*(1 + determinant)) > CROSSED*(1 + determinant)) on = 0
    end associate
    do axis = 1, 2
      if (on /= 0) exit
      found = cycle
      on = on_line(plane, found, ALONG(:, axis))
      if (norm2(found%place - cycle%place) > SAME) on = 0
      if (maxval(abs(found%point(:, :n) - cycle%point(:, :n))) > BESIDE) on = 0
    end do
    if (on /= 0) cycle = found
  end function is_on

end module kz_curves_trace
