!> A period with its derivatives, for tests/unit/kernel/jets.c.
module kz_jets_test
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use kz_model_pendulum, only: pendulum_t
  use kz_splitting_jets, only: jets_t, make_jets, set_pendulum, advance_jets, LANES, TERMS
  implicit none
  private

contains

  subroutine jets_of(pendulum, steps, order, halves, state, derivative) bind(C, name='kz_test_jets')
    type(pendulum_t), intent(in) :: pendulum(0:2) !< the pendulum, and what grows with p and q
    integer(c_int32_t), value :: steps, order
    integer(c_int32_t), value :: halves !< 1: half a period; 2: a period in two calls; else a period
    real(c_double), intent(inout) :: state(2) !< rad, not wrapped
    real(c_double), intent(out) :: derivative(2, TERMS)
    type(jets_t) :: jets
    real(c_double) :: u(LANES), v(LANES), theta(LANES, TERMS), velocity(LANES, TERMS), PI

    PI = acos(-1.0_c_double)
    call make_jets(int(steps), jets)
    call set_pendulum(jets, pendulum)
    u = state(1)/PI
    v = state(2)
    theta = 0
    velocity = 0
    theta(:, 1) = 1
    velocity(:, 2) = 1
    if (halves == 0) call advance_jets(jets, int(order), 1, int(steps), u, v, theta, velocity)
    if (halves > 0) call advance_jets(jets, int(order), 1, int(steps)/2, u, v, theta, velocity)
    if (halves > 1) call advance_jets(jets, int(order), int(steps)/2 + 1, int(steps), u, v, theta, velocity)
    state = [PI*u(LANES), v(LANES)]
    derivative(1, :) = theta(LANES, :)
    derivative(2, :) = velocity(LANES, :)
  end subroutine jets_of

end module kz_jets_test
