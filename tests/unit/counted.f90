!> A map that counts the periods it integrates with their derivative: what a search for cycles costs, for tests.
module kz_test_counted
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_vector_map, only: flow_t, WIDTH
  use kz_kernel_flows, only: make_flow, fine_numerics
  use kz_vector_schemes, only: SPLIT6_ROW
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  use kz_cycles_cycles, only: attractor_t
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

  !> Periods that Newton's method takes to look for cycles of up to 48 periods from WIDTH orbits that have run for `settle`
  !> periods; `known` = the attractors that it finds.
  function newton_periods(pendulum, settle, closeness, known) bind(C, name='kz_test_newton_periods') result(periods)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int64_t), value :: settle
    !> how near an orbit must come back to itself, rad
    real(dp), value :: closeness
    integer(c_int64_t), intent(out) :: known
    integer(c_int64_t) :: periods
    type(numerics_t), parameter :: NUMERICS = numerics_t(SPLIT6_ROW, 24)
    type(search_t) :: search
    type(counted_t), allocatable :: fine
    type(attractor_t), allocatable :: attractors(:)
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
    known = size(attractors)
    periods = count_of(search%fine)
  end function newton_periods

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
    real(dp), intent(out) :: u(n)
    real(dp), intent(out) :: v(n)

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
