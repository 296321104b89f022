!> States and what the equation makes of them in a drive period, by Taylor series in quad precision: what the errors of a period of every
!> other integrator are measured against.
module kz_taylor_probes
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_float128
  use kz_model_pendulum, only: pendulum_t
  use kz_taylor_taylor, only: drive_t, make_drive, advance_period, qp, PI_QUAD, TAYLOR_STEPS
  implicit none
  private
  public :: probes_t, make_probes, measure_quad

  type :: probes_t
    real(qp), allocatable :: start(:, :) !< (2, n): half-turns, rad per drive radian; doubles
    real(qp), allocatable :: image(:, :) !< the same
  end type probes_t

  !> A state in quad precision: theta in rad, wrapped to [-pi, pi]; turns counted apart.
  type, bind(C) :: reference_state_t
    real(c_float128) :: theta, velocity
    integer(c_int64_t) :: turns
  end type reference_state_t

contains

  !> A probe of each speed; angles are spread evenly over the circle.
  subroutine make_probes(drive, speed, probes)
    type(drive_t), intent(in) :: drive !< of the pendulum
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

  !> What the Taylor series may miss in a period, of hypot(pi, v): rounding, which a period of a strong drive makes larger. Measured
  !> between two numbers of steps.
  real(c_double) function measure_quad(drive, fastest) result(error)
    type(drive_t), intent(in) :: drive !< of the pendulum
    real(c_double), intent(in) :: fastest !< speeds up to this one, rad per drive radian
    integer, parameter :: N = 128, MORE_STEPS = 8
    real(c_double), parameter :: PI = real(PI_QUAD, c_double), MARGIN = 4, LEAST = 5e-34_c_double
    type(drive_t) :: other
    type(probes_t) :: probes, again
    real(c_double) :: speed(N), distance(N)
    real(qp) :: angle(N)
    integer :: i

    speed = [(fastest*i/N, i=1, N)]
    call make_drive(other, drive%pendulum, drive%n_steps + MORE_STEPS, drive%stretch)
    call make_probes(drive, speed, probes)
    call make_probes(other, speed, again)
    angle = probes%image(1, :) - again%image(1, :)
    distance = hypot(PI*real(angle - 2*anint(angle/2), c_double), real(probes%image(2, :) - again%image(2, :), c_double))
    error = MARGIN*maxval(max(LEAST, distance/hypot(PI, speed)))
  end function measure_quad

  ! The C interface of the quad-precision reference: include/kapitza/kernel.h. Quads stay inside, doubles come out.

  subroutine start(n, theta, velocity, low, states) bind(C, name='kz_reference_start')
    integer(c_int64_t), value :: n
    real(c_double), intent(in) :: theta(n), velocity(n)
    real(c_double), intent(in), optional :: low(2, n)
    type(reference_state_t), intent(out) :: states(n)

    states%theta = real(theta, qp)
    states%velocity = real(velocity, qp)
    if (present(low)) then
      states%theta = states%theta + low(1, :)
      states%velocity = states%velocity + low(2, :)
    end if
    states%turns = 0
  end subroutine start

  subroutine advance(pendulum, n_steps, n, periods, states) bind(C, name='kz_reference_advance')
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n, periods
    type(reference_state_t), intent(inout) :: states(n)
    type(drive_t) :: drive
    real(qp) :: theta(n), velocity(n)
    integer(c_int64_t) :: turns(n), period

    call make_drive(drive, pendulum, int(n_steps))
    theta = states%theta
    velocity = states%velocity
    turns = states%turns
    do period = 1, periods
      call advance_period(drive, theta, velocity, turns)
    end do
    states%theta = theta
    states%velocity = velocity
    states%turns = turns
  end subroutine advance

  subroutine read_states(n, states, theta, velocity, turns) bind(C, name='kz_reference_read')
    integer(c_int64_t), value :: n
    type(reference_state_t), intent(in) :: states(n)
    real(c_double), intent(out) :: theta(n), velocity(n)
    integer(c_int64_t), intent(out) :: turns(n)

    theta = real(states%theta, c_double)
    velocity = real(states%velocity, c_double)
    turns = states%turns
  end subroutine read_states

  real(c_double) function reference_error(pendulum, fastest) bind(C, name='kz_reference_error') result(error)
    type(pendulum_t), intent(in) :: pendulum
    real(c_double), value :: fastest
    type(drive_t) :: drive

    call make_drive(drive, pendulum, TAYLOR_STEPS)
    error = measure_quad(drive, fastest)
  end function reference_error

end module kz_taylor_probes
