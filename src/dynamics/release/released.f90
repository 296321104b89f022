!> Orbits from their release to the strobe after which the drive has its final form, with their errors beside them:
!> stretch by stretch, each with tables of its own, many orbits at once.
module kz_release_released
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_ptr
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_taylor_probes, only: measure_quad
  use kz_taylor_taylor, only: drive_t, make_drive, TAYLOR_STEPS
  use kz_kernel_flows, only: fine_numerics
  use kz_labels_carrier, only: carrier_t, orbit_t, make_carrier, BY_SERIES
  use kz_labels_onset, only: onset_t
  use kz_labels_period_error, only: period_error_t, speed_probes_t, make_speed_probes, measure_period
  use kz_labels_spread, only: spread_errors
  use kz_vector_map, only: flow_t, WIDTH, CAPACITY
  use kz_model_pendulum, only: pendulum_t
  use kz_release_ramps, only: release_t, part_t, first_part, next_part, is_open, strobes_before
  use kz_splitting_batch, only: make_batch
  use kz_vector_step_table, only: numerics_t, period_t, make_period
  implicit none
  private

  !> rad: error below which a stretch counts as linear; error from which an orbit is lost, its error set to FAR.
  real(dp), parameter :: LINEAR = 1e-4_dp, FAR = 10
  !> Stretches whose errors are measured: the first, the last, and some between.
  integer, parameter :: MEASURED = 4
  !> How much more than their largest error is assumed for the others.
  real(dp), parameter :: MARGIN = 2

  type, extends(onset_t) :: released_t
    type(release_t) :: release
    logical :: is_made = .false.
    type(period_error_t) :: error !< error of a stretch in double precision
    real(dp) :: quad_error = 0    !< in quad precision, of hypot(pi, v)
  contains
    procedure :: prepare
    procedure :: carry => carry_released
  end type released_t

contains

  subroutine set_release(handle, release) bind(C, name='kz_dynamics_set_release')
    type(c_ptr), value :: handle
    type(release_t), intent(in) :: release
    type(dynamics_t), pointer :: d
    type(released_t) :: onset

    d => of_handle(handle)
    onset%release = release
    if (allocated(d%onset)) deallocate (d%onset)
    if (strobes_before(release) > 0) allocate (d%onset, source=onset)
  end subroutine set_release

  subroutine get_release(handle, release) bind(C, name='kz_dynamics_get_release')
    type(c_ptr), value :: handle
    type(release_t), intent(out) :: release
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    release = release_t(0, 0, 0, 1, 0)
    if (.not. allocated(d%onset)) return
    select type (onset => d%onset)
    type is (released_t)
      release = onset%release
    end select
  end subroutine get_release

  !> The map of a stretch, by fine steps of split6.
  subroutine make_part_flow(pendulum, part, flow)
    type(pendulum_t), intent(in) :: pendulum !< as it is after a ramp
    type(part_t), intent(in) :: part !< a part of a drive period
    class(flow_t), allocatable, intent(out) :: flow !< from its beginning to its end
    type(numerics_t) :: numerics
    type(period_t) :: period

    numerics = fine_numerics(pendulum)
    numerics%steps_per_period = ceiling(numerics%steps_per_period*real(part%span, &
        dp)*sqrt(max(1.0_dp, abs(part%release%drive))))
    call make_period(pendulum, numerics, .true., period, part%stretch_t)
    call make_batch(period, flow)
  end subroutine make_part_flow

  !> Measures the errors of the stretches of a release.
  subroutine prepare(onset, pendulum, fastest)
    class(released_t), intent(inout) :: onset
    type(pendulum_t), intent(in) :: pendulum !< as it is after a ramp
    real(dp), intent(in) :: fastest !< speeds that occur, rad per drive radian
    type(part_t) :: part
    type(period_error_t) :: error
    type(speed_probes_t), allocatable :: probes
    class(flow_t), allocatable :: flow
    type(drive_t) :: drive
    integer :: n, i, every

    if (onset%is_made) return
    onset%is_made = .true.
    n = int(strobes_before(onset%release))
    every = max(1, n/(MEASURED - 1))
    onset%error%noise = 0
    allocate (probes)
    part = first_part(onset%release)
    i = 0
    do while (is_open(part))
      if (mod(i, every) == 0 .or. i >= n - 1) then
        call make_part_flow(pendulum, part, flow)
        call make_speed_probes(pendulum, fastest, probes, part%stretch_t)
        call measure_period(flow, probes, error)
        error%noise = max(MARGIN*min(error%noise, huge(1.0_dp)/MARGIN), onset%error%noise) ! the last is huge
        onset%error = error
        call make_drive(drive, pendulum, TAYLOR_STEPS, part%stretch_t)
        onset%quad_error = max(onset%quad_error, MARGIN*measure_quad(drive, fastest))
      end if
      i = i + 1
      part = next_part(part)
    end do
    onset%error%noise(ubound(onset%error%noise, 1)) = huge(1.0_dp)
  end subroutine prepare

  !> Carries orbits through the release to the strobe, and sets their age to that of the strobe.
  subroutine carry_released(onset, pendulum, precisely, orbit)
    class(released_t), intent(in) :: onset
    type(pendulum_t), intent(in) :: pendulum !< as it is after a ramp
    logical, intent(in) :: precisely !< in quad precision, else in double precision
    type(orbit_t), intent(inout) :: orbit(:) !< [n] in and out
    type(part_t) :: part
    type(drive_t), target :: drive
    class(flow_t), allocatable :: flow
    type(carrier_t) :: carrier
    integer :: first

    part = first_part(onset%release)
    do while (is_open(part))
      call make_part_flow(pendulum, part, flow)
      call make_carrier(flow, onset%error, carrier)
      if (precisely) then
        call make_drive(drive, pendulum, TAYLOR_STEPS, part%stretch_t)
        carrier%means = BY_SERIES
        carrier%drive => drive
        carrier%drive_error = onset%quad_error
      end if
      do first = 1, size(orbit), WIDTH
        call carry_lanes(carrier, orbit(first:min(size(orbit), first + WIDTH - 1)))
      end do
      part = next_part(part)
    end do
    orbit%age = orbit%age + strobes_before(onset%release)
  end subroutine carry_released

  !> At most WIDTH orbits through the stretch of the carrier.
  subroutine carry_lanes(carrier, orbit)
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
  end subroutine carry_lanes

end module kz_release_released
