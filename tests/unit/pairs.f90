!> Whole drive periods in pairs of doubles, for tests in C.
module kz_test_pairs
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_ptr, c_null_ptr, c_loc, c_f_pointer
  use kz_vector_map, only: WIDTH
  use kz_taylor_pairs, only: pairs_t, pair_series_t, pair_lanes_t, make_pairs, advance_pairs
  use kz_model_pendulum, only: pendulum_t
  use kz_taylor_probes, only: probes_t, make_probes
  use kz_taylor_taylor, only: drive_t, make_drive, TAYLOR_STEPS, ROUGH_STEPS
  implicit none
  private

contains

  function pairs_create(pendulum, tolerance, fastest, error) bind(C, name='kz_test_pairs_create') result(handle)
    type(pendulum_t), intent(in) :: pendulum
    real(c_double), value :: tolerance
    real(c_double), value :: fastest
    real(c_double), intent(out) :: error
    type(c_ptr) :: handle
    type(pair_series_t) :: shared
    type(pairs_t), pointer :: pairs
    integer :: status

    handle = c_null_ptr
    error = huge(error)
    allocate (pairs, stat=status)
    if (status /= 0) return
    call make_pairs(pendulum, tolerance, fastest, pairs, shared, 0, 0.0_c_double)
    error = pairs%error
    handle = c_loc(pairs)
  end function pairs_create

  !> Steps a period of the table for slow states; 0 = there is none, and Taylor series take its place.
  integer(c_int32_t) function pairs_steps(handle) bind(C, name='kz_test_pairs_steps') result(steps)
    type(c_ptr), value :: handle
    type(pairs_t), pointer :: pairs

    call c_f_pointer(handle, pairs)
    steps = 0
    if (size(pairs%table) > 0) steps = int(pairs%table(1)%n_steps, c_int32_t)
  end function pairs_steps

  subroutine pairs_free(handle) bind(C, name='kz_test_pairs_free')
    type(c_ptr), value :: handle
    type(pairs_t), pointer :: pairs

    call c_f_pointer(handle, pairs)
    if (associated(pairs)) deallocate (pairs)
  end subroutine pairs_free

  subroutine pairs_advance(handle, n, periods, half_turns, velocity, turns) bind(C, name='kz_test_pairs_advance')
    type(c_ptr), value :: handle
    integer(c_int64_t), value :: n
    integer(c_int64_t), value :: periods
    real(c_double), intent(inout) :: half_turns(2, n)
    real(c_double), intent(inout) :: velocity(2, n)
    integer(c_int64_t), intent(inout) :: turns(n)
    type(pairs_t), pointer :: pairs
    type(pair_lanes_t) :: lanes
    integer(c_int64_t) :: first, last, period, gained(WIDTH)
    integer :: lane_count

    call c_f_pointer(handle, pairs)
    do first = 1, n, WIDTH
      last = min(n, first + WIDTH - 1)
      lane_count = int(last - first + 1)
      lanes%u(:lane_count, :) = transpose(half_turns(:, first:last))
      lanes%v(:lane_count, :) = transpose(velocity(:, first:last))
      gained = 0
      do period = 1, periods
        call advance_pairs(pairs, lane_count, lanes, gained)
      end do
      half_turns(:, first:last) = transpose(lanes%u(:lane_count, :))
      velocity(:, first:last) = transpose(lanes%v(:lane_count, :))
      turns(first:last) = turns(first:last) + gained(:lane_count)
    end do
  end subroutine pairs_advance

  !> How far images by rough series lie from those by exact ones at most, half-turns and rad per drive radian, of 64
  !> speeds.
  real(c_double) function rough_error(pendulum, fastest) bind(C, name='kz_test_rough_error') result(error)
    type(pendulum_t), intent(in) :: pendulum
    real(c_double), value :: fastest
    type(drive_t) :: rough, exact
    type(probes_t) :: near, true
    integer :: i

    call make_drive(rough, pendulum, ROUGH_STEPS, rough=.true.)
    call make_drive(exact, pendulum, TAYLOR_STEPS)
    call make_probes(rough, [(fastest*i/64, i=1, 64)], near)
    call make_probes(exact, [(fastest*i/64, i=1, 64)], true)
    error = real(maxval(abs(near%image - true%image)), c_double)
  end function rough_error

end module kz_test_pairs
