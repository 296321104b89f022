!> Tables of the processed splitting in quad precision, for pairs of doubles.
module kz_processed_tables_r128
  use, intrinsic :: iso_c_binding, only: c_double, c_ptr
  use, intrinsic :: iso_fortran_env, only: rk => real128
  use kz_model_pendulum, only: pendulum_t, exact_stiffness, highest_harmonic
  use kz_processed_pair_products, only: right_factor_t, right_factor, set_right_factor, pair_product, pair_of
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_tables, only: series_r64_t => series_t, make_processed_series, ORDER, HARMONICS
  use kz_processed_series_r128, only: series_t, make_series, MOST_EXACT => ORDER
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_mixed_series, make_processed, ORDER, HARMONICS

  !> Largest useful numbers of powers of v in a drift (1, 3, 5, ..) and of coefficients of a kick in pairs of doubles.
  integer, parameter, public :: MOST_PAIR_DRIFTS = ORDER/2 - 1, MOST_PAIR_KICKS = 22

  include 'tables.inc'

  !> Sets the kicks of all steps at once, as products of matrices of amplitudes, sines of time, and polynomials.
  subroutine set_kicks(pendulum, series, table)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series
    type(processed_t), intent(inout) :: table
    real(rk) :: h, scale(table%n_steps), polynomial(0:HARMONICS, table%n_kick)
    type(right_factor_t) :: clock
    integer :: s, n

    h = 2*PI/table%n_steps
    n = table%n_drift + table%n_kick
    scale = [(exp(real(pendulum%beta, rk)*((s - 0.5_rk)*h)), s=1, table%n_steps)]
    call make_clock(series%times, table%n_steps, clock)
    polynomial(0, :) = 0
    polynomial(1:, :) = real(sine_polynomials(table%n_kick), rk)
    table%row(table%n_drift + 1:n, :) = kick_rows(-1, 1)
    if (table%mirrored) return
    polynomial = real(cosine_polynomials(table%n_kick), rk)
    table%row(n + table%n_drift + 1:, :) = kick_rows(1, 2)
  contains
    function kick_rows(sign, trig) result(row)
      integer, intent(in) :: sign, trig
      real(rk) :: row(table%n_kick, table%n_steps), amplitude(0:HARMONICS, table%n_steps)
      type(right_factor_t) :: factor

      amplitude = pair_product(kick_amplitudes(series, h, sign, trig), clock)
      call set_right_factor(amplitude*spread(scale, 1, HARMONICS + 1), factor)
      row = pair_product(transpose(polynomial), factor)
    end function kick_rows
  end subroutine set_kicks

  !> Amplitudes of cosines and then sines of 0, t, 2 t, .. in the harmonics of a kick of a step h, all grades together.
  pure function kick_amplitudes(series, h, sign, trig) result(amplitude)
    type(series_t), intent(in) :: series
    real(rk), intent(in) :: h
    integer, intent(in) :: sign, trig !< Sign of the derivative by theta of the trigonometric function; its code
    real(rk) :: amplitude(0:HARMONICS, 2*(series%times + 1))
    integer :: q, j

    amplitude = 0
    do q = 2, ORDER, 2
      if (trig == 2) then
        amplitude(0, :2) = amplitude(0, :2) + h**(q - 1)*series%slope(:, q, 1)
        amplitude(0, series%times + 3) = amplitude(0, series%times + 3) + h**(q - 1)*series%slope(1, q, 2)
      end if
      do j = 1, q/2
        amplitude(j, :) = amplitude(j, :) &
                          + (sign*j*h**(q - 1))*reshape(series%kick(:, j, q, trig, :), [2*(series%times + 1)])
      end do
    end do
  end function kick_amplitudes

  !> Makes the cosines, and then sines, of 0, t, 2 t, .. in the middles of all steps, multiples of pi/n_steps.
  pure subroutine make_clock(times, n_steps, clock)
    integer, intent(in) :: times, n_steps
    type(right_factor_t), intent(out) :: clock
    real(c_double) :: cosine(2, 0:2*n_steps - 1), sine(2, 0:2*n_steps - 1)
    integer :: i, l, s

    do i = 0, n_steps - 1
      cosine(:, i) = pair_of(cos(i*PI/n_steps))
      sine(:, i) = pair_of(sin(i*PI/n_steps))
    end do
    cosine(:, n_steps:) = -cosine(:, :n_steps - 1)
    sine(:, n_steps:) = -sine(:, :n_steps - 1)
    call right_factor(2*(times + 1), n_steps, clock)
    do l = 0, times
      do s = 1, n_steps
        i = modulo(l*(2*s - 1), 2*n_steps)
        clock%row(s, :, l + 1) = cosine(:, i)
        clock%row(s, :, times + l + 2) = sine(:, i)
      end do
    end do
  end subroutine make_clock

  !> Makes the series of a pendulum: first grades in quad precision, the others in doubles, exact to 1e-15 of the force.
  !> Grade q of a step h is multiplied by h**q, so that little precision is enough for high ones; further harmonics of
  !> the drive, which make them larger, need one more even grade in quads.
  subroutine make_mixed_series(pendulum, kept, series)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(c_ptr), intent(in) :: kept !< Cache, kz_kept_series of kernel.h; null = none
    type(series_t), intent(out) :: series !< Series, for any number of steps
    type(series_r64_t), allocatable :: rounded
    type(series_t), allocatable :: leading
    integer :: exact

    exact = merge(MOST_EXACT, MOST_EXACT - 2, highest_harmonic(pendulum) > 1)
    allocate (rounded, leading)
    call make_processed_series(pendulum, kept, rounded)
    call make_series(pendulum, exact, leading)
    series%mirrored = rounded%mirrored
    series%times = rounded%times
    series%kick = rounded%kick
    series%slope = rounded%slope
    series%drift = rounded%drift
    series%processor = rounded%processor
    call put_exact(leading, exact, series)
  end subroutine make_mixed_series

  !> Replaces grades up to `exact`, of the processor up to exact - 2, by those of `leading`.
  subroutine put_exact(leading, exact, series)
    type(series_t), intent(in) :: leading
    integer, intent(in) :: exact
    type(series_t), intent(inout) :: series
    integer, parameter :: HALF = MOST_EXACT/2

    series%kick(:, :, :exact, :, :) = 0
    series%kick(:leading%times, :HALF, :exact, :, :) = leading%kick(:, :, :exact, :, :)
    series%slope(:, :exact, :) = leading%slope(:, :exact, :)
    series%drift(:, :exact) = leading%drift(:, :exact)
    series%processor(:, :, :exact - 2, :, :, :) = 0
    series%processor(:HALF, :MOST_EXACT, :exact - 2, :, :, :) = leading%processor(:, :, :exact - 2, :, :, :)
  end subroutine put_exact

end module kz_processed_tables_r128
