!> The truth: Taylor series in quad precision (real128) for theta'' + beta theta' + (k - m cos t) sin theta = 0.
!>
!> With w = h theta', s = sin theta, c = cos theta over one step t = t0 + h x, 0 <= x <= 1, the scaled coefficients obey
!>   (n+1) w_(n+1) = -beta h w_n - sum_i f_i s_(n-i),  (n+1) s_(n+1) = sum_i c_i w_(n-i),  (n+1) c_(n+1) = -sum_i s_i w_(n-i),
!> where f_i are those of h^2 (k - m cos t). A coefficient of size r needs only its digits above 1e-35: once all are below
!> COARSE, double precision carries the rest of the series. Order and step follow the decay of the series.
module kz_kernel_taylor
  use, intrinsic :: iso_fortran_env, only: real64, real128, int64
  implicit none
  private
  public :: drive_t, make_drive, advance_period, qp

  integer, parameter :: qp = real128
  integer, parameter :: dp = real64
  integer, parameter :: ORDER = 56
  !> No series ends earlier: the first coefficients may vanish one by one (start at rest where k = m).
  integer, parameter :: LOWEST_ORDER = 8
  !> Sizes relative to the motion's own: where doubles are enough, and where the series ends.
  real(qp), parameter :: COARSE = 1e-19_qp
  real(dp), parameter :: TOLERANCE = 1e-36_dp
  !> A motion that needs finer parts of a step than this is not carried: NaN.
  real(dp), parameter :: FINEST = 2.0_dp**(-24)
  real(qp), parameter :: TWO_PI = 2*acos(-1.0_qp)
  integer :: index
  real(qp), parameter :: INVERSE(ORDER) = [(1/real(index, qp), index=1, ORDER)]

  !> A pendulum with the drive's series at the start of every step of a period.
  type :: drive_t
    real(qp) :: k
    real(qp) :: beta
    real(qp) :: m
    integer :: n_steps
    real(qp), allocatable :: force(:, :)
  end type drive_t

  !> The scaled series of one step: quad up to `top`, doubles for every order.
  type :: series_t
    real(qp) :: w(0:ORDER)
    real(qp) :: s(0:ORDER)
    real(qp) :: c(0:ORDER)
    real(dp) :: w_double(0:ORDER)
    real(dp) :: s_double(0:ORDER)
    real(dp) :: c_double(0:ORDER)
    !> Highest order in quad, and of all.
    integer :: top
    integer :: last
  end type series_t

