!> Follows many orbits with their errors beside them, until a trapping region holds all that an error leaves open: another orbit takes the
!> lane of one that is done. An orbit whose error grows large is doubtful: its label is not decided.
module kz_labels_orbits
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_cycles_cycles, only: attractor_t, QUASIPERIODIC
  use kz_grown_grid, only: regions_t, find_regions, chaos_region, cell_holds
  use kz_labels_nonlinear, only: measure_nonlinear, SAFETY
  use kz_labels_lanes, only: queued_lanes_t, list_flagged
  use kz_labels_carrier, only: carrier_t, orbit_t
  use kz_labels_spread, only: spread_errors, flag_large, flag_done
  use kz_lanes_map, only: WIDTH, CAPACITY, PI
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: decision_t, follow_orbits, DOUBTFUL, PENDING

  !> Labels besides the numbers of attractors: of an orbit whose error has become too large; of one that is to be followed on elsewhere.
  integer, parameter :: DOUBTFUL = -1, PENDING = -2
  !> KZ_LEVELS of dynamics.h.
  integer(c_int32_t), parameter :: NO_LEVEL = 8
  !> rad: the size of an error that a label bears.
  real(dp), parameter :: TOLERABLE = 0.03_dp
  !> rad: of larger errors what is not linear is carried too. The largest second derivatives of a period are some 100, so
  !> what is left out is less than a hundredth of an error, and less than a thousandth where it is half as large. With a larger error no orbit is known to be on a closed curve.
  real(dp), parameter :: LINEAR = 1e-4_dp
  !> Points of an ellipse's rim that a trapping region must hold.
  integer, parameter :: RIM = 8

  !> kz_decision of dynamics.h: where an orbit ends.
  type, bind(C) :: decision_t
    integer(c_int32_t) :: label = PENDING !< attractor from 1, 0 = not settled, DOUBTFUL, PENDING
    integer(c_int32_t) :: other = 0
    integer(c_int32_t) :: level = NO_LEVEL !< no error changes the label, at this level
    integer(c_int64_t) :: periods = 0     !< first period inside a trapping region, or those followed
    real(dp) :: error = 0                 !< how far the orbit may be off then, rad
    integer(c_int64_t) :: age = 0         !< periods after which it was left
    real(dp) :: state(2) = 0              !< where it was then, in the map's coordinates
  end type decision_t

  !> What lanes carry besides their states.
  type, extends(queued_lanes_t) :: lanes_t
    real(dp) :: p(WIDTH, 3) = 0         !< errors
    real(dp) :: coming(3, CAPACITY) = 0 !< of orbits that wait
    integer(c_int64_t) :: number(CAPACITY) = 0
    integer :: first(CAPACITY) = 0      !< trapping region that holds the state alone, 0 = none yet
    integer(c_int64_t) :: since(CAPACITY) = 0
    logical :: doubted(CAPACITY) = .false.
  end type lanes_t

