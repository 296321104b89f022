!> States and what the equation makes of them in a drive period, by Taylor series in quad precision: what the errors of a period of every
!> other integrator are measured against.
module kz_extended_probes
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use kz_extended_taylor, only: drive_t, advance_period, qp, PI_QUAD
  implicit none
  private
  public :: probes_t, make_probes

  type :: probes_t
    real(qp), allocatable :: start(:, :) !< (2, n): half-turns, rad per drive radian; doubles
    real(qp), allocatable :: image(:, :) !< the same
  end type probes_t

contains

  !> A probe of each speed; angles are spread evenly over the circle.
  subroutine make_probes(drive, speed, probes)
    !> of the pendulum
    type(drive_t), intent(in) :: drive
    !> [n] rad per drive radian
    real(c_double), intent(in) :: speed(:)
    !> starts and images
    type(probes_t), intent(out) :: probes
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

end module kz_extended_probes
