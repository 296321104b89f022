!> Taylor series of one step for a few orbits at once: the inner loops of the quad-precision reference.
!>
!> With w = h theta', s = sin theta, c = cos theta over t = t0 + h x, 0 <= x <= 1, the scaled coefficients obey
!>   (n+1) w_(n+1) = -beta h w_n - sum_i (f_i s_(n-i) + g_i c_(n-i)) (+ h^2 torque at n = 0),  (n+1) s_(n+1) = sum_i c_i w_(n-i),  (n+1) c_(n+1) = -sum_i s_i w_(n-i),
!> where f_i are those of h^2 a(t), g_i those of -h^2 b(t) (kz_model_pendulum). Real128 is not done by hardware, so the orders up to FINE are pairs of doubles
!> (32 digits; products by Dekker 1971: this file must be compiled without contraction); the orders beyond, smaller than
!> 1e-16 of the motion, need 16 digits and are plain doubles. Orders are fixed and lanes never look at each other: a lane's
!> result does not depend on its neighbours.
module kz_extended_series
  use, intrinsic :: iso_fortran_env, only: real64, real128
  implicit none
  private
  public :: LANES, LAST, force_t, series_t, round_series, begin_series, expand, sums, converged

  integer, parameter :: dp = real64
  integer, parameter :: qp = real128
  integer, parameter :: LANES = 8
  !> Highest order in pairs, and of all.
  integer, parameter :: FINE = 28
  integer, parameter :: LAST = 56
  !> Largest coefficients at FINE and at LAST, relative to the motion's own size.
  real(dp), parameter :: COARSE = 1e-16_dp
  real(dp), parameter :: TOLERANCE = 1e-33_dp
  real(dp), parameter :: HALVES = 2.0_dp**27 + 1
  integer :: index
  real(qp), parameter :: INVERSE(LAST + 1) = [(1/real(index, qp), index=1, LAST + 1)]
  real(dp), parameter :: INVERSE_HIGH(LAST + 1) = real(INVERSE, dp)
  real(dp), parameter :: INVERSE_LOW(LAST + 1) = real(INVERSE - real(INVERSE_HIGH, qp), dp)

  !> Highest power of time in a changing damping.
  integer, parameter :: RAMP = 3
  real(dp), parameter :: ONES(LAST) = 1
  real(dp), parameter :: NOUGHTS(LAST) = 0

  !> A number is high + low; top holds the upper half of the digits of high.
  type :: coefficients_t
    real(dp) :: high(LANES, 0:LAST)
    real(dp) :: low(LANES, 0:FINE)
    real(dp) :: top(LANES, 0:FINE)
  end type coefficients_t

  !> A series that is the same for all lanes.
  type :: shared_t
    real(dp) :: high(0:LAST - 1)
    real(dp) :: low(0:LAST - 1)
    real(dp) :: top(0:LAST - 1)
  end type shared_t

  !> The force over a step.
  type :: force_t
    type(shared_t) :: along  !< f: times sin theta
    type(shared_t) :: across !< g: times cos theta
    real(qp) :: torque = 0   !< h^2 torque
    logical :: has_across    !< whether there are g and torque
    logical :: has_ramp = .false. !< whether the damping changes:
    type(shared_t) :: damping !< beta h, order by order up to RAMP
    real(qp) :: constant_damping = 0 !< its order 0
  end type force_t

  type :: series_t
    type(coefficients_t) :: w
    type(coefficients_t) :: s
    type(coefficients_t) :: c
  end type series_t

