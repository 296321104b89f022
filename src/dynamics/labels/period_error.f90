!> The noise of a map: what steps and rounding add to the error of an orbit in one period, by classes of speed, measured
!> on probes whose true images are known.
module kz_labels_period_error
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_taylor_probes, only: probes_t, make_probes
  use kz_taylor_taylor, only: drive_t, make_drive, qp, ROUGH_STEPS
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_model_pendulum, only: pendulum_t, stiffness
  use kz_model_stretch, only: stretch_t
  implicit none
  private
  public :: period_error_t, speed_probes_t, make_speed_probes, measure_period, class_of, noise_at

  !> Classes of speed.
  integer, parameter, public :: CLASSES = 16
  !> Probes of a class, and how much more than the largest of their errors is assumed for it: of a common pendulum, and
  !> of one whose true images take seconds.
  integer, parameter :: EACH = 32, EACH_COSTLY = 4
  real(dp), parameter :: MARGIN = 1.5_dp, MARGIN_COSTLY = 3
  !> Change of velocity, rad per drive radian, from which motions are costly.
  real(dp), parameter :: COSTLY = 60

  !> States up to a speed and their images.
  type, extends(probes_t) :: speed_probes_t
    real(dp) :: fastest = 0
    integer :: each = EACH !< probes of a class
  end type speed_probes_t

  type :: period_error_t
    real(dp) :: per_speed = 0
    real(dp) :: noise(0:CLASSES) = huge(1.0_dp) !< rad; the last class: faster than all probes
    real(dp) :: worst = huge(1.0_dp)            !< largest noise of all probes
  end type period_error_t

contains

  !> Probes of a pendulum, even over the circle and speeds up to `fastest`, and images after a period or a stretch.
  subroutine make_speed_probes(pendulum, fastest, probes, stretch)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    real(dp), intent(in) :: fastest !< rad per drive radian
    type(speed_probes_t), intent(out) :: probes !< their starts and images
    type(stretch_t), intent(in), optional :: stretch !< left out: a whole period
    type(drive_t) :: drive
    integer :: n, i

    probes%fastest = fastest
    if (max(fastest, sqrt(stiffness(pendulum))) > COSTLY) probes%each = EACH_COSTLY
    n = CLASSES*probes%each
    call make_drive(drive, pendulum, ROUGH_STEPS, stretch, rough=.true.)
    call make_probes(drive, [(fastest*(i - 0.5_dp)/n, i=1, n)], probes%probes_t)
  end subroutine make_speed_probes

  !> The class of a speed.
  elemental function class_of(error, v) result(class)
    type(period_error_t), intent(in) :: error !< error of a map
    real(dp), intent(in) :: v !< rad per drive radian
    integer :: class

    class = CLASSES
    if (abs(v)*error%per_speed < CLASSES) class = int(abs(v)*error%per_speed)
  end function class_of

  !> The noise of a map at many speeds, in vectors.
  pure subroutine noise_at(error, n, v, noise)
    type(period_error_t), intent(in) :: error !< error of a map
    integer, intent(in) :: n !< lanes
    real(dp), intent(in) :: v(n) !< rad per drive radian
    real(dp), intent(inout) :: noise(WIDTH) !< rad
    real(dp) :: class
    integer :: i

    do i = 1, n
      class = abs(v(i))*error%per_speed
      noise(i) = error%noise(int(merge(class, real(CLASSES, dp), class < CLASSES)))
    end do
  end subroutine noise_at

  !> The noise of a map.
  subroutine measure_period(flow, probes, error)
    class(flow_t), intent(in) :: flow !< the map of one drive period
    type(speed_probes_t), intent(in) :: probes !< probes of its pendulum
    type(period_error_t), intent(out) :: error !< by classes of speed
    class(flow_t), allocatable :: moved
    integer :: first, class

    allocate (moved, source=flow)
    error%per_speed = CLASSES/probes%fastest
    error%noise(:CLASSES - 1) = 0
    do first = 1, size(probes%start, 2), WIDTH
      call measure_noise(moved, probes, first, error)
    end do
    do class = 0, CLASSES - 1
      error%noise(class) = merge(MARGIN, MARGIN_COSTLY, probes%each == EACH)*error%noise(class) &
                           + 2*epsilon(1.0_dp)*hypot(PI, probes%fastest*(class + 1)/CLASSES)
    end do
    error%worst = maxval(error%noise(:CLASSES - 1))
  end subroutine measure_period

  subroutine measure_noise(flow, probes, first, error)
    class(flow_t), intent(inout) :: flow
    type(speed_probes_t), intent(in) :: probes
    integer, intent(in) :: first
    type(period_error_t), intent(inout) :: error
    real(qp) :: du, dv
    real(dp) :: distance
    integer :: lane, class

    call flow%put_all(real(probes%start(1, first:first + WIDTH - 1), dp), &
                      real(probes%start(2, first:first + WIDTH - 1), dp))
    call flow%advance_physical(WIDTH)
    do lane = 1, WIDTH
      class = (first + lane - 2)/probes%each
      du = flow%u(lane) - probes%image(1, first + lane - 1)
      dv = flow%v(lane) - probes%image(2, first + lane - 1)
      distance = hypot(PI*real(du - 2*anint(du/2), dp), real(dv, dp))
      if (.not. distance <= huge(distance)) distance = huge(distance)/16 ! lost
      error%noise(class) = max(error%noise(class), distance)
    end do
  end subroutine measure_noise

end module kz_labels_period_error
