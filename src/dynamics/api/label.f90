!> The C interface of dynamics: labels with errors, and starts until the first strobe of the final drive
!> (include/kapitza/dynamics_labels.h).
module kz_api_label
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_bool, c_int8_t, c_int32_t, c_int64_t, c_ptr
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_taylor_pairs, only: pair_of, quad_of
  use kz_taylor_taylor, only: drive_t, make_drive, doubles_of, qp, PI_QUAD
  use kz_vector_locks, only: take_lock, leave_lock
  use kz_labels_carrier, only: carrier_t, orbit_t, make_exact_carrier
  use kz_labels_levels, only: prepare_level, carrier_of, is_useful, outlook_from, LEVEL_DOUBLE, LEVEL_FINE, LEVEL_QUAD
  use kz_labels_orbits, only: decision_t, orbits_t, follow_orbits, DOUBTFUL, PENDING
  use kz_labels_spread, only: add_ellipse
  use kz_vector_map, only: PI
  use kz_maps_states, only: wrapped
  implicit none
  private

  !> An orbit is followed at the next cheaper level once its error is so many times what that adds in a period.
  real(dp), parameter :: RATIO = 30

  !> Memory of kz_start of dynamics_labels.h.
  type, bind(C) :: start_t
    real(dp) :: theta(2), velocity(2)
    integer(c_int64_t) :: periods
    real(dp) :: error(3)
    real(dp) :: from = 0
    integer(c_int64_t) :: turns = 0
  end type start_t

  !> Memory of kz_label_precision of dynamics_labels.h.
  type, bind(C) :: precision_t
    integer(c_int32_t) :: level, before
    logical(c_bool) :: guess
    integer(c_int32_t) :: series_steps
  end type precision_t

