!> Bounds of the force for enclosures (include/kapitza/kernel_enclosure.h).
module kz_enclosure_force_bounds
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_long_double
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private

  integer, parameter :: ld = c_long_double

contains

  !> Implements kz_force_sizes of kernel_enclosure.h.
  subroutine force_sizes(pendulum, h, n, sizes) bind(C, name='kz_force_sizes')
    type(pendulum_t), intent(in) :: pendulum
    real(c_long_double), value :: h
    integer(c_int32_t), value :: n
    real(c_long_double), intent(out) :: sizes(0:n - 1)
    real(ld) :: size
    integer :: i, j

    size = (abs(real(pendulum%m, ld)) + abs(real(pendulum%torque_amplitude, ld)))*h
    do i = 0, n - 1
      sizes(i) = size
      size = size*(h/(i + 1))
    end do
    do j = 1, pendulum%harmonics
      size = force_amplitude(pendulum, j)*h
      do i = 0, n - 1
        sizes(i) = sizes(i) + size
        size = size*(j*h/(i + 1))
      end do
    end do
    sizes(0) = sizes(0) + h*abs(real(pendulum%k, ld)) + h*abs(real(pendulum%torque, ld))
  end subroutine force_sizes

  !> Implements kz_force_majorant of kernel_enclosure.h.
  pure function force_majorant(pendulum, r) bind(C, name='kz_force_majorant') result(bound)
    type(pendulum_t), intent(in) :: pendulum
    real(c_long_double), value :: r
    real(c_long_double) :: bound
    integer :: j

    bound = abs(real(pendulum%k, ld)) + (abs(real(pendulum%m, ld)) + abs(real(pendulum%torque_amplitude, ld)))*cosh(r)
    do j = 1, pendulum%harmonics
      bound = bound + force_amplitude(pendulum, j)*cosh(j*r)
    end do
    bound = bound + abs(real(pendulum%torque, ld))
  end function force_majorant

  !> Implements kz_force_largest of kernel_enclosure.h: a function is off its chord by at most h**2/8 max |second
  !> derivative|.
  pure function force_largest(pendulum, i, h) bind(C, name='kz_force_largest') result(bound)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: i
    real(c_long_double), value :: h
    real(c_long_double) :: bound
    integer :: j

    bound = max(abs(pendulum%k - pendulum%m*cos(i*h)), abs(pendulum%k - pendulum%m*cos((i + 1)*h))) &
            + abs(real(pendulum%m, ld))*h*h/8
    do j = 1, pendulum%harmonics
      bound = bound + force_amplitude(pendulum, j)
    end do
    bound = bound + abs(real(pendulum%torque, ld)) + abs(real(pendulum%torque_amplitude, ld))
  end function force_largest

  !> Bound of the share of harmonic j in |a(t)| + |b(t)|.
  pure function force_amplitude(pendulum, j) result(bound)
    type(pendulum_t), intent(in) :: pendulum
    integer, intent(in) :: j
    real(ld) :: bound

    bound = hypot(real(pendulum%vertical(1, j), ld), real(pendulum%vertical(2, j), ld)) &
            + hypot(real(pendulum%horizontal(1, j), ld), real(pendulum%horizontal(2, j), ld))
  end function force_amplitude

end module kz_enclosure_force_bounds
