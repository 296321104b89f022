!> The C interface of dynamics: include/kapitza/dynamics.h.
module kz_api_dynamics
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_ptr, c_null_ptr, c_loc, c_f_pointer
  use kz_kernel_map, only: WIDTH, PI
  use kz_kernel_plan, only: make_flow, fine_numerics, DOUBLE
  use kz_kernel_step_table, only: pendulum_t, numerics_t
  use kz_attractors_catalogue, only: order_of, packed, packed_cycle_size, packed_chaos_size, unpack
  use kz_attractors_chaos, only: find_chaos
  use kz_trapping_growth, only: grow_regions
  use kz_trapping_cell_images, only: PERIODS, make_images
  use kz_cycles_cycles, only: attractor_t, enter_points
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_trapping_grid, only: make_regions, draw_attractors
  use kz_attractors_cycle_search, only: find_cycle, append
  use kz_maps_map_table, only: make_table, table_row, set_table_rows, inner_top, table_map_t, make_table_map
  use kz_maps_states, only: wrapped
  use kz_maps_step_error, only: table_defect
  implicit none
  private

  !> Cells of the coarse grid along an axis.
  integer, parameter :: COARSE_CELLS = 256

  type, bind(C) :: window_t
    real(dp) :: theta_min, theta_max, velocity_min, velocity_max
  end type window_t

  type, bind(C) :: attractor_row_t
    integer(c_int32_t) :: period, winding, centre, symmetric, mirror
    real(dp) :: mean, mean_velocity, amplitude, multiplier_re(2), multiplier_im(2), lyapunov, lyapunov_error
  end type attractor_row_t

