!> The series of pendulums along a slider, interpolated from those made before. Its coefficients are polynomials of degree ORDER/2 in all terms
!> of the force, and rational in the damping, with poles at distances l/n from the real axis, l >= 1, n < ORDER. Every key of a pendulum moves
!> it along a curve: as many nodes as the degree and one more give the series on a line of forces but for rounding; fewer, and those of
!> other curves, as well as the distances to the nodes and the pendulum itself tell.
module kz_processed_slider
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, is_same, stiffness, MOST_HARMONICS
  use kz_processed_tables, only: series_t, make_processed_series, ORDER
  implicit none
  private
  public :: make_slid_series

  integer, parameter :: NODES = ORDER/2 + 1
  !> Rounding of the nodes grows by the sum of the weights: 1e-15 becomes 1e-11 at most, which no moving frame sees.
  real(rk), parameter :: HEAVIEST = 1e4_rk
  !> By so much of its force may a pendulum lie beside the curve through the nodes.
  real(rk), parameter :: BESIDE = 1e-10_rk
  !> What interpolation may leave: the product of the distances to the nodes. A step takes a force times less than 1, and a pole is no
  !> nearer than this.
  real(rk), parameter :: REMAINDER = 1e-9_rk, NEAREST_POLE = 1.0_rk/ORDER
  integer, parameter :: N_NUMBERS = 4 + 4*MOST_HARMONICS

  !> Pendulums and their series; the next one that is made takes the place `oldest`.
  type(pendulum_t), save :: place(NODES)
  type(series_t), allocatable, save :: node(:)
  integer, save :: n_nodes = 0, oldest = 1

contains

  !> The series of a pendulum: from its nodes, or where they do not reach made anew, and then it is a node.
  subroutine make_slid_series(pendulum, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(series_t), intent(out) :: series !< what does not depend on the number of steps
    real(rk) :: weight(n_nodes)
    logical :: reach
    integer :: i

    reach = .false.
    if (n_nodes > 0) then
      if (place(1)%harmonics /= pendulum%harmonics .or. place(1)%unmirrored /= pendulum%unmirrored) n_nodes = 0
    end if
    do i = 1, n_nodes
      if (.not. is_same(place(i), pendulum)) cycle
      series = node(i)
      return
    end do
    if (n_nodes > 1) call weigh(pendulum, weight, reach)
    if (reach) then
      call add_nodes(weight, series)
    else
      call make_processed_series(pendulum, series)
      call remember(pendulum, series)
    end if
  end subroutine make_slid_series

  !> Lagrange's weights of the nodes along that number of the pendulum in which they differ most. `reach`: they give its series.
  subroutine weigh(pendulum, weight, reach)
    type(pendulum_t), intent(in) :: pendulum
    real(rk), intent(out) :: weight(n_nodes)
    logical, intent(out) :: reach
    real(rk) :: at(N_NUMBERS, n_nodes), wanted(N_NUMBERS), apart(n_nodes)
    integer :: i, along

    wanted = numbers_of(pendulum)
    do i = 1, n_nodes
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
    if (reach) reach = product(apart) <= REMAINDER .or. (n_nodes == NODES .and. all(abs(at(2, :) - wanted(2)) <= 0))
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

  subroutine add_nodes(weight, series)
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

  subroutine remember(pendulum, series)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series

    if (.not. allocated(node)) allocate (node(NODES))
    if (n_nodes == 0) oldest = 1
    place(oldest) = pendulum
    node(oldest) = series
    n_nodes = min(n_nodes + 1, NODES)
    oldest = mod(oldest, NODES) + 1
  end subroutine remember

end module kz_processed_slider
