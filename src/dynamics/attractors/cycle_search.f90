!> Discovery: recurrences of the stroboscopic map among states that no known trapping region has taken.
module kz_attractors_cycle_search
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_attractors_centres, only: find_centre, CENTRED
  use kz_model_pendulum, only: pendulum_t, is_driven, pairing_symmetry, HALF_PERIOD
  use kz_cycles_cycles, only: attractor_t, close_cycle, complete_attractor, enter_points, image_of, &
                              listed_from_lowest, SLOW
  use kz_computed_ellipses, only: rings_t, find_ellipses
  use kz_cycles_newton, only: newton, n_periods
  use kz_cycles_features, only: find_features
  use kz_computed_grid, only: ellipse_at
  use kz_maps_matrices, only: eigenvalues, IDENTITY
  use kz_maps_states, only: separation, same_state
  implicit none
  private
  public :: search_t, find_cycle, add_with_image, append_with_image, append, join, known

  !> The flows and settings of a search.
  type :: search_t
    type(pendulum_t) :: pendulum
    integer :: max_period = 48
    type(rings_t) :: rings !< rings on which trapping ellipses are tried
    class(flow_t), allocatable :: flow !< the scene's map
    class(flow_t), allocatable :: fine !< the map of published values
    class(flow_t), allocatable :: sampling_flow !< map with separate steps, for samples within a period
  end type search_t

  !> Largest number of recurrences of a state tried by Newton's method, the closest first.
  integer, parameter :: MOST_TRIES = 4
  !> Largest number of states tried for one period, where a bifurcation blurs the cycle.
  integer, parameter :: BLURRED_TRIES = 4
  !> Where the map of the recurrence stretches by more than this, no attracting cycle is near: about one that a fold
  !> bears or a period doubling ends, the map is like x -> 1 - a x**2, a <= 2, whose slope is at most 4.
  real(dp), parameter :: STRETCHED = 10
  !> Outcomes of Newton's method with the scene's steps: fine steps find no attracting cycle, a known one, or are
  !> unsure.
  integer, parameter :: NOTHING = 0, KNOWN_ONE = 1, UNSURE = 2
  !> Largest distance (rad) of the scene's cycle from that of fine steps; multiplier above which one surely repels.
  real(dp), parameter :: BESIDE = 1e-5_dp, SURELY = 1.01_dp

