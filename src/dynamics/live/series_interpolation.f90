!> Interpolates splitting series in one or two parameters, for moving frames, from series made before (the nodes). A
!> coefficient of a series is a polynomial of degree ORDER/2 in all terms of the force, and a rational function of the
!> damping with poles at distances l/n from the real axis, l >= 1 and n < ORDER. In units of RADIUS it is thus analytic
!> about the wanted pendulum; the weights are the best for all functions analytic in the unit ball.
module kz_live_series_interpolation
  use, intrinsic :: iso_c_binding, only: c_ptr, c_associated, c_f_pointer
  use, intrinsic :: iso_fortran_env, only: rk => real64, qp => real128
  use kz_vector_locks, only: take_lock, leave_lock
  use kz_model_pendulum, only: pendulum_t, is_same, MOST_HARMONICS
  use kz_processed_tables, only: series_t, kept_series_t, make_processed_series, ORDER, NODES
  implicit none
  private
  public :: interpolate_series

  !> Relative error assumed of a node, which keeps the weights small.
  real(rk), parameter :: ROUNDING = 1e-13_rk
  !> Radii of analyticity in the force and in the damping: a step multiplies forces by less than 1/2, and no pole is
  !> nearer than 1/ORDER. (On paths over the plane of Fig. 12 errors of periods were up to 1.8 times the accepted one.)
  real(rk), parameter :: RADIUS(2) = [2.0_rk, 1.0_rk/ORDER]
  !> Largest distance of a node that counts, in units of RADIUS.
  real(rk), parameter :: FARTHEST = 0.5_rk
  integer, parameter :: N_PARAMETERS = 5 + 4*MOST_HARMONICS

