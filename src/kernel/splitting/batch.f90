!> A batch of lanes that a split scheme or Runge-Kutta advances.
module kz_splitting_batch
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use kz_vector_map, only: flow_t, WIDTH
  use kz_vector_step_table, only: period_t
  use kz_vector_wrap, only: wrap_lanes, vectors_of, flush_subnormals, restore_control
  use kz_splitting_stages, only: advance_steps, advance_tangents
  implicit none
  private
  public :: make_batch

  type, extends(flow_t) :: batch_t
    type(period_t) :: period
  contains
    procedure :: advance => batch_advance
    procedure :: advance_tangent => batch_tangent
    procedure :: sample => batch_sample
  end type batch_t

contains

  !> Makes a batch with the tables of one period.
  subroutine make_batch(period, flow)
    type(period_t), intent(in) :: period !< drifts and kicks of one period
    class(flow_t), allocatable, intent(out) :: flow !< the map of that period
    type(batch_t), allocatable :: batch

    allocate (batch)
    batch%period = period
    call move_alloc(batch, flow)
  end subroutine make_batch

  subroutine batch_advance(self, n)
    class(batch_t), intent(inout) :: self
    integer, intent(in) :: n
    integer(c_int64_t) :: control
    integer :: lanes

    control = flush_subnormals()
    lanes = vectors_of(n)
    call advance_steps(self%period, 1, self%period%n_steps, lanes, self%u, self%v)
    call wrap_lanes(self, 1, lanes)
    call restore_control(control)
  end subroutine batch_advance

  !> One period; matrix(:, :, i) is multiplied by d(theta, v)/d(theta0, v0). A single lane is not padded to a vector.
  subroutine batch_tangent(self, n, matrix)
    class(batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(c_double), intent(inout) :: matrix(2, 2, WIDTH)
    real(c_double) :: c(WIDTH, 2, 2)
    integer(c_int64_t) :: control
    integer :: lanes, i

    control = flush_subnormals()
    lanes = vectors_of(n)
    if (n == 1) lanes = 1
    do i = 1, n
      c(i, :, :) = matrix(:, :, i)
    end do
    c(n + 1:lanes, :, :) = 0
    call advance_tangents(self%period, lanes, self%u, self%v, c)
    call wrap_lanes(self, 1, lanes)
    do i = 1, n
      matrix(:, :, i) = c(i, :, :)
    end do
    call restore_control(control)
  end subroutine batch_tangent

  !> One period sampled at every (n_steps/n)-th step, which must not be fused; u(n, :) is not yet wrapped.
  subroutine batch_sample(self, n, u, v)
    class(batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(c_double), intent(out) :: u(:, :), v(:, :) !< (n, lanes)
    integer(c_int64_t) :: control
    integer :: i, stride, lanes

    control = flush_subnormals()
    stride = self%period%n_steps/n
    lanes = vectors_of(size(u, 2))
    if (size(u, 2) == 1) lanes = 1
    do i = 1, n
      call advance_steps(self%period, (i - 1)*stride + 1, i*stride, lanes, self%u, self%v)
      u(i, :) = self%u(:size(u, 2))
      v(i, :) = self%v(:size(u, 2))
    end do
    call wrap_lanes(self, 1, lanes)
    call restore_control(control)
  end subroutine batch_sample

end module kz_splitting_batch
