!> The C interface of dynamics: starts of a window, their largest speed, the map table (include/kapitza/dynamics.h).
module kz_api_map_table
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr
  use kz_kernel_flows, only: make_flow
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_api_dynamics, only: dynamics_t, of_handle
  use kz_maps_map_table, only: make_table, table_row, set_table_rows, inner_top, table_map_t, make_table_map
  use kz_maps_states, only: wrapped
  use kz_maps_step_error, only: error_of_table
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  implicit none
  private

  type, bind(C) :: window_t
    real(dp) :: theta_min, theta_max, velocity_min, velocity_max
  end type window_t

contains

  !> Starts spread evenly by the additive recurrence of the plastic number; the seed is the offset.
  subroutine starts(window, seed, n, state) bind(C, name='kz_dynamics_starts')
    type(window_t), intent(in) :: window !< rad and rad per drive radian
    integer(c_int64_t), value :: seed !< any number
    integer(c_int64_t), value :: n !< starts
    real(dp), intent(out) :: state(2, n) !< half-turns in [-1, 1], rad per drive radian
    real(dp), parameter :: PLASTIC = 1.32471795724474602596_dp, GOLDEN = 0.61803398874989484820_dp
    integer(c_int64_t) :: i
    real(dp) :: share(2), offset(2)

    offset = [modulo(0.5_dp + seed*GOLDEN, 1.0_dp), modulo(0.5_dp + seed*GOLDEN**2*PI, 1.0_dp)]
    do i = 1, n
      share = modulo(offset + i*[1/PLASTIC, 1/PLASTIC**2], 1.0_dp)
      state(1, i) = wrapped((window%theta_min + share(1)*(window%theta_max - window%theta_min))/PI)
      state(2, i) = window%velocity_min + share(2)*(window%velocity_max - window%velocity_min)
    end do
  end subroutine starts

  function max_velocity(handle, window) bind(C, name='kz_dynamics_max_velocity') result(top)
    type(c_ptr), value :: handle
    type(window_t), intent(in) :: window
    real(dp) :: top
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    top = fastest_of(d%search%flow, d%search%pendulum, window)
  end function max_velocity

  function fastest_motion(pendulum, numerics, window) bind(C, name='kz_max_velocity') result(top)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    type(window_t), intent(in) :: window
    real(dp) :: top
    class(flow_t), allocatable :: flow

    call make_flow(pendulum, numerics, .true., flow)
    top = fastest_of(flow, pendulum, window)
  end function fastest_motion

  function fastest_of(flow, pendulum, window) result(top)
    class(flow_t), intent(inout) :: flow
    type(pendulum_t), intent(in) :: pendulum
    type(window_t), intent(in) :: window
    real(dp) :: top
    integer, parameter :: ROWS = 16
    real(dp) :: largest, v
    integer :: row, i

    largest = max(abs(window%velocity_min), abs(window%velocity_max))
    if (pendulum%beta > 0) largest = max(largest, abs(pendulum%torque)/pendulum%beta) ! torque-driven speed
    top = largest
    do row = -ROWS, ROWS
      v = largest*row/ROWS
      do i = 1, WIDTH
        call flow%put(i, 2*real(i, dp)/WIDTH - 1, v)
      end do
      call flow%advance_physical(WIDTH)
      top = max(top, maxval(abs(flow%v(:WIDTH))))
    end do
  end function fastest_of

  subroutine table_create(handle, n_theta, n_velocity, top) bind(C, name='kz_dynamics_table_create')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n_theta, n_velocity
    real(dp), value :: top
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    d%table = make_table(int(n_theta), int(n_velocity), top)
  end subroutine table_create

  function table_row_size(handle) bind(C, name='kz_dynamics_table_row_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = 2*(d%table%n_own + 1)
  end function table_row_size

  subroutine integrate_row(handle, row, shift) bind(C, name='kz_dynamics_table_row')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: row
    real(dp), intent(out) :: shift(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call table_row(d%table, d%search%flow, int(row) + 1, shift)
  end subroutine integrate_row

  subroutine table_set(handle, rows) bind(C, name='kz_dynamics_table_set')
    type(c_ptr), value :: handle
    real(dp), intent(in) :: rows(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    call set_table_rows(d%table, rows)
  end subroutine table_set

  !> Sampled over the speeds of the window and what one period adds, without the table's margin.
  function table_error(handle, points) bind(C, name='kz_dynamics_table_error') result(largest)
    type(c_ptr), value :: handle
    integer(c_int32_t), value :: points
    real(dp) :: largest
    integer(c_int64_t), parameter :: SAMPLES = 16*WIDTH
    type(dynamics_t), pointer :: d
    type(table_map_t) :: map
    real(dp), allocatable :: state(:, :)
    real(dp) :: top

    d => of_handle(handle)
    allocate (state(2, SAMPLES))
    top = inner_top(d%table)
    call starts(window_t(-PI, PI, -top, top), 2_c_int64_t, SAMPLES, state)
    map = make_table_map(d%table, int(points), d%search%flow)
    largest = error_of_table(d%search%flow, map, state)
  end function table_error

end module kz_api_map_table
