!> Follows many orbits with the ellipses of their errors. An orbit ends when a trapping region holds its whole ellipse.
!> If the ellipse grows too large for that, the orbit is doubtful, or goes on in the next cheaper precision.
module kz_labels_orbits
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t, c_int16_t, c_int8_t, c_bool
  use kz_cycles_cycles, only: attractor_t, RUNNING
  use kz_computed_grid, only: regions_t, find_regions, chaos_region, cell_holds
  use kz_labels_nonlinear, only: measure_nonlinear, SAFETY
  use kz_maps_lanes, only: queued_lanes_t, list_flagged
  use kz_labels_carrier, only: carrier_t, orbit_t
  use kz_labels_spread, only: spread_errors, flag_between, flag_done
  use kz_vector_map, only: WIDTH, CAPACITY, PI
  use kz_maps_matrices, only: axes_of
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: decision_t, outlook_t, orbits_t, follow_orbits, DOUBTFUL, PENDING, TOLERABLE

  !> Labels besides attractor numbers: the error is too large; the orbit is to be followed elsewhere.
  integer, parameter :: DOUBTFUL = -1, PENDING = -2
  !> rad: the size of an error that a label bears.
  real(dp), parameter :: TOLERABLE = 0.03_dp
  !> rad: of larger errors what is not linear is carried too. The largest second derivatives of a period are some 100,
  !> so what is left out is less than a hundredth of an error, and less than a thousandth where it is half as large.
  !> With a larger error no orbit is known to be on a closed curve.
  real(dp), parameter :: LINEAR = 1e-4_dp
  !> Points of an ellipse's rim that a trapping region must hold.
  integer, parameter :: RIM = 8

  !> Memory of kz_label of dynamics_labels.h.
  type, bind(C) :: label_t
    integer(c_int64_t) :: periods = 0       !< first period inside a trapping region, or those followed
    integer(c_int16_t) :: label = PENDING   !< attractor from 1, 0 = not settled, DOUBTFUL, PENDING
    integer(c_int16_t) :: other = 0
    integer(c_int8_t) :: evidence = 0
    integer(c_int8_t) :: next = 0           !< the level that may decide a doubtful orbit
    integer(c_int16_t) :: zero = 0          !< nothing, as the last one
    integer(c_int32_t) :: turns = 0         !< net turns until its end (count_turns)
    integer(c_int32_t) :: zeros = 0
  end type label_t

  !> Memory of kz_decision of dynamics_labels.h: a label with the orbit behind it.
  type, bind(C) :: decision_t
    type(label_t) :: end
    logical(c_bool) :: decided = .false.  !< no error changes the label
    real(dp) :: error = 0                 !< how far the orbit may be off then, rad
    integer(c_int64_t) :: age = 0         !< periods after which it was left
    real(dp) :: state(2) = 0              !< where it was then, in the map's coordinates
    integer(c_int64_t) :: turns = 0       !< net turns by which its angle on the line is then more than state(1)
    real(dp) :: from = 0                  !< angle of the release on the line, rad
  end type decision_t

  !> Forecast after a level. The states of a doubtful orbit are followed on, with the growth of its error by the
  !> tangents alone, until they end or the error is larger than `reach`: then the next level would not decide it either.
  type :: outlook_t
    integer(c_int32_t) :: next = 0, after = 0 !< the level that follows, and the one behind it
    real(dp) :: reach = TOLERABLE             !< rad
  end type outlook_t

  !> Orbits in the lanes of a carrier, and what becomes of them.
  type, extends(queued_lanes_t) :: orbits_t
    type(carrier_t), pointer :: carrier => null()
    type(regions_t), pointer :: regions => null()
    type(attractor_t), pointer :: attractors(:) => null()
    type(orbit_t), pointer :: orbit(:) => null()
    type(decision_t), pointer :: decision(:) => null()
    integer(c_int64_t) :: most = 0      !< age up to which orbits are followed
    real(dp) :: handover = 0            !< rad: an orbit with a larger error goes on elsewhere
    logical :: guess = .false.          !< doubtful orbits are followed on without their errors
    type(outlook_t) :: outlook          !< from the level that decides
    real(dp) :: ellipse(CAPACITY, 3) = 0 !< covariances of the errors
    real(dp) :: trace(WIDTH) = 0        !< traces of the active orbits' covariances
    integer :: first(CAPACITY) = 0      !< the first region that held the state alone, 0 = none yet
    integer(c_int64_t) :: since(CAPACITY) = 0 !< from that age on
    logical :: doubted(CAPACITY) = .false.
  contains
    procedure :: admit, advance, is_done, move
  end type orbits_t

