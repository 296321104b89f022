!> Chaotic attractors: recognised by a positive largest Lyapunov exponent of orbits that nothing traps, known by a cover of small
!> cells that long orbits on them visit.
module kz_attractors_chaos
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_lanes_map, only: flow_t, WIDTH, PI
  use kz_cycles_cycles, only: attractor_t
  use kz_cycles_features, only: find_features
  use kz_grown_grid, only: regions_t, find_regions, cover_cell, COVER
  use kz_attractors_cycle_search, only: search_t, add_with_mirror
  use kz_model_pendulum, only: is_mirrored
  implicit none
  private
  public :: find_chaos

  !> Periods before the cover is taken, while it is taken, and of each lane's exponent.
  integer, parameter :: SETTLE = 20000, VISITS = 40000, EXPONENT_PERIODS = 400, FEATURE_PERIODS = 500
  !> Before all that: neighbours of a chaotic orbit part so much within so many periods. Where they do not, an orbit is only slow.
  integer, parameter :: PARTING_PERIODS = 2000
  real(dp), parameter :: PARTED = 100
  !> An exponent counts as positive if it exceeds so many standard errors.
  real(dp), parameter :: CONFIDENCE = 5
  !> Orbits are examined only where damping shrinks areas by at least exp(-SHRUNK) meanwhile: else conservative chaos looks the
  !> same.
  real(dp), parameter :: SHRUNK = 30

contains

  !> Follows a bundle of orbits from the physical state (u, v). If no trapping region holds any of them and they separate, it appends a
  !> chaotic attractor. A long chaotic transient does not count, because one of its orbits is trapped in the end. With damping so weak
  !> that areas hardly shrink, it appends nothing.
  subroutine find_chaos(search, regions, u, v, attractors)
    !> the flows and the longest period of the search
    type(search_t), intent(inout) :: search
    !> the trapping regions: a bundle that they trap is not chaotic
    type(regions_t), intent(in) :: regions
    !> start, half-turns
    real(dp), intent(in) :: u
    !> start, rad per drive radian
    real(dp), intent(in) :: v
    !> the catalogue, which gains what is found
    type(attractor_t), allocatable, intent(inout) :: attractors(:)
    type(attractor_t) :: attractor
    integer, allocatable :: visits_of(:)
    integer :: region(WIDTH), period, lane

    if (2*PI*search%pendulum%beta*(SETTLE + VISITS) < SHRUNK) return
    if (.not. neighbours_part(search%flow, u, v)) return
    do lane = 1, WIDTH
      call search%flow%put(lane, u, v + 1e-9_dp*lane)
    end do
    call search%flow%to_map(WIDTH)
    allocate (visits_of(COVER**2), source=0)
    do period = 1, SETTLE + VISITS
      call search%flow%advance(WIDTH)
      call find_regions(regions, attractors, WIDTH, search%flow%u(:WIDTH), search%flow%v(:WIDTH), region)
      if (any(region > 0)) return
      if (period <= SETTLE) cycle
      do lane = 1, WIDTH
        call visit(search%flow%u(lane), search%flow%v(lane))
      end do
    end do
    call exponent(search%flow, WIDTH, EXPONENT_PERIODS, attractor%lyapunov, attractor%lyapunov_error)
    if (attractor%lyapunov <= CONFIDENCE*attractor%lyapunov_error) return
    attractor%mirrored = is_mirrored(search%pendulum) /= 0
    call set_cover(attractor, visits_of)
    call search%flow%to_physical(1)
    call find_features(search%sampling_flow, search%pendulum, attractor, search%flow%u(1), search%flow%v(1), FEATURE_PERIODS)
    if (attractor%symmetric) then
      attractor%mean = 0
      attractor%mean_velocity = 0
    end if
    call add_with_mirror(search, attractor, attractors)
    if (attractor%mirrored .and. .not. attractor%symmetric) attractors(size(attractors))%cover = COVER**2 + 1 - attractor%cover
  contains
    subroutine visit(u_now, v_now)
      real(dp), intent(in) :: u_now
      real(dp), intent(in) :: v_now
      integer :: cell

      cell = cover_cell(regions, u_now, v_now)
      if (cell > 0) visits_of(cell) = visits_of(cell) + 1
    end subroutine visit
  end subroutine find_chaos

  !> Whether neighbours of the orbit from (u, v) part.
  function neighbours_part(flow, u, v) result(part)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v
    logical :: part
    real(dp) :: mean, error

    call flow%put(1, u, v)
    call flow%to_map(1)
    call exponent(flow, 1, PARTING_PERIODS, mean, error)
    part = PARTING_PERIODS*mean > log(PARTED)
  end function neighbours_part

  !> The cover: all visited cells. An attractor whose cover meets its own mirror image in most cells is that image.
  subroutine set_cover(attractor, visits_of)
    type(attractor_t), intent(inout) :: attractor
    integer, intent(in) :: visits_of(COVER**2)
    logical, allocatable :: visited(:)
    integer :: cell

    allocate (visited, source=visits_of > 0)
    attractor%symmetric = attractor%mirrored .and. 2*count(visited .and. visited(COVER**2:1:-1)) > count(visited)
    if (attractor%symmetric) visited = visited .or. visited(COVER**2:1:-1)
    attractor%cover = pack([(cell, cell=1, COVER**2)], visited)
  end subroutine set_cover

  !> Largest Lyapunov exponent per period of the orbits in the lanes 1 .. n, with its standard error over them.
  subroutine exponent(flow, n, periods, mean, error)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n
    integer, intent(in) :: periods
    real(dp), intent(out) :: mean
    real(dp), intent(out) :: error
    real(dp) :: tangent(2, 2, WIDTH), growth(WIDTH), length
    integer :: period, lane

    tangent = 0
    tangent(1, 1, :) = 1
    growth = 0
    do period = 1, periods
      call flow%advance_tangent(n, tangent)
      do lane = 1, n
        length = norm2(tangent(:, 1, lane))
        growth(lane) = growth(lane) + log(length)
        tangent(:, 1, lane) = tangent(:, 1, lane)/length
        tangent(:, 2, lane) = 0
      end do
    end do
    growth = growth/periods
    mean = sum(growth(:n))/n
    error = sqrt(sum((growth(:n) - mean)**2)/(n*max(n - 1.0_dp, 1.0_dp)))
  end subroutine exponent

end module kz_attractors_chaos
