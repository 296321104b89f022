!> Tables of the processed splitting in pairs of doubles (some 32 digits) for one range of speeds.
module kz_taylor_pairs_table
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: real128
  use kz_vector_map, only: WIDTH
  use kz_processed_tables_r128, only: series_t, processed_t, processor_t, make_processed, MOST_PAIR_DRIFTS, ORDER
  use kz_processed_pair_products, only: pair_of
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: pairs_table_t, pair_lanes_t, make_pairs_table, advance_pairs_table, pair_of, quad_of, SINE_COEFFICIENTS

  integer, parameter :: qp = real128

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 2.0e-37 (Remez exchange in 60 digits).
  real(qp), parameter :: SINE_COEFFICIENTS(15) = [ &
    3.141592653589793238462643383279502883532_qp, &
    -5.167712780049970029246052511183564701846_qp, &
    2.550164039877345443856177583694957089303_qp, &
    -0.5992645293207920768877393835068616642283_qp, &
    0.08214588661112822879880236315174708582035_qp, &
    -0.007370430945714350777259003326394741828258_qp, &
    0.0004663028057676125644185609747807883215079_qp, &
    -0.00002191535344783021579350146212009327079687_qp, &
    0.000000795205400147550885914096243557670141671_qp, &
    -0.0000000229484289972666061083754099127608399681_qp, &
    0.00000000053926646624120950522012910621786683528_qp, &
    -0.00000000001051847163286054698546474514157174850106_qp, &
    1.730216732436752987243058139843180217786e-13_qp, &
    -2.432063529208364844949906009765956065802e-15_qp, &
    2.898000241925418772355479264841694691025e-17_qp]

  !> KZ_HALF_ORDER and KZ_SINE_TERMS of pairs.c.
  integer, parameter :: HALF = ORDER/2, N_SINE = size(SINE_COEFFICIENTS)
  !> A coefficient is a pair if rounding it to a double would change a period by more than this share of the tolerance.
  real(c_double), parameter :: NEGLIGIBLE = 0.01_c_double

  !> Memory of kz_pair_lanes of pairs.c: high and low.
  type, bind(C) :: pair_lanes_t
    real(c_double) :: u(WIDTH, 2), v(WIDTH, 2) !< half-turns in [-1, 1]; rad per drive radian
  end type pair_lanes_t

  !> Memory of kz_displacement of pairs.c.
  type, bind(C) :: displacement_t
    real(c_double) :: coefficient(2, 0:HALF - 1, 2, 0:HALF - 1, 2, 2) = 0
    integer(c_int64_t) :: pairs(2, 0:HALF - 1, 2, 2) = 0
    integer(c_int64_t) :: parts = 1
    real(c_double) :: sine(2, N_SINE) = 0
    integer(c_int64_t) :: sine_pairs = 0
  end type displacement_t

  !> Tables of one period for speeds up to `fastest`, for kz_pairs_stages and kz_pairs_displace.
  type :: pairs_table_t
    real(c_double) :: fastest = 0, error = 0
    integer :: n_steps = 0, n_drift = 0, n_kick = 0, n_pairs = 0
    logical :: mirrored = .true.
    real(c_double), allocatable :: row(:, :)
    integer(c_int32_t), allocatable :: ordered(:) !< (n_steps): pairs.c
    real(c_double) :: decay(2) = 0
    type(displacement_t) :: to_kernel, from_kernel
  end type pairs_table_t

  interface
    !> pairs.c
    subroutine pairs_stages(mirrored, n_stages, n_drift, n_kick, n_pairs, row, ordered, decay, n, lanes, turns) &
        bind(C, name='kz_pairs_stages')
      import :: c_double, c_int32_t, c_int64_t, pair_lanes_t, WIDTH
      integer(c_int32_t), value :: mirrored
      integer(c_int64_t), value :: n_stages, n_drift, n_kick, n_pairs
      real(c_double), intent(in) :: row(*)
      integer(c_int32_t), intent(in) :: ordered(*)
      real(c_double), intent(in) :: decay(2)
      integer(c_int64_t), value :: n
      type(pair_lanes_t), intent(inout) :: lanes
      real(c_double), intent(out) :: turns(WIDTH)
    end subroutine pairs_stages

    subroutine pairs_displace(displacement, n, lanes) bind(C, name='kz_pairs_displace')
      import :: c_int64_t, displacement_t, pair_lanes_t
      type(displacement_t), intent(in) :: displacement
      integer(c_int64_t), value :: n
      type(pair_lanes_t), intent(inout) :: lanes
    end subroutine pairs_displace
  end interface

