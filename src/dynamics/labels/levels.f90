!> The precision levels at which a pendulum's orbits are followed with their errors, each made when it is first needed.
module kz_labels_levels
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use, intrinsic :: ieee_exceptions, only: ieee_set_halting_mode, ieee_set_flag, ieee_usual
  use kz_taylor_pairs, only: pairs_t, pair_series_t, make_pairs
  use kz_taylor_probes, only: measure_quad
  use kz_taylor_taylor, only: drive_t, make_drive, TAYLOR_STEPS
  use kz_kernel_flows, only: make_flow
  use kz_labels_carrier, only: carrier_t, make_carrier, BY_FINE_MAP, BY_PAIRS, BY_SERIES
  use kz_labels_period_error, only: period_error_t, speed_probes_t, make_speed_probes, measure_period
  use kz_labels_orbits, only: outlook_t, TOLERABLE
  use kz_vector_map, only: flow_t
  use kz_vector_schemes, only: PROCESSED_ROW, SPLIT6_ROW
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  use kz_processed_tables, only: MOST_DAMPING
  implicit none
  private
  public :: levels_t, carrier_of, prepare_level, is_useful, outlook_from

  !> Levels of dynamics_labels.h.
  integer, parameter, public :: LEVEL_DOUBLE = 0
  integer, parameter, public :: LEVEL_FINE = 1, LEVEL_PAIRS_16 = 2, LEVEL_PAIRS_28 = 5, LEVEL_QUAD = 6
  !> rad: of a period in double precision with more steps; with most steps of all.
  real(dp), parameter :: FINE_ERROR = 1e-14_dp
  integer, parameter :: FEWEST_FINE_STEPS = 48, MOST_FINE_STEPS = 320
  !> rad: below it the error of a period is that of rounding.
  real(dp), parameter :: ROUNDED = 1e-13_dp
  !> Growth of an error over a label's tolerance beyond which quad precision without pairs does not decide either.
  real(dp), parameter :: LOST_IN_PAIRS = 3000
  !> rad: of a period in pairs of doubles.
  real(dp), parameter :: PAIRS_ERRORS(LEVEL_PAIRS_16:LEVEL_PAIRS_28) = [1e-16_dp, 1e-20_dp, 1e-24_dp, 3e-29_dp]

  type :: levels_t
    type(pendulum_t) :: pendulum
    type(numerics_t) :: numerics                !< numerics of the scene
    real(dp) :: worst(LEVEL_DOUBLE:LEVEL_PAIRS_28) = 0 !< rad: largest error of a period at each prepared level
    type(speed_probes_t), allocatable :: probes
    type(period_error_t) :: error               !< error of a period of the scene's map
    class(flow_t), allocatable :: fine          !< double precision with more steps
    type(period_error_t) :: fine_error
    type(pairs_t) :: pairs(LEVEL_PAIRS_16:LEVEL_PAIRS_28)
    type(pair_series_t) :: pair_series          !< series shared by all levels of pairs
    type(drive_t), allocatable :: drive         !< quad precision
    real(dp) :: quad_error = 0                  !< error of a quad period, relative to hypot(pi, v)
  end type levels_t

