!> Chaotic attractors: recognised by a positive largest Lyapunov exponent of orbits that nothing traps, known by a cover
!> of small cells that long orbits on them visit.
module kz_attractors_chaos
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_cycles_cycles, only: attractor_t, half_period_images, RUNNING
  use kz_cycles_features, only: find_features
  use kz_computed_bands, only: find_band, has_band, mirrored_band, states_in_band
  use kz_computed_curves, only: curve_t
  use kz_computed_grid, only: regions_t, find_regions, cover_cell, COVER
  use kz_attractors_cycle_search, only: search_t, append_with_image
  use kz_maps_states, only: states_to_map, states_to_physical
  use kz_model_pendulum, only: pendulum_t, pairing_symmetry, MIRROR
  implicit none
  private
  public :: find_chaos, carry_chaos, set_cover, append_cover, is_damped, widen

  !> Periods before the cover is taken, while it is taken, and of each lane's exponent.
  integer, parameter :: TRANSIENT = 20000, VISITS = 40000, EXPONENT_PERIODS = 400, FEATURE_PERIODS = 500
  !> First test: neighbours of a chaotic orbit part so much within so many periods; else the orbit is only slow.
  integer, parameter :: PARTING_PERIODS = 2000
  real(dp), parameter :: PARTED = 100
  !> Periods for which a cover carried to another pendulum is visited anew, and those before.
  integer, parameter :: CARRIED_VISITS = 1500, CARRIED_TRANSIENT = 100
  !> An exponent counts as positive if it exceeds so many standard errors.
  real(dp), parameter :: CONFIDENCE = 5
  !> Periods for a second measurement of a small one: tangents of running states grow too, by a bounded factor.
  integer, parameter :: SLOW_PERIODS = 8000
  !> Orbits are examined only where damping shrinks areas by at least exp(-SHRUNK) meanwhile: else conservative chaos
  !> looks the same.
  real(dp), parameter :: SHRUNK = 30

