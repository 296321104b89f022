!> Makes the map of one drive period from a pendulum and its numerics.
module kz_kernel_flows
  use, intrinsic :: iso_c_binding, only: c_double
  use kz_vector_map, only: flow_t
  use kz_processed_tables, only: series_t, processed_t, make_processed_series, make_processed, MOST_DRIFTS, MOST_KICKS
  use kz_vector_schemes, only: SCHEMES, PROCESSED, SPLIT6_ROW
  use kz_model_pendulum, only: pendulum_t, stiffness
  use kz_vector_step_table, only: numerics_t, period_t, make_period
  use kz_processed_batch, only: make_processed_batch
  use kz_splitting_batch, only: make_batch
  implicit none
  private
  public :: make_flow, make_processed_flow, fine_numerics, sampling_numerics, FINE_STEPS

  !> Steps of split6 per period for all published values, whatever the scene says.
  integer, parameter :: FINE_STEPS = 96

contains

  !> Numerics of split6 with FINE_STEPS, more if the force is large.
  pure type(numerics_t) function fine_numerics(pendulum) result(numerics)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum

    numerics%scheme = SPLIT6_ROW
    numerics%steps_per_period = FINE_STEPS*ceiling(sqrt(max(1.0_c_double, stiffness(pendulum))))
  end function fine_numerics

  !> Numerics that show motions within a period: the scene's, or fine steps in place of the processed splitting, whose
  !> states are physical at the strobe alone. Steps are a multiple of the scene's.
  pure function sampling_numerics(pendulum, numerics) result(sampling)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(numerics_t), intent(in) :: numerics !< scheme, steps a period
    type(numerics_t) :: sampling, fine

    sampling = numerics
    if (SCHEMES(numerics%scheme + 1)%form /= PROCESSED) return
    fine = fine_numerics(pendulum)
    sampling%scheme = fine%scheme
    sampling%steps_per_period = numerics%steps_per_period &
                                *((fine%steps_per_period + numerics%steps_per_period - 1)/numerics%steps_per_period)
  end function sampling_numerics

  !> Makes the map of one drive period. (A subroutine: gfortran 12 does not free a polymorphic function's result.)
  recursive subroutine make_flow(pendulum, numerics, fused, flow, refined, fallback)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(numerics_t), intent(in) :: numerics !< scheme, steps a period
    !> True: the last entry of a step is merged with the next step's first: faster, but no samples within the period
    logical, intent(in) :: fused
    class(flow_t), allocatable, intent(out) :: flow !< the map of one drive period
    integer, intent(in), optional :: refined !< Steps of the flow for fast lanes over those of fine_numerics; default 1
    class(flow_t), intent(in), optional :: fallback !< Flow for fast lanes, if it exists: fine_numerics, not fused
    type(period_t) :: period
    type(series_t), allocatable :: series

    if (SCHEMES(numerics%scheme + 1)%form /= PROCESSED) then
      call make_period(pendulum, numerics, fused, period)
      call make_batch(period, flow)
      return
    end if
    allocate (series)
    call make_processed_series(pendulum, numerics%series, series)
    call make_processed_flow(pendulum, series, numerics, flow, refined=refined, made_fallback=fallback)
  end subroutine make_flow

  !> Makes the processed splitting from its series. numerics%fastest = huge: no other flow for fast lanes.
  recursive subroutine make_processed_flow(pendulum, series, numerics, flow, fitted, refined, made_fallback)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(series_t), intent(in) :: series !< the series of the pendulum
    type(numerics_t), intent(in) :: numerics !< scheme, steps a period
    class(flow_t), allocatable, intent(out) :: flow !< the map of one drive period
    real(c_double), intent(in), optional :: fitted !< Largest speed to which the drift is fitted; default: the fastest
    integer, intent(in), optional :: refined !< Steps of the flow for fast lanes over those of fine_numerics; default 1
    class(flow_t), intent(in), optional :: made_fallback !< Flow for fast lanes, if it exists
    type(numerics_t) :: fine
    type(processed_t) :: table
    class(flow_t), allocatable :: fallback
    real(c_double) :: fastest, fit
    integer :: drifts, kicks

    drifts = MOST_DRIFTS
    kicks = MOST_KICKS
    if (numerics%drift_terms > 0) drifts = min(drifts, int(numerics%drift_terms))
    if (numerics%kick_terms > 0) kicks = min(kicks, int(numerics%kick_terms))
    fastest = merge(numerics%fastest, 3.0_c_double, numerics%fastest > 0)
    fit = fastest
    if (present(fitted)) fit = fitted
    if (present(made_fallback)) then
      allocate (fallback, source=made_fallback)
    else if (fastest < huge(fastest)) then
      fine = fine_numerics(pendulum)
      if (present(refined)) fine%steps_per_period = refined*fine%steps_per_period
      call make_flow(pendulum, fine, .false., fallback)
    end if
    call make_processed(pendulum, series, int(numerics%steps_per_period), drifts, kicks, fit, table)
    call make_processed_batch(table, fastest, fallback, flow)
  end subroutine make_processed_flow

end module kz_kernel_flows
