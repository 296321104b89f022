!> The reference integrator: whole periods of the pendulum's equation (kz_model_pendulum) in quad precision (real128),
!> by Taylor series of fixed order (taylor_steps.c) in steps that are halved until every series is complete.
module kz_taylor_taylor
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128, int64
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_model_pendulum, only: pendulum_t, highest_harmonic
  use kz_model_series_r128, only: force_series
  use kz_model_stretch, only: stretch_t, CUBIC
  implicit none
  private
  public :: drive_t, make_drive, advance_period, doubles_of, qp

  integer, parameter :: qp = real128
  !> Steps per period for an error of some 1e-33: KZ_REFERENCE_STEPS of kernel.h.
  integer, parameter, public :: TAYLOR_STEPS = 18
  !> Steps per period for an error of 1e-20, enough to measure doubles: fewer orders take a third of the time.
  integer, parameter, public :: ROUGH_STEPS = 20
  real(qp), parameter, public :: PI_QUAD = 3.14159265358979323846264338327950288_qp
  real(qp), parameter :: TWO_PI = 2*PI_QUAD
  !> Quarters of a step per period for each further harmonic: with fewer, most steps are halved (measured for 2 to 24).
  integer, parameter :: MORE_FOR_HARMONICS = 7
  !> Largest number of halvings of a step.
  integer, parameter :: FINEST = 24
  !> KZ_TAYLOR_LANES, KZ_TAYLOR_DEEP, KZ_TAYLOR_LAST of taylor_steps.c.
  integer, parameter :: LANES = 8, DEEP_ORDERS = 4, LAST_ORDER = 56

  !> Memory of kz_taylor_shared of taylor_steps.c.
  type, bind(C) :: shared_t
    real(dp) :: high(0:LAST_ORDER - 1), low(0:LAST_ORDER - 1), rest(0:DEEP_ORDERS - 1)
  end type shared_t

  !> Memory of kz_taylor_force of taylor_steps.c.
  type, bind(C) :: force_t
    type(shared_t) :: along, across, torque
    real(dp) :: damping(0:CUBIC, 3)
    integer(c_int32_t) :: has_across, is_damping_changing
  end type force_t

  !> Memory of kz_taylor_state of taylor_steps.c.
  type, bind(C) :: state_t
    real(dp) :: theta(LANES, 3), w(LANES, 3), s(LANES, 3), c(LANES, 3)
  end type state_t

  !> A pendulum with the drive's series in every step of a period, and in every half step.
  type :: drive_t
    type(pendulum_t) :: pendulum
    integer :: n_steps
    integer :: requested !< Steps per period if the drive were a sine
    integer(c_int32_t) :: rough = 0 !< 1: errors up to 1e-20
    type(stretch_t) :: stretch
    type(force_t), allocatable :: force(:)
    type(force_t), allocatable :: halved(:) !< Series of half steps
  end type drive_t

  interface
    !> taylor_steps.c
    pure subroutine advance_steps(n, rough, force, state, converged) bind(C, name='kz_taylor_steps')
      import :: c_int64_t, c_int32_t, force_t, state_t, LANES
      integer(c_int64_t), intent(in), value :: n
      integer(c_int32_t), intent(in), value :: rough
      type(force_t), intent(in) :: force(*)
      type(state_t), intent(inout) :: state
      integer(c_int32_t), intent(inout) :: converged(LANES)
    end subroutine advance_steps
  end interface

