!> The C interface of dynamics: the map table (include/kapitza/dynamics.h).
module kz_api_map_table
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr, c_f_pointer
  use kz_lanes_map, only: WIDTH, PI
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_api_window, only: window_t, starts
  use kz_maps_map_table, only: make_table, table_row, set_table_rows, inner_top, table_map_t, make_table_map
  use kz_maps_step_error, only: error_of_table
  implicit none
  private

contains

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
    type(c_ptr), value :: shift
    type(dynamics_t), pointer :: d
    real(dp), pointer :: values(:, :)

    d => of_handle(handle)
    call c_f_pointer(shift, values, [2, d%table%n_own + 1])
    call table_row(d%table, d%search%flow, int(row) + 1, values)
  end subroutine integrate_row

  subroutine table_set(handle, rows) bind(C, name='kz_dynamics_table_set')
    type(c_ptr), value :: handle, rows
    type(dynamics_t), pointer :: d
    real(dp), pointer :: values(:, :, :)

    d => of_handle(handle)
    call c_f_pointer(rows, values, [2, d%table%n_own + 1, d%table%n_velocity])
    call set_table_rows(d%table, values)
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
