!> Whole drive periods in pairs of doubles (some 32 digits), many lanes at once: the processed splitting with enough
!> steps that the error of a period, measured against quad-precision Taylor series, is at most a tolerance. States are
!> physical, because the processor is applied at both ends of every period. Each table serves a range of speeds, since
!> faster states need more steps; Taylor series advance the fastest states.
module kz_taylor_pairs
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_ptr, c_null_ptr
  use, intrinsic :: iso_fortran_env, only: real128
  use, intrinsic :: ieee_exceptions, only: ieee_set_halting_mode, ieee_set_flag, ieee_usual
  use kz_vector_map, only: WIDTH
  use kz_vector_step_search, only: integrator_t, search_steps, expected_steps
  use kz_taylor_pairs_table, only: pairs_table_t, pair_lanes_t, make_pairs_table, advance_pairs_table, pair_of, quad_of
  use kz_processed_tables, only: MOST_DAMPING
  use kz_processed_tables_r128, only: series_t, make_mixed_series, MOST_PAIR_KICKS, ORDER
  use kz_model_pendulum, only: pendulum_t
  use kz_taylor_probes, only: probes_t, make_probes, measure_quad
  use kz_taylor_taylor, only: drive_t, make_drive, advance_period, PI => PI_QUAD, TAYLOR_STEPS
  implicit none
  private
  public :: pairs_t, pair_series_t, pair_lanes_t, make_pairs, advance_pairs, pair_of, quad_of

  integer, parameter :: qp = real128
  !> Numbers of steps are multiples of STRIDE up to MOST_STEPS, where Taylor series cost no more. GROWTH_MARGIN: factor
  !> on predicted steps, because tables are expensive to make.
  integer, parameter :: STRIDE = 8, FEWEST_STEPS = 48, MOST_STEPS = 1920
  real(c_double), parameter :: GROWTH_MARGIN = 1.04_c_double
  !> Largest speed of the first table, rad per drive radian; ratio of the next table's to it.
  real(c_double), parameter :: SLOWEST = 2.5_c_double, RATIO = 2
  integer, parameter :: MOST_TABLES = 8
  !> Number of probes of a table; safety factor on their largest error; rounding error of a period, rad.
  integer, parameter :: N_PROBES = 2*WIDTH
  real(c_double), parameter :: MARGIN = 1.5_c_double
  real(c_double), parameter :: ROUNDING = 4e-31_c_double
  !> Assumed error of the Taylor series in a period of states faster than `fastest`, relative to hypot(pi, v).
  real(c_double), parameter :: UNMEASURED = 1e-28_c_double

  type :: pairs_t
    real(c_double) :: error = 0 !< Largest error of a period of all tables, rad
    real(c_double) :: fastest = 0      !< Largest speed of the tables, rad per drive radian
    real(c_double) :: series_error = 0 !< Error of a period of faster states, relative to hypot(pi, v)
    type(pairs_table_t), allocatable :: table(:)
    type(drive_t) :: drive
  end type pairs_t

  !> Parts of the tables that do not depend on the tolerance, made once.
  type :: pair_series_t
    type(c_ptr) :: kept = c_null_ptr !< Cache of series in doubles, kz_kept_series of kernel.h; null = none
    type(series_t), allocatable :: series
    type(probes_t), allocatable :: slow !< Probes of the first table
  end type pair_series_t

  !> A table whose number of steps is searched; each try takes one more coefficient of a kick.
  type, extends(integrator_t) :: searched_table_t
    type(pendulum_t) :: pendulum
    type(series_t), pointer :: series => null()
    type(probes_t) :: probes
    real(c_double) :: fastest = 0, tolerance = 0
    integer :: kicks = 0
    type(pairs_table_t) :: table
  contains
    procedure :: measure_error => measure_table
  end type searched_table_t