contains

  !> Makes the drive of a pendulum for n_steps steps per period, or per stretch of it.
  subroutine make_drive(drive, pendulum, n_steps, stretch, rough)
    type(drive_t), intent(out) :: drive !< Series of the drive for each step
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer, intent(in) :: n_steps !< Steps for a gentle motion and a sine; harmonics take more
    type(stretch_t), intent(in), optional :: stretch !< Default: a whole period
    logical, intent(in), optional :: rough !< True: 20 digits by ROUGH_STEPS; default: 33
    integer :: i

    if (present(rough)) drive%rough = merge(1_c_int32_t, 0_c_int32_t, rough)
    if (present(stretch)) drive%stretch = stretch
    drive%pendulum = pendulum
    drive%requested = n_steps
    drive%n_steps = n_steps + (MORE_FOR_HARMONICS*(highest_harmonic(pendulum) - 1))/4
    allocate (drive%force(drive%n_steps), drive%halved(2*drive%n_steps))
    do i = 1, drive%n_steps
      drive%force(i) = force_of_step(drive, TWO_PI*drive%stretch%begin &
                                     + (i - 1)*(TWO_PI*drive%stretch%span)/drive%n_steps, step_of(drive, 0))
    end do
    do i = 1, 2*drive%n_steps
      drive%halved(i) = force_of_step(drive, TWO_PI*drive%stretch%begin + (i - 1)*step_of(drive, 1), step_of(drive, 1))
    end do
  end subroutine make_drive

  !> Length of a step after a number of halvings, rad.
  pure real(qp) function step_of(drive, halvings) result(h)
    type(drive_t), intent(in) :: drive
    integer, intent(in) :: halvings

    h = TWO_PI*drive%stretch%span/drive%n_steps/2**halvings
  end function step_of

  !> The force over a step h from t0, rad.
  pure type(force_t) function force_of_step(drive, t0, h) result(force)
    type(drive_t), intent(in) :: drive
    real(qp), intent(in) :: t0, h
    real(qp), dimension(0:LAST_ORDER - 1) :: along, across, torque
    real(qp) :: damping(0:CUBIC)
    integer :: i

    damping = 0
    damping(0) = drive%pendulum%beta*h
    call force_series(drive%pendulum, t0, h, h*h, along, across, torque)
    if (associated(drive%stretch%changes)) call put_along(drive, t0/TWO_PI, h, along, across, damping)
    force%along = round_series(along)
    force%across = round_series(-across)
    force%torque = round_series(torque)
    do i = 0, CUBIC
      force%damping(i, :) = doubles_of(damping(i), 3)
    end do
    force%has_across = merge(1_c_int32_t, 0_c_int32_t, drive%pendulum%unmirrored /= 0)
    force%is_damping_changing = merge(1_c_int32_t, 0_c_int32_t, associated(drive%stretch%changes))
  end function force_of_step

  pure type(shared_t) function round_series(series) result(rounded)
    real(qp), intent(in) :: series(0:LAST_ORDER - 1)

    rounded%high = real(series, dp)
    rounded%low = real(series - rounded%high, dp)
    rounded%rest = real(series(:DEEP_ORDERS - 1) - rounded%high(:DEEP_ORDERS - 1) - rounded%low(:DEEP_ORDERS - 1), dp)
  end function round_series

  !> Rounds a number to a sum of n doubles, the largest first.
  pure function doubles_of(x, n) result(part)
    real(qp), intent(in) :: x !< a number
    integer, intent(in) :: n !< 3 hold all its digits
    real(dp) :: part(n)
    real(qp) :: rest
    integer :: i

    rest = x
    do i = 1, n
      part(i) = real(rest, dp)
      rest = rest - part(i)
    end do
  end function doubles_of

  !> Applies the changes of damping and drive in a stretch.
  pure subroutine put_along(drive, turn, h, along, across, damping)
    type(drive_t), intent(in) :: drive
    real(qp), intent(in) :: turn, h
    real(qp), intent(inout) :: along(0:), across(0:)
    real(qp), intent(out) :: damping(0:CUBIC)
    real(qp) :: scale(0:CUBIC)

    call drive%stretch%changes(drive%stretch%along, drive%pendulum%beta, turn, h/TWO_PI, damping, scale)
    along(0) = along(0) - h*h*drive%pendulum%k
    call multiply_series(scale, along)
    along(0) = along(0) + h*h*drive%pendulum%k
    call multiply_series(scale, across)
    damping = h*damping
  end subroutine put_along

  !> Multiplies a series by a polynomial.
  pure subroutine multiply_series(polynomial, series)
    real(qp), intent(in) :: polynomial(0:CUBIC)
    real(qp), intent(inout) :: series(0:)
    integer :: n, i

    do n = ubound(series, 1), 0, -1
      series(n) = sum([(polynomial(i)*series(n - i), i=0, min(n, CUBIC))])
    end do
  end subroutine multiply_series

  !> Advances by a drive period from t = 0, or by the stretch. A state for which no step is short enough becomes NaN.
  pure subroutine advance_period(drive, theta, velocity, turns)
    type(drive_t), intent(in) :: drive !< Drive from make_drive
    real(qp), intent(inout) :: theta(:) !< Angles, rad; come back wrapped.
    real(qp), intent(inout) :: velocity(:) !< Velocities, rad per drive radian.
    integer(int64), intent(inout) :: turns(:) !< Net turns are added.
    logical :: waiting(size(theta))
    integer :: halvings, first

    waiting = .true.
    do halvings = 0, FINEST
      first = 1
      do while (first <= size(theta))
        call advance_waiting(drive, halvings, theta, velocity, waiting, first)
      end do
      if (.not. any(waiting)) exit
    end do
    where (waiting)
      theta = ieee_value(theta, ieee_quiet_nan)
      velocity = theta
    elsewhere
      turns = turns + nint(theta/TWO_PI, int64)
      theta = theta - TWO_PI*anint(theta/TWO_PI)
    end where
  end subroutine advance_period

  !> Advances the next waiting states from `first` on, one per lane; successful ones wait no longer.
  pure subroutine advance_waiting(drive, halvings, theta, velocity, waiting, first)
    type(drive_t), intent(in) :: drive
    integer, intent(in) :: halvings
    real(qp), intent(inout) :: theta(:), velocity(:)
    logical, intent(inout) :: waiting(:)
    integer, intent(inout) :: first !< Becomes the next state to look at.
    real(qp) :: lane_theta(LANES), lane_velocity(LANES)
    logical :: done(LANES)
    integer :: state(LANES), n, i

    n = 0
    do while (first <= size(theta) .and. n < LANES)
      if (waiting(first)) then
        n = n + 1
        state(n) = first
      end if
      first = first + 1
    end do
    if (n == 0) return
    lane_theta = 0
    lane_velocity = 0
    lane_theta(:n) = theta(state(:n))
    lane_velocity(:n) = velocity(state(:n))
    done = [(i <= n, i=1, LANES)]
    call advance_lanes(drive, halvings, lane_theta, lane_velocity, done)
    do i = 1, n
      if (.not. done(i)) cycle
      theta(state(i)) = lane_theta(i)
      velocity(state(i)) = lane_velocity(i)
      waiting(state(i)) = .false.
    end do
  end subroutine advance_waiting

  !> Advances every lane by one period.
  pure subroutine advance_lanes(drive, halvings, theta, velocity, done)
    type(drive_t), intent(in) :: drive
    integer, intent(in) :: halvings
    real(qp), intent(inout) :: theta(LANES), velocity(LANES)
    logical, intent(inout) :: done(LANES) !< Lanes in use; becomes false if a series did not converge.
    type(state_t) :: state
    integer(c_int32_t) :: converged(LANES)
    real(qp) :: h
    integer :: i

    h = step_of(drive, halvings)
    do i = 1, LANES
      state%theta(i, :) = doubles_of(theta(i), 3)
      state%w(i, :) = doubles_of(velocity(i)*h, 3)
      state%s(i, :) = doubles_of(sin(theta(i)), 3)
      state%c(i, :) = doubles_of(cos(theta(i)), 3)
    end do
    converged = merge(1_c_int32_t, 0_c_int32_t, done)
    if (halvings == 0) then
      call advance_steps(size(drive%force, kind=c_int64_t), drive%rough, drive%force, state, converged)
    else if (halvings == 1) then
      call advance_steps(size(drive%halved, kind=c_int64_t), drive%rough, drive%halved, state, converged)
    else
      do i = 1, drive%n_steps*2**halvings
        call advance_steps(1_c_int64_t, drive%rough, &
                           [force_of_step(drive, TWO_PI*drive%stretch%begin + (i - 1)*h, h)], state, converged)
        if (all(converged == 0)) exit
      end do
    end if
    done = converged /= 0
    theta = quads_of(state%theta)
    velocity = quads_of(state%w)/h
  end subroutine advance_lanes

  pure function quads_of(part) result(x)
    real(dp), intent(in) :: part(LANES, 3)
    real(qp) :: x(LANES)

    x = real(part(:, 1), qp) + (real(part(:, 2), qp) + part(:, 3))
  end function quads_of

end module kz_taylor_taylor
