!> The C interface of the kernel, include/kapitza/kernel.h: thin entries of doubles and integers.
module kz_kernel_api
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_ptr, c_char, c_null_char, c_loc, c_f_pointer
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_flow, fine_numerics, sampling_numerics
  use kz_vector_schemes, only: SCHEMES
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  implicit none
  private

  type :: flows_t
    class(flow_t), allocatable :: fused, unfused
  end type flows_t

  type, bind(C) :: scheme_row_t
    character(kind=c_char) :: name(16)
    integer(c_int32_t) :: order, kicks, default_steps
  end type scheme_row_t

contains

  integer(c_int32_t) function scheme_count() bind(C, name='kz_scheme_count') result(n)
    n = size(SCHEMES)
  end function scheme_count

  subroutine scheme_row(row, scheme) bind(C, name='kz_scheme_row')
    integer(c_int32_t), value :: row
    type(scheme_row_t), intent(out) :: scheme
    integer :: i

    scheme%name = c_null_char
    do i = 1, len_trim(SCHEMES(row + 1)%name)
      scheme%name(i) = SCHEMES(row + 1)%name(i:i)
    end do
    scheme%order = SCHEMES(row + 1)%order
    scheme%kicks = SCHEMES(row + 1)%kicks
    scheme%default_steps = SCHEMES(row + 1)%default_steps
  end subroutine scheme_row

  subroutine numerics_fine(pendulum, numerics) bind(C, name='kz_numerics_fine')
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(out) :: numerics

    numerics = fine_numerics(pendulum)
  end subroutine numerics_fine

  type(c_ptr) function flow_create(pendulum, numerics) bind(C, name='kz_flow_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum
    type(numerics_t), intent(in) :: numerics
    type(flows_t), pointer :: flows

    allocate (flows)
    call make_flow(pendulum, numerics, .true., flows%fused)
    call make_flow(pendulum, sampling_numerics(pendulum, numerics), .false., flows%unfused)
    handle = c_loc(flows)
  end function flow_create

  subroutine flow_free(handle) bind(C, name='kz_flow_free')
    type(c_ptr), value :: handle
    type(flows_t), pointer :: flows

    call c_f_pointer(handle, flows)
    if (associated(flows)) deallocate (flows)
  end subroutine flow_free

  subroutine advance_states(handle, n, periods, theta, velocity, turns) bind(C, name='kz_advance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n, periods
    real(c_double), intent(inout) :: theta(n), velocity(n)
    integer(c_int64_t), intent(inout) :: turns(n)

    call advance_batches(handle, n, periods, theta, velocity, turns)
  end subroutine advance_states

  subroutine advance_tangent(handle, n, periods, theta, velocity, turns, matrix) bind(C, name='kz_advance_tangent')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n, periods
    real(c_double), intent(inout) :: theta(n), velocity(n)
    integer(c_int64_t), intent(inout) :: turns(n)
    real(c_double), intent(out) :: matrix(2, 2, n)

    call advance_batches(handle, n, periods, theta, velocity, turns, matrix)
  end subroutine advance_tangent

  subroutine advance_batches(handle, n, periods, theta, velocity, turns, matrix)
    type(c_ptr), intent(in) :: handle
    integer(c_int64_t), intent(in) :: n, periods
    real(c_double), intent(inout) :: theta(n), velocity(n)
    integer(c_int64_t), intent(inout) :: turns(n)
    real(c_double), intent(out), optional :: matrix(2, 2, n)
    type(flows_t), pointer :: flows
    class(flow_t), allocatable :: flow
    real(c_double), allocatable :: tangent(:, :, :) !< Unallocated if no matrix is asked for
    integer(c_int64_t) :: first, last, period
    integer :: lanes, i

    call c_f_pointer(handle, flows)
    allocate (flow, source=flows%fused)
    do first = 1, n, WIDTH
      last = min(first + WIDTH - 1, n)
      lanes = int(last - first + 1)
      call flow%put_all(theta(first:last)/PI, velocity(first:last))
      if (present(matrix)) tangent = spread(reshape([1.0_c_double, 0.0_c_double, 0.0_c_double, 1.0_c_double], [2, 2]), &
                                            3, WIDTH)
      call flow%to_map(lanes, tangent)
      do period = 1, periods
        if (present(matrix)) call flow%advance_tangent(lanes, tangent)
        if (.not. present(matrix)) call flow%advance(lanes)
      end do
      call flow%to_physical(lanes, tangent)
      theta(first:last) = flow%u(:lanes)*PI
      velocity(first:last) = flow%v(:lanes)
      turns(first:last) = turns(first:last) + flow%turns(:lanes)
      do i = 1, merge(lanes, 0, present(matrix))
        matrix(:, :, first + i - 1) = transpose(tangent(:, :, i))
      end do
    end do
  end subroutine advance_batches

  subroutine sample_motion(handle, periods, samples, theta, velocity, theta_out, velocity_out) bind(C, name='kz_sample')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: periods, samples
    real(c_double), value :: theta, velocity
    real(c_double), intent(out) :: theta_out(0:periods*samples), velocity_out(0:periods*samples)
    type(flows_t), pointer :: flows
    class(flow_t), allocatable :: flow
    real(c_double) :: u(samples, 1), v(samples, 1)
    integer(c_int64_t) :: period, first, last, turns

    call c_f_pointer(handle, flows)
    allocate (flow, source=flows%unfused)
    call flow%put(1, theta/PI, velocity)
    theta_out(0) = theta
    velocity_out(0) = velocity
    do period = 1, periods
      first = (period - 1)*samples + 1
      last = period*samples
      turns = flow%turns(1)
      call flow%sample(int(samples), u, v)
      theta_out(first:last) = (u(:, 1) + 2*turns)*PI
      velocity_out(first:last) = v(:, 1)
    end do
  end subroutine sample_motion

end module kz_kernel_api
