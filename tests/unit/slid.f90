!> Periods of pendulums along a slider, by series that come from neighbours and by their own, for tests.
module kz_test_slid
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_kernel_flows, only: make_flow
  use kz_vector_schemes, only: PROCESSED_ROW
  use kz_model_pendulum, only: pendulum_t
  use kz_vector_step_table, only: numerics_t
  implicit none
  private

contains

  !> The largest difference of one period of these pendulums, one after the other, rad.
  function slid_error(n, pendulum, series) bind(C, name='kz_test_slid_error') result(largest)
    integer(c_int64_t), value :: n
    type(pendulum_t), intent(in) :: pendulum(n)
    type(c_ptr), value :: series !< kz_kept_series
    real(dp) :: largest
    type(numerics_t) :: plain, numerics
    class(flow_t), allocatable :: moving, own
    integer :: i

    plain = numerics_t(PROCESSED_ROW, 16, fastest=3)
    numerics = numerics_t(PROCESSED_ROW, 16, fastest=3, series=series)
    largest = 0
    do i = 1, int(n)
      call make_flow(pendulum(i), numerics, .true., moving, slid=.true.)
      call make_flow(pendulum(i), plain, .true., own)
      call advance(moving)
      call advance(own)
      largest = max(largest, PI*maxval(abs(moving%u(:WIDTH) - own%u(:WIDTH))), maxval(abs(moving%v(:WIDTH) - own%v(:WIDTH))))
    end do
  end function slid_error

  !> States of a small part of the plane, so that none is wrapped otherwise than its partner.
  subroutine advance(flow)
    class(flow_t), intent(inout) :: flow
    integer :: lane

    do lane = 1, WIDTH
      call flow%put(lane, 0.01_dp*lane, 0.02_dp*lane - 0.6_dp)
    end do
    call flow%to_map(WIDTH)
    call flow%advance(WIDTH)
    call flow%to_physical(WIDTH)
  end subroutine advance

end module kz_test_slid
