!> One drive period of the processed splitting as a table of drifts and kicks, and its processor, in quad precision; lanes of
!> doubles round them. Derivation: docs/theory.md, "The processed splitting".
module kz_processed_tables
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: real64, real128
  use kz_processed_series_r64, only: series_r64_t => series_t, make_series_r64 => make_series
  use kz_processed_series_r128, only: series_t, make_series, ORDER, HARMONICS
  use kz_model_pendulum, only: pendulum_t, exact_stiffness
  implicit none
  private
  public :: series_t, processed_t, processor_t, make_processed_series, make_processed, ORDER, HARMONICS

  integer, parameter :: qp = real128
  real(qp), parameter :: PI = 3.14159265358979323846264338327950288_qp
  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use in double precision.
  integer, parameter, public :: MOST_DRIFTS = 4, MOST_KICKS = 11
  !> The same in pairs of doubles.
  integer, parameter, public :: MOST_PAIR_DRIFTS = ORDER/2 - 1, MOST_PAIR_KICKS = 22
  !> The velocity is carried as v exp(beta t) through a period: more damping than this would overflow.
  real(qp), parameter, public :: MOST_DAMPING = 16/(2*PI)

  !> A displacement of theta (half-turns) and v (rad per drive radian): sum over n and j of v**n times sin(pi j u) (n even) or
  !> cos(pi j u) (n odd).
  type :: processor_t
    real(qp) :: theta(0:HARMONICS, 0:ORDER) = 0
    real(qp) :: velocity(0:HARMONICS, 0:ORDER) = 0
  end type processor_t

  !> Stage s: u += v (d1 + d3 v**2 + ..), then v -= r (1 - r**2)(c1 + c2 r**2 + ..) with r = u reduced to [-1, 1]; row(:, s) holds
  !> d1, d3, .., c1, c2, .. . After the last stage u += v (last(1) + last(2) v**2 + ..), v *= decay.
  type :: processed_t
    integer :: n_steps
    integer :: n_drift
    integer :: n_kick
    real(qp), allocatable :: row(:, :)
    real(qp), allocatable :: last(:)
    real(qp) :: decay
    type(processor_t) :: enter
    type(processor_t) :: leave
  end type processed_t

