!> One drive period of a pendulum as a list of drifts and kicks, made in quad precision and rounded to doubles.
module kz_vector_step_table
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_ptr, c_null_ptr
  use, intrinsic :: iso_fortran_env, only: rk => real64, real128
  use kz_model_pendulum, only: pendulum_t, force_at
  use kz_model_stretch, only: stretch_t, CUBIC
  use kz_vector_schemes, only: stage_t, scheme_stages, SCHEMES, RUNGE_KUTTA
  implicit none
  private
  public :: numerics_t, period_t, make_period

  integer, parameter :: qp = real128
  real(qp), parameter :: PI = 3.14159265358979323846264338327950288_qp
  real(qp), parameter :: INVERSE_PI = 1/PI

  type, bind(C) :: numerics_t
    integer(c_int32_t) :: scheme, steps_per_period
    !> Processed splitting: powers of the velocity in a drift and coefficients of a kick; 0 = enough for every step
    integer(c_int32_t) :: drift_terms = 0
    integer(c_int32_t) :: kick_terms = 0
    real(c_double) :: fastest = 0 !< Largest speed of the processed splitting, rad per drive radian; 0 = 3
    type(c_ptr) :: series = c_null_ptr !< Cache of its series (kz_kept_series of kernel.h); null = none
  end type numerics_t

  !> Tables of a period. Split schemes: stage s is u += drift(s) v; v = decay(s) v; v -= kick(s) sin(pi (u - shift(s)))
  !> - push(s); after the last one another drift. rk4: kick(2 i + 1 .. 2 i + 3), shift and push at the beginning, middle
  !> and end of step i + 1. The force a sin theta - b cos theta is one sine, kick = hypot(a, b) shifted by their angle;
  !> without b and torque kick = a, and there is neither shift nor push.
  type :: period_t
    logical :: split
    integer :: n_steps
    integer, allocatable :: step_end(:) !< (n_steps) Last stage of every step, if steps are not fused
    real(rk), allocatable :: drift(:)   !< Rad per unit of velocity
    real(rk), allocatable :: drift_u(:) !< Half-turns per unit of velocity
    real(rk), allocatable :: decay(:), kick(:)
    real(rk), allocatable :: shift(:)   !< half-turns
    real(rk), allocatable :: push(:)
    logical :: mirrored
    real(rk) :: beta
    real(rk) :: step                    !< rad
  end type period_t

