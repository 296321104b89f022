!> Neighbours of orbits as a flow moves them beside its orbits, and by themselves; the kernel's own sine: for tests.
module kz_test_neighbours
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_kernel_flows, only: make_flow
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_vector_step_table, only: numerics_t
  use kz_model_pendulum, only: pendulum_t
  use kz_processed_processor, only: sine
  implicit none
  private

  integer, parameter :: POINTS = 6

contains

  !> sin(pi u) of half-turns.
  real(dp) function sine_of(u) bind(C, name='kz_test_sine') result(s)
    real(dp), value :: u

    s = sine(u)
  end function sine_of

  !> The largest error of a neighbour `distance` rad from a state, whose speed is up to 2 below `fastest`, in parts of
  !> its distance from the state's image. The tables serve speeds up to 3.
  function neighbour_error(pendulum, scheme, steps, fastest, distance) bind(C, name='kz_test_neighbour_error') &
      result(error)
    type(pendulum_t), intent(in) :: pendulum
    integer(c_int32_t), value :: scheme
    integer(c_int32_t), value :: steps
    real(dp), value :: fastest
    real(dp), value :: distance
    real(dp) :: error
    class(flow_t), allocatable :: flow, single
    real(dp) :: u(WIDTH), v(WIDTH), by(2, POINTS, WIDTH), start(2, POINTS, WIDTH), tangent(WIDTH, 4), right(2)
    integer :: i, j

    call make_flow(pendulum, numerics_t(scheme, steps, fastest=3.0_dp), .true., flow)
    allocate (single, source=flow)
    u = [(2*modulo(0.618_dp*i, 1.0_dp) - 1, i=1, WIDTH)]
    v = [((fastest - 2*modulo(0.755_dp*i, 1.0_dp))*(-1)**i, i=1, WIDTH)]
    do i = 1, WIDTH
      call flow%put(i, u(i), v(i))
      do j = 1, POINTS
        start(:, j, i) = distance*[cos(PI*j/3 + i), sin(PI*j/3 + i)]
      end do
    end do
    call flow%advance_linear(WIDTH, tangent)
    by = start
    call flow%displace([(i, i=1, WIDTH)], u, v, by)
    error = 0
    do i = 1, WIDTH
      do j = 1, POINTS
        call single%put(1, u(i), v(i))
        call single%put(2, u(i) + start(1, j, i)/PI, v(i) + start(2, j, i))
        call single%advance(2)
        right = [PI*(single%u(2) - single%u(1)), single%v(2) - single%v(1)]
        right(1) = right(1) - 2*PI*anint(right(1)/(2*PI))
        error = max(error, norm2(by(:, j, i) - right)/norm2(right))
      end do
    end do
  end function neighbour_error

end module kz_test_neighbours
