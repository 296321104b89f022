!> Whole drive periods in quad precision for C (reference.h): what other integrators are compared with.
module kz_tools_reference
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_float128
  use kz_model_pendulum, only: pendulum_t
  use kz_taylor_probes, only: measure_quad
  use kz_taylor_taylor, only: drive_t, make_drive, advance_period, qp, TAYLOR_STEPS
  implicit none
  private

  !> A state in quad precision: theta in rad, wrapped to [-pi, pi]; turns counted apart.
  type, bind(C) :: reference_state_t
    real(c_float128) :: theta, velocity
    integer(c_int64_t) :: turns
  end type reference_state_t

contains

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

end module kz_tools_reference