contains

  !> Converts a pair to a quad.
  pure real(qp) function quad_of(pair) result(x)
    real(c_double), intent(in) :: pair(2) !< high, low

    x = real(pair(1), qp) + pair(2)
  end function quad_of

  !> Makes the tables of a period of n_steps steps. Coefficients that are small compared with the tolerance are doubles.
  subroutine make_pairs_table(pendulum, series, n_steps, n_kick, fastest, tolerance, table)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(series_t), intent(in) :: series !< Series of the pendulum
    integer, intent(in) :: n_steps, n_kick !< steps a period; coefficients of a kick
    real(c_double), intent(in) :: fastest !< Largest speed that the tables shall serve, rad per drive radian
    real(c_double), intent(in) :: tolerance !< error of a period, rad
    type(pairs_table_t), intent(out) :: table !< Tables, whose error is still to be measured
    type(processed_t) :: exact
    integer :: j, n, half, part

    call make_processed(pendulum, series, n_steps, MOST_PAIR_DRIFTS, n_kick, fastest, exact)
    table%mirrored = exact%mirrored
    table%fastest = fastest
    table%n_steps = n_steps
    table%n_drift = exact%n_drift
    table%n_kick = n_kick
    n = exact%n_drift + n_kick
    do part = 0, ubound(exact%row, 1)/n - 1
      table%n_pairs = max(table%n_pairs, min(n_kick - 1, number_of_pairs( &
                      [(n_steps*maxval(abs(exact%row(part*n + exact%n_drift + j, :))), j=1, n_kick)], tolerance)))
    end do
    half = n + 1 + table%n_pairs
    allocate (table%row(half*ubound(exact%row, 1)/n, n_steps + 1), table%ordered(n_steps))
    table%row = 0
    table%ordered = 0
    do part = 0, ubound(exact%row, 1)/n - 1
      call set_rows(exact%row(part*n + 1:(part + 1)*n, :), &
                    exact%last(part*exact%n_drift + 1:(part + 1)*exact%n_drift), part == 0, &
                    table, table%row(part*half + 1:(part + 1)*half, :))
    end do
    table%decay = pair_of(exact%decay)
    call set_displacement(exact%to_kernel, fastest, tolerance, table%to_kernel)
    call set_displacement(exact%from_kernel, fastest, tolerance, table%from_kernel)
  end subroutine make_pairs_table

  !> Sets the odd or the even coefficients of all stages; with odd ones also whether kicks are ordered.
  subroutine set_rows(exact, last, odd, table, row)
    real(qp), intent(in) :: exact(:, :), last(:)
    logical, intent(in) :: odd
    type(pairs_table_t), intent(inout) :: table
    real(c_double), intent(inout) :: row(:, :)
    integer :: s, j, n

    n = table%n_drift
    do s = 1, table%n_steps
      call set_drift(exact(:n, s), row(:, s))
      do j = 1, table%n_pairs
        row(n + 2*j:n + 2*j + 1, s) = pair_of(exact(n + j, s))
      end do
      if (odd) &
        table%ordered(s) = merge(1_c_int32_t, 0_c_int32_t, all([(is_ordered(exact(n + j:, s)), j=1, table%n_pairs)]))
      row(n + 2*table%n_pairs + 2:, s) = real(exact(n + table%n_pairs + 1:, s), c_double)
    end do
    call set_drift(last, row(:, table%n_steps + 1))
  end subroutine set_rows

  !> Returns whether the first coefficient is at least as large as the others together, with a margin for rounding.
  pure logical function is_ordered(c)
    real(qp), intent(in) :: c(:)

    is_ordered = abs(real(c(1), c_double)) >= 1.0001_c_double*sum(abs(real(c(2:), c_double)))
  end function is_ordered

  pure subroutine set_drift(drift, row)
    real(qp), intent(in) :: drift(:)
    real(c_double), intent(inout) :: row(:)

    row(1:2) = pair_of(drift(1))
    row(3:size(drift) + 1) = real(drift(2:), c_double)
  end subroutine set_drift

  !> Number of the leading contributions to a period that need more than double precision.
  pure integer function number_of_pairs(contribution, tolerance) result(n)
    real(qp), intent(in) :: contribution(:)
    real(c_double), intent(in) :: tolerance

    n = findloc(abs(contribution)*epsilon(1.0_c_double) > NEGLIGIBLE*tolerance, .true., 1, back=.true.)
  end function number_of_pairs

  pure subroutine set_displacement(processor, fastest, tolerance, displacement)
    type(processor_t), intent(in) :: processor
    real(c_double), intent(in) :: fastest, tolerance
    type(displacement_t), intent(out) :: displacement
    real(qp) :: largest
    integer :: j, part

    displacement%parts = merge(1, 2, processor%mirrored)
    do part = 1, int(displacement%parts)
      do j = 0, HALF - 1
        call set_harmonic(processor%theta(j, :ORDER - 2*max(j, 1), part), &
                          displacement%coefficient(:, :, :, j, 1, part), displacement%pairs(:, j, 1, part))
        call set_harmonic(processor%velocity(j, :ORDER - 2*max(j, 1), part), &
                          displacement%coefficient(:, :, :, j, 2, part), displacement%pairs(:, j, 2, part))
      end do
    end do
    largest = sum(abs(displacement%coefficient(1, 0, :, :, :, :)))
    do j = 1, N_SINE
      displacement%sine(:, j) = pair_of(SINE_COEFFICIENTS(j))
    end do
    displacement%sine_pairs = number_of_pairs([(largest*SINE_COEFFICIENTS(j)/4.0_qp**(j - 1), j=1, N_SINE)], tolerance)
  contains
    pure subroutine set_harmonic(c, coefficient, pairs)
      real(qp), intent(in) :: c(0:)
      real(c_double), intent(inout) :: coefficient(2, 0:HALF - 1, 2)
      integer(c_int64_t), intent(out) :: pairs(2)
      integer :: n

      do n = 0, ubound(c, 1)
        coefficient(:, n/2, mod(n, 2) + 1) = pair_of(c(n))
      end do
      pairs(1) = number_of_pairs([(c(n)*fastest**n, n=0, ubound(c, 1), 2)], tolerance)
      pairs(2) = number_of_pairs([(c(n)*fastest**n, n=1, ubound(c, 1), 2)], tolerance)
    end subroutine set_harmonic
  end subroutine set_displacement

  !> Advances n lanes by one period with the tables of one range of speeds.
  subroutine advance_pairs_table(table, n, lanes, turns)
    type(pairs_table_t), intent(in) :: table !< the tables
    integer, intent(in) :: n !< lanes in use
    type(pair_lanes_t), intent(inout) :: lanes !< physical states
    real(c_double), intent(out) :: turns(WIDTH) !< [n] the net number of turns

    call pairs_displace(table%to_kernel, int(n, c_int64_t), lanes)
    call pairs_stages(merge(1_c_int32_t, 0_c_int32_t, table%mirrored), int(table%n_steps, c_int64_t), &
                      int(table%n_drift, c_int64_t), int(table%n_kick, c_int64_t), &
                      int(table%n_pairs, c_int64_t), table%row, table%ordered, table%decay, int(n, c_int64_t), lanes, &
                          turns)
    call pairs_displace(table%from_kernel, int(n, c_int64_t), lanes)
  end subroutine advance_pairs_table

end module kz_taylor_pairs_table
