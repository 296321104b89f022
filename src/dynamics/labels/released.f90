!> Orbits from their release to the strobe after which the drive has its final form, with their errors beside them: stretch by stretch, each
!> with tables of its own, many orbits at once.
module kz_labels_released
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_taylor_probes, only: measure_quad
  use kz_taylor_taylor, only: drive_t, make_drive, TAYLOR_STEPS
  use kz_kernel_flows, only: make_stretch_flow
  use kz_labels_carrier, only: carrier_t, orbit_t, make_carrier, BY_SERIES
  use kz_labels_period_error, only: period_error_t, speed_probes_t, make_speed_probes, measure_period
  use kz_labels_spread, only: spread_errors
  use kz_vector_map, only: flow_t, WIDTH, CAPACITY
  use kz_model_pendulum, only: pendulum_t
  use kz_model_release, only: release_t, stretch_t, first_stretch, next_stretch, is_open, strobes_before
  implicit none
  private
  public :: released_t, make_released, carry_released

  !> rad: what is not linear in a stretch is left out below it; an orbit whose error is larger is lost, its error as large as FAR.
  real(dp), parameter :: LINEAR = 1e-4_dp, FAR = 10
  !> Stretches whose errors are measured: the first, the last, and some between.
  integer, parameter :: MEASURED = 4
  !> How much more than their largest error is assumed for the others.
  real(dp), parameter :: MARGIN = 2

  type :: released_t
    type(release_t) :: release
    type(period_error_t) :: error !< of a stretch in double precision
    real(dp) :: quad_error = 0    !< in quad precision, of hypot(pi, v)
  end type released_t

contains

  !> Measures the errors of the stretches of a release.
  subroutine make_released(released, release, pendulum, fastest)
    type(released_t), intent(out) :: released !< is made
    type(release_t), intent(in) :: release !< how the motions begin
    type(pendulum_t), intent(in) :: pendulum !< as it is after a ramp
    real(dp), intent(in) :: fastest !< speeds that occur, rad per drive radian
    type(stretch_t) :: stretch
    type(period_error_t) :: error
    type(speed_probes_t), allocatable :: probes
    class(flow_t), allocatable :: flow
    type(drive_t) :: drive
    integer :: n, i, every

    released%release = release
    n = int(strobes_before(release))
    every = max(1, n/(MEASURED - 1))
    released%error%noise = 0
    allocate (probes)
    stretch = first_stretch(release)
    i = 0
    do while (is_open(stretch))
      if (mod(i, every) == 0 .or. i >= n - 1) then
        call make_stretch_flow(pendulum, stretch, flow)
        call make_speed_probes(pendulum, fastest, probes, stretch)
        call measure_period(flow, probes, error)
        error%noise = max(MARGIN*min(error%noise, huge(1.0_dp)/MARGIN), released%error%noise) ! the last is huge
        released%error = error
        call make_drive(drive, pendulum, TAYLOR_STEPS, stretch)
        released%quad_error = max(released%quad_error, MARGIN*measure_quad(drive, fastest))
      end if
      i = i + 1
      stretch = next_stretch(stretch)
    end do
    released%error%noise(ubound(released%error%noise, 1)) = huge(1.0_dp)
  end subroutine make_released

  !> Carries orbits through the release to the strobe, and sets their age to that of the strobe.
  subroutine carry_released(released, pendulum, precisely, orbit)
    type(released_t), intent(in) :: released !< what make_released gave
    type(pendulum_t), intent(in) :: pendulum !< as it is after a ramp
    logical, intent(in) :: precisely !< in quad precision, else in double precision
    type(orbit_t), intent(inout) :: orbit(:) !< [n] in and out
    type(stretch_t) :: stretch
    type(drive_t), target :: drive
    class(flow_t), allocatable :: flow
    type(carrier_t) :: carrier
    integer :: first

    stretch = first_stretch(released%release)
    do while (is_open(stretch))
      call make_stretch_flow(pendulum, stretch, flow)
      call make_carrier(flow, released%error, carrier)
      if (precisely) then
        call make_drive(drive, pendulum, TAYLOR_STEPS, stretch)
        carrier%means = BY_SERIES
        carrier%drive => drive
        carrier%drive_error = released%quad_error
      end if
      do first = 1, size(orbit), WIDTH
        call carry(carrier, orbit(first:min(size(orbit), first + WIDTH - 1)))
      end do
      stretch = next_stretch(stretch)
    end do
    orbit%age = orbit%age + strobes_before(released%release)
  end subroutine carry_released

  !> At most WIDTH orbits through the stretch of the carrier.
  subroutine carry(carrier, orbit)
    type(carrier_t), intent(inout) :: carrier
    type(orbit_t), intent(inout) :: orbit(:)
    real(dp) :: p(CAPACITY, 3), trace(WIDTH), nonlinear(WIDTH)
    integer :: lane, n

    n = size(orbit)
    p = 0
    nonlinear = 0
    trace = 0
    do lane = 1, n
      call carrier%put(lane, orbit(lane))
      p(lane, :) = orbit(lane)%p
    end do
    call carrier%to_map(1, n)
    call carrier%advance(n)
    call spread_errors(n, carrier%tangent, carrier%noise, nonlinear, p, trace)
    do lane = 1, n
      call carrier%take(lane, orbit(lane))
      orbit(lane)%lost = 0
      orbit(lane)%p = p(lane, :)
      if (.not. trace(lane) < LINEAR**2) orbit(lane)%p = FAR**2*[1, 0, 1]
    end do
  end subroutine carry

end module kz_labels_released
