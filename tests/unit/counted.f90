!> A map that counts the periods it integrates with their derivative: what a search for cycles costs, for tests.
module kz_test_counted
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_vector_schemes, only: SPLIT6_ROW
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_ellipses, only: ellipse_square
  use kz_maps_states, only: angle_difference
  use kz_attractors_cycle_search, only: search_t, find_cycle
  implicit none
  private

  type, extends(flow_t) :: counted_t
    class(flow_t), allocatable :: inner
    integer(c_int64_t) :: periods = 0
  contains
    procedure :: put
    procedure :: advance
    procedure :: advance_tangent
    procedure :: sample
  end type counted_t

contains

  !> Periods that Newton's method takes to look for cycles of up to 48 periods from WIDTH orbits that have run for
  !> `settle` periods; `known` = the attractors that it finds.
  function newton_periods(pendulum, settle, closeness, known) bind(C, name='kz_test_newton_periods') result(periods)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: settle
    !> Largest distance, rad, at which an orbit has come back to itself
    real(dp), value :: closeness
    integer(c_int64_t), intent(out) :: known
    integer(c_int64_t) :: periods
    type(search_t) :: search
    type(attractor_t), allocatable :: attractors(:)

    call find_attractors(pendulum, settle, closeness, search, attractors)
    known = size(attractors)
    periods = count_of(search%fine)
  end function newton_periods

  !> How far the rims of the ellipses of those attractors have come from the strobe points after 12 lifetimes, at most,
  !> in their norm. `radius`: the smallest extent of their ellipses in the angle, rad.
  function rims(pendulum, settle, closeness, radius) bind(C, name='kz_test_rims') result(farthest)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: settle
    real(dp), value :: closeness
    real(dp), intent(out) :: radius
    real(dp) :: farthest
    type(search_t) :: search
    type(attractor_t), allocatable :: attractors(:)
    integer :: a

    call find_attractors(pendulum, settle, closeness, search, attractors)
    farthest = 0
    radius = huge(radius)
    do a = 1, size(attractors)
      associate (form => attractors(a)%form(:, 1))
        if (form(1) > 0) radius = min(radius, PI*sqrt(form(3)/(form(1)*form(3) - form(2)**2)))
        if (form(1) > 0) farthest = max(farthest, rim_after(search%flow, attractors(a), ceiling(12/(PI*pendulum%beta))))
      end associate
    end do
  end function rims

  !> The farthest of WIDTH points of the rim of an attractor's first ellipse after so many periods, or a few more.
  function rim_after(flow, attractor, periods) result(farthest)
    class(flow_t), intent(inout) :: flow
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: periods
    real(dp) :: farthest
    real(dp) :: du, dv
    integer :: i

    associate (form => attractor%form(:, 1))
      do i = 1, WIDTH ! form = L L^T, and the rim is that of the unit circle under the inverse of L^T
        dv = 0.99_dp*sin(2*PI*i/WIDTH)/sqrt(form(3) - form(2)**2/form(1))
        du = 0.99_dp*cos(2*PI*i/WIDTH)/sqrt(form(1)) - form(2)/form(1)*dv
        call flow%put(i, attractor%kernel_u(1) + du, attractor%kernel_v(1) + dv)
      end do
    end associate
    do i = 1, attractor%period*ceiling(real(periods)/real(attractor%period))
      call flow%advance(WIDTH)
    end do
    farthest = maxval([(sqrt(ellipse_square(attractor, 1, angle_difference(flow%u(i), 0.0_dp), flow%v(i))), i=1, &
                        WIDTH)])
  end function rim_after

  !> The attractors that are found from WIDTH orbits.
  subroutine find_attractors(pendulum, settle, closeness, search, attractors)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), intent(in) :: settle
    real(dp), intent(in) :: closeness
    type(search_t), intent(out) :: search
    type(attractor_t), allocatable, intent(out) :: attractors(:)
    type(numerics_t), parameter :: NUMERICS = numerics_t(SPLIT6_ROW, 24)
    type(counted_t), allocatable :: fine
    integer, allocatable :: n_blurred(:)
    integer :: i, next

    search%pendulum = pendulum
    call make_flow(pendulum, NUMERICS, .true., search%flow)
    call make_flow(pendulum, fine_numerics(pendulum), .false., search%sampling_flow)
    allocate (fine)
    call make_flow(pendulum, NUMERICS, .true., fine%inner)
    call move_alloc(fine, search%fine)
    allocate (attractors(0))
    do i = 1, WIDTH
      call search%flow%put(i, 0.3_dp, 0.01_dp*i)
    end do
    do i = 1, int(settle)
      call search%flow%advance(WIDTH)
    end do
    next = 1
    allocate (n_blurred(search%max_period))
    n_blurred = 0
    associate (u => real(search%flow%u(:WIDTH), dp), v => real(search%flow%v(:WIDTH), dp))
      do while (next <= WIDTH)
        call find_cycle(search, u, v, closeness, next, n_blurred, attractors)
      end do
    end associate
  end subroutine find_attractors

  function count_of(flow) result(periods)
    class(flow_t), intent(in) :: flow
    integer(c_int64_t) :: periods

    periods = -1
    select type (flow)
    type is (counted_t)
      periods = flow%periods
    end select
  end function count_of

  subroutine put(self, lane, u, v)
    class(counted_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(dp), intent(in) :: u
    real(dp), intent(in) :: v

    call self%inner%put(lane, u, v)
    call show(self)
  end subroutine put

  subroutine advance(self, n)
    class(counted_t), intent(inout) :: self
    integer, intent(in) :: n

    call self%inner%advance(n)
    call show(self)
  end subroutine advance

  subroutine advance_tangent(self, n, matrix)
    class(counted_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout) :: matrix(2, 2, WIDTH)

    call self%inner%advance_tangent(n, matrix)
    self%periods = self%periods + n
    call show(self)
  end subroutine advance_tangent

  subroutine sample(self, n, u, v)
    class(counted_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(out) :: u(:, :), v(:, :)

    call self%inner%sample(n, u, v)
    call show(self)
  end subroutine sample

  subroutine show(self)
    class(counted_t), intent(inout) :: self

    self%u = self%inner%u
    self%v = self%inner%v
    self%turns = self%inner%turns
  end subroutine show

end module kz_test_counted
