!> A batch of different pendulums, one per lane: one drive period of split6 in doubles. Each lane has its own decay and
!> drifts; its kicks are k and m times common ones, since the force is linear in both.
module kz_mixed_mixed_batch
  use, intrinsic :: iso_c_binding, only: rk => c_double, ik => c_int64_t
  use kz_vector_map, only: map_t, put_state, move_state, WIDTH, PI
  use kz_vector_schemes, only: stage_t, scheme_stages, SCHEMES, SPLIT6_ROW
  use kz_vector_sine, only: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT, INVERSE_PI
  use kz_vector_wrap, only: wrap_lanes, vectors_of
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: mixed_batch_t, track_t, make_mixed_batch

  !> Kicks of a step, and its drifts: one before each kick and one at the end.
  integer, parameter :: KICKS = SCHEMES(SPLIT6_ROW + 1)%kicks, DRIFTS = KICKS + 1

  type, extends(map_t) :: mixed_batch_t
    integer :: n_steps = 0
    real(rk) :: time(DRIFTS) = 0               !< Length of each drift, drive radians
    real(rk), allocatable :: weight(:, :, :)   !< (k and m, kick, step): parts of a kick
    real(rk) :: k(WIDTH) = 0, m(WIDTH) = 0
    real(rk) :: drift(WIDTH, DRIFTS) = 0       !< Half-turns per unit of velocity
    real(rk) :: decay(WIDTH, DRIFTS) = 0
  contains
    procedure :: set_pendulum
    procedure :: move => mixed_move
    procedure :: advance => mixed_advance
    procedure :: advance_tangent => mixed_tangent
  end type mixed_batch_t

  !> Angles at the ends of the steps, unwrapped, half-turns.
  type :: track_t
    real(rk) :: total(WIDTH) = 0
    real(rk) :: lowest(WIDTH) = huge(1.0_rk)
    real(rk) :: highest(WIDTH) = -huge(1.0_rk)
  end type track_t

