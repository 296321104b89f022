!> The pendulum and its equation of motion, theta'' + beta theta' + a(t) sin theta - b(t) cos theta = torque +
!> torque_amplitude cos t, with a = k - m cos t - sum_j (vertical(1, j) cos j t + vertical(2, j) sin j t), b = sum_j
!> (horizontal(1, j) cos j t + horizontal(2, j) sin j t): include/kapitza/model.h. Integrators take a, b, their symmetry
!> and bounds from here.
module kz_model_pendulum
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use, intrinsic :: iso_fortran_env, only: real64, real128
  implicit none
  private
  public :: pendulum_t, is_same, stiffness, exact_stiffness, symmetries, is_driven, pairing_symmetry, is_mirrored, &
            is_sine, highest_harmonic, acceleration, force_at, sine_force, MOST_HARMONICS

  integer, parameter :: qp = real128
  !> KZ_HARMONICS of model.h.
  integer, parameter :: MOST_HARMONICS = 24
  !> KZ_SYMMETRY_... of model.h; 0 = none.
  integer(c_int32_t), parameter, public :: MIRROR = 1, HALF_PERIOD = 2, HALF_TURN = 4
  real(qp), parameter :: PI = 3.14159265358979323846264338327950288_qp

  type, bind(C) :: pendulum_t
    real(c_double) :: k, beta, m
    real(c_double) :: torque = 0
    real(c_double) :: torque_amplitude = 0
    real(c_double) :: vertical(2, MOST_HARMONICS) = 0
    real(c_double) :: horizontal(2, MOST_HARMONICS) = 0
    integer(c_int32_t) :: harmonics = 0
    integer(c_int32_t) :: unmirrored = 0
  end type pendulum_t

  !> a(t) of the drive m cos t alone, from the cosine.
  interface sine_force
    module procedure sine_force_r64, sine_force_r128
  end interface sine_force