contains

  !> A series as pairs.
  pure function round_series(series) result(rounded)
    !> coefficients, order by order
    real(qp), intent(in) :: series(0:LAST - 1)
    type(shared_t) :: rounded

    rounded%high = real(series, dp)
    rounded%low = real(series - rounded%high, dp)
    rounded%top = upper_half(rounded%high)
  end function round_series

  !> Order 0.
  pure subroutine begin_series(series, w, s, c)
    !> takes the lowest order; theta and h theta' are there
    type(series_t), intent(inout) :: series
    !> h theta' at the start of the step.
    real(qp), intent(in) :: w(LANES)
    !> sin theta
    real(qp), intent(in) :: s(LANES)
    !> cos theta
    real(qp), intent(in) :: c(LANES)

    call begin_one(series%w, w)
    call begin_one(series%s, s)
    call begin_one(series%c, c)
  end subroutine begin_series

  pure subroutine begin_one(x, start)
    type(coefficients_t), intent(inout) :: x
    real(qp), intent(in) :: start(LANES)

    x%high(:, 0) = real(start, dp)
    x%low(:, 0) = real(start - x%high(:, 0), dp)
    x%top(:, 0) = upper_half(x%high(:, 0))
  end subroutine begin_one

  !> All orders from order 0.
  pure subroutine expand(series, force, damping)
    !> its lowest order, in; all orders, out
    type(series_t), intent(inout) :: series
    !> over the step
    type(force_t), intent(in) :: force
    !> beta h.
    real(qp), intent(in) :: damping
    real(dp) :: damping_high, damping_low
    integer :: n

    damping_high = real(damping, dp)
    damping_low = real(damping - damping_high, dp)
    do n = 0, FINE - 1
      call next_pair(n, force, damping_high, damping_low, series%w, series%s, series%c)
    end do
    do n = FINE, LAST - 1
      call next_double(n, force, damping_high, series%w%high, series%s%high, series%c%high)
    end do
  end subroutine expand

  !> Order n + 1 from the orders up to n, in pairs.
  pure subroutine next_pair(n, force, damping_high, damping_low, w, s, c)
    integer, intent(in) :: n
    type(force_t), intent(in) :: force
    real(dp), intent(in) :: damping_high
    real(dp), intent(in) :: damping_low
    type(coefficients_t), intent(inout) :: w
    type(coefficients_t), intent(inout) :: s
    type(coefficients_t), intent(inout) :: c
    real(dp), dimension(LANES) :: w_high, w_low, s_high, s_low, c_high, c_low
    integer :: i, j, lane

    w_high = 0
    w_low = 0
    s_high = 0
    s_low = 0
    c_high = 0
    c_low = 0
    do lane = 1, LANES
      call add_product(damping_high, damping_low, upper_half(damping_high), &
                       w%high(lane, n), w%low(lane, n), w%top(lane, n), w_high(lane), w_low(lane))
    end do
    do i = 0, n
      j = n - i
      do lane = 1, LANES
        call add_product(force%along%high(i), force%along%low(i), force%along%top(i), &
                         s%high(lane, j), s%low(lane, j), s%top(lane, j), w_high(lane), w_low(lane))
        call add_product(c%high(lane, i), c%low(lane, i), c%top(lane, i), &
                         w%high(lane, j), w%low(lane, j), w%top(lane, j), s_high(lane), s_low(lane))
        call add_product(s%high(lane, i), s%low(lane, i), s%top(lane, i), &
                         w%high(lane, j), w%low(lane, j), w%top(lane, j), c_high(lane), c_low(lane))
      end do
    end do
    if (force%has_across) call add_across(n, force, c, w_high, w_low)
    if (force%has_ramp) call add_ramp(n, force, w, w_high, w_low)
    call set_order(w, n + 1, -w_high, -w_low)
    call set_order(s, n + 1, s_high, s_low)
    call set_order(c, n + 1, -c_high, -c_low)
  end subroutine next_pair

  !> sum += sum_i g_i c_(n-i), and minus the torque.
  pure subroutine add_across(n, force, c, sum_high, sum_low)
    integer, intent(in) :: n
    type(force_t), intent(in) :: force
    type(coefficients_t), intent(in) :: c
    real(dp), intent(inout) :: sum_high(LANES)
    real(dp), intent(inout) :: sum_low(LANES)
    real(dp) :: high
    integer :: i

    do i = 0, n
      call add_product(force%across%high(i), force%across%low(i), force%across%top(i), &
                       c%high(:, n - i), c%low(:, n - i), c%top(:, n - i), sum_high, sum_low)
    end do
    if (n > 0) return
    high = real(force%torque, dp)
    call add_product(-high, -real(force%torque - high, dp), -upper_half(high), 1.0_dp, 0.0_dp, 1.0_dp, sum_high, sum_low)
  end subroutine add_across

  !> sum += what the change of the damping adds.
  pure subroutine add_ramp(n, force, w, sum_high, sum_low)
    integer, intent(in) :: n
    type(force_t), intent(in) :: force
    type(coefficients_t), intent(in) :: w
    real(dp), intent(inout) :: sum_high(LANES)
    real(dp), intent(inout) :: sum_low(LANES)
    integer :: i

    do i = 1, min(n, RAMP)
      call add_product(force%damping%high(i), force%damping%low(i), force%damping%top(i), &
                       w%high(:, n - i), w%low(:, n - i), w%top(:, n - i), sum_high, sum_low)
    end do
  end subroutine add_ramp

  !> x_n = (high + low) / n.
  pure subroutine set_order(x, n, high, low)
    type(coefficients_t), intent(inout) :: x
    integer, intent(in) :: n
    real(dp), intent(in) :: high(LANES)
    real(dp), intent(in) :: low(LANES)
    real(dp) :: a, b
    integer :: lane

    do lane = 1, LANES
      a = 0
      b = 0
      call add_product(high(lane), low(lane), upper_half(high(lane)), &
                       INVERSE_HIGH(n), INVERSE_LOW(n), upper_half(INVERSE_HIGH(n)), a, b)
      x%high(lane, n) = a + b
      x%low(lane, n) = b - (x%high(lane, n) - a)
      x%top(lane, n) = upper_half(x%high(lane, n))
    end do
  end subroutine set_order

  !> Order n + 1 in doubles.
  pure subroutine next_double(n, force, damping, w, s, c)
    integer, intent(in) :: n
    type(force_t), intent(in) :: force
    real(dp), intent(in) :: damping
    real(dp), intent(inout) :: w(LANES, 0:LAST)
    real(dp), intent(inout) :: s(LANES, 0:LAST)
    real(dp), intent(inout) :: c(LANES, 0:LAST)
    real(dp), dimension(LANES) :: of_w, of_s, of_c
    integer :: i

    of_w = damping*w(:, n)
    of_s = 0
    of_c = 0
    do i = 0, n
      of_w = of_w + force%along%high(i)*s(:, n - i)
      of_s = of_s + c(:, i)*w(:, n - i)
      of_c = of_c + s(:, i)*w(:, n - i)
    end do
    if (force%has_across) then
      do i = 0, n
        of_w = of_w + force%across%high(i)*c(:, n - i)
      end do
    end if
    if (force%has_ramp) of_w = of_w + matmul(w(:, n - 1:n - RAMP:-1), force%damping%high(1:RAMP))
    w(:, n + 1) = -of_w/(n + 1)
    s(:, n + 1) = of_s/(n + 1)
    c(:, n + 1) = -of_c/(n + 1)
  end subroutine next_double

  !> The changes over the step: of theta beyond w_0, of w, s and c. Smallest terms first.
  pure subroutine sums(series, theta, w, s, c)
    !> all orders
    type(series_t), intent(in) :: series
    !> change of theta beyond w_0, rad
    real(qp), intent(out) :: theta(LANES)
    !> change of h theta'
    real(qp), intent(out) :: w(LANES)
    !> change of sin theta
    real(qp), intent(out) :: s(LANES)
    !> change of cos theta
    real(qp), intent(out) :: c(LANES)

    theta = sum_of(series%w, INVERSE_HIGH(2:), INVERSE_LOW(2:))
    w = sum_of(series%w, ONES, NOUGHTS)
    s = sum_of(series%s, ONES, NOUGHTS)
    c = sum_of(series%c, ONES, NOUGHTS)
  end subroutine sums

  !> Sum over the orders n >= 1 of x_n times a weight.
  pure function sum_of(x, weight_high, weight_low) result(total)
    type(coefficients_t), intent(in) :: x
    real(dp), intent(in) :: weight_high(LAST)
    real(dp), intent(in) :: weight_low(LAST)
    real(qp) :: total(LANES)
    real(dp), dimension(LANES) :: high, low
    integer :: n, lane

    high = 0
    do n = LAST, FINE + 1, -1
      high = high + weight_high(n)*x%high(:, n)
    end do
    low = 0
    do n = FINE, 1, -1
      do lane = 1, LANES
        call add_product(weight_high(n), weight_low(n), upper_half(weight_high(n)), &
                         x%high(lane, n), x%low(lane, n), x%top(lane, n), high(lane), low(lane))
      end do
    end do
    total = real(high, qp) + low
  end function sum_of

  !> Which lanes' series are complete at LAST, and small enough at FINE for what follows.
  pure function converged(series) result(well)
    !> all orders
    type(series_t), intent(in) :: series
    logical :: well(LANES)
    real(dp) :: motion
    integer :: lane

    do lane = 1, LANES
      motion = max(maxval(abs(series%w%high(lane, 0:4))), maxval(abs(series%s%high(lane, 0:4))))
      well(lane) = small(series, lane, FINE, COARSE*motion) .and. small(series, lane, LAST, TOLERANCE*motion)
    end do
  end function converged

  !> Neighbours too, for a coefficient may vanish by chance or by symmetry.
  pure function small(series, lane, n, bound) result(yes)
    type(series_t), intent(in) :: series
    integer, intent(in) :: lane
    integer, intent(in) :: n
    real(dp), intent(in) :: bound
    logical :: yes

    yes = all(abs(series%w%high(lane, n - 2:n)) <= bound) .and. all(abs(series%s%high(lane, n - 2:n)) <= bound) &
          .and. all(abs(series%c%high(lane, n - 2:n)) <= bound)
  end function small

  !> sum = sum + a b in pairs (the sum's low part is not carried up).
  elemental subroutine add_product(a_high, a_low, a_top, b_high, b_low, b_top, sum_high, sum_low)
    real(dp), intent(in) :: a_high
    real(dp), intent(in) :: a_low
    real(dp), intent(in) :: a_top
    real(dp), intent(in) :: b_high
    real(dp), intent(in) :: b_low
    real(dp), intent(in) :: b_top
    real(dp), intent(inout) :: sum_high
    real(dp), intent(inout) :: sum_low
    real(dp) :: product, rest, total, back

    product = a_high*b_high
    rest = ((a_top*b_top - product) + a_top*(b_high - b_top) + (a_high - a_top)*b_top) + (a_high - a_top)*(b_high - b_top)
    rest = rest + (a_high*b_low + a_low*b_high)
    total = sum_high + product
    back = total - sum_high
    sum_low = sum_low + (((sum_high - (total - back)) + (product - back)) + rest)
    sum_high = total
  end subroutine add_product

  !> The upper 26 bits of a double.
  elemental function upper_half(x) result(top)
    real(dp), intent(in) :: x
    real(dp) :: top
    real(dp) :: large

    large = HALVES*x
    top = large - (large - x)
  end function upper_half

end module kz_extended_series
