!> Hamilton's flow of the least torque: theta'' + beta theta' + a(t) sin theta - b(t) cos theta - torque(t) = 2 beta p2,
!> with the action int beta p2**2 dt. It is split like the pendulum (split6): the drift is linear in (theta, velocity,
!> p1, p2), and the kick changes velocity and p1 alone, so that the map of a period is symplectic to rounding.
module kz_paths_flow
  use, intrinsic :: iso_c_binding, only: rk => c_double, c_int32_t, c_int64_t, c_ptr, c_loc, c_f_pointer
  use, intrinsic :: iso_fortran_env, only: ik => int64, real128
  use kz_model_pendulum, only: pendulum_t, force_at
  use kz_splitting_jets, only: jets_t, make_jets, set_pendulum
  use kz_vector_sine, only: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT, INVERSE_PI
  implicit none
  private

  !> States that move together.
  integer, parameter :: N_LANES = 16
  !> Kicks of a step of split6; the last drift of a step and the first of the next are one, drift FUSED.
  integer, parameter :: KICKS = 14, FUSED = KICKS + 2

  !> A drift: the matrix of the linear flow, and the integrals along it that are quadratic forms of (velocity, p1, p2).
  type :: drift_t
    real(rk) :: matrix(4, 4)
    real(rk) :: action(3, 3)     !< Quadratic form of beta p2**2
    real(rk) :: of_damping(3, 3) !< Quadratic form of p2 velocity - p2**2, d action / d beta
  end type drift_t

  type :: hamilton_t
    integer :: n_steps
    type(jets_t) :: jets !< kicks of the pendulum and of its derivatives by two parameters
    type(drift_t) :: drifts(FUSED)
  end type hamilton_t

  !> Lanes: state(:, i), tangent(:, i, j) = d state i / d start j, integrals: action, d by both parameters and beta.
  type :: lanes_t
    real(rk) :: state(N_LANES, 4), tangent(N_LANES, 4, 4), integral(N_LANES, 4)
  end type lanes_t

