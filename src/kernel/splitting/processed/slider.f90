!> The series of pendulums along a slider, interpolated from series that were made before (the nodes). A coefficient of a series is a polynomial
!> of degree ORDER/2 in all terms of the force, and a rational function of the damping, whose poles lie at distances l/n from the real axis, l >= 1
!> and n < ORDER. A slider changes one key, so its pendulums lie on a curve in the space of these terms. Where the curve is a line at one
!> damping, degree + 1 nodes determine the series up to rounding. With fewer nodes, on other curves, or along the damping, the series is accepted
!> if two bounds hold: the pendulum itself is interpolated closely enough (BESIDE), and so is its series (REMAINDER).
module kz_processed_slider
  use, intrinsic :: iso_c_binding, only: c_ptr, c_associated, c_f_pointer
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_locks, only: take_lock, leave_lock
  use kz_model_pendulum, only: pendulum_t, is_same, stiffness, MOST_HARMONICS
  use kz_processed_tables, only: series_t, kept_series_t, make_processed_series, ORDER, NODES
  implicit none
  private
  public :: make_slid_series

  !> Rounding of the nodes grows by the sum of the weights: 1e-15 becomes 1e-11 at most, which no moving frame sees.
  real(rk), parameter :: HEAVIEST = 1e4_rk
  !> The largest distance of a pendulum from the curve through the nodes, in units of its force.
  real(rk), parameter :: BESIDE = 1e-10_rk
  !> The largest error of the interpolation: the product of the distances to the nodes, because a step multiplies forces by less than 1 and no
  !> pole is nearer than NEAREST_POLE.
  real(rk), parameter :: REMAINDER = 1e-9_rk, NEAREST_POLE = 1.0_rk/ORDER
  integer, parameter :: N_NUMBERS = 4 + 4*MOST_HARMONICS

contains

  !> The series of a pendulum: interpolated from the nodes, or made and kept as a node.
  subroutine make_slid_series(pendulum, handle, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(c_ptr), intent(in) :: handle !< kz_kept_series of kernel.h, which holds the nodes; null = the series is made
    type(series_t), intent(out) :: series !< what does not depend on the number of steps
    type(kept_series_t), pointer :: kept

    if (c_associated(handle)) then
      call c_f_pointer(handle, kept)
      call take_lock(kept%lock)
      call slide(pendulum, handle, kept, series)
      call leave_lock(kept%lock)
    else
      call make_processed_series(pendulum, handle, series)
    end if
  end subroutine make_slid_series

  subroutine slide(pendulum, handle, kept, series)
    type(pendulum_t), intent(in) :: pendulum
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
    reach = .false.
    if (kept%n_nodes > 1) call weigh(pendulum, kept%place(:kept%n_nodes), weight(:kept%n_nodes), reach)
    if (reach) then
      call add_nodes(kept%node, weight(:kept%n_nodes), series)
    else
      call make_processed_series(pendulum, handle, series)
      call remember(pendulum, series, kept)
    end if
  end subroutine slide

  !> Lagrange's weights of the nodes along the number of the pendulum in which they differ most. `reach`: these weights give its series.
  subroutine weigh(pendulum, place, weight, reach)
    type(pendulum_t), intent(in) :: pendulum
    type(pendulum_t), intent(in) :: place(:)
    real(rk), intent(out) :: weight(size(place))
    logical, intent(out) :: reach
    real(rk) :: at(N_NUMBERS, size(place)), wanted(N_NUMBERS), apart(size(place))
    integer :: i, along

    wanted = numbers_of(pendulum)
    do i = 1, size(place)
      at(:, i) = numbers_of(place(i))
      apart(i) = sum(abs(at(:, i) - wanted)) + abs(at(2, i) - wanted(2))/NEAREST_POLE
    end do
    along = maxloc(maxval(at, 2) - minval(at, 2), 1)
    weight = 0
    reach = are_apart(at(along, :))
    if (.not. reach) return
    weight = lagrange(at(along, :), wanted(along))
    reach = sum(abs(weight)) <= HEAVIEST
    if (reach) reach = all(abs(matmul(at, weight) - wanted) <= BESIDE*(stiffness(pendulum) + pendulum%beta))
    if (reach) reach = product(apart) <= REMAINDER .or. (size(place) == NODES .and. all(abs(at(2, :) - wanted(2)) <= 0))
  end subroutine weigh

  !> k, the damping, m, and the other numbers of the equation.
  pure function numbers_of(pendulum) result(numbers)
    type(pendulum_t), intent(in) :: pendulum
    real(rk) :: numbers(N_NUMBERS)

    numbers(:4) = [pendulum%k, pendulum%beta, pendulum%m, pendulum%torque]
    numbers(5:4 + 2*MOST_HARMONICS) = reshape(pendulum%vertical, [2*MOST_HARMONICS])
    numbers(5 + 2*MOST_HARMONICS:) = reshape(pendulum%horizontal, [2*MOST_HARMONICS])
  end function numbers_of

  !> Whether no two numbers are the same.
  pure logical function are_apart(x)
    real(rk), intent(in) :: x(:)
    integer :: i

    are_apart = .true.
    do i = 2, size(x)
      are_apart = are_apart .and. all(abs(x(:i - 1) - x(i)) > 0)
    end do
  end function are_apart

  pure function lagrange(nodes_at, x) result(weight)
    real(rk), intent(in) :: nodes_at(:), x
    real(rk) :: weight(size(nodes_at))
    integer :: i, j

    weight = 1
    do i = 1, size(nodes_at)
      do j = 1, size(nodes_at)
        if (j /= i) weight(i) = weight(i)*(x - nodes_at(j))/(nodes_at(i) - nodes_at(j))
      end do
    end do
  end function lagrange

  subroutine add_nodes(node, weight, series)
    type(series_t), intent(in) :: node(:)
    real(rk), intent(in) :: weight(:)
    type(series_t), intent(out) :: series
    integer :: i

    series = node(1)
    series%kick = weight(1)*series%kick
    series%slope = weight(1)*series%slope
    series%drift = weight(1)*series%drift
    series%processor = weight(1)*series%processor
    do i = 2, size(weight)
      series%kick = series%kick + weight(i)*node(i)%kick
      series%slope = series%slope + weight(i)*node(i)%slope
      series%drift = series%drift + weight(i)*node(i)%drift
      series%processor = series%processor + weight(i)*node(i)%processor
    end do
  end subroutine add_nodes

  subroutine remember(pendulum, series, kept)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series
    type(kept_series_t), intent(inout) :: kept

    if (.not. allocated(kept%node)) allocate (kept%node(NODES))
    if (kept%n_nodes == 0) kept%oldest = 1
    kept%place(kept%oldest) = pendulum
    kept%node(kept%oldest) = series
    kept%n_nodes = min(kept%n_nodes + 1, NODES)
    kept%oldest = mod(kept%oldest, NODES) + 1
  end subroutine remember

end module kz_processed_slider
