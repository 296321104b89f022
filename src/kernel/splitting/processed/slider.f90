!> The series of pendulums that a hand moves, along one key or over the plane of two, interpolated from series that were made before (the
!> nodes). A coefficient of a series is a polynomial of degree ORDER/2 in all terms of the force, and a rational function of the damping, whose
!> poles lie at distances l/n from the real axis, l >= 1 and n < ORDER. In units of RADIUS it is therefore analytic about the pendulum that is
!> wanted, where nodes may lie anywhere: the weights are those that are best for all functions analytic in the unit ball.
module kz_processed_slider
  use, intrinsic :: iso_c_binding, only: c_ptr, c_associated, c_f_pointer
  use, intrinsic :: iso_fortran_env, only: rk => real64, qp => real128
  use kz_vector_locks, only: take_lock, leave_lock
  use kz_model_pendulum, only: pendulum_t, is_same, MOST_HARMONICS
  use kz_processed_tables, only: series_t, kept_series_t, make_processed_series, ORDER, NODES
  implicit none
  private
  public :: make_slid_series

  !> The error of a node, which keeps the weights small.
  real(rk), parameter :: ROUNDING = 1e-13_rk
  !> Of the force and of the damping: a step multiplies forces by less than 1/2, and no pole is nearer than 1/ORDER. (On drags over the plane of
  !> Fig. 12, of lines, circles and leaps, periods were wrong by at most 1.8 times the error that was accepted.)
  real(rk), parameter :: RADIUS(2) = [2.0_rk, 1.0_rk/ORDER]
  !> Nodes that are farther, in units of RADIUS, do not count.
  real(rk), parameter :: FARTHEST = 0.5_rk
  integer, parameter :: N_NUMBERS = 5 + 4*MOST_HARMONICS

