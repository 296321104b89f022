!> Probes: states and their images by quad-precision Taylor series, against which other integrators are measured.
module kz_taylor_probes
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use kz_taylor_taylor, only: drive_t, make_drive, advance_period, qp, PI_QUAD
  implicit none
  private
  public :: probes_t, make_probes, measure_quad

  type :: probes_t
    real(qp), allocatable :: start(:, :) !< (2, n): half-turns, rad per drive radian; doubles
    real(qp), allocatable :: image(:, :) !< Their images, (2, n)
  end type probes_t

contains

  !> Makes a probe of each speed, with angles spread evenly over the circle.
  subroutine make_probes(drive, speed, probes)
    type(drive_t), intent(in) :: drive !< drive of the pendulum
    real(c_double), intent(in) :: speed(:) !< [n] rad per drive radian
    type(probes_t), intent(out) :: probes !< starts and images
    real(c_double), parameter :: GOLDEN = 0.61803398874989484820_c_double
    real(qp), allocatable :: theta(:), velocity(:)
    integer(c_int64_t), allocatable :: turns(:)
    integer :: i

    allocate (probes%start(2, size(speed)), probes%image(2, size(speed)))
    allocate (turns(size(speed)), source=0_c_int64_t)
    do i = 1, size(speed)
      probes%start(:, i) = [2*modulo(i*GOLDEN, 1.0_c_double) - 1, speed(i)]
    end do
    theta = PI_QUAD*probes%start(1, :)
    velocity = probes%start(2, :)
    call advance_period(drive, theta, velocity, turns)
    probes%image(1, :) = theta/PI_QUAD
    probes%image(2, :) = velocity
  end subroutine make_probes

  !> Measures the error of the Taylor series in a period, relative to hypot(pi, v), by comparing two numbers of steps.
  !> It is rounding, which a strong drive amplifies.
  real(c_double) function measure_quad(drive, fastest) result(error)
    type(drive_t), intent(in) :: drive !< drive of the pendulum
    real(c_double), intent(in) :: fastest !< Largest speed, rad per drive radian
    integer, parameter :: N = 128, MORE_STEPS = 8
    real(c_double), parameter :: PI = real(PI_QUAD, c_double), MARGIN = 4, LEAST = 5e-34_c_double
    type(drive_t) :: other
    type(probes_t) :: probes, repeated
    real(c_double) :: speed(N), distance(N)
    real(qp) :: angle(N)
    integer :: i

    speed = [(fastest*i/N, i=1, N)]
    call make_drive(other, drive%pendulum, drive%requested + MORE_STEPS, drive%stretch)
    call make_probes(drive, speed, probes)
    call make_probes(other, speed, repeated)
    angle = probes%image(1, :) - repeated%image(1, :)
    distance = hypot(PI*real(angle - 2*anint(angle/2), c_double), &
                     real(probes%image(2, :) - repeated%image(2, :), c_double))
    error = MARGIN*maxval(max(LEAST, distance/hypot(PI, speed)))
  end function measure_quad

end module kz_taylor_probes
