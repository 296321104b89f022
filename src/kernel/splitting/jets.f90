!> One drive period of split6 with its derivatives: of third order in the state, of first order in two parameters, and
!> mixed ones of second order. They are the derivatives of the discrete map itself, to rounding.
module kz_splitting_jets
  use, intrinsic :: iso_c_binding, only: rk => c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_vector_map, only: PI
  use kz_vector_schemes, only: stage_t, scheme_stages, SCHEMES, SPLIT6_ROW
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: jets_t, make_jets, set_pendulum, advance_jets, LANES, TERMS
  public :: DX, DY, DP, DQ, DXX, DXY, DYY, DXP, DYP, DXQ, DYQ, DXXX, DXXY, DXYY, DYYY

  !> States advanced at once: more do not fit into the registers with their derivatives, and take six times as long.
  integer, parameter :: LANES = 4
  !> Partial derivatives of a coordinate: by the angle x and the velocity y of the start, and by the parameters p and q.
  integer, parameter :: DX = 1, DY = 2, DP = 3, DQ = 4, DXX = 5, DXY = 6, DYY = 7, DXP = 8, DYP = 9, DXQ = 10, &
      DYQ = 11, DXXX = 12, DXXY = 13, DXYY = 14, DYYY = 15, TERMS = 15
  integer, parameter :: KICKS = SCHEMES(SPLIT6_ROW + 1)%kicks, FUSED = KICKS + 2

  !> The period of a pendulum. Index 0 is the value, 1 and 2 are the derivatives by p and q.
  type :: jets_t
    integer :: n_steps = 0
    real(rk) :: time(FUSED) = 0                !< Length of each drift, drive radians; last: that between two steps
    real(rk), allocatable :: weight(:)         !< Length of each kick, drive radians
    real(rk), allocatable :: cosine(:)         !< Cosine and sine of its time
    real(rk), allocatable :: sine(:)
    real(rk), allocatable :: kicks(:, :, :)    !< (0:2, a b push, kick) in a sin theta - b cos theta - push
    real(rk) :: drifts(0:2, 2, FUSED) = 0      !< (0:2, drift rad per velocity; decay of it, FUSED)
    logical :: damped = .true.                 !< True: the damping depends on p or q
    logical :: mirrored = .false.              !< True: b and push are 0
    real(rk) :: damping(0:2) = 0
  end type jets_t

  interface
    !> Steps of LANES states (jets.c)
    subroutine advance_lanes(order, damped, mirrored, n, kicks, drifts, u, v, theta, velocity) &
        bind(C, name='kz_jets_advance')
      import :: rk, c_int32_t, c_int64_t, LANES, TERMS
      integer(c_int32_t), value :: order, damped, mirrored
      integer(c_int64_t), value :: n
      real(rk), intent(in) :: kicks(*), drifts(*)
      real(rk), intent(inout) :: u(LANES), v(LANES), theta(LANES, TERMS), velocity(LANES, TERMS)
    end subroutine advance_lanes
  end interface

