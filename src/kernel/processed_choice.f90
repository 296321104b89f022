!> Chooses the cheapest processed splitting for a pendulum by measured errors of one period.
module kz_kernel_processed_choice
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use, intrinsic :: ieee_exceptions, only: ieee_set_halting_mode, ieee_set_flag, ieee_usual
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_processed_flow
  use kz_vector_step_search, only: integrator_t, search_steps
  use kz_processed_tables, only: series_t, make_processed_series, MOST_DRIFTS, MOST_KICKS, MOST_DAMPING, ORDER
  use kz_vector_schemes, only: PROCESSED_ROW
  use kz_model_pendulum, only: pendulum_t, stiffness
  use kz_vector_step_table, only: numerics_t
  use kz_taylor_probes, only: probes_t, make_probes
  use kz_taylor_taylor, only: drive_t, make_drive, ROUGH_STEPS
  implicit none
  private

  !> Status codes of common.h.
  integer(c_int32_t), parameter :: OK = 0, REFUSED = 2
  !> Numbers of steps that are tried; the most are KZ_MOST_PROCESSED_STEPS of kernel.h.
  integer, parameter :: FEWEST_STEPS = 12, MOST_STEPS = 160
  !> Least number of coefficients of a kick.
  integer, parameter :: FEWEST_KICKS = 4
  !> Operations per step and lane besides the terms of drift and kick.
  integer, parameter :: OTHER_OPERATIONS = 6
  !> Largest angle of a turn, and phase of the fastest oscillation, in a step, rad; beyond them no number of steps is
  !> tried. Measured: errors per period exceed 1e-6 rad above 0.7 and 0.22, 1e-3 rad above 2 and 0.4.
  real(c_double), parameter :: MAX_STEP_ANGLE = 3.2_c_double, MAX_STEP_PHASE = 0.8_c_double
  !> Number of probes, states with speeds from 0 to the fastest, and safety factor on their largest error.
  integer, parameter :: N_PROBES = 2*WIDTH
  real(c_double), parameter :: MARGIN = 1.5_c_double

  !> The splitting of a pendulum whose number of steps is searched.
  type, extends(integrator_t) :: splitting_t
    type(pendulum_t) :: pendulum
    type(series_t), allocatable :: series
    type(probes_t) :: probes
    type(numerics_t) :: numerics
  contains
    procedure :: measure_error => measure_splitting
  end type splitting_t