contains

  !> Makes what a level needs and has not yet.
  subroutine prepare_level(levels, level, flow, fastest)
    type(levels_t), intent(inout) :: levels !< levels of a pendulum
    integer, intent(in) :: level !< LEVEL_DOUBLE or a finer one
    class(flow_t), intent(in) :: flow !< the scene's map
    real(dp), intent(in) :: fastest !< speeds that occur, rad per drive radian

    call ieee_set_halting_mode(ieee_usual, .false.) ! an overflow of too few steps is measured, not trapped
    if (.not. allocated(levels%probes)) then
      allocate (levels%probes)
      call make_speed_probes(levels%pendulum, fastest, levels%probes)
      call measure_period(flow, levels%probes, levels%error)
      levels%worst(LEVEL_DOUBLE) = levels%error%worst
    end if
    select case (level)
    case (LEVEL_FINE)
      if (.not. allocated(levels%fine)) call make_fine(levels, fastest)
    case (LEVEL_PAIRS_16:LEVEL_PAIRS_28)
      if (.not. allocated(levels%pairs(level)%table)) call make_table(levels, level, fastest)
    case (LEVEL_QUAD)
      if (.not. allocated(levels%drive)) then
        allocate (levels%drive)
        call make_drive(levels%drive, levels%pendulum, TAYLOR_STEPS)
        levels%quad_error = measure_quad(levels%drive, fastest)
      end if
    end select
    call ieee_set_flag(ieee_usual, .false.)
  end subroutine prepare_level

  !> Tables of pairs of doubles. Their steps are expected from those of the coarser ones, which are made first where
  !> this process has not met them yet: what a rank has done before must not change a label. The steps of the coarsest
  !> are expected from the scene's, which have fewer terms than would show their order, and a quarter more.
  recursive subroutine make_table(levels, level, fastest)
    type(levels_t), intent(inout) :: levels
    integer, intent(in) :: level
    real(dp), intent(in) :: fastest
    real(dp) :: error
    integer :: steps

    steps = 0
    error = levels%error%worst
    if (levels%numerics%scheme == PROCESSED_ROW .and. error > ROUNDED) &
      steps = ceiling(1.25_dp*levels%numerics%steps_per_period)
    if (level > LEVEL_PAIRS_16) then
      if (.not. allocated(levels%pairs(level - 1)%table)) call make_table(levels, level - 1, fastest)
      associate (coarser => levels%pairs(level - 1))
        if (size(coarser%table) > 0) then
          steps = coarser%table(1)%n_steps
          error = coarser%table(1)%error
        end if
      end associate
    end if
    levels%pair_series%kept = levels%numerics%series
    call make_pairs(levels%pendulum, PAIRS_ERRORS(level), fastest, levels%pairs(level), levels%pair_series, steps, &
                    error)
    levels%worst(level) = levels%pairs(level)%error
  end subroutine make_table

  !> Makes the processed splitting, or split6 where that does not serve, with steps enough to leave little but rounding.
  subroutine make_fine(levels, fastest)
    type(levels_t), intent(inout) :: levels
    real(dp), intent(in) :: fastest
    type(numerics_t) :: fine
    logical :: is_served
    integer :: n

    is_served = levels%pendulum%beta <= MOST_DAMPING
    n = FEWEST_FINE_STEPS
    if (levels%numerics%scheme == PROCESSED_ROW) n = max(n, 2*int(0.82_dp*levels%numerics%steps_per_period))
    do
      fine = numerics_t(merge(PROCESSED_ROW, SPLIT6_ROW, is_served), n, fastest=fastest, series=levels%numerics%series)
      call make_flow(levels%pendulum, fine, .true., levels%fine)
      call measure_period(levels%fine, levels%probes, levels%fine_error)
      levels%worst(LEVEL_FINE) = levels%fine_error%worst
      if (levels%fine_error%worst <= FINE_ERROR .or. n >= MOST_FINE_STEPS) return
      n = min(MOST_FINE_STEPS, 2*int(0.7_dp*n))
    end do
  end subroutine make_fine

  !> Whether a level gains so much on the next cheaper one that it pays: the one with more steps may not.
  pure logical function is_useful(levels, level)
    type(levels_t), intent(in) :: levels !< levels of a pendulum; LEVEL_DOUBLE has been prepared
    integer, intent(in) :: level !< LEVEL_DOUBLE or a finer one
    real(dp), parameter :: GAIN = 30

    is_useful = level /= LEVEL_FINE .or. levels%error%worst > GAIN*FINE_ERROR
  end function is_useful

  !> Forecasts error growth after a level. Pairs of doubles alone are skipped, and for other pairs: whatever their
  !> digits, labels are the same and so is the evidence for them. Quad precision is tried again, without the pairs.
  pure function outlook_from(levels, level) result(outlook)
    type(levels_t), intent(in) :: levels !< levels of a pendulum; the level has been prepared
    integer, intent(in) :: level !< LEVEL_DOUBLE or a finer one
    type(outlook_t) :: outlook

    if (level == LEVEL_QUAD) then
      outlook%next = LEVEL_QUAD
      outlook%after = LEVEL_QUAD + 1
      outlook%reach = LOST_IN_PAIRS*TOLERABLE
      return
    end if
    outlook%next = level + 1
    if (.not. is_useful(levels, int(outlook%next))) outlook%next = outlook%next + 1
    outlook%after = outlook%next
    if (outlook%next < LEVEL_PAIRS_16 .or. outlook%next >= LEVEL_PAIRS_28) return
    outlook%after = outlook%next + 1
    outlook%reach = max(TOLERABLE, TOLERABLE*levels%worst(level)/PAIRS_ERRORS(outlook%next))
  end function outlook_from

  !> Returns the carrier of orbits at a prepared level.
  subroutine carrier_of(levels, level, flow, carrier)
    type(levels_t), target, intent(in) :: levels !< levels of a pendulum
    integer, intent(in) :: level !< LEVEL_DOUBLE or a finer one
    class(flow_t), intent(in) :: flow !< the scene's map
    type(carrier_t), intent(out) :: carrier !< the carrier

    call make_carrier(flow, levels%error, carrier)
    select case (level)
    case (LEVEL_FINE)
      carrier%means = BY_FINE_MAP
      allocate (carrier%fine, source=levels%fine)
      allocate (carrier%shown, source=levels%fine)
      carrier%fine_error = levels%fine_error
    case (LEVEL_PAIRS_16:LEVEL_PAIRS_28)
      carrier%means = BY_PAIRS
      carrier%pairs => levels%pairs(level)
    case (LEVEL_QUAD)
      carrier%means = BY_SERIES
      carrier%drive => levels%drive
      carrier%drive_error = levels%quad_error
    end select
  end subroutine carrier_of

end module kz_labels_levels