contains

  subroutine label_starts(handle, precision, n, start, max_periods, decision) bind(C, name='kz_dynamics_label')
    type(c_ptr), value :: handle
    type(precision_t), intent(in) :: precision
    integer(c_int64_t), value :: n
    type(start_t), intent(in) :: start(n)
    integer(c_int64_t), value :: max_periods
    type(decision_t), intent(out) :: decision(n)
    type(dynamics_t), pointer :: d
    type(decision_t), allocatable :: found(:)
    integer(c_int64_t), allocatable :: place(:)
    integer(c_int64_t) :: i
    logical :: early

    d => of_handle(handle)
    early = precision%level == LEVEL_QUAD .and. precision%before <= LEVEL_FINE
    call label_orbits(d, precision, early, max_periods, start, decision)
    if (precision%level /= LEVEL_QUAD .or. precision%series_steps > 0) return
    ! Quad precision to its last digit: leaving it early, or for pairs of doubles, adds errors.
    place = pack([(i, i=1, n)], decision%end%label == DOUBTFUL .and. (early .or. decision%end%next == LEVEL_QUAD))
    allocate (found(size(place)))
    if (size(place) > 0) &
      call label_orbits(d, precision_t(LEVEL_QUAD, min(precision%before, LEVEL_FINE), .false._c_bool, 0), .false., &
                        max_periods, start(place), found)
    decision(place) = found
  end subroutine label_starts

  !> The orbit of a start, which is known to the last place of its double, or, with `precisely`, of its pair.
  elemental subroutine begin_orbit(start, precisely, orbit)
    type(start_t), intent(in) :: start !< rad, rad per drive radian
    logical, intent(in) :: precisely !< to all digits of its pairs, else to those of doubles
    type(orbit_t), intent(out) :: orbit !< the orbit
    real(qp) :: u
    real(dp) :: turns

    if (precisely) then
      u = (real(start%theta(1), qp) + start%theta(2))/PI_QUAD
      turns = real(anint(u/2), dp)
      orbit%u = doubles_of(u - 2*turns, 3)
      orbit%v = start%velocity
      orbit%lost = 4*real(epsilon(u), dp)
    else
      orbit%u = [wrapped(start%theta(1)/PI), start%theta(2)/PI, 0.0_dp]
      turns = 0.5_dp*(start%theta(1)/PI - orbit%u(1))
      orbit%v = start%velocity
      orbit%lost = 2*epsilon(1.0_dp)
    end if
    orbit%lost = orbit%lost*(max(abs(start%theta(1)), PI) + abs(start%velocity(1)))
    orbit%age = start%periods
    orbit%p = start%error
    orbit%turns = start%turns + nint(turns, c_int64_t)
  end subroutine begin_orbit

  !> The angle at which a start was released, rad.
  elemental function angle_of_release(start) result(from)
    type(start_t), intent(in) :: start
    real(dp) :: from

    from = merge(start%theta(1), start%from, start%periods == 0)
  end function angle_of_release

  !> Orbits begin at a level and go down from level to level as their errors grow.
  subroutine label_orbits(d, precision, early, most, start, decision)
    type(dynamics_t), intent(inout), target :: d
    type(precision_t), intent(in) :: precision
    logical, intent(in) :: early !< leave quad precision once half of its digits are lost: decides most in half the time
    integer(c_int64_t), intent(in) :: most
    type(start_t), intent(in) :: start(:)
    type(decision_t), intent(out) :: decision(:)
    type(drive_t), target :: drive
    type(carrier_t) :: carrier
    type(orbit_t), allocatable :: orbit(:), some(:)
    type(decision_t), allocatable :: found(:)
    integer, allocatable :: place(:)
    type(orbits_t) :: like
    real(dp) :: handover
    integer :: level, now, next, i

    level = precision%level
    allocate (orbit(size(start)))
    call begin_orbit(start, level > LEVEL_DOUBLE, orbit)
    decision%from = angle_of_release(start)
    like%regions => d%regions
    like%attractors => d%attractors
    like%most = most
    if (precision%series_steps > 0) then
      call make_drive(drive, d%search%pendulum, int(precision%series_steps))
      call make_exact_carrier(d%search%flow, drive, carrier)
      call follow_orbits(like, carrier, huge(1.0_dp), orbit, decision)
      return
    end if
    call prepare(d, LEVEL_DOUBLE)
    if (.not. is_useful(d%levels, level)) then
      decision%end%label = DOUBTFUL
      decision%end%next = int(level + 1, c_int8_t)
      return
    end if
    call prepare(d, level)
    like%outlook = outlook_from(d%levels, level)
    now = level
    do
      next = merge(int(precision%before), now - 1, now == level)
      if (.not. is_useful(d%levels, next)) next = next - 1
      handover = handover_to(d, now, next, early .and. now == level)
      call carrier_of(d%levels, now, d%flow, carrier)
      like%guess = precision%guess .and. now == level
      if (now == level) then ! most orbits need no more: they are not copied
        call follow_orbits(like, carrier, handover, orbit, decision)
      else
        some = orbit(place)
        found = decision(place)
        call follow_orbits(like, carrier, handover, some, found)
        orbit(place) = some
        decision(place) = found
      end if
      if (now == LEVEL_DOUBLE) return ! nothing is handed over from there
      place = pack([(i, i=1, size(orbit))], decision%end%label == PENDING)
      if (size(place) == 0) return
      now = next
    end do
  end subroutine label_orbits

  !> The error, rad, with which orbits of a level go on at the next one; makes both levels.
  function handover_to(d, now, next, early) result(handover)
    type(dynamics_t), intent(inout) :: d
    integer, intent(in) :: now, next
    logical, intent(in) :: early !< leave quad precision once half of its digits are lost
    real(dp) :: handover

    handover = huge(handover)
    call prepare(d, now)
    if (now == LEVEL_DOUBLE) return
    call prepare(d, next)
    handover = RATIO*d%levels%worst(next)
    if (early) handover = sqrt(handover*d%levels%quad_error)
  end function handover_to

  !> Makes a level at its first use, whichever thread asks.
  subroutine prepare(d, level)
    type(dynamics_t), intent(inout) :: d
    integer, intent(in) :: level

    call take_lock(d%lock)
    call prepare_level(d%levels, level, d%flow, d%regions%top)
    call leave_lock(d%lock)
  end subroutine prepare

  subroutine begin_starts(handle, level, n, start) bind(C, name='kz_dynamics_begin')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: level
    integer(c_int64_t), value :: n
    type(start_t), intent(inout) :: start(n)
    type(dynamics_t), pointer :: d
    type(orbit_t), allocatable :: orbit(:)
    integer(c_int64_t), allocatable :: fresh(:)
    integer(c_int64_t) :: i
    logical :: precisely

    d => of_handle(handle)
    if (.not. allocated(d%onset)) return
    fresh = pack([(i, i=1, n)], start%periods == 0)
    if (size(fresh) == 0) return
    call take_lock(d%lock)
    call d%onset%prepare(d%search%pendulum, d%regions%top)
    call leave_lock(d%lock)
    precisely = level > LEVEL_FINE
    allocate (orbit(size(fresh)))
    call begin_orbit(start(fresh), precisely, orbit)
    call d%onset%carry(d%search%pendulum, precisely, orbit)
    do i = 1, size(fresh)
      start(fresh(i)) = start_of(orbit(i), start(fresh(i))%theta(1), precisely)
    end do
  end subroutine begin_starts

  !> Back to rad, which costs a rounding.
  pure function start_of(orbit, from, precisely) result(start)
    type(orbit_t), intent(in) :: orbit
    real(dp), intent(in) :: from !< angle of its release, rad
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
    start%from = from
    start%turns = orbit%turns
  end function start_of

end module kz_api_label