contains

  !> Follows orbits up to age `most`. decision(i)%label = PENDING and the orbit as it is then where its error has reached `handover`, if
  !> that is below TOLERABLE.
  subroutine follow_orbits(carrier, regions, attractors, most, handover, guess, level, orbit, decision)
    type(carrier_t), intent(inout) :: carrier !< what moves the orbits by one period
    type(regions_t), intent(in) :: regions !< the trapping regions
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    integer(c_int64_t), intent(in) :: most !< periods
    real(dp), intent(in) :: handover !< rad
    logical, intent(in) :: guess !< follow doubtful orbits on, to where the states alone end
    integer(c_int32_t), intent(in) :: level !< that decides
    type(orbit_t), intent(inout) :: orbit(:) !< [n] in and out
    type(decision_t), intent(inout) :: decision(:) !< [n] as they are made, in; out
    type(lanes_t) :: lanes
    integer(c_int64_t) :: next
    real(dp) :: trace(WIDTH), largest, u(WIDTH), v(WIDTH), nonlinear(WIDTH)
    integer :: region(WIDTH), done(WIDTH), list(WIDTH), n_done, lane, i
    logical :: with_covers

    next = 1
    trace = 0
    with_covers = size(regions%covered) > 0
    largest = min(TOLERABLE, handover)**2
    do lane = 1, WIDTH
      call occupy(lane)
    end do
    do while (lanes%active > 0)
      u = carrier%u(:WIDTH)
      v = carrier%v(:WIDTH)
      call carrier%advance(lanes%active)
      call add_nonlinear(lanes%active)
      call spread_errors(lanes%active, carrier%tangent, carrier%noise, nonlinear, lanes%p, trace)
      call find_regions(regions, attractors, lanes%active, carrier%u(:lanes%active), carrier%v(:lanes%active), region)
      lanes%age(:lanes%active) = lanes%age(:lanes%active) + 1
      call flag_done(lanes%active, region, trace, largest, done)
      if (with_covers .or. maxval(lanes%age(:lanes%active)) >= most) done = 1
      call list_flagged(lanes%active, done, list, n_done)
      do i = 1, n_done
        if (is_open(list(i), region(list(i)), trace(list(i)))) cycle
        call occupy(list(i))
      end do
    end do
  contains
    !> What is not linear in the period, where errors are large.
    subroutine add_nonlinear(n)
      integer, intent(in) :: n
      integer :: large(WIDTH), lane(WIDTH), n_large

      nonlinear = 0
      call flag_large(n, lanes%p, LINEAR**2, large)
      if (sum(large(:n)) == 0) return
      call list_flagged(n, large, lane, n_large)
      call measure_nonlinear(carrier, lane(:n_large), u, v, lanes%p, nonlinear)
    end subroutine add_nonlinear

    !> An orbit that waits, or else the last active one, moves into the free lane, which is at most the first behind the active ones.
    subroutine occupy(lane)
      integer, intent(in) :: lane
      integer :: from

      if (lanes%waiting == 0) call let_in
      call lanes%next(lane, from)
      if (from == 0) return
      if (from > WIDTH) then
        lanes%p(lane, :) = lanes%coming(:, from)
      else
        lanes%p(lane, :) = lanes%p(from, :)
      end if
      call move(carrier, lanes, from, lane)
    end subroutine occupy

    !> Puts the next orbits into the lanes behind the first WIDTH. Those that are done leave at once.
    subroutine let_in
      integer :: found(WIDTH), n, i

      do while (lanes%waiting == 0 .and. next <= size(orbit))
        n = int(min(int(WIDTH, c_int64_t), size(orbit) - next + 1))
        do i = WIDTH + 1, WIDTH + n
          call carrier%put(i, orbit(next))
          call open_lane(lanes, i, next, orbit(next))
          next = next + 1
        end do
        call carrier%to_map(WIDTH + 1, WIDTH + n)
        call find_regions(regions, attractors, n, carrier%u(WIDTH + 1:WIDTH + n), carrier%v(WIDTH + 1:WIDTH + n), found)
        do i = n, 1, -1 ! the first orbit is to leave the queue first
          if (is_followed(WIDTH + i, found(i))) call lanes%wait(WIDTH + i)
        end do
      end do
    end subroutine let_in

    !> Whether an orbit that has just been put is to be followed: not where it is trapped at once.
    logical function is_followed(lane, region)
      integer, intent(in) :: lane, region

      is_followed = .true.
      if (region > 0) call note_region(lanes, lane, region, guess)
      if (region > 0 .and. sum(lanes%coming([1, 3], lane)) < TOLERABLE**2) &
        is_followed = .not. holds(regions, attractors, carrier%u(lane), carrier%v(lane), lanes%coming(:, lane), carrier%region_error(lane), region)
      if (.not. is_followed) call settle(lane, region, .true., lanes%coming(:, lane))
      if (is_followed .and. lanes%age(lane) >= most) then
        is_followed = .false.
        call settle(lane, merge(lanes%first(lane), merge(DOUBTFUL, 0, region > 0), guess), .false., lanes%coming(:, lane))
      end if
    end function is_followed

    !> Whether the orbit is to be followed on; if not, its ending is noted.
    logical function is_open(lane, region, trace)
      integer, intent(in) :: lane, region
      real(dp), intent(in) :: trace
      logical :: late
      integer :: host

      is_open = .true.
      late = lanes%age(lane) >= most
      if (handover < TOLERABLE .and. trace >= handover**2) then
        call pass_on(lane)
        is_open = .false.
        return
      end if
      if (.not. trace < TOLERABLE**2) lanes%doubted(lane) = .true.
      if (lanes%doubted(lane)) lanes%p(lane, :) = 0
      if (region > 0) then
        lanes%guest_of(lane) = 0
        call note_region(lanes, lane, region, guess)
        if (.not. lanes%doubted(lane)) &
          is_open = .not. holds(regions, attractors, carrier%u(lane), carrier%v(lane), lanes%p(lane, :), carrier%region_error(lane), region)
        if (.not. is_open) call settle(lane, region, .true., lanes%p(lane, :))
      else if (with_covers) then
        host = chaos_region(regions, carrier%u(lane), carrier%v(lane))
        if (host > 0) host = merge(host, 0, attractors(host)%period /= QUASIPERIODIC .or. &
                                   (trace < LINEAR**2 .and. .not. lanes%doubted(lane)))
        is_open = .not. lanes%is_captured(lane, host)
        if (.not. is_open) call settle(lane, host, .true., lanes%p(lane, :))
      end if
      if (.not. is_open) return
      if (lanes%doubted(lane) .and. lanes%guest_of(lane) == 0 .and. (.not. guess .or. lanes%first(lane) > 0)) then
        call settle(lane, merge(lanes%first(lane), DOUBTFUL, guess), .false., lanes%p(lane, :))
      else if (late) then
        call settle(lane, merge(lanes%first(lane), merge(DOUBTFUL, 0, region > 0), guess), &
                    .not. lanes%doubted(lane) .and. region == 0, lanes%p(lane, :))
      else
        return
      end if
      is_open = .false.
    end function is_open

    !> The orbit leaves as it is.
    subroutine pass_on(lane)
      integer, intent(in) :: lane

      associate (o => orbit(lanes%number(lane)))
        call carrier%take(lane, o)
        o%p = lanes%p(lane, :)
        o%lost = 0
        o%age = lanes%age(lane)
      end associate
      decision(lanes%number(lane))%label = PENDING
    end subroutine pass_on

    subroutine settle(lane, label, decided, p)
      integer, intent(in) :: lane, label
      logical, intent(in) :: decided
      real(dp), intent(in) :: p(3)
      integer(c_int64_t) :: periods

      periods = lanes%age(lane)
      if (label > 0 .and. label == lanes%first(lane)) periods = lanes%since(lane)
      decision(lanes%number(lane)) = decision_t(label, 0, merge(level, NO_LEVEL, decided), periods, &
                                                SAFETY*sqrt(p(1) + p(3)), lanes%age(lane), [carrier%u(lane), carrier%v(lane)])
    end subroutine settle
  end subroutine follow_orbits

  subroutine open_lane(lanes, lane, number, orbit)
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: lane
    integer(c_int64_t), intent(in) :: number
    type(orbit_t), intent(in) :: orbit

    lanes%number(lane) = number
    lanes%coming(:, lane) = orbit%p
    lanes%age(lane) = orbit%age
    lanes%first(lane) = 0
    lanes%since(lane) = 0
    lanes%guest_of(lane) = 0
    lanes%stay(lane) = 0
    lanes%doubted(lane) = .false.
  end subroutine open_lane

  !> The first region that holds the state; a later one of another attractor counts in its place, but not for a guess.
  subroutine note_region(lanes, lane, region, guess)
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: lane, region
    logical, intent(in) :: guess

    if (lanes%first(lane) == region .or. (guess .and. lanes%first(lane) > 0)) return
    lanes%first(lane) = region
    lanes%since(lane) = lanes%age(lane)
  end subroutine note_region

  subroutine move(carrier, lanes, from, to)
    type(carrier_t), intent(inout) :: carrier
    type(lanes_t), intent(inout) :: lanes
    integer, intent(in) :: from, to

    call carrier%move(from, to)
    call lanes%copy(from, to)
    lanes%number(to) = lanes%number(from)
    lanes%first(to) = lanes%first(from)
    lanes%since(to) = lanes%since(from)
    lanes%doubted(to) = lanes%doubted(from)
  end subroutine move

  !> Whether the trapping region that holds (u0, v0) holds the whole ellipse, and `region_error` rad beyond.
  function holds(regions, attractors, u0, v0, p, region_error, region) result(inside)
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    real(dp), intent(in) :: u0, v0, p(3), region_error
    integer, intent(in) :: region
    logical :: inside
    real(dp) :: u(RIM), v(RIM), angle, along, across, slant
    integer :: label(RIM), i

    along = sqrt(p(1))
    inside = cell_holds(regions, u0, v0, (SAFETY*along + region_error)/PI, SAFETY*sqrt(p(3)) + region_error)
    if (inside) return
    slant = merge(p(2)/along, 0.0_dp, along > 0)
    across = sqrt(max(0.0_dp, p(3) - slant**2))
    do i = 1, RIM
      angle = 2*PI*i/RIM
      u(i) = angle_difference(u0 + ((SAFETY*along + region_error)*cos(angle))/PI, 0.0_dp)
      v(i) = v0 + SAFETY*(slant*cos(angle) + across*sin(angle)) + region_error*sin(angle)
    end do
    call find_regions(regions, attractors, RIM, u, v, label)
    inside = all(label == region)
  end function holds

end module kz_labels_orbits
