!> Hill's damped equation u'' + beta u' + (k - m f(t)) u = 0 over a period, one lane per point (k, beta, m); f is the
!> drive of a pendulum with k = 0 and m = 1, by default the cosine.
!>
!> u = exp(-beta t/2) w removes the damping; w'' + (kappa - m f) w = 0, kappa = k - beta**2/4, is integrated over half a
!> period by Taylor series about the middle of each step. See include/kapitza/kernel.h.
module kz_kernel_linear
  use, intrinsic :: iso_c_binding, only: c_double, c_int8_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_map, only: WIDTH
  use kz_model_pendulum, only: pendulum_t, stiffness, highest_harmonic
  use kz_model_series_r64, only: force_series
  implicit none
  private

  real(rk), parameter :: PI = 3.14159265358979323846_rk
  !> Order of the series; largest sqrt(|kappa| + |m|) times half a step, for a truncation error below 1e-15.
  integer, parameter :: ORDER = 22
  real(rk), parameter :: MAX_PHASE = 1.2_rk
  !> Solutions beyond 2**SCALE_BITS are scaled down by it.
  integer, parameter :: SCALE_BITS = 400

  !> w(pi) = c, s and w'(pi) = c_dot, s_dot of the solutions with (w, w') = (1, 0), (0, 1) at t = 0, in units of
  !> 2**exponent. Over a whole period of an even drive trace/2 = 2 c s_dot - 1 = 2 s c_dot + 1.
  type :: half_period_t
    real(rk) :: c, s, c_dot, s_dot
    integer(c_int64_t) :: exponent
  end type half_period_t

  !> The two solutions at the current time in units of 2**(SCALE_BITS scalings); derivatives are per half step.
  type :: solutions_t
    real(rk) :: w(WIDTH, 2), w_dot(WIDTH, 2)
    integer(c_int64_t) :: scalings(WIDTH)
  end type solutions_t

  !> Even and odd terms of a series at x = 1, and of its derivative.
  type :: sums_t
    real(rk), dimension(WIDTH) :: even = 0, odd = 0, d_even = 0, d_odd = 0
  end type sums_t