contains

  !> Implements kz_numerics_choose of kernel.h.
  integer(c_int32_t) function choose_numerics(pendulum, tolerance, fastest, numerics, error) &
      bind(C, name='kz_numerics_choose') result(status)
    type(pendulum_t), intent(in) :: pendulum
    real(c_double), value :: tolerance, fastest
    type(numerics_t), intent(inout) :: numerics
    real(c_double), intent(out) :: error
    type(splitting_t) :: integrator
    type(drive_t) :: drive
    integer :: given, i

    status = REFUSED
    error = huge(error)
    if (pendulum%beta > MOST_DAMPING .or. out_of_reach(pendulum, fastest)) return
    call ieee_set_halting_mode(ieee_usual, .false.) ! too few steps may overflow
    integrator%order = ORDER
    integrator%pendulum = pendulum
    allocate (integrator%series)
    call make_processed_series(pendulum, numerics%series, integrator%series)
    call make_drive(drive, pendulum, ROUGH_STEPS, rough=.true.)
    call make_probes(drive, [(fastest*(i - 1)/(N_PROBES - 1), i=1, N_PROBES)], integrator%probes)
    numerics%scheme = PROCESSED_ROW
    numerics%fastest = fastest
    numerics%drift_terms = MOST_DRIFTS
    numerics%kick_terms = MOST_KICKS
    integrator%numerics = numerics
    given = numerics%steps_per_period
    call choose_terms(integrator, tolerance, merge(given, FEWEST_STEPS, given > 0), &
                      merge(given, MOST_STEPS, given > 0), numerics, error)
    if (given > 0 .or. error <= tolerance) status = OK
    call ieee_set_flag(ieee_usual, .false.)
  end function choose_numerics

  !> Returns .true. if a pendulum is too stiff or a motion too fast for any number of steps, and for NaN.
  pure logical function out_of_reach(pendulum, fastest) result(out)
    type(pendulum_t), intent(in) :: pendulum
    real(c_double), intent(in) :: fastest
    real(c_double), parameter :: STEP = 2*PI/MOST_STEPS

    out = .not. (STEP*fastest <= MAX_STEP_ANGLE .and. STEP*sqrt(stiffness(pendulum)) <= MAX_STEP_PHASE)
  end function out_of_reach

  !> Returns the largest error of one period of n steps over the probes, rad.
  real(c_double) function measure_splitting(integrator, n) result(error)
    class(splitting_t), intent(inout) :: integrator
    integer, intent(in) :: n
    class(flow_t), allocatable :: flow
    type(numerics_t) :: unbounded
    real(c_double) :: distance
    integer :: first, lane

    integrator%numerics%steps_per_period = int(n, c_int32_t)
    unbounded = integrator%numerics
    unbounded%fastest = huge(unbounded%fastest)
    call make_processed_flow(integrator%pendulum, integrator%series, unbounded, flow, integrator%numerics%fastest)
    error = 0
    do first = 0, N_PROBES - WIDTH, WIDTH
      call flow%put_all(real(integrator%probes%start(1, first + 1:first + WIDTH), c_double), &
                        real(integrator%probes%start(2, first + 1:first + WIDTH), c_double))
      call flow%advance_physical(WIDTH)
      do lane = 1, WIDTH
        distance = hypot(PI*(modulo(flow%u(lane) - real(integrator%probes%image(1, first + lane), c_double) + 1, &
                                    2.0_c_double) - 1), &
                         flow%v(lane) - real(integrator%probes%image(2, first + lane), c_double))
        if (.not. distance <= error) error = distance ! NaN too
      end do
    end do
    error = MARGIN*error
    if (.not. error <= huge(error)) error = huge(error)
  end function measure_splitting

  !> Finds for each number of terms the fewest steps that reach the tolerance, and takes the cheapest of them; the first
  !> search, with all terms, bounds the steps from below. With given steps (`fewest` = `most`) it takes the fewest terms
  !> that lose neither the tolerance nor the accuracy of the steps.
  subroutine choose_terms(integrator, tolerance, fewest, most, numerics, error)
    type(splitting_t), intent(inout) :: integrator
    real(c_double), intent(in) :: tolerance
    integer, intent(in) :: fewest, most
    type(numerics_t), intent(out) :: numerics
    real(c_double), intent(out) :: error
    real(c_double) :: candidate_error, accepted
    integer :: first, last, drifts, kicks, steps

    call search_steps(integrator, tolerance, fewest, most, first, error)
    numerics = integrator%numerics
    last = merge(most, huge(most), fewest == most)
    accepted = merge(max(tolerance, 1.2_c_double*error), tolerance, fewest == most)
    if (error > accepted) return
    do drifts = MOST_DRIFTS, 1, -1
      do kicks = MOST_KICKS, FEWEST_KICKS, -1
        integrator%numerics%drift_terms = drifts
        integrator%numerics%kick_terms = kicks
        if (cheaper_steps(numerics, integrator%numerics) < first) cycle
        call search_steps(integrator, accepted, first, min(last, cheaper_steps(numerics, integrator%numerics)), steps, &
                          candidate_error)
        if (candidate_error > accepted) exit
        numerics = integrator%numerics
        error = candidate_error
      end do
    end do
  end subroutine choose_terms

  !> Largest number of steps at which a candidate costs less than the chosen numerics.
  pure integer function cheaper_steps(chosen, candidate) result(steps)
    type(numerics_t), intent(in) :: chosen, candidate

    steps = (chosen%steps_per_period*operations_per_step(chosen) - 1)/operations_per_step(candidate)
  end function cheaper_steps

  pure integer function operations_per_step(numerics) result(n)
    type(numerics_t), intent(in) :: numerics

    n = numerics%drift_terms + numerics%kick_terms + OTHER_OPERATIONS
  end function operations_per_step

end module kz_kernel_processed_choice
