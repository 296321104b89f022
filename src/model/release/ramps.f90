!> Beginnings of motions: the phase of the drive at the release, and a ramp of damping or drive
!> (include/kapitza/model_release.h). Time is counted in drive periods from the strobe at or before the release.
module kz_release_ramps
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_model_stretch, only: stretch_t, CUBIC
  implicit none
  private
  public :: release_t, part_t, first_part, next_part, is_open, strobes_before

  integer, parameter :: qp = real128
  real(qp), parameter :: TWO_PI = 6.28318530717958647692528676655900577_qp
  !> Memory of kz_release of model_release.h.
  type, bind(C) :: release_t
    real(c_double) :: phase, periods, damping, drive
    integer(c_int32_t) :: smooth
  end type release_t

  !> A stretch between a release and the strobe at which the drive has its final form.
  type, extends(stretch_t) :: part_t
    type(release_t) :: release
  end type part_t

contains

  !> Number of the first strobe of the final drive; 0 if the release is on it.
  pure function strobes_before(release) bind(C, name='kz_release_strobes') result(n)
    type(release_t), intent(in) :: release !< Release
    integer(c_int64_t) :: n

    n = ceiling(release%periods, c_int64_t)
    if (abs(release%phase) > 0) n = max(1_c_int64_t, n)
  end function strobes_before

  !> The stretch from the release to the next strobe or the end of the ramp. Whole turns of the phase are removed in
  !> quad precision, so that decided labels are those of exactly this phase.
  function first_part(release) result(part)
    type(release_t), intent(in) :: release !< Release
    type(part_t) :: part
    real(qp) :: turns

    part%release = release
    part%along = [release%periods, release%damping, release%drive, real(release%smooth, c_double)]
    turns = release%phase/TWO_PI
    part%begin = turns - floor(turns)
    part%span = 0
    part = next_part(part)
  end function first_part

  !> The stretch after this one, up to the next strobe or the end of the ramp.
  function next_part(part) result(next)
    type(part_t), intent(in) :: part !< Last stretch that was followed
    type(part_t) :: next
    real(qp) :: end, ramp

    next = part
    next%begin = part%begin + part%span
    if (abs(next%begin - anint(next%begin)) < 1e-25_qp) next%begin = anint(next%begin)
    end = aint(next%begin) + 1
    ramp = part%release%periods
    next%changes => null()
    if (next%begin < ramp) next%changes => on_ramp
    if (next%begin < ramp) end = min(end, ramp)
    next%span = end - next%begin
  end function next_part

  !> True if a stretch begins before the drive has its final form and a strobe is reached.
  pure function is_open(part) result(open)
    type(part_t), intent(in) :: part !< Stretch
    logical :: open

    open = part%begin < strobes_before(part%release)
  end function is_open

  !> Remaining share of the ramp, 1 .. 0, as a polynomial in x, at `turn` + x width periods; 1 - 3 s**2 + 2 s**3 if
  !> smooth.
  pure function ramp_left(periods, is_smooth, turn, width) result(series)
    real(c_double), intent(in) :: periods
    logical, intent(in) :: is_smooth
    real(qp), intent(in) :: turn, width
    real(qp) :: series(0:CUBIC), s, d

    series = 0
    s = turn/periods
    d = width/periods
    if (.not. is_smooth) then
      series(:1) = [1 - s, -d]
    else
      series = [1 - s**2*(3 - 2*s), -6*s*(1 - s)*d, -3*(1 - 2*s)*d**2, 2*d**3]
    end if
  end function ramp_left

  !> A `course` of kz_model_stretch; along: periods, damping, drive, 1 = smooth.
  pure subroutine on_ramp(along, beta, turn, width, damping, drive)
    real(c_double), intent(in) :: along(4), beta
    real(qp), intent(in) :: turn, width
    real(qp), intent(out) :: damping(0:CUBIC), drive(0:CUBIC)
    real(qp) :: rest(0:CUBIC)

    rest = ramp_left(along(1), along(4) > 0, turn, width)
    damping = (real(along(2), qp) - beta)*rest
    damping(0) = damping(0) + beta
    drive = (real(along(3), qp) - 1)*rest
    drive(0) = drive(0) + 1
  end subroutine on_ramp

end module kz_release_ramps