contains

  !> Interpolates the series of a pendulum from the nodes, or makes it and keeps it as a node.
  subroutine interpolate_series(pendulum, error, handle, series)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    real(rk), intent(in) :: error !< Largest error of the interpolation, rad; that of a period may be twice as large
    type(c_ptr), intent(in) :: handle !< kz_kept_series of kernel.h with the nodes; null = the series is made
    type(series_t), intent(out) :: series !< Series, for any number of steps
    type(kept_series_t), pointer :: kept

    if (c_associated(handle)) then
      call c_f_pointer(handle, kept)
      call take_lock(kept%lock)
      call interpolate_or_make(pendulum, error, handle, kept, series)
      call leave_lock(kept%lock)
    else
      call make_processed_series(pendulum, handle, series)
    end if
  end subroutine interpolate_series

  subroutine interpolate_or_make(pendulum, error, handle, kept, series)
    type(pendulum_t), intent(in) :: pendulum
    real(rk), intent(in) :: error
    type(c_ptr), intent(in) :: handle
    type(kept_series_t), intent(inout) :: kept !< Target of `handle`
    type(series_t), intent(out) :: series
    real(rk) :: weight(NODES)
    logical :: accepted
    integer :: i

    if (kept%place(1)%harmonics /= pendulum%harmonics .or. kept%place(1)%unmirrored /= pendulum%unmirrored) &
      kept%n_nodes = 0
    do i = 1, kept%n_nodes
      if (.not. is_same(kept%place(i), pendulum)) cycle
      series = kept%node(i)
      return
    end do
    call set_weights(pendulum, error, kept%place(:kept%n_nodes), weight(:kept%n_nodes), accepted)
    if (accepted) then
      call add_nodes(kept%node(:kept%n_nodes), weight(:kept%n_nodes), series)
    else
      call make_processed_series(pendulum, handle, series)
      call keep_node(pendulum, series, kept)
    end if
  end subroutine interpolate_or_make

  !> Sets the weights of the nodes with the least error for the pendulum. Functions analytic in the unit ball have the
  !> kernel K = 1/(1 - x y) (Drury and Arveson): for norm 1 the squared error of weights w is at most w K w - 2 sum w +
  !> 1, which is least at K w = 1. `accepted`: the least error, with the rounding of the nodes, is small enough.
  subroutine set_weights(pendulum, error, place, weight, accepted)
    type(pendulum_t), intent(in) :: pendulum
    real(rk), intent(in) :: error
    type(pendulum_t), intent(in) :: place(:)
    real(rk), intent(out) :: weight(size(place))
    logical, intent(out) :: accepted
    real(qp) :: offset(N_PARAMETERS, size(place)), best(size(place))
    logical :: varies(N_PARAMETERS)
    integer :: near_node(size(place)), i, n

    n = 0
    do i = 1, size(place)
      offset(:, n + 1) = scaled_difference(place(i), pendulum)
      if (norm2(real(offset(:, n + 1), rk)) > FARTHEST) cycle
      n = n + 1
      near_node(n) = i
    end do
    varies = any(abs(offset(:, :n)) > 0, 2)
    best(:n) = least_error_weights(reshape(pack(offset(:, :n), spread(varies, 2, n)), [count(varies), n]))
    weight = 0
    weight(near_node(:n)) = real(best(:n), rk)
    accepted = 1 - sum(best(:n)) <= error**2
  end subroutine set_weights

  !> Solves (K + ROUNDING**2) w = 1 by Cholesky's method, in quad precision because errors are squared in it.
  pure function least_error_weights(offset) result(weight)
    real(qp), intent(in) :: offset(:, :) !< Nodes less the wanted pendulum, in units of RADIUS
    real(qp) :: weight(size(offset, 2)), factor(size(offset, 2), size(offset, 2))
    integer :: i, j

    do j = 1, size(weight)
      do i = j, size(weight)
        factor(i, j) = 1/(1 - dot_product(offset(:, i), offset(:, j))) &
                       - dot_product(factor(i, :j - 1), factor(j, :j - 1))
        if (i == j) factor(j, j) = sqrt(factor(j, j) + real(ROUNDING, qp)**2)
        if (i > j) factor(i, j) = factor(i, j)/factor(j, j)
      end do
      weight(j) = (1 - dot_product(factor(j, :j - 1), weight(:j - 1)))/factor(j, j)
    end do
    do j = size(weight), 1, -1
      weight(j) = (weight(j) - dot_product(factor(j + 1:, j), weight(j + 1:)))/factor(j, j)
    end do
  end function least_error_weights

  !> Difference of the parameters of two pendulums, in units of RADIUS.
  pure function scaled_difference(one, other) result(distance)
    type(pendulum_t), intent(in) :: one, other
    real(qp) :: distance(N_PARAMETERS)

    distance = (real(parameters_of(one), qp) - parameters_of(other))/RADIUS(1)
    distance(2) = distance(2)*(RADIUS(1)/RADIUS(2))
  end function scaled_difference

  !> Parameters of the equation: k, the damping, m and the others.
  pure function parameters_of(pendulum) result(parameters)
    type(pendulum_t), intent(in) :: pendulum
    real(rk) :: parameters(N_PARAMETERS)

    parameters(:5) = [pendulum%k, pendulum%beta, pendulum%m, pendulum%torque, pendulum%torque_amplitude]
    parameters(6:5 + 2*MOST_HARMONICS) = reshape(pendulum%vertical, [2*MOST_HARMONICS])
    parameters(6 + 2*MOST_HARMONICS:) = reshape(pendulum%horizontal, [2*MOST_HARMONICS])
  end function parameters_of

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
      series%processor(:, :, ::2, :, :, :) = series%processor(:, :, ::2, :, :, :) &
                                             + weight(i)*node(i)%processor(:, :, ::2, :, :, :)
    end do
  end subroutine add_nodes

  !> Keeps a series as a node, in place of the farthest one if there is no space.
  subroutine keep_node(pendulum, series, kept)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series
    type(kept_series_t), intent(inout) :: kept
    real(rk) :: distance(NODES)
    integer :: i

    if (.not. allocated(kept%node)) allocate (kept%node(NODES))
    i = kept%n_nodes + 1
    if (i > NODES) then
      distance = [(norm2(real(scaled_difference(kept%place(i), pendulum), rk)), i=1, NODES)]
      i = maxloc(distance, 1)
    end if
    kept%place(i) = pendulum
    kept%node(i) = series
    kept%n_nodes = max(kept%n_nodes, i)
  end subroutine keep_node

end module kz_live_series_interpolation
