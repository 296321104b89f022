!> A made-up map with two attracting fixed points, mirror images so far apart, and a saddle between them: dynamics on it
!> for tests.
module kz_test_doublet
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_ptr, c_loc
  use kz_vector_locks, only: create_lock
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_model_pendulum, only: pendulum_t
  use kz_api_dynamics, only: dynamics_t
  implicit none
  private

  !> u goes to u/2, v to half * f(v/half), f(z) = 3 z/sqrt(4 + 5 z**2): f(1) = 1, f'(1) = 4/9, f'(0) = 3/2.
  type, extends(flow_t) :: doublet_t
    real(dp) :: half = 0
  contains
    procedure :: advance
    procedure :: advance_tangent
    procedure :: sample
  end type doublet_t

contains

  function create(apart) bind(C, name='kz_test_doublet_create') result(handle)
    !> Velocities of the two fixed points, rad per drive radian
    real(dp), value :: apart
    type(c_ptr) :: handle
    type(dynamics_t), pointer :: d

    allocate (d)
    d%lock = create_lock()
    d%search%pendulum = pendulum_t(0, -log(2.0_dp/9)/(2*PI), 0) ! areas shrink as at the fixed points
    d%search%max_period = 4
    allocate (d%flow, source=doublet_t(half=apart/2))
    allocate (d%search%flow, source=d%flow)
    allocate (d%search%fine, source=d%flow)
    allocate (d%search%sampling_flow, source=d%flow)
    allocate (d%attractors(0))
    handle = c_loc(d)
  end function create

  subroutine advance(self, n)
    class(doublet_t), intent(inout) :: self
    integer, intent(in) :: n

    self%u(:n) = 0.5_dp*self%u(:n)
    self%v(:n) = 3*self%v(:n)/sqrt(4 + 5*(self%v(:n)/self%half)**2)
  end subroutine advance

  subroutine advance_tangent(self, n, matrix)
    class(doublet_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(inout) :: matrix(2, 2, WIDTH)
    integer :: i

    do i = 1, n
      matrix(1, :, i) = 0.5_dp*matrix(1, :, i)
      matrix(2, :, i) = 12*matrix(2, :, i)/sqrt(4 + 5*(self%v(i)/self%half)**2)**3
    end do
    call self%advance(n)
  end subroutine advance_tangent

  subroutine sample(self, n, u, v)
    class(doublet_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(out) :: u(:, :), v(:, :)

    call self%advance(size(u, 2))
    u = spread(self%u(:size(u, 2)), 1, n)
    v = spread(self%v(:size(v, 2)), 1, n)
  end subroutine sample

end module kz_test_doublet