contains

  function create(pendulum, numerics, max_period) bind(C, name='kz_dynamics_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    integer(c_int64_t), value :: max_period
    type(c_ptr) :: handle
    type(dynamics_t), pointer :: d
    type(numerics_t) :: coarse
    integer :: status

    handle = c_null_ptr
    allocate (d, stat=status)
    if (status /= 0) return
    coarse = numerics
    coarse%precision = min(numerics%precision, int(DOUBLE, c_int32_t))
    d%numerics = numerics
    call make_flow(pendulum, numerics, .true., d%flow)
    d%search%pendulum = pendulum
    d%search%max_period = int(max_period)
    call make_flow(pendulum, coarse, .true., d%search%flow)
    call make_flow(pendulum, fine_numerics(pendulum), .true., d%search%fine)
    call make_flow(pendulum, fine_numerics(pendulum), .false., d%search%sampling_flow)
    allocate (d%attractors(0))
    handle = c_loc(d)
  end function create

  subroutine destroy(handle) bind(C, name='kz_dynamics_free')
    type(c_ptr), value :: handle
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (associated(d)) deallocate (d)
  end subroutine destroy

  !> Points of the additive recurrence of the plastic number, an even spread; the seed is its offset.
  subroutine starts(window, seed, n, state) bind(C, name='kz_dynamics_starts')
    type(window_t), intent(in) :: window
    integer(c_int64_t), value :: seed
    integer(c_int64_t), value :: n
    real(dp), intent(out) :: state(2, n)
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
    integer, parameter :: ROWS = 16
    type(dynamics_t), pointer :: d
    real(dp) :: largest, v
    integer :: row, i

    d => of_handle(handle)
    largest = max(abs(window%velocity_min), abs(window%velocity_max))
    top = largest
    do row = -ROWS, ROWS
      v = largest*row/ROWS
      do i = 1, WIDTH
        call d%search%flow%put(i, 2*real(i, dp)/WIDTH - 1, v)
      end do
      call d%search%flow%enter(WIDTH)
      call d%search%flow%advance(WIDTH)
      call d%search%flow%leave(WIDTH)
      top = max(top, maxval(abs(d%search%flow%v(:WIDTH))))
    end do
  end function max_velocity

  subroutine coarse_regions(handle, top) bind(C, name='kz_dynamics_coarse_regions')
    type(c_ptr), value :: handle
    real(dp), value :: top
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (allocated(d%images)) deallocate (d%images)
    d%regions = make_regions(COARSE_CELLS, COARSE_CELLS, top)
  end subroutine coarse_regions

  subroutine fine_regions(handle, cells, top) bind(C, name='kz_dynamics_fine_regions')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: cells
    real(dp), value :: top
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (allocated(d%images)) deallocate (d%images)
    allocate (d%images(size(PERIODS)))
    d%regions = make_regions(2*((int(cells) + 1)/2), int(cells), top)
    call make_images(d%regions, d%search%flow, d%images)
    call update_regions(handle)
  end subroutine fine_regions

  subroutine update_regions(handle) bind(C, name='kz_dynamics_update')
    type(c_ptr), value :: handle
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    if (d%regions%n_drawn == size(d%attractors)) return
    call draw_attractors(d%regions, d%attractors)
    if (allocated(d%images)) call grow_regions(d%regions, d%attractors, d%images)
  end subroutine update_regions

  function cycle_size(handle) bind(C, name='kz_dynamics_cycle_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = 1 + packed_cycle_size(d%search%max_period) + d%search%max_period
  end function cycle_size

  function chaos_size() bind(C, name='kz_dynamics_chaos_size') result(n)
    integer(c_int64_t) :: n

    n = packed_chaos_size()
  end function chaos_size

  !> found: states looked at; the catalogue of what was found; how often each period was blurred.
  subroutine search_cycle(handle, n, state, closeness, found) bind(C, name='kz_dynamics_find_cycle')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: state(2, n)
    real(dp), value :: closeness
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer, allocatable :: n_blurred(:)
    integer :: next, n_known, first, last

    d => of_handle(handle)
    n_known = size(d%attractors)
    first = 2 + packed_cycle_size(d%search%max_period)
    last = first + d%search%max_period - 1
    next = nint(found(1)) + 1
    n_blurred = nint(found(first:last))
    call find_cycle(d%search, state(1, :), state(2, :), closeness, next, n_blurred, d%attractors)
    found(1) = next - 1
    found(first:last) = n_blurred
    call take_new(d, n_known, found(2))
  end subroutine search_cycle

  subroutine search_chaos(handle, state, found) bind(C, name='kz_dynamics_find_chaos')
    type(c_ptr), value :: handle
    real(dp), intent(in) :: state(2)
    real(dp), intent(inout) :: found(*)
    type(dynamics_t), pointer :: d
    integer :: n_known

    d => of_handle(handle)
    n_known = size(d%attractors)
    call find_chaos(d%search, d%regions, state(1), state(2), d%attractors)
    call take_new(d, n_known, found)
  end subroutine search_chaos

  !> Takes the attractors beyond the first n_known out of the catalogue, packed.
  subroutine take_new(d, n_known, flat)
    type(dynamics_t), intent(inout) :: d
    integer, intent(in) :: n_known
    real(dp), intent(inout) :: flat(*)

    associate (new => packed(d%attractors(n_known + 1:)))
      flat(:size(new)) = new
    end associate
    d%attractors = d%attractors(:n_known)
  end subroutine take_new

  subroutine adopt(handle, flat) bind(C, name='kz_dynamics_adopt')
    type(c_ptr), value :: handle
    type(c_ptr), value :: flat
    type(dynamics_t), pointer :: d
    real(dp), pointer :: values(:)
    type(attractor_t), allocatable :: new(:)
    integer :: i

    d => of_handle(handle)
    call c_f_pointer(flat, values, [max(packed_cycle_size(d%search%max_period), packed_chaos_size())])
    call unpack(values, new)
    do i = 1, size(new)
      call append_known(d, new(i))
    end do
  end subroutine adopt

  function packed_size(handle) bind(C, name='kz_dynamics_packed_size') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = size(packed(d%attractors))
  end function packed_size

  subroutine pack_catalogue(handle, n, flat) bind(C, name='kz_dynamics_pack')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(out) :: flat(n)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    flat = packed(d%attractors)
  end subroutine pack_catalogue

  subroutine unpack_catalogue(handle, n, flat) bind(C, name='kz_dynamics_unpack')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: flat(n)
    type(dynamics_t), pointer :: d
    type(attractor_t), allocatable :: known(:)
    integer :: i

    d => of_handle(handle)
    call unpack(flat, known)
    deallocate (d%attractors)
    allocate (d%attractors(0))
    do i = 1, size(known)
      call append_known(d, known(i))
    end do
  end subroutine unpack_catalogue

  !> An attractor that was found elsewhere; its strobe points in the coordinates of this map are found again.
  subroutine append_known(d, attractor)
    type(dynamics_t), intent(inout) :: d
    type(attractor_t), intent(in) :: attractor
    type(attractor_t) :: entered

    entered = attractor
    if (entered%period > 0) call enter_points(d%search%flow, entered)
    call append(d%attractors, entered)
  end subroutine append_known

  subroutine table_create(handle, n_theta, n_velocity, top) bind(C, name='kz_dynamics_table_create')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n_theta
    integer(c_int64_t), value :: n_velocity
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
    type(c_ptr), value :: handle
    type(c_ptr), value :: rows
    type(dynamics_t), pointer :: d
    real(dp), pointer :: values(:, :, :)

    d => of_handle(handle)
    call c_f_pointer(rows, values, [2, d%table%n_own + 1, d%table%n_velocity])
    call set_table_rows(d%table, values)
  end subroutine table_set

  function trapped_share(handle) bind(C, name='kz_dynamics_trapped_share') result(share)
    type(c_ptr), value :: handle
    real(dp) :: share
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    share = count(d%regions%label > 0)/real(size(d%regions%label), dp)
  end function trapped_share

  !> Sampled over the speeds of the window and what one period adds, without the table's margin.
  function defect(handle, points) bind(C, name='kz_dynamics_table_defect') result(largest)
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
    largest = table_defect(d%search%flow, map, state)
  end function defect

  function attractor_count(handle) bind(C, name='kz_dynamics_count') result(n)
    type(c_ptr), value :: handle
    integer(c_int64_t) :: n
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    n = size(d%attractors)
  end function attractor_count

  subroutine attractor_row(handle, number, row, theta, velocity) bind(C, name='kz_dynamics_attractor')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: number
    type(attractor_row_t), intent(out) :: row
    real(dp), intent(inout) :: theta(*)
    real(dp), intent(inout) :: velocity(*)
    type(dynamics_t), pointer :: d
    integer :: n

    d => of_handle(handle)
    associate (a => d%attractors(number))
      row = attractor_row_t(a%period, a%winding, a%centre, merge(1, 0, a%symmetric), a%mirror, PI*a%mean, a%mean_velocity, &
                            a%amplitude, real(a%multiplier, dp), aimag(a%multiplier), a%lyapunov, a%lyapunov_error)
      n = a%period
      if (n == 0) return ! a chaotic attractor has no strobe points
      theta(:n) = half_open(a%u)
      velocity(:n) = a%v + 0.0_dp
    end associate
  end subroutine attractor_row

  !> Half-turns to rad in [-pi, pi), never -0.
  elemental function half_open(u) result(theta)
    real(dp), intent(in) :: u
    real(dp) :: theta

    theta = PI*u + 0.0_dp
    if (theta >= PI) theta = -PI
  end function half_open

  subroutine attractor_order(handle, number) bind(C, name='kz_dynamics_order')
    type(c_ptr), value :: handle
    integer(c_int64_t), intent(out) :: number(*)
    type(dynamics_t), pointer :: d

    d => of_handle(handle)
    number(:size(d%attractors)) = order_of(d%attractors)
  end subroutine attractor_order

end module kz_api_dynamics
