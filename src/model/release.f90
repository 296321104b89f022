!> How motions begin: the phase of the drive at which the pendulum is released, and a ramp along which its damping or its drive comes from
!> another value. Time is counted in drive periods from the strobe at or before the release: include/kapitza/model.h.
module kz_model_release
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: release_t, stretch_t, whole_period, first_stretch, next_stretch, is_open, strobes_before, damping_series, drive_series, CUBIC

  integer, parameter :: qp = real128
  real(qp), parameter :: TWO_PI = 6.28318530717958647692528676655900577_qp
  !> Highest power of time in a ramp.
  integer, parameter :: CUBIC = 3

  !> kz_release of model.h.
  type, bind(C) :: release_t
    real(c_double) :: phase
    real(c_double) :: periods
    real(c_double) :: damping
    real(c_double) :: drive
    integer(c_int32_t) :: smooth
  end type release_t

  !> A part of a drive period: with ramps that are polynomials in time, or without.
  type :: stretch_t
    real(qp) :: begin = 0       !< drive periods
    real(qp) :: span = 1        !< drive periods, at most 1
    logical :: changes = .false. !< whether it is on a ramp
    type(release_t) :: release
  end type stretch_t

contains

  !> Number of the first strobe from which on the drive has its final form; 0 if it has this form from the release.
  pure function strobes_before(release) bind(C, name='kz_release_strobes') result(n)
    type(release_t), intent(in) :: release !< of the motions
    integer(c_int64_t) :: n

    n = ceiling(release%periods, c_int64_t)
    if (abs(release%phase) > 0) n = max(1_c_int64_t, n)
  end function strobes_before

  !> The stretch of a whole drive period with the final drive.
  pure function whole_period() result(stretch)
    type(stretch_t) :: stretch

    stretch = stretch_t(release=release_t(0, 0, 0, 1, 0))
  end function whole_period

  !> The stretch from the release to the next strobe, or to the end of the ramp. Whole turns of the phase are taken out in quad precision, so
  !> that decided labels are those of exactly this phase.
  pure function first_stretch(release) result(stretch)
    type(release_t), intent(in) :: release !< of the motions
    type(stretch_t) :: stretch
    real(qp) :: turns

    stretch = stretch_t(release=release, span=0)
    turns = release%phase/TWO_PI
    stretch%begin = turns - floor(turns)
    stretch = next_stretch(stretch)
  end function first_stretch

  !> The stretch after this one, up to the next strobe or the end of the ramp.
  pure function next_stretch(stretch) result(next)
    type(stretch_t), intent(in) :: stretch !< what has been followed
    type(stretch_t) :: next
    real(qp) :: end, ramp

    next = stretch
    next%begin = stretch%begin + stretch%span
    if (abs(next%begin - anint(next%begin)) < 1e-25_qp) next%begin = anint(next%begin)
    end = aint(next%begin) + 1
    ramp = stretch%release%periods
    next%changes = next%begin < ramp
    if (next%changes) end = min(end, ramp)
    next%span = end - next%begin
  end function next_stretch

  !> True if a stretch begins before the drive has its final form and a strobe is reached.
  pure function is_open(stretch) result(open)
    type(stretch_t), intent(in) :: stretch !< a stretch
    logical :: open

    open = stretch%begin < strobes_before(stretch%release)
  end function is_open

  !> What is left of the ramp, 1 .. 0, as a polynomial in x, at `turn` + x width drive periods. Smooth ramps go as 1 - 3 s**2 + 2 s**3.
  pure function rest_of(stretch, turn, width) result(series)
    type(stretch_t), intent(in) :: stretch
    real(qp), intent(in) :: turn, width
    real(qp) :: series(0:CUBIC)
    real(qp) :: s, d

    series = 0
    if (.not. stretch%changes) return
    s = turn/stretch%release%periods
    d = width/stretch%release%periods
    if (stretch%release%smooth == 0) then
      series(:1) = [1 - s, -d]
    else
      series = [1 - s**2*(3 - 2*s), -6*s*(1 - s)*d, -3*(1 - 2*s)*d**2, 2*d**3]
    end if
  end function rest_of

  !> beta as a polynomial in x, at `turn` + x width drive periods.
  pure function damping_series(stretch, pendulum, turn, width) result(series)
    type(stretch_t), intent(in) :: stretch !< of the time
    type(pendulum_t), intent(in) :: pendulum !< as it is after the ramp
    real(qp), intent(in) :: turn, width !< drive periods
    real(qp) :: series(0:CUBIC)

    series = (real(stretch%release%damping, qp) - pendulum%beta)*rest_of(stretch, turn, width)
    series(0) = series(0) + pendulum%beta
  end function damping_series

  !> The strength of the drive relative to the final one, as a polynomial in x, at `turn` + x width drive periods.
  pure function drive_series(stretch, turn, width) result(series)
    type(stretch_t), intent(in) :: stretch !< of the time
    real(qp), intent(in) :: turn, width !< drive periods
    real(qp) :: series(0:CUBIC)

    series = (real(stretch%release%drive, qp) - 1)*rest_of(stretch, turn, width)
    series(0) = series(0) + 1
  end function drive_series

end module kz_model_release