contains

  include 'vector/sine.inc'

  !> Implements kz_path_forces of kernel_paths.h.
  subroutine path_forces(pendulum, n, share, force) bind(C, name='kz_path_forces')
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: n
    real(rk), value :: share
    real(rk), intent(out) :: force(3, n)
    real(real128) :: time, a, b
    integer :: i

    do i = 1, n
      time = 8*atan(1.0_real128)*(i - 1 + share)/n
      call force_at(pendulum, cmplx(cos(time), sin(time), real128), a, b)
      force(:, i) = [real(a, rk), real(b, rk), real(pendulum%torque + pendulum%torque_amplitude*cos(time), rk)]
    end do
  end subroutine path_forces

  !> Implements kz_hamilton_create of kernel_paths.h.
  function hamilton_create(pendulum, n_steps) bind(C, name='kz_hamilton_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum(0:2)
    integer(c_int32_t), value :: n_steps
    type(c_ptr) :: handle
    type(hamilton_t), pointer :: flow
    integer :: i

    allocate (flow)
    flow%n_steps = n_steps
    call make_jets(int(n_steps), flow%jets)
    call set_pendulum(flow%jets, pendulum)
    if (flow%jets%mirrored) flow%jets%kicks(:, 2:, :) = 0
    do i = 1, FUSED
      flow%drifts(i) = drift_of(pendulum(0)%beta, flow%jets%time(i))
    end do
    handle = c_loc(flow)
  end function hamilton_create

  !> Implements kz_hamilton_free of kernel_paths.h.
  subroutine hamilton_free(handle) bind(C, name='kz_hamilton_free')
    type(c_ptr), value :: handle
    type(hamilton_t), pointer :: flow

    call c_f_pointer(handle, flow)
    if (associated(flow)) deallocate (flow)
  end subroutine hamilton_free

  !> The drift of a time; its integrals by Gauss's rule.
  pure function drift_of(beta, time) result(drift)
    real(rk), intent(in) :: beta, time
    type(drift_t) :: drift
    real(rk), parameter :: NODES(4) = [0.1834346424956498_rk, 0.525532409916329_rk, 0.7966664774136267_rk, &
                                       0.9602898564975363_rk], &
                           WEIGHTS(4) = [0.362683783378362_rk, 0.3137066458778873_rk, 0.2223810344533745_rk, &
                                         0.1012285362903763_rk]
    real(rk) :: rows(4, 4), v(3), p(3)
    integer :: i, side

    drift%matrix = linear_flow(beta, time)
    drift%action = 0
    drift%of_damping = 0
    do i = 1, size(NODES)
      do side = -1, 1, 2
        rows = linear_flow(beta, 0.5_rk*time*(1 + side*NODES(i)))
        v = rows(2, 2:)
        p = rows(4, 2:)
        drift%action = drift%action + 0.5_rk*time*WEIGHTS(i)*beta*outer(p, p)
        drift%of_damping = drift%of_damping + 0.5_rk*time*WEIGHTS(i)*(outer(p, v) - outer(p, p))
      end do
    end do
  end function drift_of

  pure function outer(a, b) result(product_of)
    real(rk), intent(in) :: a(3), b(3)
    real(rk) :: product_of(3, 3)

    product_of = spread(a, 2, 3)*spread(b, 1, 3)
  end function outer

  !> theta' = v, v' = -beta v + 2 beta p2, p1' = 0, p2' = -p1 + beta p2, by series.
  pure function linear_flow(beta, time) result(flow)
    real(rk), intent(in) :: beta, time
    real(rk) :: flow(4, 4), rate(4, 4), term(4, 4)
    integer, parameter :: TERMS = 40
    integer :: n

    rate = 0
    rate(1, 2) = 1
    rate(2, 2) = -beta
    rate(2, 4) = 2*beta
    rate(4, 3) = -1
    rate(4, 4) = beta
    term = 0
    do n = 1, 4
      term(n, n) = 1
    end do
    flow = term
    do n = 1, TERMS
      term = matmul(rate, term)*(time/n)
      flow = flow + term
    end do
  end function linear_flow

  !> Implements kz_hamilton_advance of kernel_paths.h.
  subroutine hamilton_advance(handle, n, state, with_tangent, tangent, with_integral, integral) &
      bind(C, name='kz_hamilton_advance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(rk), intent(inout) :: state(4, n)
    integer(c_int32_t), value :: with_tangent, with_integral
    real(rk), intent(out) :: tangent(4, 4, *), integral(4, *)
    type(hamilton_t), pointer :: flow
    type(lanes_t) :: lanes
    integer(c_int64_t) :: first, at
    integer :: lane

    call c_f_pointer(handle, flow)
    do first = 1, n, N_LANES
      call put(state(:, first:min(n, first + N_LANES - 1)), lanes)
      call advance(flow, 1, flow%n_steps, with_tangent /= 0, with_integral /= 0, lanes)
      do lane = 1, int(min(n - first + 1, int(N_LANES, c_int64_t)))
        at = first + lane - 1
        state(:, at) = lanes%state(lane, :)
        if (with_tangent /= 0) tangent(:, :, at) = transpose(lanes%tangent(lane, :, :))
        if (with_integral /= 0) integral(:, at) = lanes%integral(lane, :)
      end do
    end do
  end subroutine hamilton_advance

  !> Implements kz_hamilton_sample of kernel_paths.h.
  subroutine hamilton_sample(handle, samples, n, state, sample) bind(C, name='kz_hamilton_sample')
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: samples
    integer(c_int64_t), value :: n
    real(rk), intent(in) :: state(4, n)
    real(rk), intent(out) :: sample(4, samples, n)
    type(hamilton_t), pointer :: flow
    type(lanes_t) :: lanes
    integer(c_int64_t) :: first, last
    integer :: i, steps

    call c_f_pointer(handle, flow)
    steps = flow%n_steps/samples
    do first = 1, n, N_LANES
      last = min(n, first + N_LANES - 1)
      call put(state(:, first:last), lanes)
      do i = 1, samples
        call advance(flow, (i - 1)*steps + 1, i*steps, .false., .false., lanes)
        sample(:, i, first:last) = transpose(lanes%state(:last - first + 1, :))
      end do
    end do
  end subroutine hamilton_sample

  !> Lanes with these states; a lane without one repeats the first.
  pure subroutine put(state, lanes)
    real(rk), intent(in) :: state(:, :)
    type(lanes_t), intent(out) :: lanes
    integer :: i

    do i = 1, 4
      lanes%state(:, i) = state(i, 1)
      lanes%state(:size(state, 2), i) = state(i, :)
    end do
    lanes%tangent = 0
    do i = 1, 4
      lanes%tangent(:, i, i) = 1
    end do
    lanes%integral = 0
  end subroutine put

  !> Steps first .. last of a period.
  subroutine advance(flow, first, last, with_tangent, with_integral, lanes)
    type(hamilton_t), intent(in) :: flow
    integer, intent(in) :: first, last
    logical, intent(in) :: with_tangent, with_integral
    type(lanes_t), intent(inout) :: lanes
    integer :: step, stage, s

    do step = first, last
      do stage = 1, KICKS
        s = stage
        if (stage == 1 .and. step > first) s = FUSED
        if (with_integral) call integrate(flow%drifts(s), lanes)
        call drift(flow%drifts(s)%matrix, with_tangent, lanes)
        call kick(flow%jets%kicks(:, :, (step - 1)*KICKS + stage), with_tangent, with_integral, lanes)
      end do
    end do
    if (with_integral) call integrate(flow%drifts(KICKS + 1), lanes)
    call drift(flow%drifts(KICKS + 1)%matrix, with_tangent, lanes)
  end subroutine advance

  subroutine integrate(drift, lanes)
    type(drift_t), intent(in) :: drift
    type(lanes_t), intent(inout) :: lanes
    integer :: i

    do i = 1, N_LANES
      associate (x => lanes%state(i, 2:))
        lanes%integral(i, 1) = lanes%integral(i, 1) + dot_product(x, matmul(drift%action, x))
        lanes%integral(i, 4) = lanes%integral(i, 4) + dot_product(x, matmul(drift%of_damping, x))
      end associate
    end do
  end subroutine integrate

  pure subroutine drift(matrix, with_tangent, lanes)
    real(rk), intent(in) :: matrix(4, 4)
    logical, intent(in) :: with_tangent
    type(lanes_t), intent(inout) :: lanes
    integer :: j

    call move(lanes%state(:, 1), lanes%state(:, 2), lanes%state(:, 3), lanes%state(:, 4))
    if (.not. with_tangent) return
    do j = 1, 4
      call move(lanes%tangent(:, 1, j), lanes%tangent(:, 2, j), lanes%tangent(:, 3, j), lanes%tangent(:, 4, j))
    end do
  contains
    pure subroutine move(theta, v, p1, p2)
      real(rk), intent(inout) :: theta(N_LANES), v(N_LANES), p2(N_LANES)
      real(rk), intent(in) :: p1(N_LANES)
      integer :: i

      do i = 1, N_LANES
        theta(i) = theta(i) + matrix(1, 2)*v(i) + (matrix(1, 3)*p1(i) + matrix(1, 4)*p2(i))
        v(i) = matrix(2, 2)*v(i) + (matrix(2, 3)*p1(i) + matrix(2, 4)*p2(i))
        p2(i) = matrix(4, 3)*p1(i) + matrix(4, 4)*p2(i)
      end do
    end subroutine move
  end subroutine drift

  pure subroutine kick(of, with_tangent, with_integral, lanes)
    real(rk), intent(in) :: of(0:2, 3) !< (value and its derivatives, of sin theta, of -cos theta and push)
    logical, intent(in) :: with_tangent, with_integral
    type(lanes_t), intent(inout) :: lanes
    real(rk) :: s(N_LANES), c(N_LANES), slope(N_LANES), bend(N_LANES), u
    integer :: i, j

    do i = 1, N_LANES
      u = INVERSE_PI*lanes%state(i, 1)
      s(i) = sine(u)
      c(i) = sine(u + 0.5_rk)
      slope(i) = of(0, 1)*c(i) + of(0, 2)*s(i)
      bend(i) = (of(0, 1)*s(i) - of(0, 2)*c(i))*lanes%state(i, 4)
      lanes%state(i, 2) = lanes%state(i, 2) - (of(0, 1)*s(i) - of(0, 2)*c(i) - of(0, 3))
      lanes%state(i, 3) = lanes%state(i, 3) + slope(i)*lanes%state(i, 4)
    end do
    if (with_integral) then
      do j = 1, 2
        lanes%integral(:, 1 + j) = lanes%integral(:, 1 + j) + lanes%state(:, 4)*(of(j, 1)*s - of(j, 2)*c - of(j, 3))
      end do
    end if
    if (.not. with_tangent) return
    do j = 1, 4
      do i = 1, N_LANES
        lanes%tangent(i, 2, j) = lanes%tangent(i, 2, j) - slope(i)*lanes%tangent(i, 1, j)
        lanes%tangent(i, 3, j) = lanes%tangent(i, 3, j) &
                                 + (slope(i)*lanes%tangent(i, 4, j) - bend(i)*lanes%tangent(i, 1, j))
      end do
    end do
  end subroutine kick

end module kz_paths_flow