contains

  !> Makes the tables that all pendulums share.
  subroutine make_jets(n_steps, jets)
    integer, intent(in) :: n_steps !< Steps of split6 per drive period
    type(jets_t), intent(out) :: jets !< Tables without a pendulum
    type(stage_t) :: stages(2*KICKS + 1)
    real(rk) :: clock, weight(KICKS)
    real(real128) :: step
    integer :: i, s, n

    stages = scheme_stages(SCHEMES(SPLIT6_ROW + 1))
    step = 8*atan(1.0_real128)/n_steps
    weight = real(step*stages(2::2)%share, rk)
    n = n_steps*KICKS
    jets%n_steps = n_steps
    jets%time(:KICKS + 1) = real(step*stages(1::2)%share, rk)
    jets%time(FUSED) = real(step*(stages(1)%share + stages(2*KICKS + 1)%share), rk)
    allocate (jets%weight(n), jets%cosine(n), jets%sine(n), jets%kicks(0:2, 3, n))
    n = 0
    do i = 1, n_steps
      clock = i - 1
      do s = 1, KICKS
        n = n + 1
        clock = clock + real(stages(2*s - 1)%share, rk)
        jets%weight(n) = weight(s)
        jets%cosine(n) = cos(2*PI/n_steps*clock)
        jets%sine(n) = sin(2*PI/n_steps*clock)
      end do
    end do
  end subroutine make_jets

  !> Sets the pendulum and its derivatives.
  subroutine set_pendulum(jets, pendulum)
    type(jets_t), intent(inout) :: jets !< Tables, whose kicks and drifts are set
    type(pendulum_t), intent(in) :: pendulum(0:2) !< Pendulum; its derivatives by p; by q
    real(rk) :: k(0:2), m(0:2), torque(0:2), amplitude(0:2)
    integer :: i, n

    jets%damping = pendulum%beta
    jets%damped = maxval(abs(pendulum(1:)%beta)) > 0
    jets%mirrored = maxval(pendulum%unmirrored) == 0
    k = pendulum%k
    m = pendulum%m
    torque = pendulum%torque
    amplitude = pendulum%torque_amplitude
    do n = 1, size(jets%weight)
      jets%kicks(:, 1, n) = jets%weight(n)*(k - m*jets%cosine(n))
      if (jets%mirrored) cycle ! nothing else is read
      jets%kicks(:, 2, n) = 0
      jets%kicks(:, 3, n) = jets%weight(n)*(torque + amplitude*jets%cosine(n))
    end do
    if (maxval(pendulum%harmonics) > 0) call add_harmonics(jets, pendulum)
    do i = 1, FUSED
      call set_drift(jets%time(i), pendulum%beta, jets%drifts(:, 1, i), jets%drifts(:, 2, i))
    end do
  end subroutine set_pendulum

  subroutine add_harmonics(jets, pendulum)
    type(jets_t), intent(inout) :: jets
    type(pendulum_t), intent(in) :: pendulum(0:2)
    real(rk) :: c, s, former
    integer :: n, j

    do n = 1, size(jets%weight)
      c = 1
      s = 0
      do j = 1, maxval(pendulum%harmonics)
        former = c
        c = c*jets%cosine(n) - s*jets%sine(n)
        s = s*jets%cosine(n) + former*jets%sine(n)
        jets%kicks(:, 1, n) = jets%kicks(:, 1, n) &
                              - jets%weight(n)*(pendulum%vertical(1, j)*c + pendulum%vertical(2, j)*s)
        jets%kicks(:, 2, n) = jets%kicks(:, 2, n) &
                              + jets%weight(n)*(pendulum%horizontal(1, j)*c + pendulum%horizontal(2, j)*s)
      end do
    end do
  end subroutine add_harmonics

  !> Sets the drift (1 - exp(-z))/beta and the decay exp(-z), z = beta*time, and their derivatives, by series.
  pure subroutine set_drift(time, beta, drift, decay)
    real(rk), intent(in) :: time, beta(0:2)
    real(rk), intent(out) :: drift(0:2), decay(0:2)
    integer, parameter :: TERMS_OF_SERIES = 30
    real(rk) :: z, power, mean, slope
    integer :: n

    z = beta(0)*time
    power = 1
    mean = 0
    slope = 0
    do n = 0, TERMS_OF_SERIES ! power = (-z)**n/n!
      mean = mean + power/(n + 1)
      slope = slope - power/(n + 2)
      power = -power*z/(n + 1)
    end do
    drift(0) = time*mean
    drift(1:) = time**2*slope*beta(1:)
    decay(0) = exp(-z)
    decay(1:) = -time*decay(0)*beta(1:)
  end subroutine set_drift

  !> Advances through steps of a period.
  subroutine advance_jets(jets, order, from, to, u, v, theta, velocity)
    type(jets_t), intent(in) :: jets !< the tables of a period with a pendulum
    integer, intent(in) :: order !< Highest order of derivatives, 0 .. 3
    integer, intent(in) :: from, to !< the first and the last step
    real(rk), intent(inout) :: u(LANES), v(LANES) !< half-turns, not wrapped; rad per drive radian
    real(rk), intent(inout) :: theta(LANES, TERMS), velocity(LANES, TERMS) !< Derivatives: rad, rad per drive radian

    call advance_lanes(int(order, c_int32_t), merge(1_c_int32_t, 0_c_int32_t, jets%damped), &
                       merge(1_c_int32_t, 0_c_int32_t, jets%mirrored), int(to - from + 1, c_int64_t), &
                       jets%kicks(:, :, (from - 1)*KICKS + 1:to*KICKS), jets%drifts, u, v, theta, velocity)
  end subroutine advance_jets

end module kz_splitting_jets