contains

  !> Follows a bundle of orbits from the physical state (u, v). If no trapping region holds any of them and they
  !> separate, it appends a chaotic attractor. A long chaotic transient does not count, because one of its orbits is
  !> trapped in the end. With damping so weak that areas hardly shrink, or if the orbits stay beyond the regions, it
  !> appends nothing.
  subroutine find_chaos(search, regions, u, v, attractors)
    type(search_t), intent(inout) :: search !< the flows and the longest period of the search
    type(regions_t), intent(in) :: regions !< the trapping regions: a bundle that they trap is not chaotic
    real(dp), intent(in) :: u, v !< start, half-turns, rad per drive radian
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue, which gains what is found
    type(attractor_t) :: attractor
    logical, allocatable :: visited(:), image(:)
    logical :: trapped
    integer :: lane

    if (.not. is_damped(search%pendulum)) return
    if (.not. neighbours_part(search%flow, u, v)) return
    do lane = 1, WIDTH
      call search%flow%put(lane, u, v + 1e-9_dp*lane)
    end do
    call search%flow%to_map(WIDTH)
    call visit(search%flow, regions, attractors, TRANSIENT, VISITS, visited, trapped)
    if (trapped .or. .not. any(visited)) return
    call measure_exponent(search%flow, attractor%lyapunov, attractor%lyapunov_error)
    if (attractor%lyapunov <= CONFIDENCE*attractor%lyapunov_error) return
    image = set_cover(search, regions, [(lane, lane=1, WIDTH)], VISITS, .false., attractor, visited)
    call search%flow%to_physical(1)
    call find_features(search%sampling_flow, search%pendulum, attractor, search%flow%u(:1), search%flow%v(:1), &
                       FEATURE_PERIODS)
    if (attractor%symmetric) then
      attractor%mean = 0
      attractor%mean_velocity = 0
    end if
    call append_cover(search, image, attractor, attractors)
  end subroutine find_chaos

  !> Whether areas shrink so fast that what goes on for long attracts.
  pure logical function is_damped(pendulum)
    type(pendulum_t), intent(in) :: pendulum !< its damping counts

    is_damped = 2*PI*pendulum%beta*(TRANSIENT + VISITS) >= SHRUNK
  end function is_damped

  !> Carries a chaotic attractor or a running state to a pendulum nearby. Its cover is what a bundle of orbits from the
  !> old one visits, and the cells beside, which longer orbits would visit: right enough for pictures that move. It
  !> appends nothing where a trapping region holds one of the orbits.
  subroutine carry_chaos(search, regions, old, attractors)
    type(search_t), intent(inout) :: search !< the flows of the pendulum
    type(regions_t), intent(in) :: regions !< its trapping regions
    type(attractor_t), intent(in) :: old !< the attractor
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue, which gains it and its image
    type(attractor_t) :: attractor
    type(curve_t) :: curve
    logical, allocatable :: visited(:), image(:)
    logical :: trapped
    integer :: lane

    call put_on(search%flow, regions, old)
    call visit(search%flow, regions, attractors, CARRIED_TRANSIENT, CARRIED_VISITS, visited, trapped)
    if (trapped) return
    attractor = old
    if (attractor%period == RUNNING) then
      attractor%mean_velocity = search%flow%turns(1)/real(CARRIED_TRANSIENT + CARRIED_VISITS, dp)
      call find_band(search%flow, search%pendulum%beta, search%flow%u(:WIDTH), search%flow%v(:WIDTH), attractors, &
                     attractor%band, curve)
    end if
    if (.not. (any(visited) .or. has_band(attractor))) return
    call widen(visited)
    image = set_cover(search, regions, [(lane, lane=1, WIDTH)], CARRIED_VISITS, .true., attractor, visited)
    call append_cover(search, image, attractor, attractors)
  end subroutine carry_chaos

  !> Puts states near an attractor into the lanes: in its band, or in cells of its cover.
  subroutine put_on(flow, regions, attractor)
    class(flow_t), intent(inout) :: flow
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractor
    integer, allocatable :: inner(:)
    real(dp) :: u(WIDTH), v(WIDTH)
    integer :: lane, cell

    if (has_band(attractor)) then
      call states_in_band(attractor%band, u, v)
      call flow%put_all(u, v)
      return
    end if
    call find_inner(attractor%cover, inner)
    do lane = 1, WIDTH
      cell = inner(1 + (lane - 1)*size(inner)/WIDTH) - 1
      call flow%put(lane, 2*(mod(cell, COVER) + 0.5_dp)/COVER - 1, regions%top*(2*(cell/COVER + 0.5_dp)/COVER - 1))
    end do
  end subroutine put_on

  !> The cells of a cover whose four neighbours belong to it too; all, where there are none.
  pure subroutine find_inner(cover_cells, inner)
    integer, intent(in) :: cover_cells(:)
    integer, allocatable, intent(out) :: inner(:)
    logical, allocatable :: covered(:)
    integer :: i

    allocate (covered(1 - COVER:COVER**2 + COVER), source=.false.)
    covered(cover_cells) = .true.
    inner = pack(cover_cells, [(all(covered(cover_cells(i) + [-COVER, -1, 1, COVER])), i=1, size(cover_cells))])
    if (size(inner) == 0) inner = cover_cells
  end subroutine find_inner

  !> Marks the four neighbours of every marked cell. (The first and last columns are neighbours across the circle.)
  pure subroutine widen(marked)
    logical, intent(inout) :: marked(COVER, COVER) !< cells of a cover
    logical, allocatable :: before(:, :)

    allocate (before, source=marked)
    marked = before .or. cshift(before, 1, 1) .or. cshift(before, -1, 1)
    marked(:, 2:) = marked(:, 2:) .or. before(:, :COVER - 1)
    marked(:, :COVER - 1) = marked(:, :COVER - 1) .or. before(:, 2:)
  end subroutine widen

  !> Appends an attractor with its cover, and its image if that is another one.
  subroutine append_cover(search, image, attractor, attractors)
    type(search_t), intent(inout) :: search !< the flows
    logical, intent(in) :: image(:) !< the cells of the image, of set_cover
    type(attractor_t), intent(inout) :: attractor !< attractor that joins the catalogue
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue

    call append_with_image(search, attractor, attractors)
    if (attractor%symmetry == 0 .or. attractor%symmetric) return
    attractors(size(attractors))%cover = cells_of(image)
    if (attractor%period == RUNNING) &
      call set_image_band(search, attractors(:size(attractors) - 1), attractors(size(attractors)))
  end subroutine append_cover

  !> Sets the band of an image, which has that of its original.
  subroutine set_image_band(search, others, image)
    type(search_t), intent(inout) :: search
    type(attractor_t), intent(in) :: others(:)
    type(attractor_t), intent(inout) :: image
    type(curve_t) :: curve
    real(dp) :: u(WIDTH), v(WIDTH)

    if (image%symmetry == MIRROR) then
      image%band = mirrored_band(image%band)
    else if (has_band(image)) then
      call states_in_band(image%band, u, v)
      call states_to_physical(search%flow, u, v)
      call half_period_images(search%sampling_flow, u, v)
      call states_to_map(search%flow, u, v)
      call find_band(search%flow, search%pendulum%beta, u, v, others, image%band, curve)
    end if
  end subroutine set_image_band

  !> The numbers of the marked cells.
  pure function cells_of(marked) result(cells)
    logical, intent(in) :: marked(COVER**2)
    integer, allocatable :: cells(:)
    integer :: cell

    cells = pack([(cell, cell=1, COVER**2)], marked)
  end function cells_of

  !> Follows the lanes of a flow, and marks the cells of the cover that they visit after the transient; trapped = a
  !> trapping region holds one of them.
  subroutine visit(flow, regions, attractors, transient, periods, visited, trapped)
    class(flow_t), intent(inout) :: flow
    type(regions_t), intent(in) :: regions
    type(attractor_t), intent(in) :: attractors(:)
    integer, intent(in) :: transient, periods
    logical, allocatable, intent(out) :: visited(:)
    logical, intent(out) :: trapped
    integer :: region(WIDTH), period, lane, cell

    allocate (visited(COVER**2), source=.false.)
    do period = 1, transient + periods
      call flow%advance(WIDTH)
      call find_regions(regions, attractors, WIDTH, flow%u(:WIDTH), flow%v(:WIDTH), region)
      trapped = any(region > 0)
      if (trapped) return
      if (period <= transient) cycle
      do lane = 1, WIDTH
        cell = cover_cell(regions, flow%u(lane), flow%v(lane))
        if (cell > 0) visited(cell) = .true.
      end do
    end do
  end subroutine visit

  !> Whether neighbours of the orbit from (u, v) part.
  function neighbours_part(flow, u, v) result(part)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: u, v
    logical :: part
    real(dp) :: mean, error

    call flow%put(1, u, v)
    call flow%to_map(1)
    call exponent(flow, 1, PARTING_PERIODS, mean, error)
    part = PARTING_PERIODS*mean > log(PARTED)
  end function neighbours_part

  !> The cover: all visited cells. An attractor whose cover meets its own image in most cells is that image.
  function set_cover(search, regions, lanes, periods, widened, attractor, visited) result(image)
    type(search_t), intent(inout) :: search !< whose flow holds orbits on the attractor
    type(regions_t), intent(in) :: regions !< say where cells lie
    integer, intent(in) :: lanes(:), periods !< lanes of these orbits; drive periods for which images are followed
    logical, intent(in) :: widened !< whether the visited cells are widened ones
    type(attractor_t), intent(inout) :: attractor !< whose symmetry and cover are set
    logical, intent(inout) :: visited(COVER**2) !< cells that orbits visit
    logical, allocatable :: image(:) !< boxes of the cover of the images

    allocate (image(COVER**2), source=.false.)
    attractor%symmetry = pairing_symmetry(search%pendulum)
    if (attractor%symmetry == MIRROR) then
      image = visited(COVER**2:1:-1)
    else if (attractor%symmetry /= 0) then
      call visit_images(search, regions, lanes, periods, image)
      if (widened) call widen(image)
    end if
    attractor%symmetric = 2*count(visited .and. image) > count(visited)
    if (attractor%symmetric) visited = visited .or. image
    attractor%cover = cells_of(visited)
  end function set_cover

  !> Marks the cells that the images of some lanes visit, half a drive period later; the lanes stay as they are.
  subroutine visit_images(search, regions, lanes, periods, image)
    type(search_t), intent(inout) :: search
    type(regions_t), intent(in) :: regions
    integer, intent(in) :: lanes(:), periods
    logical, intent(inout) :: image(COVER**2)
    real(dp) :: u(size(lanes)), v(size(lanes)), kept_u(WIDTH), kept_v(WIDTH)
    integer :: n, period, lane, cell

    n = size(lanes)
    associate (flow => search%flow)
      kept_u = flow%u(:WIDTH)
      kept_v = flow%v(:WIDTH)
      u = flow%u(lanes)
      v = flow%v(lanes)
      call states_to_physical(flow, u, v)
      call half_period_images(search%sampling_flow, u, v)
      call flow%put_all(u, v)
      call flow%to_map(n)
      do period = 1, periods
        call flow%advance(n)
        do lane = 1, n
          cell = cover_cell(regions, flow%u(lane), flow%v(lane))
          if (cell > 0) image(cell) = .true.
        end do
      end do
      call flow%put_all(kept_u, kept_v)
    end associate
  end subroutine visit_images

  !> Largest Lyapunov exponent per period of the orbits in all lanes, with standard error; 0 if small and falling.
  subroutine measure_exponent(flow, mean, error)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(out) :: mean, error
    real(dp) :: first

    call exponent(flow, WIDTH, EXPONENT_PERIODS, mean, error)
    if (EXPONENT_PERIODS*mean > 2*log(PARTED)) return
    first = mean
    call exponent(flow, WIDTH, SLOW_PERIODS, mean, error)
    if (mean < 0.5_dp*first) mean = 0
  end subroutine measure_exponent

  !> Largest Lyapunov exponent per period of the orbits in the lanes 1 .. n, with its standard error over them.
  subroutine exponent(flow, n, periods, mean, error)
    class(flow_t), intent(inout) :: flow
    integer, intent(in) :: n, periods
    real(dp), intent(out) :: mean, error
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