contains

  !> Makes tables with an error of one period within a tolerance. Taylor series serve speeds that no table reaches.
  subroutine make_pairs(pendulum, tolerance, fastest, pairs, shared, like_steps, like_error)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    real(c_double), intent(in) :: tolerance !< Largest error of one period, angle and velocity together, rad
    real(c_double), intent(in) :: fastest !< Largest speed that tables shall serve, rad per drive radian
    type(pairs_t), intent(out) :: pairs !< Tables
    type(pair_series_t), intent(inout) :: shared !< Series shared with other tables of the pendulum
    !> Steps of a table for slow states with a known error, from which the first number of steps follows; 0 = none
    integer, intent(in) :: like_steps
    real(c_double), intent(in) :: like_error !< Its error, rad
    type(pairs_table_t), allocatable :: tables(:)
    integer :: n

    call make_drive(pairs%drive, pendulum, TAYLOR_STEPS)
    pairs%error = ROUNDING
    n = 0
    allocate (tables(0:MOST_TABLES))
    if (pendulum%beta <= MOST_DAMPING) then
      call ieee_set_halting_mode(ieee_usual, .false.) ! too few steps may overflow
      if (.not. allocated(shared%series)) then
        allocate (shared%series)
        call make_mixed_series(pendulum, shared%kept, shared%series)
        allocate (shared%slow)
        call make_probes(pairs%drive, speeds_of(tables(0)), shared%slow)
      end if
      if (like_steps > 0) &
        tables(0)%n_steps = round_to_stride(GROWTH_MARGIN*expected_steps(int(like_steps, c_int32_t), like_error, &
            tolerance, int(ORDER, c_int32_t)))
      do while (n < MOST_TABLES .and. tables(n)%fastest < fastest)
        call choose_table(pendulum, shared, pairs%drive, tolerance, tables(n), tables(n + 1))
        if (tables(n + 1)%error > tolerance) exit
        n = n + 1
        pairs%error = max(pairs%error, tables(n)%error)
      end do
      call ieee_set_flag(ieee_usual, .false.)
    end if
    allocate (pairs%table, source=tables(1:n))
    pairs%fastest = tables(n)%fastest
    pairs%series_error = UNMEASURED
    if (pairs%fastest < fastest) pairs%series_error = measure_quad(pairs%drive, fastest)
  end subroutine make_pairs

  pure integer function round_to_stride(steps) result(n)
    real(c_double), intent(in) :: steps

    n = STRIDE*ceiling(steps/STRIDE)
  end function round_to_stride

  !> Number of coefficients of a kick that is enough for a tolerance.
  pure integer function expected_kicks(tolerance) result(n)
    real(c_double), intent(in) :: tolerance

    n = min(MOST_PAIR_KICKS, ceiling(7 - 0.39_c_double*log10(tolerance)))
  end function expected_kicks

  !> Speeds of the probes of the table after a slower one.
  pure function speeds_of(slower) result(speed)
    type(pairs_table_t), intent(in) :: slower
    real(c_double) :: speed(N_PROBES), fastest
    integer :: i

    fastest = max(SLOWEST, RATIO*slower%fastest)
    speed = [(slower%fastest + (fastest - slower%fastest)*(i - 1)/(N_PROBES - 1), i=1, N_PROBES)]
  end function speeds_of

  !> Makes the table after a slower one, with enough steps for a measured error within the tolerance.
  subroutine choose_table(pendulum, shared, drive, tolerance, slower, table)
    type(pendulum_t), intent(in) :: pendulum
    type(pair_series_t), target, intent(in) :: shared
    type(drive_t), intent(in) :: drive
    real(c_double), intent(in) :: tolerance
    type(pairs_table_t), intent(in) :: slower
    type(pairs_table_t), intent(out) :: table
    type(searched_table_t) :: integrator
    real(c_double) :: error
    integer :: fewest, n

    integrator%order = ORDER
    integrator%stride = STRIDE
    integrator%growth_margin = GROWTH_MARGIN
    integrator%pendulum = pendulum
    integrator%series => shared%series
    integrator%tolerance = tolerance
    integrator%fastest = max(SLOWEST, RATIO*slower%fastest)
    integrator%kicks = expected_kicks(tolerance)
    fewest = slower%n_steps
    if (slower%fastest > 0) then
      call make_probes(drive, speeds_of(slower), integrator%probes)
      fewest = STRIDE*int(1.5_c_double*slower%n_steps/STRIDE) ! twice the speed needs about 1.5 times the steps
    else
      integrator%probes = shared%slow
    end if
    call search_steps(integrator, tolerance, max(FEWEST_STEPS, fewest), MOST_STEPS, n, error)
    table = integrator%table
    table%error = error
  end subroutine choose_table

  !> Measures the largest error of one period of n steps, rad.
  function measure_table(integrator, n) result(error)
    class(searched_table_t), intent(inout) :: integrator
    integer, intent(in) :: n
    real(c_double) :: error, distance, turns(WIDTH)
    real(qp) :: u
    type(pair_lanes_t) :: lanes
    integer :: first, lane

    call make_pairs_table(integrator%pendulum, integrator%series, n, integrator%kicks, integrator%fastest, &
                          integrator%tolerance, integrator%table)
    integrator%kicks = min(MOST_PAIR_KICKS, integrator%kicks + 1)
    error = 0
    do first = 0, N_PROBES - WIDTH, WIDTH
      do lane = 1, WIDTH
        lanes%u(lane, :) = pair_of(integrator%probes%start(1, first + lane))
        lanes%v(lane, :) = pair_of(integrator%probes%start(2, first + lane))
      end do
      call advance_pairs_table(integrator%table, WIDTH, lanes, turns)
      do lane = 1, WIDTH
        u = quad_of(lanes%u(lane, :)) - integrator%probes%image(1, first + lane)
        distance = real(hypot(PI*(u - 2*anint(u/2)), quad_of(lanes%v(lane, :)) &
                              - integrator%probes%image(2, first + lane)), c_double)
        if (.not. distance <= error) error = distance ! NaN too
      end do
    end do
    error = MARGIN*error + ROUNDING
    if (.not. error <= huge(error)) error = huge(error)
  end function measure_table

  !> Advances n lanes by one period; a lost state becomes NaN.
  subroutine advance_pairs(pairs, n, lanes, turns)
    type(pairs_t), intent(in) :: pairs !< the tables
    integer, intent(in) :: n !< lanes in use
    type(pair_lanes_t), intent(inout) :: lanes !< physical states
    integer(c_int64_t), intent(inout) :: turns(WIDTH) !< Net turns, counterclockwise +, are added
    integer :: l, of_table(WIDTH), lane

    do lane = 1, n
      of_table(lane) = count(abs(lanes%v(lane, 1)) > pairs%table%fastest) + 1
    end do
    do l = 1, size(pairs%table)
      if (any(of_table(:n) == l)) &
        call advance_with_table(pairs%table(l), pack([(lane, lane=1, n)], of_table(:n) == l), lanes, turns)
    end do
    if (any(of_table(:n) > size(pairs%table))) &
      call advance_by_taylor(pairs%drive, pack([(lane, lane=1, n)], of_table(:n) > size(pairs%table)), lanes, turns)
  end subroutine advance_pairs

  subroutine advance_with_table(table, lane, lanes, turns)
    type(pairs_table_t), intent(in) :: table
    integer, intent(in) :: lane(:)
    type(pair_lanes_t), intent(inout) :: lanes
    integer(c_int64_t), intent(inout) :: turns(WIDTH)
    type(pair_lanes_t) :: some
    real(c_double) :: gained(WIDTH)
    integer :: n

    n = size(lane)
    some = pair_lanes_t(0, 0)
    some%u(:n, :) = lanes%u(lane, :)
    some%v(:n, :) = lanes%v(lane, :)
    call advance_pairs_table(table, n, some, gained)
    lanes%u(lane, :) = some%u(:n, :)
    lanes%v(lane, :) = some%v(:n, :)
    turns(lane) = turns(lane) + int(gained(:n), c_int64_t)
  end subroutine advance_with_table

  !> Advances lanes by Taylor series.
  subroutine advance_by_taylor(drive, lane, lanes, turns)
    type(drive_t), intent(in) :: drive
    integer, intent(in) :: lane(:)
    type(pair_lanes_t), intent(inout) :: lanes
    integer(c_int64_t), intent(inout) :: turns(WIDTH)
    real(qp) :: theta(size(lane)), velocity(size(lane))
    integer(c_int64_t) :: gained(size(lane))
    integer :: i

    do i = 1, size(lane)
      theta(i) = PI*quad_of(lanes%u(lane(i), :))
      velocity(i) = quad_of(lanes%v(lane(i), :))
    end do
    gained = 0
    call advance_period(drive, theta, velocity, gained)
    do i = 1, size(lane)
      lanes%u(lane(i), :) = pair_of(theta(i)/PI)
      lanes%v(lane(i), :) = pair_of(velocity(i))
    end do
    turns(lane) = turns(lane) + gained
  end subroutine advance_by_taylor

end module kz_taylor_pairs
