!> Newton's method on the cycles that many motions come near, each of a pendulum of its own.
module kz_lanes_closing
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: WIDTH, PI
  use kz_mixed_mixed_batch, only: mixed_batch_t, track_t
  use kz_cycles_features, only: centre_of, ELSEWHERE
  use kz_maps_matrices, only: eigenvalues, solved, IDENTITY
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: closed_t, close_motions

  !> Newton steps, last step's size, largest distance (rad), and how near a sooner return must be.
  integer, parameter :: STEPS = 8
  real(dp), parameter :: SHORT = 1e-9_dp, FAR = 1e-2_dp, BACK = 1e-7_dp

  !> The result of following a motion.
  type :: closed_t
    logical :: found = .false.      !< it comes back, and the method found where
    logical :: attracts = .false.
    integer :: period = 0
    integer :: winding = 0
    integer :: centre = ELSEWHERE
    real(dp) :: exponent = 0        !< per drive period
    real(dp) :: distance = 0        !< distance of the motion from the cycle, rad
  end type closed_t

  !> The orbits of all lanes, with what is known after each period.
  type :: orbits_t
    real(dp), allocatable :: u(:, :)            !< lane, periods from 0 on
    real(dp), allocatable :: v(:, :)
    real(dp), allocatable :: matrix(:, :, :, :) !< 2, 2, lane, periods from 1 on
    type(track_t), allocatable :: track(:)      !< tracks of periods from 1 on
    integer, allocatable :: winding(:, :)
  end type orbits_t

contains

  !> Finds the cycles near the present states of the lanes 1 .. n, and begins with the longest period.
  subroutine close_motions(batch, n, period, closed)
    type(mixed_batch_t), intent(inout) :: batch !< pendulums and states
    integer, intent(in) :: n !< lanes in use
    integer, intent(in) :: period(:) !< periods after which the motions come back, descending
    type(closed_t), intent(out) :: closed(:) !< result of each
    type(orbits_t) :: orbits
    real(dp) :: start(2, WIDTH), x(2, WIDTH), step(2)
    integer :: iteration, i

    start(1, :n) = batch%u(:n)
    start(2, :n) = batch%v(:n)
    x(:, :n) = start(:, :n)
    do iteration = 1, STEPS
      call follow(batch, n, period, x, orbits)
      do i = 1, n
        step = solved(orbits%matrix(:, :, i, period(i)), residual(orbits, i, period(i)))
        closed(i)%found = norm2(step) < SHORT
        if (norm2(step) < FAR) x(:, i) = x(:, i) - [step(1)/PI, step(2)]
      end do
      if (all(closed(:n)%found)) exit
    end do
    do i = 1, n
      closed(i)%distance = norm2([PI*angle_difference(x(1, i), start(1, i)), x(2, i) - start(2, i)])
      closed(i)%found = closed(i)%found .and. closed(i)%distance < FAR
      if (closed(i)%found) call describe(batch, orbits, i, period(i), closed(i))
    end do
  end subroutine close_motions

  !> All orbits from x, each through its period.
  subroutine follow(batch, n, period, x, orbits)
    type(mixed_batch_t), intent(inout) :: batch
    integer, intent(in) :: n, period(:)
    real(dp), intent(in) :: x(:, :)
    type(orbits_t), intent(out) :: orbits
    type(track_t) :: track
    real(dp) :: matrix(2, 2, WIDTH)
    integer :: t, lanes, i

    allocate (orbits%u(n, 0:period(1)), orbits%v(n, 0:period(1)), orbits%matrix(2, 2, n, period(1)))
    allocate (orbits%track(period(1)), orbits%winding(n, period(1)))
    do i = 1, n
      call batch%put(i, x(1, i), x(2, i))
      matrix(:, :, i) = IDENTITY
    end do
    orbits%u(:, 0) = x(1, :n)
    orbits%v(:, 0) = x(2, :n)
    do t = 1, period(1)
      lanes = count(period(:n) >= t)
      call batch%advance_tangent(lanes, matrix, track)
      orbits%u(:lanes, t) = batch%u(:lanes)
      orbits%v(:lanes, t) = batch%v(:lanes)
      orbits%matrix(:, :, :lanes, t) = matrix(:, :, :lanes)
      orbits%track(t) = track
      do i = 1, lanes
        orbits%winding(i, t) = int(batch%turns(i)) + nint(0.5_dp*(batch%u(i) - x(1, i)))
      end do
    end do
  end subroutine follow

  !> How far lane i is from its start after some periods: rad, rad per drive radian.
  pure function residual(orbits, i, periods) result(shift)
    type(orbits_t), intent(in) :: orbits
    integer, intent(in) :: i, periods
    real(dp) :: shift(2)

    shift = [PI*angle_difference(orbits%u(i, periods), orbits%u(i, 0)), orbits%v(i, periods) - orbits%v(i, 0)]
  end function residual

  !> Smallest period, winding, exponent and centre of the closed orbit of lane i.
  subroutine describe(batch, orbits, i, period, closed)
    type(mixed_batch_t), intent(in) :: batch
    type(orbits_t), intent(in) :: orbits
    integer, intent(in) :: i, period
    type(closed_t), intent(inout) :: closed
    complex(dp) :: multiplier(2)
    integer :: p

    do p = 1, period - 1
      if (mod(period, p) == 0 .and. norm2(residual(orbits, i, p)) < BACK) exit
    end do
    multiplier = eigenvalues(orbits%matrix(:, :, i, p), product(batch%decay(i, :))**(batch%n_steps*p))
    closed%period = p
    closed%winding = orbits%winding(i, p)
    closed%attracts = abs(multiplier(1)) < 1
    closed%exponent = log(abs(multiplier(1)))/p
    associate (track => orbits%track(p))
      closed%centre = centre_of(closed%winding /= 0, track%total(i)/(p*batch%n_steps), track%lowest(i), &
                                track%highest(i))
    end associate
  end subroutine describe

end module kz_lanes_closing
