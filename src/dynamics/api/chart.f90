!> The C interface of dynamics: ends of motions of many pendulums (include/kapitza/dynamics.h).
module kz_api_chart
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_model_pendulum, only: pendulum_t
  use kz_plane_ends, only: motion_t, ending_t, find_ends
  implicit none
  private

contains

  subroutine chart_ends(n_steps, n, pendulum, start, max_period, max_periods, endings) bind(C, name='kz_chart_ends')
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n
    type(pendulum_t), intent(in) :: pendulum(n)
    real(dp), intent(in) :: start(2) !< half-turns, rad per drive radian
    integer(c_int32_t), value :: max_period
    integer(c_int64_t), intent(in) :: max_periods(n)
    type(ending_t), intent(out) :: endings(n)
    type(motion_t), allocatable :: motions(:)
    integer :: i

    allocate (motions(n))
    do i = 1, int(n)
      motions(i) = motion_t(id=i, longest=max_periods(i), pendulum=pendulum(i), u=start(1), v=start(2))
    end do
    motions = pack(motions, max_periods > 0)
    call find_ends(int(n_steps), int(max_period), motions, endings)
  end subroutine chart_ends

end module kz_api_chart