contains

  elemental function sine_force_r64(k, m, cosine) result(force)
    real(real64), intent(in) :: k, m, cosine
    real(real64) :: force

    force = k - m*cosine
  end function sine_force_r64

  elemental function sine_force_r128(k, m, cosine) result(force)
    real(real128), intent(in) :: k, m, cosine
    real(real128) :: force

    force = k - m*cosine
  end function sine_force_r128

  !> Returns .true. if two pendulums have the same numbers, to the bit.
  pure function is_same(one, other) result(same)
    type(pendulum_t), intent(in) :: one, other !< Pendulums
    logical :: same

    same = all(transfer(one, [0_c_int32_t]) == transfer(other, [0_c_int32_t])) ! to the bit
  end function is_same

  !> Upper bound of |a(t)| + |b(t)| + |torque| + |torque_amplitude| over all t.
  pure function stiffness(pendulum) bind(C, name='kz_stiffness') result(bound)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    real(c_double) :: bound

    bound = real(exact_stiffness(pendulum), c_double)
  end function stiffness

  !> kz_stiffness in quad precision.
  pure function exact_stiffness(pendulum) result(bound)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    real(qp) :: bound
    integer :: j

    bound = abs(real(pendulum%k, qp)) + abs(pendulum%m)
    do j = 1, pendulum%harmonics
      bound = bound + hypot(pendulum%vertical(1, j), pendulum%vertical(2, j)) &
              + hypot(pendulum%horizontal(1, j), pendulum%horizontal(2, j))
    end do
    bound = bound + abs(pendulum%torque) + abs(pendulum%torque_amplitude)
  end function exact_stiffness

  !> Symmetries of the equation, a sum of MIRROR, HALF_PERIOD and HALF_TURN, by exact zeros: half a period later odd
  !> harmonics have changed their signs, upside down a and b have.
  pure function symmetries(pendulum) bind(C, name='kz_symmetries') result(sum_of)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: sum_of
    logical :: vertical(0:1), horizontal(0:1) ! whether harmonics are there: 0 = even, with gravity, 1 = odd
    integer :: j

    vertical = [abs(pendulum%k) > 0, abs(pendulum%m + pendulum%vertical(1, 1)) > 0 &
                .or. abs(pendulum%vertical(2, 1)) > 0]
    horizontal = [.false., maxval(abs(pendulum%horizontal(:, 1))) > 0]
    do j = 2, pendulum%harmonics
      vertical(mod(j, 2)) = vertical(mod(j, 2)) .or. maxval(abs(pendulum%vertical(:, j))) > 0
      horizontal(mod(j, 2)) = horizontal(mod(j, 2)) .or. maxval(abs(pendulum%horizontal(:, j))) > 0
    end do
    sum_of = 0
    if (pendulum%unmirrored == 0) sum_of = sum_of + MIRROR
    if (.not. (vertical(1) .or. horizontal(0) .or. abs(pendulum%torque) > 0)) sum_of = sum_of + HALF_PERIOD
    if (.not. (vertical(0) .or. horizontal(0) .or. abs(pendulum%torque_amplitude) > 0)) sum_of = sum_of + HALF_TURN
  end function symmetries

  !> 1 if anything of the equation depends on time, else 0.
  pure function is_driven(pendulum) bind(C, name='kz_is_driven') result(driven)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: driven

    associate (n => pendulum%harmonics)
      driven = merge(1, 0, abs(pendulum%m) > 0 .or. abs(pendulum%torque_amplitude) > 0 .or. &
                     any(abs(pendulum%vertical(:, :n)) > 0) .or. any(abs(pendulum%horizontal(:, :n)) > 0))
    end associate
  end function is_driven

  !> The symmetry by which attractors and cycles have images: MIRROR, else HALF_PERIOD, else 0.
  pure function pairing_symmetry(pendulum) bind(C, name='kz_pairing_symmetry') result(symmetry)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: symmetry

    symmetry = iand(symmetries(pendulum), HALF_PERIOD)
    if (is_mirrored(pendulum) /= 0) symmetry = MIRROR
  end function pairing_symmetry

  !> 1 if the mirror image (-theta, -velocity) of every motion is a motion too, else 0.
  pure function is_mirrored(pendulum) bind(C, name='kz_is_mirrored') result(mirrored)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: mirrored

    mirrored = 1 - pendulum%unmirrored
  end function is_mirrored

  !> 1 if the drive is k - m cos t without further terms, else 0.
  pure function is_sine(pendulum) bind(C, name='kz_is_sine') result(sine)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: sine

    sine = merge(1, 0, pendulum%harmonics == 0 .and. pendulum%unmirrored == 0)
  end function is_sine

  !> Highest harmonic of the drive, at least 1.
  pure function highest_harmonic(pendulum) result(highest)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    integer(c_int32_t) :: highest

    highest = max(1_c_int32_t, pendulum%harmonics)
  end function highest_harmonic

  !> Computes a(t) and b(t) at a time t of the drive.
  pure subroutine force_at(pendulum, clock, a, b)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    complex(qp), intent(in) :: clock !< exp(i t)
    real(qp), intent(out) :: a !< Factor of sin theta
    real(qp), intent(out) :: b !< Factor of -cos theta
    complex(qp) :: power
    integer :: j

    a = pendulum%k - pendulum%m*real(clock, qp)
    b = 0
    power = 1
    do j = 1, pendulum%harmonics ! exp(i j t) by products, because functions of quads are slow
      power = power*clock
      a = a - pendulum%vertical(1, j)*real(power, qp) - pendulum%vertical(2, j)*aimag(power)
      b = b + pendulum%horizontal(1, j)*real(power, qp) + pendulum%horizontal(2, j)*aimag(power)
    end do
  end subroutine force_at

  !> theta'' of a state at the time t of the drive, rad.
  pure function acceleration(pendulum, t, theta, velocity) result(rate)
    type(pendulum_t), intent(in) :: pendulum !< the pendulum
    real(c_double), intent(in) :: t !< drive time, rad
    real(c_double), intent(in) :: theta, velocity !< rad, rad per drive radian
    real(c_double) :: rate
    integer :: j

    rate = -pendulum%beta*velocity - (pendulum%k - pendulum%m*cos(t))*sin(theta)
    do j = 1, pendulum%harmonics
      rate = rate + (pendulum%vertical(1, j)*cos(j*t) + pendulum%vertical(2, j)*sin(j*t))*sin(theta) &
             + (pendulum%horizontal(1, j)*cos(j*t) + pendulum%horizontal(2, j)*sin(j*t))*cos(theta)
    end do
    if (pendulum%unmirrored /= 0) rate = rate + pendulum%torque + pendulum%torque_amplitude*cos(t)
  end function acceleration

end module kz_model_pendulum