contains

  !> Tries physical states (at most WIDTH) whose orbits may have settled on unknown cycles, from state `next` on, until
  !> it finds one. It appends the cycle and its image.
  subroutine find_cycle(search, u, v, closeness, next, n_blurred, attractors)
    type(search_t), intent(inout) :: search !< the flows and the longest period of the search
    real(dp), intent(in) :: u(:), v(:) !< states to look from, half-turns, rad per drive radian
    real(dp), intent(in) :: closeness !< how near an orbit must come back to itself, rad
    integer, intent(inout) :: next !< in and out: the state to go on from; size(u) + 1 where all have been looked at
    !> In and out: how often the cycle of each period up to max_period was found blurred; 0 at first
    integer, intent(inout) :: n_blurred(:)
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue, which gains what is found
    real(dp), allocatable :: orbit_u(:, :), orbit_v(:, :)
    integer :: n, n_known, last

    last = search%max_period
    if (is_weak(search)) last = max(last, CENTRED)
    allocate (orbit_u(size(u), 0:last), orbit_v(size(u), 0:last))
    call search%flow%put_all(u, v)
    call search%flow%to_map(size(u))
    orbit_u(:, 0) = search%flow%u(:size(u))
    orbit_v(:, 0) = search%flow%v(:size(u))
    do n = 1, last
      call search%flow%advance(size(u))
      orbit_u(:, n) = search%flow%u(:size(u))
      orbit_v(:, n) = search%flow%v(:size(u))
    end do
    n_known = size(attractors)
    do while (next <= size(u) .and. size(attractors) == n_known)
      call try_recurrences(search, [u(next), v(next)], orbit_u(next, :), orbit_v(next, :), closeness, n_blurred, &
                           attractors)
      next = next + 1
    end do
  end subroutine find_cycle

  !> Polishes the closest recurrences of an orbit until one gives an attracting cycle; first, what it spirals around.
  subroutine try_recurrences(search, start, u, v, closeness, n_blurred, attractors)
    type(search_t), intent(inout) :: search
    real(dp), intent(in) :: start(2) !< its first state in physical coordinates
    real(dp), intent(in) :: u(0:) !< the orbit in those of the scene's map
    real(dp), intent(in) :: v(0:), closeness
    integer, intent(inout) :: n_blurred(:) !< for every period: how often its cycle has been found blurred
    type(attractor_t), allocatable, intent(inout) :: attractors(:)
    real(dp) :: distance(search%max_period), centre(2), spread
    type(attractor_t) :: candidate
    logical :: found, blurred
    integer :: tries, n, promise

    n = search%max_period
    if (ellipse_at(attractors, u(n), v(n)) > 0) return
    if (is_weak(search)) then
      call find_centre(search%max_period, u, v, n, centre, spread)
      found = .false.
      if (n > 0) call try(n, centre, max(0.1_dp, 2*spread))
      if (found) return
    end if
    distance = separation(u(1:search%max_period), v(1:search%max_period), u(0), v(0))
    do tries = 1, MOST_TRIES
      n = first_of_the_closest(distance)
      if (.not. distance(n) < closeness) return
      found = .false.
      if (n_blurred(n) < BLURRED_TRIES) then
        if (.not. repels(search, n, u(0), v(0))) call try(n, start, max(0.1_dp, 20*distance(n)))
      end if
      if (found) return
      distance(n::n) = huge(1.0_dp) ! its multiples lead to the same cycle
    end do
  contains
    subroutine try(period, x, farthest)
      integer, intent(in) :: period
      real(dp), intent(in) :: x(2), farthest

      promise = promise_of(search, period, x, farthest, attractors)
      found = promise == KNOWN_ONE
      if (promise /= UNSURE) return
      found = close_cycle(search%fine, search%pendulum%beta, period, x, farthest, candidate, blurred)
      candidate%symmetry = pairing_symmetry(search%pendulum)
      if (found) call complete_attractor(search%sampling_flow, candidate, found)
      if (found) found = candidate%winding == 0 .or. is_driven(search%pendulum) /= 0
      if (blurred) n_blurred(period) = n_blurred(period) + 1
      if (.not. found) return
      if (.not. known(attractors, candidate%period, candidate%u, candidate%v)) &
        call add_with_image(search, candidate, attractors)
    end subroutine try
  end subroutine try_recurrences

  !> Whether damping is so weak that motions spiral around a cycle long before they come near it.
  pure function is_weak(search)
    type(search_t), intent(in) :: search
    logical :: is_weak

    is_weak = PI*search%pendulum%beta < SLOW
  end function is_weak

  !> Whether a cycle of n periods near (u, v), in the coordinates of the scene's map, would repel. Recurrences on a
  !> chaotic set lead to such cycles without end: their map costs dozens of times less than Newton's method.
  function repels(search, n, u, v)
    type(search_t), intent(inout) :: search
    integer, intent(in) :: n
    real(dp), intent(in) :: u, v
    logical :: repels
    real(dp) :: tangent(2, 2, WIDTH)
    complex(dp) :: multiplier(2)
    integer :: i

    tangent(:, :, 1) = IDENTITY
    call search%flow%put(1, u, v)
    do i = 1, n
      call search%flow%advance_tangent(1, tangent)
    end do
    multiplier = eigenvalues(tangent(:, :, 1), exp(-2*PI*search%pendulum%beta*n))
    repels = abs(multiplier(1)) > STRETCHED
  end function repels

  !> Where damping is weak, slow spirals come back near themselves all the time, and hundreds of them lead to the same
  !> cycle. Newton's method with the scene's steps costs a small part of that with fine ones, and goes the same way.
  function promise_of(search, n, start, farthest, attractors) result(promise)
    type(search_t), intent(inout) :: search
    integer, intent(in) :: n
    real(dp), intent(in) :: start(2), farthest
    type(attractor_t), intent(in) :: attractors(:)
    integer :: promise
    real(dp) :: x(2), residual(2), matrix(2, 2)
    complex(dp) :: multiplier(2)
    logical :: found, blurred
    integer :: a

    x = start
    call newton(search%flow, n, farthest, x, found, blurred)
    promise = merge(UNSURE, NOTHING, found .or. blurred)
    if (.not. found) return
    call n_periods(search%flow, n, 1, x, residual, matrix)
    multiplier = eigenvalues(matrix, exp(-2*PI*search%pendulum%beta*n))
    if (abs(multiplier(1)) > SURELY) promise = NOTHING
    if (abs(multiplier(1)) >= 1) return
    do a = 1, size(attractors)
      if (attractors(a)%period <= 0) cycle
      if (mod(n, attractors(a)%period) /= 0) cycle
      if (any(separation(attractors(a)%u, attractors(a)%v, x(1), x(2)) < BESIDE)) promise = KNOWN_ONE
    end do
  end function promise_of

  !> The shortest recurrence among those within a factor 3 of the closest: its multiples come back about as near.
  pure function first_of_the_closest(distance) result(n)
    real(dp), intent(in) :: distance(:)
    integer :: n

    do n = 1, size(distance)
      if (distance(n)/3 <= minval(distance)) return ! candidates that were tried are set to huge
    end do
    n = 1
  end function first_of_the_closest

  !> True if a cycle of this period through any of these states is among the attractors.
  pure function known(attractors, period, u, v)
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue
    integer, intent(in) :: period !< drive periods
    real(dp), intent(in) :: u(:), v(:) !< physical states, half-turns, rad per drive radian
    logical :: known
    integer :: a, j

    known = .true.
    do a = 1, size(attractors)
      if (attractors(a)%period /= period) cycle
      do j = 1, size(u)
        if (any(same_state(attractors(a)%u, attractors(a)%v, u(j), v(j)))) return
      end do
    end do
    known = .false.
  end function known

  !> Completes an attractor (trapping ellipses, features) and appends it, and its image if that is another one.
  subroutine add_with_image(search, attractor, attractors)
    type(search_t), intent(inout) :: search !< the flows and the longest period of the search
    type(attractor_t), intent(inout) :: attractor !< the attractor: points, multipliers, symmetry; comes back complete
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue, which gains it
    integer :: n_known

    n_known = size(attractors)
    if (attractor%period > 0) then
      call enter_points(search%flow, attractor)
      call find_ellipses(search%flow, search%fine, attractor, attractors, search%rings)
      call find_features(search%sampling_flow, search%pendulum, attractor, attractor%u(:1), attractor%v(:1), &
                         attractor%period)
    end if
    call append_with_image(search, attractor, attractors)
    if (attractor%symmetry /= HALF_PERIOD .or. attractor%period <= 0 .or. size(attractors) < n_known + 2) return
    associate (image => attractors(n_known + 2))
      call find_ellipses(search%flow, search%fine, image, attractors(:n_known + 1), search%rings)
    end associate
  end subroutine add_with_image

  !> Appends a complete cycle or chaotic attractor, and its image if that is another one.
  subroutine append_with_image(search, attractor, attractors)
    type(search_t), intent(inout) :: search !< the flows
    type(attractor_t), intent(inout) :: attractor !< attractor that joins the catalogue; sets its number of the image
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue
    type(attractor_t) :: image
    logical :: paired

    paired = attractor%symmetry /= 0 .and. .not. attractor%symmetric
    attractor%mirror = size(attractors) + merge(2, 1, paired)
    call append(attractors, attractor)
    if (.not. paired) return
    call image_of(search%sampling_flow, attractor, image)
    if (image%symmetry == HALF_PERIOD .and. image%period > 0) call enter_points(search%flow, image)
    image%mirror = size(attractors)
    call append(attractors, image)
  end subroutine append_with_image

  !> Appends an attractor, with its strobe points in order from the lowest.
  subroutine append(attractors, attractor)
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue
    type(attractor_t), intent(in) :: attractor !< attractor that joins it
    type(attractor_t) :: one(1)

    one(1) = attractor
    if (attractor%period > 0) call listed_from_lowest(one(1))
    call join(attractors, one)
  end subroutine append

  !> Appends attractors to a catalogue.
  subroutine join(attractors, more)
    type(attractor_t), allocatable, intent(inout) :: attractors(:) !< the catalogue
    type(attractor_t), intent(in) :: more(:) !< attractors that join it
    type(attractor_t), allocatable :: longer(:)
    integer :: n, i

    n = size(attractors)
    allocate (longer(n + size(more)))
    do i = 1, n
      longer(i) = attractors(i)
    end do
    do i = 1, size(more)
      longer(n + i) = more(i)
    end do
    call move_alloc(longer, attractors)
  end subroutine join

end module kz_attractors_cycle_search
