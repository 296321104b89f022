!> Running states: closed curves of the stroboscopic map that attract, and that an orbit fills and never closes. Since
!> damping shrinks all areas alike, such a curve cannot enclose one: it goes around the cylinder. A band round it shows
!> that it attracts, and the map along it that it does not lock to a cycle. Without any drive a rotation that attracts
!> is such a curve too, whatever its period.
!>
!> Where no band is found, averages along orbits tell: weighted by a smooth window, these converge faster than any power
!> of its length where the motion is quasi-periodic (S. Das, Y. Saiki, E. Sander, J. A. Yorke, Nonlinearity 30 (2017)
!> 4111), and like a square root where it is chaotic; where a motion still approaches something, those of two windows
!> differ. A slow spiral beside a bifurcation, whose averages hardly change, does not come to all angles.
module kz_attractors_running
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_attractors_chaos, only: append_cover, set_cover, is_damped, widen
  use kz_attractors_cycle_search, only: search_t
  use kz_cycles_cycles, only: attractor_t, RUNNING
  use kz_cycles_features, only: ROTATING
  use kz_computed_bands, only: find_band, has_band
  use kz_computed_curves, only: curve_t, is_locked, mean_turns, node, resample, window_weight, NODES
  use kz_computed_grid, only: regions_t, find_regions, cover_cell, COVER
  use kz_maps_states, only: states_to_physical
  use kz_model_pendulum, only: is_driven
  use kz_vector_map, only: flow_t, WIDTH, PI
  implicit none
  private
  public :: find_running

  !> Periods of a window, of which there are two; periods during which the cover is taken.
  integer, parameter :: WINDOW = 2000, VISITS = 4000
  !> Averages: turns a period, growth of a tangent, velocity, its square, cosine of the angle.
  integer, parameter :: TURNS = 1, GROWN = 2, AVERAGES = 5
  !> Parts of the circle, each of which a running state visits.
  integer, parameter :: PARTS = 16
  !> Largest change of averages between two windows of a stationary motion; two orbits on one curve also differ by less.
  real(dp), parameter :: SAME = 1e-6_dp
  !> Turns in a period: mean values of two windows that differ by less are more precise than the curve.
  real(dp), parameter :: SETTLED_WITHIN = 1e-11_dp
  !> Turns in a period, by which two orbits that may lie on one curve differ at most.
  real(dp), parameter :: NEAR = 1e-3_dp
  !> A tangent grows or shrinks by less in both windows: else the motion is chaotic, or locked to a cycle.
  real(dp), parameter :: BOUNDED = 100
  !> Growth or shrinking of a tangent within a window from which it does not return; checked every so many periods.
  real(dp), parameter :: LOST = 1e8_dp
  integer, parameter :: LOOKED_AT = 100
  !> End of the first window, in lifetimes 1/(2 pi beta): before, hardly any orbit's averages have converged to SAME.
  real(dp), parameter :: EARLIEST = 10

  !> State of the orbits in the lanes of a flow after a window.
  type :: record_t
    real(dp) :: average(AVERAGES, WIDTH) = 0
    real(dp) :: growth(WIDTH) = 0        !< logarithm of a tangent's length, of all windows
    real(dp) :: tangent(2, 2, WIDTH) = 0
    logical :: trapped(WIDTH) = .false.  !< in a trapping region
  end type record_t