contains

  !> The drive of a pendulum for n_steps steps a period.
  pure function make_drive(k, beta, m, n_steps) result(drive)
    !> 1/Omega^2.
    real(dp), intent(in) :: k
    !> Damping.
    real(dp), intent(in) :: beta
    !> Drive amplitude.
    real(dp), intent(in) :: m
    !> Steps a period where the motion is gentle.
    integer, intent(in) :: n_steps
    type(drive_t) :: drive
    integer :: i

    drive%k = k
    drive%beta = beta
    drive%m = m
    drive%n_steps = n_steps
    allocate (drive%force(0:ORDER - 1, n_steps))
    do i = 1, n_steps
      drive%force(:, i) = force_series(drive, (i - 1)*TWO_PI/n_steps, TWO_PI/n_steps)
    end do
  end function make_drive

  !> Scaled Taylor coefficients of h^2 (k - m cos t) about t0.
  pure function force_series(drive, t0, h) result(force)
    type(drive_t), intent(in) :: drive
    !> Drive time, rad.
    real(qp), intent(in) :: t0
    !> Step, rad.
    real(qp), intent(in) :: h
    real(qp) :: force(0:ORDER - 1)
    real(qp) :: cycle(0:3), scale
    integer :: i

    cycle = [cos(t0), -sin(t0), -cos(t0), sin(t0)]
    scale = h*h*drive%m
    do i = 0, ORDER - 1
      force(i) = -scale*cycle(mod(i, 4))
      scale = scale*h*INVERSE(i + 1)
    end do
    force(0) = force(0) + h*h*drive%k
  end function force_series

  !> One whole drive period from t = 0; theta comes back wrapped. NaN where the motion is too fast to be carried.
  pure subroutine advance_period(drive, theta, velocity, turns)
    type(drive_t), intent(in) :: drive
    !> Angle, rad.
    real(qp), intent(inout) :: theta
    !> Velocity, rad per drive radian.
    real(qp), intent(inout) :: velocity
    !> Gains the net number of turns.
    integer(int64), intent(inout) :: turns
    real(qp) :: s, c
    real(dp) :: part
    integer :: i

    s = sin(theta)
    c = cos(theta)
    part = 1
    do i = 1, drive%n_steps
      call take_step(drive, i, part, theta, velocity, s, c)
      part = min(1.0_dp, 2*part)
    end do
    if (abs(theta) > TWO_PI/2) then
      turns = turns + nint(theta/TWO_PI, int64)
      theta = theta - TWO_PI*anint(theta/TWO_PI)
    end if
  end subroutine advance_period

  !> One step of the period, in parts that are halved until the series converges on them.
  pure subroutine take_step(drive, i, part, theta, velocity, s, c)
    type(drive_t), intent(in) :: drive
    !> Which step, from 1.
    integer, intent(in) :: i
    !> Part of a step to try first; comes back as the part that went well.
    real(dp), intent(inout) :: part
    real(qp), intent(inout) :: theta
    real(qp), intent(inout) :: velocity
    real(qp), intent(inout) :: s
    real(qp), intent(inout) :: c
    type(series_t) :: series
    real(qp) :: step, h
    real(dp) :: done
    logical :: converged

    step = TWO_PI/drive%n_steps
    done = 0
    do while (done < 1)
      h = step*part
      if (part < 1) then
        call expand(force_series(drive, (i - 1 + done)*step, h), drive%beta*h, velocity*h, s, c, series, converged)
      else
        call expand(drive%force(:, i), drive%beta*h, velocity*h, s, c, series, converged)
      end if
      if (converged) then
        call add_up(series, h, theta, velocity, s, c)
        done = done + part
      else
        part = part/2
        if (part < FINEST) exit
      end if
    end do
    if (done < 1) theta = (theta - theta)/(s - s)
    if (done < 1) velocity = theta
  end subroutine take_step

  !> The series of one step; converged = false where ORDER is not enough for it.
  pure subroutine expand(force, damping, w, s, c, series, converged)
    !> Series of h^2 (k - m cos t).
    real(qp), intent(in) :: force(0:ORDER - 1)
    !> beta h.
    real(qp), intent(in) :: damping
    !> h theta' at the start.
    real(qp), intent(in) :: w
    real(qp), intent(in) :: s
    real(qp), intent(in) :: c
    type(series_t), intent(inout) :: series
    logical, intent(out) :: converged
    real(dp) :: force_double(0:ORDER - 1), damping_double, scale, size, previous
    integer :: n

    series%w(0) = w
    series%s(0) = s
    series%c(0) = c
    series%top = ORDER
    call round_order(series, 0)
    force_double = real(force, dp)
    damping_double = real(damping, dp)
    scale = max(abs(series%w_double(0)), abs(series%s_double(0)))
    size = scale
    converged = .false.
    do n = 0, ORDER - 1
      previous = size
      if (n < series%top) then
        call next_quad(series, n, force, damping)
        call round_order(series, n + 1)
      else
        call next_double(series, n, force_double, damping_double)
      end if
      size = max(abs(series%w_double(n + 1)), abs(series%s_double(n + 1)), abs(series%c_double(n + 1)))
      scale = max(scale, size)
      if (n + 1 < LOWEST_ORDER) cycle
      if (series%top == ORDER .and. max(size, previous) <= COARSE*scale) series%top = n + 1
      converged = max(size, previous) <= TOLERANCE*scale
      if (converged) exit
    end do
    series%last = min(n + 1, ORDER)
    series%top = min(series%top, series%last)
  end subroutine expand

  !> Order n + 1 of the series from the orders up to n, in quad precision.
  pure subroutine next_quad(series, n, force, damping)
    type(series_t), intent(inout) :: series
    integer, intent(in) :: n
    real(qp), intent(in) :: force(0:ORDER - 1)
    real(qp), intent(in) :: damping
    real(qp) :: of_w, of_s, of_c
    integer :: i

    of_w = damping*series%w(n)
    of_s = 0
    of_c = 0
    do i = 0, n
      of_w = of_w + force(i)*series%s(n - i)
      of_s = of_s + series%c(i)*series%w(n - i)
      of_c = of_c + series%s(i)*series%w(n - i)
    end do
    series%w(n + 1) = -of_w*INVERSE(n + 1)
    series%s(n + 1) = of_s*INVERSE(n + 1)
    series%c(n + 1) = -of_c*INVERSE(n + 1)
  end subroutine next_quad

  !> The same in double precision.
  pure subroutine next_double(series, n, force, damping)
    type(series_t), intent(inout) :: series
    integer, intent(in) :: n
    real(dp), intent(in) :: force(0:ORDER - 1)
    real(dp), intent(in) :: damping
    real(dp) :: of_w, of_s, of_c
    integer :: i

    of_w = damping*series%w_double(n)
    of_s = 0
    of_c = 0
    do i = 0, n
      of_w = of_w + force(i)*series%s_double(n - i)
      of_s = of_s + series%c_double(i)*series%w_double(n - i)
      of_c = of_c + series%s_double(i)*series%w_double(n - i)
    end do
    series%w_double(n + 1) = -of_w/(n + 1)
    series%s_double(n + 1) = of_s/(n + 1)
    series%c_double(n + 1) = -of_c/(n + 1)
  end subroutine next_double

  pure subroutine round_order(series, n)
    type(series_t), intent(inout) :: series
    integer, intent(in) :: n

    series%w_double(n) = real(series%w(n), dp)
    series%s_double(n) = real(series%s(n), dp)
    series%c_double(n) = real(series%c(n), dp)
  end subroutine round_order

  !> The state at the end of the step: every series summed, smallest terms first.
  pure subroutine add_up(series, h, theta, velocity, s, c)
    type(series_t), intent(in) :: series
    !> Step, rad.
    real(qp), intent(in) :: h
    real(qp), intent(inout) :: theta
    real(qp), intent(out) :: velocity
    real(qp), intent(out) :: s
    real(qp), intent(out) :: c
    real(dp) :: rest(4)
    real(qp) :: total(4)
    integer :: n

    rest = 0
    do n = series%last, series%top + 1, -1
      rest = rest + [series%w_double(n)/(n + 1), series%w_double(n), series%s_double(n), series%c_double(n)]
    end do
    total = rest
    do n = series%top, 0, -1
      total(1) = total(1) + series%w(n)*INVERSE(n + 1)
      total(2) = total(2) + series%w(n)
      total(3) = total(3) + series%s(n)
      total(4) = total(4) + series%c(n)
    end do
    theta = theta + total(1)
    velocity = total(2)/h
    s = total(3)
    c = total(4)
  end subroutine add_up

end module kz_kernel_taylor
