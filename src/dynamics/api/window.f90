!> The C interface of dynamics: starts of a window, and how fast they become (include/kapitza/dynamics.h).
module kz_api_window
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_ptr
  use kz_lanes_map, only: WIDTH, PI
  use kz_api_handle, only: dynamics_t, of_handle
  use kz_maps_states, only: wrapped
  implicit none
  private

  public :: window_t, starts

  type, bind(C) :: window_t
    real(dp) :: theta_min, theta_max, velocity_min, velocity_max
  end type window_t

contains

  !> Starts spread evenly by the additive recurrence of the plastic number; the seed is the offset.
  subroutine starts(window, seed, n, state) bind(C, name='kz_dynamics_starts')
    type(window_t), intent(in) :: window !< rad and rad per drive radian
    integer(c_int64_t), value :: seed !< any number
    integer(c_int64_t), value :: n !< starts
    real(dp), intent(out) :: state(2, n) !< half-turns in [-1, 1], rad per drive radian
    real(dp), parameter :: PLASTIC = 1.32471795724474602596_dp, GOLDEN = 0.61803398874989484820_dp
    integer(c_int64_t) :: i
    real(dp) :: share(2), offset(2)

    offset = [modulo(0.5_dp + seed*GOLDEN, 1.0_dp), modulo(0.5_dp + seed*GOLDEN**2*PI, 1.0_dp)]
    do i = 1, n
      share = modulo(offset + i*[1/PLASTIC, 1/PLASTIC**2], 1.0_dp)
      state(1, i) = wrapped((window%theta_min + share(1)*(window%theta_max - window%theta_min))/PI)
      state(2, i) = window%velocity_min + share(2)*(window%velocity_max - window%velocity_min)
    end do
  end subroutine starts

  function max_velocity(handle, window) bind(C, name='kz_dynamics_max_velocity') result(top)
    type(c_ptr), value :: handle
    type(window_t), intent(in) :: window
    real(dp) :: top
    integer, parameter :: ROWS = 16
    type(dynamics_t), pointer :: d
    real(dp) :: largest, v
    integer :: row, i

    d => of_handle(handle)
    largest = max(abs(window%velocity_min), abs(window%velocity_max))
    top = largest
    do row = -ROWS, ROWS
      v = largest*row/ROWS
      do i = 1, WIDTH
        call d%search%flow%put(i, 2*real(i, dp)/WIDTH - 1, v)
      end do
      call d%search%flow%to_map(WIDTH)
      call d%search%flow%advance(WIDTH)
      call d%search%flow%to_physical(WIDTH)
      top = max(top, maxval(abs(d%search%flow%v(:WIDTH))))
    end do
  end function max_velocity

end module kz_api_window