contains

  !> Computes the solutions at t = pi for n points.
  subroutine half_periods(form, n, k, beta, m, half)
    type(pendulum_t), intent(in), optional :: form !< the drive, with k = 0 and m = 1
    integer(c_int64_t), intent(in) :: n
    real(rk), intent(in) :: k(n), beta(n), m(n) !< Stiffness, damping, drive [n]
    type(half_period_t), intent(out) :: half(n) !< Solutions [n]
    type(pendulum_t) :: wave
    integer(c_int64_t) :: first
    integer :: lanes

    wave = wave_of(form)
    do first = 1, n, WIDTH
      lanes = int(min(int(WIDTH, c_int64_t), n - first + 1))
      call half_batch(wave, lanes, k(first:), beta(first:), m(first:), half(first:))
    end do
  end subroutine half_periods

  !> The given drive, or the cosine if there is none.
  pure function wave_of(form) result(wave)
    type(pendulum_t), intent(in), optional :: form
    type(pendulum_t) :: wave

    wave = pendulum_t(k=0, beta=0, m=1)
    if (present(form)) wave = form
  end function wave_of

  !> Computes the largest multiplier, its angle and the stability of n points.
  subroutine floquet(form, n, k, beta, m, log_multiplier, angle, stable) bind(C, name='kz_linear_floquet')
    type(pendulum_t), intent(in), optional :: form !< the drive, with k = 0 and m = 1
    integer(c_int64_t), value :: n
    real(c_double), intent(in) :: k(n), beta(n), m(n) !< stiffness, damping, drive [n]
    real(c_double), intent(out) :: log_multiplier(n) !< natural log of the largest |multiplier| [n]
    real(c_double), intent(out) :: angle(n) !< Floquet angle / 2 pi [n]
    integer(c_int8_t), intent(out) :: stable(n) !< 1 = stable [n]
    type(half_period_t), allocatable :: half(:), back(:)
    type(pendulum_t) :: reversed
    integer(c_int64_t) :: j

    allocate (half(n))
    call half_periods(form, n, k, beta, m, half)
    reversed = wave_of(form)
    if (.not. any(abs(reversed%vertical(2, :)) > 0)) then ! an even drive: the second half is the first one, reversed
      back = half
    else
      reversed%vertical(2, :) = -reversed%vertical(2, :)
      allocate (back(n))
      call half_periods(reversed, n, k, beta, m, back)
    end if
    do j = 1, n
      call classify_point(half(j), back(j), beta(j), rounding_of(k(j), beta(j), m(j)), log_multiplier(j), angle(j), &
                          stable(j))
    end do
  end subroutine floquet

  !> Multiplier, angle and stability of one point, from the halves of its period; `back` is the second half, run
  !> backwards in time. With growth mu of w per period: trace/2 = cosh(mu) or -cosh(mu), thus sinh(mu/2)**2 = plus or
  !> minus; between the tongues sin(pi angle)**2 = -plus. A product below its rounding error counts as 0.
  pure subroutine classify_point(half, back, beta, rounding, log_multiplier, angle, stable)
    type(half_period_t), intent(in) :: half, back
    real(rk), intent(in) :: beta, rounding
    real(rk), intent(out) :: log_multiplier, angle
    integer(c_int8_t), intent(out) :: stable
    real(rk) :: plus, minus, growth, first_half(4), second_half(4)
    integer(c_int64_t) :: exponent

    exponent = max(half%exponent, back%exponent)
    first_half = in_units_of(half, exponent)
    second_half = in_units_of(back, exponent)*[1, -1, -1, 1] ! the inverse of the second half
    plus = above_rounding(minus_determinant(0.5_rk*(first_half - second_half)), rounding) ! (trace - 2)/4
    minus = above_rounding(minus_determinant(0.5_rk*(first_half + second_half)), rounding) ! -(trace + 2)/4
    if (plus >= 0) then
      growth = growth_of(plus, exponent)
      angle = 0
    else if (minus >= 0) then
      growth = growth_of(minus, exponent)
      angle = 0.5_rk
    else
      growth = 0
      angle = atan2(sqrt(-plus), sqrt(-minus))/PI
    end if
    log_multiplier = growth - PI*beta
    stable = merge(1_c_int8_t, 0_c_int8_t, log_multiplier < 0 .or. (beta <= 0 .and. plus < 0 .and. minus < 0))
  end subroutine classify_point

  pure function in_units_of(half, exponent) result(numbers)
    type(half_period_t), intent(in) :: half
    integer(c_int64_t), intent(in) :: exponent
    real(rk) :: numbers(4)

    numbers = scale([half%c, half%s, half%c_dot, half%s_dot], int(max(half%exponent - exponent, -4000_c_int64_t)))
  end function in_units_of

  pure real(rk) function minus_determinant(x) result(value)
    real(rk), intent(in) :: x(4)

    value = x(2)*x(3) - x(1)*x(4)
  end function minus_determinant

  !> Rounding error of a product of two solutions near their zeros.
  pure real(rk) function rounding_of(k, beta, m) result(rounding)
    real(rk), intent(in) :: k, beta, m

    rounding = (4*epsilon(1.0_rk)*(1 + abs(k) + 0.25_rk*beta**2 + abs(m)))**2
  end function rounding_of

  !> The product, or 0 if it is below its rounding error.
  pure real(rk) function above_rounding(product, rounding) result(sure)
    real(rk), intent(in) :: product, rounding

    sure = merge(product, 0.0_rk, abs(product) > rounding)
  end function above_rounding

  !> The growth mu with sinh(mu/2)**2 = square 4**exponent.
  pure real(rk) function growth_of(square, exponent) result(growth)
    real(rk), intent(in) :: square
    integer(c_int64_t), intent(in) :: exponent

    if (exponent == 0 .and. square < 1e30_rk) then
      growth = 2*asinh(sqrt(square))
    else
      growth = log(4*max(square, tiny(1.0_rk))) + 2*exponent*log(2.0_rk)
    end if
  end function growth_of

  !> Advances one batch through half a period; its stiffest lane sets the steps.
  subroutine half_batch(wave, lanes, k, beta, m, half)
    type(pendulum_t), intent(in) :: wave
    integer, intent(in) :: lanes
    real(rk), intent(in) :: k(*), beta(*), m(*)
    type(half_period_t), intent(out) :: half(*)
    real(rk) :: kappa(WIDTH), drive(WIDTH), h, series(0:ORDER + 3), across(0:0)
    type(solutions_t) :: y
    integer :: n_steps, terms, i

    kappa = 0
    drive = 0
    kappa(:lanes) = k(:lanes) - 0.25_rk*beta(:lanes)**2
    drive(:lanes) = m(:lanes)
    n_steps = max(3*highest_harmonic(wave), &
                  ceiling(PI*sqrt(maxval(abs(kappa) + stiffness(wave)*abs(drive)))/(2*MAX_PHASE)))
    h = PI/(2*n_steps)
    y%w = spread([1.0_rk, 0.0_rk], 1, WIDTH)
    y%w_dot = spread([0.0_rk, h], 1, WIDTH)
    y%scalings = 0
    terms = series_terms(highest_harmonic(wave)*h)
    do i = 1, n_steps
      call force_series(wave, (2*i - 1)*h, h, -1.0_rk, series, across)
      call advance_step(y, -h*h*kappa, h*h*drive, series, terms)
    end do
    do i = 1, lanes
      half(i) = half_period_t(y%w(i, 1), y%w(i, 2), y%w_dot(i, 1)/h, y%w_dot(i, 2)/h, SCALE_BITS*y%scalings(i))
    end do
  end subroutine half_batch

  !> Number of terms of the drive's series above double precision; h: half a step times the highest harmonic.
  pure integer function series_terms(h) result(terms)
    real(rk), intent(in) :: h
    real(rk) :: size

    size = 1
    do terms = 1, ORDER - 1
      size = size*h/terms
      if (size < 1e-18_rk) exit
    end do
  end function series_terms

  !> Advances by a step of two units of x about its middle: with the solutions A, B that begin in the middle, the states
  !> at the ends are W(x) = (A, B; A', B') times the middle's, det W = 1.
  subroutine advance_step(y, kappa, drive, wave, terms)
    type(solutions_t), intent(inout) :: y
    real(rk), intent(in) :: kappa(WIDTH), drive(WIDTH), wave(0:ORDER + 3)
    integer, intent(in) :: terms
    type(sums_t) :: a, b
    real(rk), dimension(WIDTH) :: middle, middle_rate
    integer :: j

    call sum_series(1, kappa, drive, wave, terms, a)
    call sum_series(2, kappa, drive, wave, terms, b)
    do j = 1, 2
      middle = (b%d_odd - b%d_even)*y%w(:, j) - (b%even - b%odd)*y%w_dot(:, j)
      middle_rate = (a%even - a%odd)*y%w_dot(:, j) - (a%d_odd - a%d_even)*y%w(:, j)
      y%w(:, j) = (a%even + a%odd)*middle + (b%even + b%odd)*middle_rate
      y%w_dot(:, j) = (a%d_odd + a%d_even)*middle + (b%d_odd + b%d_even)*middle_rate
    end do
    call scale_down(y)
  end subroutine advance_step

  !> Sums the even and odd terms, and derivatives, at x = 1 of the solution with first coefficients (1, 0) or (0, 1).
  subroutine sum_series(which, kappa, drive, wave, terms, sums)
    integer, intent(in) :: which
    real(rk), intent(in) :: kappa(WIDTH), drive(WIDTH), wave(0:ORDER + 3)
    integer, intent(in) :: terms
    type(sums_t), intent(out) :: sums
    real(rk) :: a(WIDTH, -3:ORDER + 1), forced(WIDTH)
    integer :: n, j

    a(:, :-1) = 0
    a(:, 0) = merge(1, 0, which == 1)
    a(:, 1) = merge(0, 1, which == 1)
    do n = 0, ORDER - 1
      forced = 0
      do j = 0, min(n, terms), 4
        forced = forced + wave(j)*a(:, n - j) + wave(j + 1)*a(:, n - j - 1) + wave(j + 2)*a(:, n - j - 2) &
                 + wave(j + 3)*a(:, n - j - 3)
      end do
      a(:, n + 2) = (kappa*a(:, n) + drive*forced)*(1.0_rk/((n + 1)*(n + 2)))
    end do
    do n = ORDER, 0, -2
      sums%even = sums%even + a(:, n)
      sums%d_even = sums%d_even + n*a(:, n)
      sums%odd = sums%odd + a(:, n + 1)
      sums%d_odd = sums%d_odd + (n + 1)*a(:, n + 1)
    end do
  end subroutine sum_series

  !> Scales lanes down before they overflow.
  subroutine scale_down(y)
    type(solutions_t), intent(inout) :: y
    real(rk) :: large(WIDTH), scale(WIDTH)
    integer :: j

    large = max(maxval(abs(y%w), 2), maxval(abs(y%w_dot), 2))
    if (all(large < 2.0_rk**SCALE_BITS)) return
    scale = merge(2.0_rk**(-SCALE_BITS), 1.0_rk, large >= 2.0_rk**SCALE_BITS)
    do j = 1, 2
      y%w(:, j) = y%w(:, j)*scale
      y%w_dot(:, j) = y%w_dot(:, j)*scale
    end do
    y%scalings = y%scalings + merge(1, 0, large >= 2.0_rk**SCALE_BITS)
  end subroutine scale_down

end module kz_kernel_linear
