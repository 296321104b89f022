!> The processor of the processed splitting, the change between physical and kernel coordinates.
module kz_processed_processor
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  use kz_vector_map, only: WIDTH
  use kz_vector_wrap, only: vectors_of
  use kz_vector_sine, only: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT, INVERSE_PI
  use kz_processed_tables, only: processor_t, HARMONICS
  implicit none
  private
  public :: change_coordinates, change_derivative, sine

  interface
    !> processor.c
    subroutine change_lanes(mirrored, theta, velocity, n, sine, cosine, u, v) bind(C, name='kz_processed_change')
      import :: c_int32_t, c_int64_t, c_double
      integer(c_int32_t), value :: mirrored
      real(c_double), intent(in) :: theta(*), velocity(*)
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: sine(*), cosine(*)
      real(c_double), intent(inout) :: u(*), v(*)
    end subroutine change_lanes
  end interface

contains

  !> Adds processor(u, v) to n states, at most WIDTH.
  subroutine change_coordinates(processor, n, u, v)
    type(processor_t), intent(in) :: processor !< Change of coordinates
    integer, intent(in) :: n !< states
    real(rk), intent(inout) :: u(n), v(n) !< half-turns; rad per drive radian
    real(rk), dimension(WIDTH) :: x, y, s, c
    integer :: lanes

    x(:n) = u
    x(n + 1:) = 0
    y(:n) = v
    y(n + 1:) = 0
    lanes = vectors_of(n)
    call sine_and_cosine(lanes, x, s, c)
    call change_lanes(merge(1_c_int32_t, 0_c_int32_t, processor%mirrored), processor%theta, processor%velocity, &
                      int(lanes, c_int64_t), s, c, x, y)
    u = x(:n)
    v = y(:n)
  end subroutine change_coordinates

  !> sin(pi u) and cos(pi u), mirror-symmetric to the bit.
  subroutine sine_and_cosine(n, u, s, c)
    integer, intent(in) :: n
    real(rk), intent(in) :: u(n)
    real(rk), intent(out) :: s(n), c(n)
    real(rk) :: r
    integer :: i

    do i = 1, n
      r = abs(u(i) - 2*((0.5_rk*u(i) + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)) ! without even half-turns, 0 <= r <= 1
      s(i) = sine(u(i))
      c(i) = sine(0.5_rk - r)
    end do
  end subroutine sine_and_cosine

  !> Derivative of (u, v) + processor(u, v) by (theta, v), angles in rad.
  function change_derivative(processor, u, v) result(derivative)
    type(processor_t), intent(in) :: processor !< Change of coordinates
    real(rk), intent(in) :: u, v !< half-turns; rad per drive radian
    real(rk) :: derivative(2, 2)
    real(rk), parameter :: PI = 3.14159265358979323846_rk
    real(rk) :: s(1), c(1), theta(2), velocity(2), by_u(2), by_v(2)
    integer :: j

    by_u = 0
    by_v = 0
    do j = 0, HARMONICS
      call sine_and_cosine(1, [j*u], s, c)
      theta = harmonic_slopes(processor%theta(j, :, 1), j, s(1), c(1), v, 0)
      velocity = harmonic_slopes(processor%velocity(j, :, 1), j, s(1), c(1), v, 0)
      if (.not. processor%mirrored) then
        theta = theta + harmonic_slopes(processor%theta(j, :, 2), j, s(1), c(1), v, 1)
        velocity = velocity + harmonic_slopes(processor%velocity(j, :, 2), j, s(1), c(1), v, 1)
      end if
      by_u = by_u + [theta(1), velocity(1)]
      by_v = by_v + [theta(2), velocity(2)]
    end do
    derivative(1, :) = [1 + by_u(1), PI*by_v(1)]
    derivative(2, :) = [by_u(2)/PI, 1 + by_v(2)]
  end function change_derivative

  !> Derivatives by u and v of a harmonic: sin(pi j u) (even powers of v) + cos(pi j u) (odd powers), swapped if odd =
  !> 1.
  pure function harmonic_slopes(coefficient, j, s, c, v, odd) result(slope)
    real(rk), intent(in) :: coefficient(0:)
    integer, intent(in) :: j
    real(rk), intent(in) :: s, c, v
    integer, intent(in) :: odd
    real(rk) :: slope(2)
    integer :: n

    slope = 0
    do n = 0, ubound(coefficient, 1)
      if (mod(n + odd, 2) == 0) then
        slope = slope + coefficient(n)*[j*c*v**n/INVERSE_PI, n*s*v**max(n - 1, 0)]
      else
        slope = slope + coefficient(n)*[-j*s*v**n/INVERSE_PI, n*c*v**max(n - 1, 0)]
      end if
    end do
  end function harmonic_slopes

  include 'vector/sine.inc'

end module kz_processed_processor