contains

  !> The series of a pendulum: grades up to `quad_grades` in quad precision (all of them: a second), those beyond in double, right to
  !> 1e-15 of the force itself. Grade q of a step h counts h**q, so little precision is enough for high ones.
  subroutine make_processed_series(pendulum, quad_grades, series)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    !> even, at most ORDER; 0 = none
    integer, intent(in) :: quad_grades
    !> what does not depend on the number of steps
    type(series_t), intent(out) :: series
    type(series_r64_t), allocatable :: rounded
    type(series_t), allocatable :: exact

    allocate (rounded)
    call make_series_r64(pendulum%k, pendulum%beta, pendulum%m, ORDER, rounded)
    series%kick_cosine = rounded%kick_cosine
    series%kick_sine = rounded%kick_sine
    series%drift = rounded%drift
    series%enter = rounded%enter
    series%leave = rounded%leave
    series%residual = rounded%residual
    if (quad_grades == 0) return
    allocate (exact)
    call make_series(real(pendulum%k, qp), real(pendulum%beta, qp), real(pendulum%m, qp), quad_grades, exact)
    series%kick_cosine(:, :, :quad_grades) = exact%kick_cosine(:, :, :quad_grades)
    series%kick_sine(:, :, :quad_grades) = exact%kick_sine(:, :, :quad_grades)
    series%drift(:, :quad_grades) = exact%drift(:, :quad_grades)
    series%enter(:, :, :quad_grades - 2, :) = exact%enter(:, :, :quad_grades - 2, :)
    series%leave(:, :, :quad_grades - 2, :) = exact%leave(:, :, :quad_grades - 2, :)
  end subroutine make_processed_series

  !> The tables of one period of n_steps steps: n_drift powers of the velocity in a drift, n_kick coefficients of a kick.
  subroutine make_processed(pendulum, series, n_steps, n_drift, n_kick, fastest, table)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    !> the series of the pendulum
    type(series_t), intent(in) :: series
    !> steps a period
    integer, intent(in) :: n_steps
    !> powers of the velocity in a drift
    integer, intent(in) :: n_drift
    !> coefficients of a kick
    integer, intent(in) :: n_kick
    !> rad per drive radian; the drift is fitted up to it
    real(c_double), intent(in) :: fastest
    !> the tables of one period
    type(processed_t), intent(out) :: table
    real(qp) :: h, beta, harmonics(HARMONICS, n_kick), drift(n_drift), time
    integer :: s, i

    h = 2*PI/n_steps
    beta = pendulum%beta
    table%n_steps = n_steps
    table%n_drift = n_drift
    table%n_kick = n_kick
    table%decay = exp(-2*PI*beta)
    allocate (table%row(n_drift + n_kick, n_steps), table%last(n_drift))
    harmonics = harmonic_polynomials(n_kick)
    drift = fitted_drift(series, h, fastest + exact_stiffness(pendulum), n_drift)
    do s = 0, n_steps
      time = (s - merge(0.0_qp, 0.5_qp, s == 0))*h
      do i = 1, n_drift
        table%last(i) = drift(i)/PI*exp(-(2*i - 1)*beta*time) &
                        *decayed(beta*(2*i - 1), merge(0.5_qp, 1.0_qp, s == 0 .or. s == n_steps)*h)
      end do
      if (s == n_steps) exit
      table%row(:n_drift, s + 1) = table%last
      time = (s + 0.5_qp)*h
      table%row(n_drift + 1:, s + 1) = exp(beta*time)*matmul(kick_harmonics(series, h, time), harmonics)
    end do
    call set_processor(series%enter, h, table%enter)
    call set_processor(series%leave, h, table%leave)
  end subroutine make_processed

  !> Integral of exp(-rate t) over a time.
  pure function decayed(rate, time) result(integral)
    real(qp), intent(in) :: rate
    real(qp), intent(in) :: time
    real(qp) :: integral
    integer :: i

    if (rate*time > 1) then
      integral = (1 - exp(-rate*time))/rate
      return
    end if
    integral = 1
    do i = 32, 2, -1
      integral = 1 - integral*rate*time/i
    end do
    integral = integral*time
  end function decayed

  !> What a kick at a time takes from the velocity: sum over j of these times sin(j theta).
  pure function kick_harmonics(series, h, time) result(kick)
    type(series_t), intent(in) :: series
    real(qp), intent(in) :: h
    real(qp), intent(in) :: time
    real(qp) :: kick(HARMONICS)
    real(qp) :: cosine(0:HARMONICS), sine(0:HARMONICS)
    integer :: q, j, l

    cosine(0) = 1
    sine(0) = 0
    cosine(1) = cos(time)
    sine(1) = sin(time)
    do l = 2, HARMONICS
      cosine(l) = cosine(l - 1)*cosine(1) - sine(l - 1)*sine(1)
      sine(l) = sine(l - 1)*cosine(1) + cosine(l - 1)*sine(1)
    end do
    kick = 0
    do q = 2, ORDER, 2
      do j = 1, q/2
        kick(j) = kick(j) - h**(q - 1)*j*(dot_product(cosine(:q/2), series%kick_cosine(:q/2, j, q)) + &
                                          dot_product(sine(:q/2), series%kick_sine(:q/2, j, q)))
      end do
    end do
  end function kick_harmonics

  !> sin(pi j r)/(r (1 - r**2)) as polynomials in r**2 of n coefficients, interpolated at the Chebyshev nodes of [0, 1]: the
  !> kick is 0 at the two rest positions, exactly.
  pure function harmonic_polynomials(n) result(polynomial)
    integer, intent(in) :: n
    real(qp) :: polynomial(HARMONICS, n)
    real(qp) :: node(n), difference(n), root
    integer :: i, j, k

    node = [(0.5_qp*(1 + cos(PI*(2*i - 1)/(2*n))), i=1, n)]
    do j = 1, HARMONICS
      do i = 1, n
        root = sqrt(node(i))
        difference(i) = sin(PI*j*root)/(root*(1 - node(i)))
      end do
      do k = 1, n - 1
        difference(k + 1:) = (difference(k + 1:) - difference(k:n - 1))/(node(k + 1:) - node(:n - k))
      end do
      polynomial(j, :) = 0
      do k = n, 1, -1
        polynomial(j, 2:) = polynomial(j, :n - 1) - node(k)*polynomial(j, 2:)
        polynomial(j, 1) = difference(k) - node(k)*polynomial(j, 1)
      end do
    end do
  end function harmonic_polynomials

  !> Coefficients of v, v**3, .. of theta' = v + M'(v), fitted by least squares at Chebyshev nodes up to the fastest velocity.
  pure function fitted_drift(series, h, fastest, n) result(drift)
    type(series_t), intent(in) :: series
    real(qp), intent(in) :: h
    real(qp), intent(in) :: fastest
    integer, intent(in) :: n
    real(qp) :: drift(n)
    integer, parameter :: NODES = 24
    real(qp) :: speed, rest, normal(n, n), right(n), power(n)
    integer :: i, j, q

    normal = 0
    right = 0
    do i = 1, NODES
      speed = fastest*cos(PI*(2*i - 1)/(4*NODES))
      power = [(speed**(2*j - 1)/fastest**(2*j - 1), j=1, n)]
      rest = 0
      do q = 4, ORDER, 2
        rest = rest + h**q*sum([(2*j*series%drift(2*j, q)*speed**(2*j - 1), j=1, q/2 - 1)])
      end do
      rest = rest/h**2
      normal = normal + spread(power, 2, n)*spread(power, 1, n)
      right = right + rest*power
    end do
    call solve(normal, right)
    drift = [(right(j)/fastest**(2*j - 1), j=1, n)]
    drift(1) = drift(1) + 1
  end function fitted_drift

  !> Solves a small positive definite system by elimination.
  pure subroutine solve(matrix, right)
    real(qp), intent(inout) :: matrix(:, :)
    real(qp), intent(inout) :: right(:)
    real(qp) :: share
    integer :: i, j

    do j = 1, size(right)
      do i = j + 1, size(right)
        share = matrix(i, j)/matrix(j, j)
        matrix(i, :) = matrix(i, :) - share*matrix(j, :)
        right(i) = right(i) - share*right(j)
      end do
    end do
    do j = size(right), 1, -1
      right(j) = (right(j) - dot_product(matrix(j, j + 1:), right(j + 1:)))/matrix(j, j)
    end do
  end subroutine solve

  pure subroutine set_processor(map, h, processor)
    real(qp), intent(in) :: map(0:HARMONICS, 0:ORDER, 2:ORDER, 2)
    real(qp), intent(in) :: h
    type(processor_t), intent(out) :: processor
    integer :: q

    do q = 2, ORDER - 2, 2
      processor%theta = processor%theta + h**q*map(:, :, q, 1)/PI
      processor%velocity = processor%velocity + h**q*map(:, :, q, 2)
    end do
  end subroutine set_processor

end module kz_processed_tables
