!> The stages of a period of the processed splitting in double precision, and their derivative.
module kz_processed_stages
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_lanes_map, only: WIDTH
  use kz_lanes_sine, only: MAGIC
  use kz_processed_tables, only: processed_t
  implicit none
  private
  public :: stages_t, make_stages, advance_stages, tangent_stages

  !> The rows of processed_t.
  type :: stages_t
    integer :: n_drift
    integer :: n_kick
    real(rk), allocatable :: row(:, :)
    real(rk), allocatable :: last(:)
    real(rk) :: decay
  end type stages_t

  interface
    !> The stages of a period for the lanes 1 .. n, or some more (stages.c).
    subroutine run_stages(n_drift, n_kick, n_stages, row, n, u, v) bind(C, name='kz_processed_kicks')
      import :: c_double, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: n_drift
      integer(c_int32_t), value :: n_kick
      integer(c_int64_t), value :: n_stages
      real(c_double), intent(in) :: row(*)
      integer(c_int64_t), value :: n
      real(c_double), intent(inout) :: u(WIDTH)
      real(c_double), intent(inout) :: v(WIDTH)
    end subroutine run_stages
  end interface

contains

  !> The tables of one period, rounded.
  subroutine make_stages(table, stages)
    !> in quad precision
    type(processed_t), intent(in) :: table
    !> in double precision
    type(stages_t), intent(out) :: stages
    integer :: i

    stages%n_drift = table%n_drift
    stages%n_kick = table%n_kick
    allocate (stages%row(size(table%row, 1), size(table%row, 2)))
    do i = 1, size(table%row, 2) ! by columns: many steps would fill the stack
      stages%row(:, i) = real(table%row(:, i), rk)
    end do
    allocate (stages%last, source=real(table%last, rk))
    stages%decay = real(table%decay, rk)
  end subroutine make_stages

  !> One period of n lanes.
  subroutine advance_stages(self, n, u, v)
    !> tables of a period
    type(stages_t), intent(in) :: self
    !> lanes
    integer, intent(in) :: n
    !> half-turns
    real(rk), intent(inout) :: u(WIDTH)
    !> rad per drive radian
    real(rk), intent(inout) :: v(WIDTH)

    call run_stages(int(self%n_drift, c_int32_t), int(self%n_kick, c_int32_t), size(self%row, 2, c_int64_t), self%row, &
                    int(n, c_int64_t), u, v)
    call finish_period(self, n, u, v)
  end subroutine advance_stages

  !> The last drift, and the velocity itself again.
  subroutine finish_period(self, n, u, v)
    type(stages_t), intent(in) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(WIDTH)
    real(rk), intent(inout) :: v(WIDTH)
    real(rk) :: step(WIDTH)
    integer :: i, j

    step(:n) = self%last(self%n_drift)
    do j = self%n_drift - 1, 1, -1
      do i = 1, n
        step(i) = step(i)*v(i)**2 + self%last(j)
      end do
    end do
    do i = 1, n
      u(i) = u(i) + v(i)*step(i)
      v(i) = self%decay*v(i)
    end do
  end subroutine finish_period

  !> The derivative along the stages from the lanes' present states; c(i, :, j): column j, angles in half-turns.
  subroutine tangent_stages(self, n, start_u, start_v, c)
    !> tables of a period
    type(stages_t), intent(in) :: self
    !> lanes
    integer, intent(in) :: n
    !> half-turns
    real(rk), intent(in) :: start_u(n)
    !> velocity times exp(beta t)
    real(rk), intent(in) :: start_v(n)
    !> columns of the tangent map, lane by lane
    real(rk), intent(inout) :: c(WIDTH, 2, 2)
    real(rk), dimension(n) :: u, v, r, q, kick, slope
    integer :: s, j

    u = start_u
    v = start_v
    do s = 1, size(self%row, 2)
      call drift_tangent(self%row(:self%n_drift, s), n, u, v, c)
      r = u - 2*((0.5_rk*u + MAGIC) - MAGIC)
      q = r*r
      kick = 0
      slope = 0
      do j = self%n_drift + self%n_kick, self%n_drift + 1, -1
        slope = slope*q + kick
        kick = kick*q + self%row(j, s)
      end do
      v = v - (r - r*q)*kick
      slope = (1 - 3*q)*kick + 2*q*(1 - q)*slope
      c(:n, 2, 1) = c(:n, 2, 1) - slope*c(:n, 1, 1)
      c(:n, 2, 2) = c(:n, 2, 2) - slope*c(:n, 1, 2)
    end do
    call drift_tangent(self%last, n, u, v, c)
    c(:n, 2, :) = self%decay*c(:n, 2, :)
  end subroutine tangent_stages

  !> u += v (d(1) + d(2) v**2 + ..) and its derivative.
  subroutine drift_tangent(drift, n, u, v, c)
    real(rk), intent(in) :: drift(:)
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(n)
    real(rk), intent(in) :: v(n)
    real(rk), intent(inout) :: c(WIDTH, 2, 2)
    real(rk), dimension(n) :: square, step, shear
    integer :: j

    square = v*v
    step = 0
    shear = 0
    do j = size(drift), 1, -1
      step = step*square + drift(j)
      shear = shear*square + (2*j - 1)*drift(j)
    end do
    u = u + v*step
    c(:n, 1, 1) = c(:n, 1, 1) + shear*c(:n, 2, 1)
    c(:n, 1, 2) = c(:n, 1, 2) + shear*c(:n, 2, 2)
  end subroutine drift_tangent

end module kz_processed_stages
