!> The series of pendulums along a slider, k or m: its coefficients are polynomials of degree ORDER/2 in either, so that as many nodes and
!> one more give them for every value, but for rounding.
module kz_processed_slider
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_model_pendulum, only: pendulum_t, is_same
  use kz_processed_tables, only: series_t, make_processed_series, ORDER
  implicit none
  private
  public :: make_slid_series

  integer, parameter :: NODES = ORDER/2 + 1
  !> Rounding of the nodes grows by the sum of the weights: 1e-15 becomes 1e-11 at most, which no moving frame sees.
  real(rk), parameter :: HEAVIEST = 1e4_rk

  !> Pendulums that differ in k alone, or in m alone, and their series; the next one that is made takes the place `oldest`.
  type(pendulum_t), save :: place(NODES)
  type(series_t), allocatable, save :: node(:)
  integer, save :: n_nodes = 0, oldest = 1

contains

  !> The series of a pendulum: from its nodes, or where they do not reach made anew, and then it is a node.
  subroutine make_slid_series(pendulum, series)
    !> k, beta, m
    type(pendulum_t), intent(in) :: pendulum
    !> what does not depend on the number of steps
    type(series_t), intent(out) :: series
    real(rk) :: weight(NODES)
    integer :: i

    if (.not. on_the_line(pendulum)) n_nodes = 0
    do i = 1, n_nodes
      if (.not. is_same(place(i), pendulum)) cycle
      series = node(i)
      return
    end do
    if (n_nodes == NODES) then
      weight = weights(position(place, pendulum), position(pendulum, place(1)))
      if (sum(abs(weight)) <= HEAVIEST) then
        call add_nodes(weight, series)
        return
      end if
    end if
    call make_processed_series(pendulum, series)
    call remember(pendulum, series)
  end subroutine make_slid_series

  !> Whether the pendulum and all nodes differ in one of k and m alone.
  function on_the_line(pendulum) result(there)
    type(pendulum_t), intent(in) :: pendulum
    logical :: there
    type(pendulum_t) :: moved
    integer :: i
    logical :: by_k, by_m

    by_k = .true.
    by_m = .true.
    do i = 1, n_nodes
      moved = place(i)
      moved%k = pendulum%k
      by_k = by_k .and. is_same(moved, pendulum)
      moved = place(i)
      moved%m = pendulum%m
      by_m = by_m .and. is_same(moved, pendulum)
    end do
    there = by_k .or. by_m
  end function on_the_line

  !> Where a pendulum lies along the line that it shares with another one; only one of the two terms varies there.
  elemental function position(pendulum, other) result(x)
    type(pendulum_t), intent(in) :: pendulum
    type(pendulum_t), intent(in) :: other
    real(rk) :: x

    x = merge(pendulum%k, pendulum%m, abs(pendulum%k - other%k) > 0)
  end function position

  !> Lagrange's weights at x.
  pure function weights(nodes_at, x) result(weight)
    real(rk), intent(in) :: nodes_at(NODES)
    real(rk), intent(in) :: x
    real(rk) :: weight(NODES)
    integer :: i, j

    weight = 1
    do i = 1, NODES
      do j = 1, NODES
        if (j /= i) weight(i) = weight(i)*(x - nodes_at(j))/(nodes_at(i) - nodes_at(j))
      end do
    end do
  end function weights

  subroutine add_nodes(weight, series)
    real(rk), intent(in) :: weight(NODES)
    type(series_t), intent(out) :: series
    integer :: i

    series = node(1)
    call multiply(series, weight(1))
    do i = 2, NODES
      series%kick_cosine = series%kick_cosine + weight(i)*node(i)%kick_cosine
      series%kick_sine = series%kick_sine + weight(i)*node(i)%kick_sine
      series%slope = series%slope + weight(i)*node(i)%slope
      series%drift = series%drift + weight(i)*node(i)%drift
      series%to_kernel = series%to_kernel + weight(i)*node(i)%to_kernel
      series%from_kernel = series%from_kernel + weight(i)*node(i)%from_kernel
      series%residual = max(series%residual, node(i)%residual)
    end do
  end subroutine add_nodes

  subroutine multiply(series, weight)
    type(series_t), intent(inout) :: series
    real(rk), intent(in) :: weight

    series%kick_cosine = weight*series%kick_cosine
    series%kick_sine = weight*series%kick_sine
    series%slope = weight*series%slope
    series%drift = weight*series%drift
    series%to_kernel = weight*series%to_kernel
    series%from_kernel = weight*series%from_kernel
  end subroutine multiply

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