contains

  !> The derivatives of a(t) by k and by m at t = 2 pi * turn: a = k a_k + m a_m where the drive is m cos t alone.
  pure function parts_of_force(turn) result(parts)
    real(rk), intent(in) :: turn !< drive periods
    real(rk) :: parts(2)

    parts = [1.0_rk, -cos(2*PI*turn)]
  end function parts_of_force

  !> Makes a batch without pendulums.
  subroutine make_mixed_batch(n_steps, batch)
    integer, intent(in) :: n_steps !< Steps of split6 per drive period
    type(mixed_batch_t), intent(out) :: batch !< Batch with the tables that all pendulums share
    type(stage_t) :: stages(2*KICKS + 1)
    real(rk) :: clock, step
    integer :: i, s

    stages = scheme_stages(SCHEMES(SPLIT6_ROW + 1))
    step = 2*PI/n_steps
    batch%n_steps = n_steps
    batch%time = step*real(stages(1::2)%share, rk)
    allocate (batch%weight(2, KICKS, n_steps))
    do i = 1, n_steps
      clock = i - 1
      do s = 1, KICKS
        clock = clock + real(stages(2*s - 1)%share, rk)
        batch%weight(:, s, i) = step*real(stages(2*s)%share, rk)*parts_of_force(clock/n_steps)
      end do
    end do
  end subroutine make_mixed_batch

  !> Gives a lane its pendulum.
  subroutine set_pendulum(self, lane, pendulum)
    class(mixed_batch_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    real(rk) :: half(DRIFTS)

    half = 0.5_rk*pendulum%beta*self%time
    self%k(lane) = pendulum%k
    self%m(lane) = pendulum%m
    self%decay(lane, :) = exp(-2*half)
    self%drift(lane, :) = INVERSE_PI*self%time
    where (abs(half) > 0) self%drift(lane, :) = self%drift(lane, :)*exp(-half)*(sinh(half)/half)
  end subroutine set_pendulum

  subroutine mixed_move(self, from, to)
    class(mixed_batch_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call move_state(self, from, to)
    self%k(to) = self%k(from)
    self%m(to) = self%m(from)
    self%drift(to, :) = self%drift(from, :)
    self%decay(to, :) = self%decay(from, :)
  end subroutine mixed_move

  subroutine mixed_advance(self, n)
    class(mixed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lanes, i

    lanes = vectors_of(n)
    do i = 1, self%n_steps
      call advance_step(self, i, lanes, self%u, self%v)
    end do
    call wrap_lanes(self, 1, lanes)
  end subroutine mixed_advance

  subroutine advance_step(self, step, n, u, v)
    class(mixed_batch_t), intent(in) :: self
    integer, intent(in) :: step, n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)
    real(rk) :: of_k, of_m
    integer :: s, i

    do s = 1, KICKS
      of_k = self%weight(1, s, step)
      of_m = self%weight(2, s, step)
      do i = 1, n
        u(i) = u(i) + self%drift(i, s)*v(i)
        v(i) = self%decay(i, s)*v(i) - (of_k*self%k(i) + of_m*self%m(i))*sine(u(i))
      end do
    end do
    u(:n) = u(:n) + self%drift(:n, DRIFTS)*v(:n)
    v(:n) = self%decay(:n, DRIFTS)*v(:n)
  end subroutine advance_step

  !> One period; matrix(:, :, i) is multiplied by d(theta, v)/d(theta0, v0); `track` takes the angles after each step.
  subroutine mixed_tangent(self, n, matrix, track)
    class(mixed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: matrix(2, 2, WIDTH)
    type(track_t), intent(inout) :: track
    real(rk) :: c(WIDTH, 2, 2), angle(WIDTH)
    integer :: lanes, i, j

    lanes = vectors_of(n)
    do j = 1, 2
      c(:, :, j) = transpose(matrix(:, j, :))
    end do
    c(n + 1:, :, :) = 0
    do i = 1, self%n_steps
      call tangent_step(self, i, lanes, self%u, self%v, c)
      angle(:n) = self%u(:n) + 2*real(self%turns(:n), rk)
      track%total(:n) = track%total(:n) + angle(:n)
      track%lowest(:n) = min(track%lowest(:n), angle(:n))
      track%highest(:n) = max(track%highest(:n), angle(:n))
    end do
    call wrap_lanes(self, 1, lanes)
    do j = 1, 2
      matrix(:, j, :n) = transpose(c(:n, :, j))
    end do
  end subroutine mixed_tangent

  !> Advances by a step with its derivative; c(i, :, j): column j of the tangent map of lane i.
  subroutine tangent_step(self, step, n, u, v, c)
    class(mixed_batch_t), intent(in) :: self
    integer, intent(in) :: step, n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH), c(WIDTH, 2, 2)
    real(rk) :: of_k, of_m, kick, drift, decay
    integer :: s, i

    do s = 1, KICKS
      of_k = self%weight(1, s, step)
      of_m = self%weight(2, s, step)
      do i = 1, n
        drift = PI*self%drift(i, s)
        decay = self%decay(i, s)
        kick = of_k*self%k(i) + of_m*self%m(i)
        u(i) = u(i) + self%drift(i, s)*v(i)
        v(i) = decay*v(i) - kick*sine(u(i))
        kick = kick*sine(u(i) + 0.5_rk)
        c(i, 1, 1) = c(i, 1, 1) + drift*c(i, 2, 1)
        c(i, 1, 2) = c(i, 1, 2) + drift*c(i, 2, 2)
        c(i, 2, 1) = decay*c(i, 2, 1) - kick*c(i, 1, 1)
        c(i, 2, 2) = decay*c(i, 2, 2) - kick*c(i, 1, 2)
      end do
    end do
    do i = 1, n
      u(i) = u(i) + self%drift(i, DRIFTS)*v(i)
      v(i) = self%decay(i, DRIFTS)*v(i)
      c(i, 1, :) = c(i, 1, :) + PI*self%drift(i, DRIFTS)*c(i, 2, :)
      c(i, 2, :) = self%decay(i, DRIFTS)*c(i, 2, :)
    end do
  end subroutine tangent_step

  include 'vector/sine.inc'

end module kz_mixed_mixed_batch