contains

  !> Makes the tables of one period, or of a stretch of it.
  subroutine make_period(pendulum, numerics, fused, period, stretch)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(numerics_t), intent(in) :: numerics !< scheme and steps a period of the table
    !> True: the last entry of a step is merged with the next step's first: faster, but no samples within the period
    logical, intent(in) :: fused
    type(period_t), intent(out) :: period !< Drifts and kicks of one period
    type(stretch_t), intent(in), optional :: stretch !< Stretch whose drive may change; default: a whole period
    type(stretch_t) :: part
    real(qp) :: step

    if (present(stretch)) part = stretch
    period%n_steps = numerics%steps_per_period
    step = 2*PI*part%span/period%n_steps
    period%beta = pendulum%beta
    period%step = real(step, rk)
    period%mirrored = pendulum%unmirrored == 0
    period%split = SCHEMES(numerics%scheme + 1)%form /= RUNGE_KUTTA
    if (period%split) then
      call split_tables(period, pendulum, scheme_stages(SCHEMES(numerics%scheme + 1)), step, fused, part)
    else
      call rk4_tables(period, pendulum, part)
    end if
  end subroutine make_period

  subroutine rk4_tables(period, pendulum, part)
    type(period_t), intent(inout) :: period
    type(pendulum_t), intent(in) :: pendulum
    type(stretch_t), intent(in) :: part
    real(qp) :: turn
    integer :: i

    call allocate_kicks(period, 2*period%n_steps + 1)
    do i = 0, 2*period%n_steps
      turn = part%begin + part%span*(real(i, qp)/(2*period%n_steps))
      call set_kick(period, pendulum, part, i + 1, 1.0_qp, turn, phasor(turn))
    end do
  end subroutine rk4_tables

  !> Sets all entries of all steps of a split scheme.
  subroutine split_tables(period, pendulum, stages, step, fused, part)
    type(period_t), intent(inout) :: period
    type(pendulum_t), intent(in) :: pendulum
    type(stage_t), intent(in) :: stages(:)
    real(qp), intent(in) :: step
    logical, intent(in) :: fused
    type(stretch_t), intent(in) :: part
    !> exp(2 pi i t) at the beginning of the part and of the step; of the length of a step; of each stage within its
    !> step. Products cost less than cosines in quad precision.
    complex(qp) :: clock_at_begin, clock_of_step, step_phasor, stage_phasor(size(stages))
    real(qp) :: time(period%n_steps*size(stages) + 1), elapsed(size(stages)), weight(size(stages)), shift
    integer :: n, i, s

    elapsed = elapsed_shares(stages)
    weight = stages%share*step
    clock_at_begin = phasor(part%begin)
    step_phasor = phasor(part%span/period%n_steps)
    do s = 1, size(stages)
      stage_phasor(s) = phasor(part%span*(elapsed(s)/period%n_steps))
    end do
    call allocate_kicks(period, period%n_steps*size(stages) + 1)
    allocate (period%step_end(period%n_steps))
    n = 0
    shift = 0
    clock_of_step = clock_at_begin
    do i = 0, period%n_steps - 1
      do s = 1, size(stages)
        if (stages(s)%is_kick) then
          call append_kick(weight(s), elapsed(s), clock_of_step*stage_phasor(s))
        else
          shift = shift + stages(s)%share
        end if
      end do
      if (.not. fused .and. shift > 0) call append_kick(0.0_qp, 0.0_qp, clock_at_begin)
      period%step_end(i + 1) = n
      clock_of_step = clock_of_step*step_phasor
    end do
    call trim_kicks(period, n)
    time(n + 1) = shift
    if (associated(part%changes)) then
      call set_changing_drifts(period, pendulum, part, time(:n + 1)*step)
    else
      call set_damped_drifts(period, time(:n + 1), step)
    end if
  contains
    !> Appends a kick after a share of step i.
    subroutine append_kick(weight, share, clock_of_turn)
      real(qp), intent(in) :: weight, share
      complex(qp), intent(in) :: clock_of_turn
      real(qp) :: turn

      n = n + 1
      time(n) = shift
      turn = part%begin
      if (associated(part%changes)) turn = turn + part%span*((i + share)/period%n_steps)
      call set_kick(period, pendulum, part, n, weight, turn, clock_of_turn)
      shift = 0
    end subroutine append_kick
  end subroutine split_tables

  !> Shares of a step that have elapsed at each of its stages.
  pure function elapsed_shares(stages) result(clock)
    type(stage_t), intent(in) :: stages(:)
    real(qp) :: clock(size(stages))
    integer :: s

    clock(1) = 0
    do s = 2, size(stages)
      clock(s) = clock(s - 1)
      if (.not. stages(s - 1)%is_kick) clock(s) = clock(s) + stages(s - 1)%share
    end do
  end function elapsed_shares

  !> exp(2 pi i turn).
  pure complex(qp) function phasor(turn)
    real(qp), intent(in) :: turn

    phasor = cmplx(cos(2*PI*turn), sin(2*PI*turn), qp)
  end function phasor

  !> Sets the drifts (1 - exp(-beta t))/beta and decays exp(-beta t) from their times.
  subroutine set_damped_drifts(period, share, step)
    type(period_t), intent(inout) :: period
    real(qp), intent(in) :: share(:) !< Share of a step of each drift
    real(qp), intent(in) :: step !< rad
    !> Entries to search for an equal drift, since drifts repeat from step to step
    integer, parameter :: LOOK_BACK = 20
    real(qp) :: beta, time
    integer :: i, former

    beta = period%beta
    call allocate_drifts(period, size(share))
    do i = 1, size(share)
      former = findloc(share(max(1, i - LOOK_BACK):i), share(i), dim=1) + max(0, i - LOOK_BACK - 1)
      if (former < i) then
        period%decay(i) = period%decay(former)
        period%drift(i) = period%drift(former)
        period%drift_u(i) = period%drift_u(former)
      else
        time = share(i)*step
        call set_drift(period, i, exp(-beta*time), time*mean_decay(beta*time))
      end if
    end do
  end subroutine set_damped_drifts

  !> Sets drifts and decays for a changing damping by series: exp(-B(t)), B the integral of beta, and its integral.
  subroutine set_changing_drifts(period, pendulum, part, time)
    type(period_t), intent(inout) :: period
    type(pendulum_t), intent(in) :: pendulum
    type(stretch_t), intent(in) :: part
    real(qp), intent(in) :: time(:)
    integer, parameter :: TERMS = 48
    real(qp) :: rate(0:CUBIC), drive(0:CUBIC), decay_series(0:TERMS), turn
    integer :: i, n, last

    call allocate_drifts(period, size(time))
    turn = part%begin
    do i = 1, size(time)
      call part%changes(part%along, pendulum%beta, turn, time(i)/(2*PI), rate, drive)
      rate = time(i)*rate
      decay_series(0) = 1
      do n = 0, TERMS - 1
        decay_series(n + 1) = -sum(rate(:min(n, CUBIC))*decay_series(n:max(0, n - CUBIC):-1))/(n + 1)
        if (n <= CUBIC) cycle
        if (maxval(abs(decay_series(n - CUBIC + 1:n + 1))) < epsilon(turn)**2) exit
      end do
      last = min(n + 1, TERMS)
      call set_drift(period, i, sum(decay_series(:last)), time(i)*sum([(decay_series(n)/(n + 1), n=0, last)]))
      turn = turn + time(i)/(2*PI)
    end do
  end subroutine set_changing_drifts

  subroutine allocate_drifts(period, n)
    type(period_t), intent(inout) :: period
    integer, intent(in) :: n

    allocate (period%decay(n), period%drift(n), period%drift_u(n))
  end subroutine allocate_drifts

  subroutine set_drift(period, i, decay, drift)
    type(period_t), intent(inout) :: period
    integer, intent(in) :: i
    real(qp), intent(in) :: decay, drift

    period%decay(i) = real(decay, rk)
    period%drift(i) = real(drift, rk)
    period%drift_u(i) = real(drift*INVERSE_PI, rk)
  end subroutine set_drift

  !> (1 - exp(-x))/x without cancellation.
  pure real(qp) function mean_decay(x) result(mean)
    real(qp), intent(in) :: x
    integer :: i

    if (abs(x) > 1) then
      mean = (1 - exp(-x))/x
      return
    end if
    mean = 1
    do i = 32, 2, -1
      mean = 1 - mean*x/i
    end do
  end function mean_decay

  subroutine allocate_kicks(period, n)
    type(period_t), intent(inout) :: period
    integer, intent(in) :: n

    allocate (period%kick(n))
    if (.not. period%mirrored) allocate (period%shift(n), period%push(n))
  end subroutine allocate_kicks

  subroutine trim_kicks(period, n)
    type(period_t), intent(inout) :: period
    integer, intent(in) :: n

    period%kick = period%kick(:n)
    if (period%mirrored) return
    period%shift = period%shift(:n)
    period%push = period%push(:n)
  end subroutine trim_kicks

  !> Sets kick n: the force at t = 2 pi * turn with exp(i t) = clock, times a weight.
  subroutine set_kick(period, pendulum, part, n, weight, turn, clock)
    type(period_t), intent(inout) :: period
    type(pendulum_t), intent(in) :: pendulum
    type(stretch_t), intent(in) :: part
    integer, intent(in) :: n
    real(qp), intent(in) :: weight, turn
    complex(qp), intent(in) :: clock
    real(qp) :: a, b, damping(0:CUBIC), drive(0:CUBIC)

    call force_at(pendulum, clock, a, b)
    if (associated(part%changes)) then
      call part%changes(part%along, pendulum%beta, turn, 0.0_qp, damping, drive)
      a = pendulum%k + drive(0)*(a - pendulum%k)
      b = drive(0)*b
    end if
    period%kick(n) = real(weight*a, rk)
    if (period%mirrored) return
    period%kick(n) = real(weight*hypot(a, b), rk)
    period%shift(n) = real(atan2(b, a)/PI, rk)
    period%push(n) = real(weight*(pendulum%torque + pendulum%torque_amplitude*real(clock, qp)), rk)
  end subroutine set_kick

end module kz_vector_step_table
