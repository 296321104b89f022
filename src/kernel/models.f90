!> Two simpler models of the same pendulum as time series: the linear (Mathieu) equation and the slow equation of the
!> effective potential. Both are drifts and kicks like the pendulum itself; only the restoring force differs.
module kz_kernel_models
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use kz_kernel_flows, only: FINE_STEPS
  use kz_model_pendulum, only: pendulum_t, stiffness
  use kz_vector_schemes, only: SPLIT6_ROW
  use kz_vector_step_table, only: numerics_t, period_t, make_period
  implicit none
  private

  !> Codes of the models, KZ_MATHIEU and KZ_EFFECTIVE of kernel.h.
  integer(c_int32_t), parameter :: MATHIEU = 1, EFFECTIVE = 2

  !> theta'' + beta theta' + drive(t) * restoring(theta) = 0, the drive tabulated over one period.
  type :: model_t
    integer(c_int32_t) :: code
    type(pendulum_t) :: pendulum
    type(period_t) :: period
  end type model_t

  interface
    !> model.h
    pure function slow_pull(k, beta, m, cosine) bind(C, name='kz_slow_pull') result(pull)
      import :: c_double
      real(c_double), value :: k, beta, m, cosine
      real(c_double) :: pull
    end function slow_pull
  end interface

contains

  subroutine sample_model(code, pendulum, periods, samples, start, theta, velocity) bind(C, name='kz_sample_model')
    integer(c_int32_t), value :: code !< MATHIEU or EFFECTIVE
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    integer(c_int64_t), value :: periods, samples !< Drive periods; samples per period
    real(c_double), intent(in) :: start(2) !< Start: rad, rad per drive radian
    real(c_double), intent(out) :: theta(0:periods*samples) !< Angles at t = 2 pi s/samples
    real(c_double), intent(out) :: velocity(0:periods*samples) !< Velocities at these times
    type(model_t) :: model
    real(c_double) :: x(2)
    integer(c_int64_t) :: s
    integer :: stride, part

    call make_model(code, pendulum, int(samples), start(2), model)
    stride = model%period%n_steps/int(samples)
    x = start
    theta(0) = x(1)
    velocity(0) = x(2)
    do s = 1, periods*samples
      part = int(mod(s - 1, samples))
      call advance_model(model, part*stride, (part + 1)*stride, x)
      theta(s) = x(1)
      velocity(s) = x(2)
    end do
  end subroutine sample_model

  !> Makes the tables: fine steps, more for fast motions, a multiple of the samples. The slow equation has the force 1.
  subroutine make_model(code, pendulum, samples, velocity, model)
    integer(c_int32_t), intent(in) :: code
    type(pendulum_t), intent(in) :: pendulum
    integer, intent(in) :: samples
    real(c_double), intent(in) :: velocity
    type(model_t), intent(out) :: model
    type(numerics_t) :: numerics
    real(c_double) :: speed

    speed = sqrt(stiffness(pendulum))
    if (code == EFFECTIVE) speed = sqrt(abs(pendulum%k) + pendulum%m**2) + abs(velocity)
    numerics%scheme = SPLIT6_ROW
    numerics%steps_per_period = samples*ceiling(FINE_STEPS*max(1.0_c_double, speed)/samples)
    model%code = code
    model%pendulum = pendulum
    if (code == EFFECTIVE) then
      call make_period(pendulum_t(1, pendulum%beta, 0), numerics, .false., model%period)
    else
      call make_period(pendulum, numerics, .false., model%period)
    end if
  end subroutine make_model

  !> Advances x = (theta, velocity) from the end of step `from` to the end of step `to` of a period.
  subroutine advance_model(model, from, to, x)
    type(model_t), intent(in) :: model
    integer, intent(in) :: from, to
    real(c_double), intent(inout) :: x(2)
    integer :: s, first

    first = 1
    if (from > 0) first = model%period%step_end(from) + 1
    do s = first, model%period%step_end(to)
      x(1) = x(1) + model%period%drift(s)*x(2)
      x(2) = model%period%decay(s)*x(2) - model%period%kick(s)*restoring_force(model, x(1))
    end do
  end subroutine advance_model

  pure real(c_double) function restoring_force(model, theta) result(force)
    type(model_t), intent(in) :: model
    real(c_double), intent(in) :: theta

    force = theta
    if (model%code == EFFECTIVE) &
      force = sin(theta)*slow_pull(model%pendulum%k, model%pendulum%beta, model%pendulum%m, cos(theta))
  end function restoring_force

end module kz_kernel_models