contains

  !> The series of a pendulum: interpolated from the nodes, or made and kept as a node.
  subroutine make_slid_series(pendulum, error, handle, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    real(rk), intent(in) :: error !< of the interpolation at most, rad; of a period it may be twice that
    type(c_ptr), intent(in) :: handle !< kz_kept_series of kernel.h, which holds the nodes; null = the series is made
    type(series_t), intent(out) :: series !< what does not depend on the number of steps
    type(kept_series_t), pointer :: kept

    if (c_associated(handle)) then
      call c_f_pointer(handle, kept)
      call take_lock(kept%lock)
      call slide(pendulum, error, handle, kept, series)
      call leave_lock(kept%lock)
    else
      call make_processed_series(pendulum, handle, series)
    end if
  end subroutine make_slid_series

  subroutine slide(pendulum, error, handle, kept, series)
    type(pendulum_t), intent(in) :: pendulum
    real(rk), intent(in) :: error
    type(c_ptr), intent(in) :: handle
    type(kept_series_t), intent(inout) :: kept !< what `handle` points at
    type(series_t), intent(out) :: series
    real(rk) :: weight(NODES)
    logical :: reach
    integer :: i

    if (kept%place(1)%harmonics /= pendulum%harmonics .or. kept%place(1)%unmirrored /= pendulum%unmirrored) kept%n_nodes = 0
    do i = 1, kept%n_nodes
      if (.not. is_same(kept%place(i), pendulum)) cycle
      series = kept%node(i)
      return
    end do
    call weigh(pendulum, error, kept%place(:kept%n_nodes), weight(:kept%n_nodes), reach)
    if (reach) then
      call add_nodes(kept%node(:kept%n_nodes), weight(:kept%n_nodes), series)
    else
      call make_processed_series(pendulum, handle, series)
      call remember(pendulum, series, kept)
    end if
  end subroutine slide

  !> The weights of the nodes with the least error for the pendulum. Functions that are analytic in the unit ball have the kernel 1/(1 - x y) (Drury
  !> and Arveson): of those with norm 1, weights w are wrong by w K w - 2 sum w + 1 at most, squared, which is least where K w = 1. `reach`: that
  !> least error, with the rounding of the nodes, is accepted.
  subroutine weigh(pendulum, error, place, weight, reach)
    type(pendulum_t), intent(in) :: pendulum
    real(rk), intent(in) :: error
    type(pendulum_t), intent(in) :: place(:)
    real(rk), intent(out) :: weight(size(place))
    logical, intent(out) :: reach
    real(qp) :: at(N_NUMBERS, size(place)), best(size(place))
    logical :: varies(N_NUMBERS)
    integer :: near(size(place)), i, n

    n = 0
    do i = 1, size(place)
      at(:, n + 1) = parted(place(i), pendulum)
      if (norm2(real(at(:, n + 1), rk)) > FARTHEST) cycle
      n = n + 1
      near(n) = i
    end do
    varies = any(abs(at(:, :n)) > 0, 2)
    best(:n) = solution(reshape(pack(at(:, :n), spread(varies, 2, n)), [count(varies), n]))
    weight = 0
    weight(near(:n)) = real(best(:n), rk)
    reach = 1 - sum(best(:n)) <= error**2
  end subroutine weigh

  !> The solution of (K + ROUNDING**2) w = 1 by Cholesky's method, in quad precision because errors are squared in it.
  pure function solution(at) result(weight)
    real(qp), intent(in) :: at(:, :) !< nodes, in units of RADIUS from the pendulum that is wanted
    real(qp) :: weight(size(at, 2)), factor(size(at, 2), size(at, 2))
    integer :: i, j

    do j = 1, size(weight)
      do i = j, size(weight)
        factor(i, j) = 1/(1 - dot_product(at(:, i), at(:, j))) - dot_product(factor(i, :j - 1), factor(j, :j - 1))
        if (i == j) factor(j, j) = sqrt(factor(j, j) + real(ROUNDING, qp)**2)
        if (i > j) factor(i, j) = factor(i, j)/factor(j, j)
      end do
      weight(j) = (1 - dot_product(factor(j, :j - 1), weight(:j - 1)))/factor(j, j)
    end do
    do j = size(weight), 1, -1
      weight(j) = (weight(j) - dot_product(factor(j + 1:, j), weight(j + 1:)))/factor(j, j)
    end do
  end function solution

  !> How far one pendulum lies from another, in units of RADIUS.
  pure function parted(one, other) result(distance)
    type(pendulum_t), intent(in) :: one, other
    real(qp) :: distance(N_NUMBERS)

    distance = (real(numbers_of(one), qp) - numbers_of(other))/RADIUS(1)
    distance(2) = distance(2)*(RADIUS(1)/RADIUS(2))
  end function parted

  !> k, the damping, m, and the other numbers of the equation.
  pure function numbers_of(pendulum) result(numbers)
    type(pendulum_t), intent(in) :: pendulum
    real(rk) :: numbers(N_NUMBERS)

    numbers(:5) = [pendulum%k, pendulum%beta, pendulum%m, pendulum%torque, pendulum%torque_amplitude]
    numbers(6:5 + 2*MOST_HARMONICS) = reshape(pendulum%vertical, [2*MOST_HARMONICS])
    numbers(6 + 2*MOST_HARMONICS:) = reshape(pendulum%horizontal, [2*MOST_HARMONICS])
  end function numbers_of

  subroutine add_nodes(node, weight, series)
    type(series_t), intent(in) :: node(:)
    real(rk), intent(in) :: weight(:)
    type(series_t), intent(out) :: series
    integer :: i

    series = node(1)
    series%slope = 0
    series%drift = 0
    series%kick = 0
    series%processor = 0
    do i = 1, size(weight)
      if (.not. abs(weight(i)) > 0) cycle
      series%slope = series%slope + weight(i)*node(i)%slope
      series%drift = series%drift + weight(i)*node(i)%drift
      series%kick(:, :, ::2, :, :) = series%kick(:, :, ::2, :, :) + weight(i)*node(i)%kick(:, :, ::2, :, :)
      series%processor(:, :, ::2, :, :, :) = series%processor(:, :, ::2, :, :, :) + weight(i)*node(i)%processor(:, :, ::2, :, :, :)
    end do
  end subroutine add_nodes

  !> Keeps a series as a node, in place of the farthest one if all places are taken.
  subroutine remember(pendulum, series, kept)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series
    type(kept_series_t), intent(inout) :: kept
    real(rk) :: distance(NODES)
    integer :: i

    if (.not. allocated(kept%node)) allocate (kept%node(NODES))
    i = kept%n_nodes + 1
    if (i > NODES) then
      distance = [(norm2(real(parted(kept%place(i), pendulum), rk)), i=1, NODES)]
      i = maxloc(distance, 1)
    end if
    kept%place(i) = pendulum
    kept%node(i) = series
    kept%n_nodes = max(kept%n_nodes, i)
  end subroutine remember

end module kz_processed_slider