contains

  !> Follows orbits up to the age `most`. decision(i)%end%label = PENDING and the orbit as it is then where its error
  !> has reached `handover`, if that is below TOLERABLE.
  subroutine follow_orbits(like, carrier, handover, orbit, decision)
    type(orbits_t), intent(in) :: like !< has the regions, the attractors, what is forecast, the ages
    type(carrier_t), intent(inout), target :: carrier !< moves the orbits by one period
    real(dp), intent(in) :: handover !< rad
    type(orbit_t), intent(inout), target :: orbit(:) !< [n] in and out
    type(decision_t), intent(inout), target :: decision(:) !< [n] as they are made, in; out
    type(orbits_t) :: orbits

    orbits = like
    orbits%carrier => carrier
    orbits%orbit => orbit
    orbits%decision => decision
    orbits%handover = handover
    orbits%items = size(orbit)
    call orbits%run()
  end subroutine follow_orbits

  subroutine admit(self, n)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    do lane = WIDTH + 1, WIDTH + n
      associate (orbit => self%orbit(self%number(lane)))
        call self%carrier%put(lane, orbit)
        self%ellipse(lane, :) = orbit%p
        self%age(lane) = orbit%age
      end associate
    end do
    self%first(WIDTH + 1:) = 0
    self%since(WIDTH + 1:) = 0
    self%doubted(WIDTH + 1:) = .false.
    call self%carrier%to_map(WIDTH + 1, WIDTH + n)
    call find_regions(self%regions, self%attractors, n, self%carrier%flow%u(WIDTH + 1:WIDTH + n), &
                      self%carrier%flow%v(WIDTH + 1:WIDTH + n), self%region(WIDTH + 1:))
  end subroutine admit

  !> Whether an orbit that has just been put is trapped, or too old; then its end has been noted.
  function ends_at_once(self, lane) result(done)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: done

    done = .false.
    if (self%region(lane) > 0) call note_region(self, lane)
    if (self%region(lane) > 0 .and. sum(self%ellipse(lane, [1, 3])) < TOLERABLE**2) done = is_held(self, lane)
    if (done) then
      call note_end(self, lane, self%region(lane), .true.)
    else if (self%age(lane) >= self%most) then
      done = .true.
      call note_end(self, lane, left_label(self, lane), .false.)
    end if
  end function ends_at_once

  subroutine advance(self, list, n)
    class(orbits_t), intent(inout) :: self
    integer, intent(out) :: list(WIDTH), n
    real(dp) :: u(WIDTH), v(WIDTH), nonlinear(WIDTH)
    integer :: done(WIDTH)

    associate (m => self%active, carrier => self%carrier)
      u = carrier%flow%u(:WIDTH)
      v = carrier%flow%v(:WIDTH)
      call carrier%advance(m)
      if (.not. carrier%exact) then
        call add_nonlinear(self, u, v, nonlinear)
        call spread_errors(m, carrier%tangent, carrier%noise, nonlinear, self%ellipse, self%trace)
      end if
      call find_regions(self%regions, self%attractors, m, carrier%flow%u(:m), carrier%flow%v(:m), self%region)
      self%age(:m) = self%age(:m) + 1
      call flag_done(m, self%region, self%trace, min(TOLERABLE, self%handover)**2, done)
      if (size(self%regions%covered) > 0 .or. maxval(self%age(:m)) >= self%most) done = 1
      call list_flagged(m, done, list, n)
    end associate
  end subroutine advance

  !> Nonlinear part of the period from the states (u, v), where errors are large.
  subroutine add_nonlinear(self, u, v, nonlinear)
    class(orbits_t), intent(inout) :: self
    real(dp), intent(in) :: u(WIDTH), v(WIDTH)
    real(dp), intent(out) :: nonlinear(WIDTH)
    integer :: large(WIDTH), lane(WIDTH), n_large

    nonlinear = 0
    call flag_between(self%active, self%ellipse, LINEAR**2, TOLERABLE**2, large)
    if (sum(large(:self%active)) == 0) return
    call list_flagged(self%active, large, lane, n_large)
    call measure_nonlinear(self%carrier, lane(:n_large), u, v, self%ellipse, nonlinear)
  end subroutine add_nonlinear

  function is_done(self, lane) result(yes)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    yes = .true.
    if (lane > WIDTH) then
      yes = ends_at_once(self, lane)
    else if (self%handover < TOLERABLE .and. self%trace(lane) >= self%handover**2) then
      call pass_on(self, lane)
    else
      if (.not. self%trace(lane) < TOLERABLE**2) self%doubted(lane) = .true.
      if (self%doubted(lane) .and. self%guess) self%ellipse(lane, :) = 0
      if (.not. is_trapped(self, lane)) yes = is_left(self, lane)
    end if
  end function is_done

  !> Whether a region or a cover holds an orbit; then its end has been noted.
  function is_trapped(self, lane) result(trapped)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: trapped
    integer :: owner

    trapped = .false.
    owner = self%region(lane)
    if (owner > 0) then
      self%in_cover(lane) = 0
      call note_region(self, lane)
      if (.not. self%doubted(lane)) trapped = is_held(self, lane)
    else if (size(self%regions%covered) > 0) then
      owner = chaos_region(self%regions, self%carrier%flow%u(lane), self%carrier%flow%v(lane))
      if (owner > 0) owner = merge(owner, 0, self%attractors(owner)%period /= RUNNING .or. &
                                 (self%trace(lane) < LINEAR**2 .and. .not. self%doubted(lane)))
      trapped = self%is_captured(lane, owner)
    end if
    if (trapped) call note_end(self, lane, owner, .true.)
  end function is_trapped

  !> Whether an untrapped orbit is followed no further: doubtful, or too old; then its end has been noted.
  function is_left(self, lane) result(left)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: left

    left = .true.
    if (self%doubted(lane) .and. self%in_cover(lane) == 0 .and. is_known(self, lane)) then
      call note_end(self, lane, merge(self%first(lane), DOUBTFUL, self%guess), .false.)
    else if (self%age(lane) >= self%most) then
      call note_end(self, lane, left_label(self, lane), .not. self%doubted(lane) .and. self%region(lane) == 0)
    else
      left = .false.
    end if
  end function is_left

  !> Whether it is known what becomes of a doubtful orbit: where its states end, or which level may decide it.
  pure logical function is_known(self, lane)
    class(orbits_t), intent(in) :: self
    integer, intent(in) :: lane

    is_known = merge(self%first(lane) > 0, self%region(lane) > 0 .or. is_beyond(self, lane), self%guess)
  end function is_known

  !> Whether the error of a doubtful orbit has grown so large that the next level would not decide it.
  pure logical function is_beyond(self, lane)
    class(orbits_t), intent(in) :: self
    integer, intent(in) :: lane

    is_beyond = .not. self%ellipse(lane, 1) + self%ellipse(lane, 3) < self%outlook%reach**2
  end function is_beyond

  !> The label of an orbit that is left at its last age, with its state in a region or not.
  pure function left_label(self, lane) result(label)
    class(orbits_t), intent(in) :: self
    integer, intent(in) :: lane
    integer :: label

    label = merge(self%first(lane), merge(DOUBTFUL, 0, self%region(lane) > 0), self%guess)
  end function left_label

  !> The orbit goes on elsewhere, as it is.
  subroutine pass_on(self, lane)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane

    associate (o => self%orbit(self%number(lane)))
      call self%carrier%take(lane, o)
      o%p = self%ellipse(lane, :)
      o%lost = 0
      o%age = self%age(lane)
    end associate
    self%decision(self%number(lane))%end%label = PENDING
  end subroutine pass_on

  subroutine note_end(self, lane, label, decided)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane, label
    logical, intent(in) :: decided
    integer(c_int64_t) :: periods
    integer(c_int8_t) :: next
    real(dp) :: error

    periods = self%age(lane)
    if (label > 0 .and. label == self%first(lane)) periods = self%since(lane)
    error = 0
    if (.not. self%doubted(lane)) error = SAFETY*sqrt(self%ellipse(lane, 1) + self%ellipse(lane, 3))
    next = 0
    if (label == DOUBTFUL) next = int(merge(self%outlook%after, self%outlook%next, is_beyond(self, lane)), c_int8_t)
    self%decision(self%number(lane)) = decision_t(label_t(periods, int(label, c_int16_t), next=next), &
                                                  logical(decided, c_bool), error, self%age(lane), &
                                                  [self%carrier%flow%u(lane), self%carrier%flow%v(lane)], &
                                                  self%carrier%turns_of(lane), self%decision(self%number(lane))%from)
  end subroutine note_end

  !> The first region that holds the state; a later one of another attractor counts in its place, but not for a guess.
  subroutine note_region(self, lane)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: lane

    if (self%first(lane) == self%region(lane) .or. (self%guess .and. self%first(lane) > 0)) return
    self%first(lane) = self%region(lane)
    self%since(lane) = self%age(lane)
  end subroutine note_region

  subroutine move(self, from, to)
    class(orbits_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call self%carrier%move(from, to)
    call self%copy(from, to)
    self%ellipse(to, :) = self%ellipse(from, :)
    self%first(to) = self%first(from)
    self%since(to) = self%since(from)
    self%doubted(to) = self%doubted(from)
  end subroutine move

  !> Whether the region that holds the state of a lane holds its whole ellipse, and `region_error` rad beyond.
  function is_held(self, lane) result(held)
    class(orbits_t), intent(in) :: self
    integer, intent(in) :: lane
    logical :: held
    real(dp) :: u(RIM), v(RIM), axes(3), angle, reach
    integer :: label(RIM), i

    associate (u0 => self%carrier%flow%u(lane), v0 => self%carrier%flow%v(lane), &
               error => self%carrier%region_error(lane))
      reach = SAFETY*sqrt(self%ellipse(lane, 1) + self%ellipse(lane, 3)) + error
      held = cell_holds(self%regions, u0, v0, reach/PI, reach)
      if (held) return ! most errors are small
      axes = axes_of(self%ellipse(lane, :))
      held = cell_holds(self%regions, u0, v0, (SAFETY*axes(1) + error)/PI, SAFETY*sqrt(self%ellipse(lane, 3)) + error)
      if (held) return
      do i = 1, RIM
        angle = 2*PI*i/RIM
        u(i) = angle_difference(u0 + ((SAFETY*axes(1) + error)*cos(angle))/PI, 0.0_dp)
        v(i) = v0 + SAFETY*(axes(2)*cos(angle) + axes(3)*sin(angle)) + error*sin(angle)
      end do
    end associate
    call find_regions(self%regions, self%attractors, RIM, u, v, label)
    held = all(label == self%region(lane))
  end function is_held

end module kz_labels_orbits