contains

  !> Looks for a running state among orbits; appends the first with its cover and band, and its image if another one.
  subroutine find_running(search, regions, state, age, attractors)
    type(search_t), intent(inout) :: search !< the flows and the longest period of the search
    type(regions_t), intent(in) :: regions !< the trapping regions: what they hold is not looked at
    real(dp), intent(in) :: state(:, :) !< [2, n <= WIDTH] where the orbits begin, half-turns, rad per drive radian
    real(dp), intent(in) :: age !< drive periods after their starts: nothing is looked for too early
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue, which gains what is found
    type(attractor_t) :: attractor
    type(record_t) :: record
    type(curve_t) :: curve
    real(dp) :: before(AVERAGES, WIDTH)
    logical, allocatable :: visited(:), image(:)
    integer, allocatable :: lane(:)
    logical :: settled
    integer :: n, i

    n = size(state, 2)
    if (.not. is_damped(search%pendulum) .or. 2*PI*search%pendulum%beta*(age + WINDOW) < EARLIEST) return
    call search%flow%put_all(state(1, :), state(2, :))
    call search%flow%to_map(n)
    record%tangent(1, 1, :) = 1
    call follow_window(search%flow, regions, attractors, n, record)
    lane = pack([(i, i=1, n)], [(may_fill(record, i, LOST), i=1, n)])
    if (size(lane) == 0) return
    before = record%average
    call follow_window(search%flow, regions, attractors, n, record)
    lane = pack([(i, i=1, n)], [(may_fill(record, i, LOST), i=1, n)])
    if (size(lane) == 0) return
    lane = pack(lane, [(abs(record%average(TURNS, lane(i)) - record%average(TURNS, lane(1))) < NEAR, i=1, size(lane))])
    attractor%mean_velocity = record%average(TURNS, lane(1))
    attractor%lyapunov = record%average(GROWN, lane(1))
    attractor%lyapunov_error = hypot(attractor%lyapunov, before(GROWN, lane(1))) ! deviation from 0 over both windows
    settled = abs(attractor%mean_velocity - before(TURNS, lane(1))) < SETTLED_WITHIN
    call find_band(search%flow, search%pendulum%beta, search%flow%u(lane), search%flow%v(lane), attractors, &
                   attractor%band, curve)
    if (has_band(attractor)) then
      if (is_driven(search%pendulum) /= 0) then
        if (is_locked(curve, search%max_period)) return
        if (.not. settled) attractor%mean_velocity = mean_turns(curve)
      else if (.not. settled) then
        attractor%mean_velocity = own_velocity(search%flow, curve)
      end if
      call mark_curve(regions, curve, visited)
    else
      lane = pack(lane, [(is_steady(record, before, lane(i)), i=1, size(lane))])
      if (size(lane) == 0) return
      lane = pack(lane, [(all(abs(record%average(:, lane(i)) - record%average(:, lane(1))) < SAME), i=1, size(lane))])
      call visit_cells(search%flow, regions, n, lane, visited)
      if (.not. any(visited)) return ! it does not come to all angles, or is faster than the cover reaches
    end if
    if (abs(attractor%mean_velocity) < SAME) return ! all states of it are at rest but for the drive
    if (any(attractors%period == RUNNING .and. abs(attractors%mean_velocity - attractor%mean_velocity) < SAME)) return
    attractor%period = RUNNING
    attractor%centre = ROTATING
    attractor%winding = nint(sign(1.0_dp, attractor%mean_velocity))
    call widen(visited) ! to where longer orbits would come
    image = set_cover(search, regions, lane, VISITS, .true., attractor, visited)
    call append_cover(search, image, attractor, attractors)
  end subroutine find_running

  !> The mean velocity along a curve where nothing is driven, from the time that a turn takes.
  function own_velocity(flow, curve) result(mean)
    class(flow_t), intent(inout) :: flow
    type(curve_t), intent(in) :: curve
    real(dp) :: mean, u(NODES), v(NODES), physical(NODES)
    logical :: found
    integer :: j

    u = [(node(j), j=1, NODES)]
    v = curve%v
    call states_to_physical(flow, u, v)
    where (u - [(node(j), j=1, NODES)] > 1) u = u - 2
    where (u - [(node(j), j=1, NODES)] < -1) u = u + 2
    call resample(u, v, physical, found)
    mean = NODES/sum(1/merge(physical, curve%v, found))
  end function own_velocity

  !> Marks the cells of the cover that a curve visits.
  pure subroutine mark_curve(regions, curve, visited)
    type(regions_t), intent(in) :: regions
    type(curve_t), intent(in) :: curve
    logical, allocatable, intent(out) :: visited(:)
    integer :: cell, j

    allocate (visited(COVER**2), source=.false.)
    do j = 1, NODES
      cell = cover_cell(regions, node(j), curve%v(j))
      if (cell > 0) visited(cell) = .true.
    end do
  end subroutine mark_curve

  !> Whether a lane is on a closed curve: not trapped, averages converged, tangent neither growing nor shrinking.
  pure logical function is_steady(record, before, lane)
    type(record_t), intent(in) :: record
    real(dp), intent(in) :: before(AVERAGES, WIDTH) !< averages of the window before
    integer, intent(in) :: lane

    is_steady = may_fill(record, lane, BOUNDED) .and. all(abs(record%average(:, lane) - before(:, lane)) < SAME)
  end function is_steady

  !> Whether a lane may be on a closed curve: not trapped, and its tangent changed by less than a factor.
  pure logical function may_fill(record, lane, factor)
    type(record_t), intent(in) :: record
    integer, intent(in) :: lane
    real(dp), intent(in) :: factor

    may_fill = .not. record%trapped(lane) .and. abs(record%growth(lane)) < log(factor)
  end function may_fill

  !> Follows the lanes 1 .. n through a window, or until none can be on a closed curve.
  subroutine follow_window(flow, regions, attractors, n, record)
    class(flow_t), intent(inout) :: flow
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    integer, intent(in) :: n
    type(record_t), intent(inout) :: record
    real(dp) :: weight, weights, length, turned, u_before(n)
    integer(c_int64_t) :: turns_before(n)
    integer :: region(WIDTH), period, i

    record%average = 0
    weights = 0
    do period = 1, WINDOW
      u_before = flow%u(:n)
      turns_before = flow%turns(:n)
      call flow%advance_tangent(n, record%tangent)
      call find_regions(regions, attractors, n, flow%u(:n), flow%v(:n), region)
      weight = window_weight(period, WINDOW)
      weights = weights + weight
      do i = 1, n
        length = norm2(record%tangent(:, 1, i))
        turned = flow%turns(i) - turns_before(i) + 0.5_dp*(flow%u(i) - u_before(i))
        record%average(:, i) = record%average(:, i) &
                               + weight*[turned, log(length), flow%v(i), flow%v(i)**2, cos(PI*flow%u(i))]
        record%trapped(i) = record%trapped(i) .or. region(i) > 0
        record%growth(i) = record%growth(i) + log(length)
        record%tangent(:, :, i) = reshape([record%tangent(:, 1, i)/length, 0.0_dp, 0.0_dp], [2, 2])
      end do
      if (mod(period, LOOKED_AT) /= 0) cycle
      if (.not. any([(may_fill(record, i, LOST), i=1, n)])) exit
    end do
    record%average = record%average/weights
  end subroutine follow_window

  !> Marks the cells of the cover that the lanes visit; none where some angles are never visited.
  subroutine visit_cells(flow, regions, n, lane, visited)
    class(flow_t), intent(inout) :: flow
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: n, lane(:)
    logical, allocatable, intent(out) :: visited(:)
    logical :: seen(0:PARTS - 1)
    integer :: period, i, cell

    allocate (visited(COVER**2), source=.false.)
    seen = .false.
    do period = 1, VISITS
      call flow%advance(n)
      do i = 1, size(lane)
        cell = cover_cell(regions, flow%u(lane(i)), flow%v(lane(i)))
        if (cell > 0) visited(cell) = .true.
        seen(min(int(modulo(flow%u(lane(i)), 2.0_dp)*(PARTS/2)), PARTS - 1)) = .true.
      end do
    end do
    if (.not. all(seen)) visited = .false.
  end subroutine visit_cells

end module kz_attractors_running
