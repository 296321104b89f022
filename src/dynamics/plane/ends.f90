!> Where motions of many pendulums end: each is followed until it comes back to a point of its own, and Newton's method then tells
!> the cycle; those that never do are held for chaotic where neighbours part.
module kz_plane_ends
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_lanes_map, only: WIDTH, PI
  use kz_split_mixed_batch, only: mixed_batch_t, track_t, make_mixed_batch
  use kz_model_pendulum, only: pendulum_t
  use kz_plane_closing, only: closed_t, close_motions
  use kz_plane_recurrence, only: past_t, make_past
  implicit none
  private

  !> Periods after a cycle that does not attract before the next one is tried.
  integer, parameter :: PAUSE = 32
  !> rad: a motion so near a cycle that does not attract does not leave it for long.
  real(dp), parameter :: ON_IT = 1e-9_dp
  !> Of the exponent of a motion that has not settled: blocks of periods, and the standard errors that it must exceed.
  integer, parameter :: BLOCKS = 10, BLOCK = 100
  real(dp), parameter :: CONFIDENCE = 5
  integer, parameter :: OPEN = -1, CHAOTIC = 0

  !> A motion on its way, to be begun or gone on with.
  type :: motion_t
    integer :: id = 0                    !< place of its end
    integer(c_int64_t) :: age = 0        !< drive periods since its start
    integer(c_int64_t) :: longest = 0    !< drive periods after which it counts as not settled
    integer(c_int64_t) :: pause = 0      !< age before which no cycle is tried
    integer :: back = 0                  !< periods after which it has come back
    type(pendulum_t) :: pendulum
    real(dp) :: u = 0                    !< half-turns
    real(dp) :: v = 0                    !< rad per drive radian
  end type motion_t

  type, bind(C) :: ending_t
    integer(c_int32_t) :: period = OPEN
    integer(c_int32_t) :: winding = 0
    integer(c_int32_t) :: centre = 3
    integer(c_int32_t) :: settling_time = 0
    real(dp) :: exponent = 0
  end type ending_t

contains

  !> kz_chart_ends of dynamics.h.
  subroutine chart_ends(n_steps, n, pendulum, start, max_period, max_periods, endings) bind(C, name='kz_chart_ends')
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n
    type(pendulum_t), intent(in) :: pendulum(n)
    real(dp), intent(in) :: start(2)
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

  !> Follows all motions, each of which has the place of its end. Those that wait to be gone on with take the places of the list that are free.
  subroutine find_ends(n_steps, max_period, motions, endings)
    integer, intent(in) :: n_steps, max_period
    type(motion_t), intent(inout) :: motions(:)
    type(ending_t), intent(inout) :: endings(:)
    type(mixed_batch_t) :: batch
    type(past_t) :: past
    type(motion_t) :: lane(WIDTH)
    type(motion_t), allocatable :: near(:), tired(:)
    integer :: n, n_waiting

    call make_mixed_batch(n_steps, batch)
    call make_past(max_period, past)
    allocate (near(0), tired(0))
    n = 0
    n_waiting = size(motions)
    do
      do while (n < WIDTH .and. n_waiting > 0)
        n = n + 1
        lane(n) = motions(n_waiting)
        n_waiting = n_waiting - 1
        call load(batch, n, lane(n))
        call past%begin(n, batch)
      end do
      if (n == 0 .and. size(near) == 0) exit
      if (n > 0) call one_period(batch, past, lane, n, near, tired)
      if (size(near) >= WIDTH .or. (n == 0 .and. size(near) > 0)) call settle(n_steps, near, motions, n_waiting, endings)
    end do
    call classify(n_steps, tired, endings)
  end subroutine find_ends

  subroutine load(batch, lane, motion)
    type(mixed_batch_t), intent(inout) :: batch
    integer, intent(in) :: lane
    type(motion_t), intent(in) :: motion

    call batch%set_pendulum(lane, motion%pendulum)
    call batch%put(lane, motion%u, motion%v)
  end subroutine load

  !> Lanes that have come back leave for `near`, those that have gone on for too long for `tired`.
  subroutine one_period(batch, past, lane, n, near, tired)
    type(mixed_batch_t), intent(inout) :: batch
    type(past_t), intent(inout) :: past
    type(motion_t), intent(inout) :: lane(WIDTH)
    integer, intent(inout) :: n
    type(motion_t), allocatable, intent(inout) :: near(:), tired(:)
    integer :: back(WIDTH), i
    logical :: leaves(WIDTH)

    call batch%advance(n)
    lane(:n)%age = lane(:n)%age + 1
    call past%find(n, batch, back)
    call past%note(n, batch)
    lane(:n)%back = back(:n)
    leaves(:n) = (back(:n) > 0 .and. lane(:n)%age >= lane(:n)%pause) .or. lane(:n)%age >= lane(:n)%longest
    if (.not. any(leaves(:n))) return
    do i = n, 1, -1
      if (.not. leaves(i)) cycle
      lane(i)%u = batch%u(i)
      lane(i)%v = batch%v(i)
      if (back(i) > 0) then
        near = [near, lane(i)]
      else
        tired = [tired, lane(i)]
      end if
      if (i < n) then
        lane(i) = lane(n)
        call batch%move(n, i)
        call past%move(n, i)
      end if
      n = n - 1
    end do
  end subroutine one_period

  !> The cycles of up to a batch of motions that have come back; those whose cycle does not attract go on later.
  subroutine settle(n_steps, near, motions, n_waiting, endings)
    integer, intent(in) :: n_steps
    type(motion_t), allocatable, intent(inout) :: near(:)
    type(motion_t), intent(inout) :: motions(:)
    integer, intent(inout) :: n_waiting
    type(ending_t), intent(inout) :: endings(:)
    type(mixed_batch_t) :: batch
    type(motion_t) :: lane(WIDTH)
    type(closed_t) :: closed(WIDTH)
    integer :: n, i, j

    n = 0
    call make_mixed_batch(n_steps, batch)
    do j = maxval(near%back), 1, -1
      do i = 1, min(size(near), WIDTH)
        if (near(i)%back /= j) cycle
        n = n + 1
        lane(n) = near(i)
        call load(batch, n, near(i))
      end do
    end do
    near = near(n + 1:)
    call close_motions(batch, n, lane(:n)%back, closed)
    do i = 1, n
      associate (motion => lane(i))
        if (closed(i)%found .and. closed(i)%attracts) then
          endings(motion%id) = ending_t(closed(i)%period, closed(i)%winding, closed(i)%centre, int(motion%age, c_int32_t), &
                                        closed(i)%exponent)
        else if (motion%age >= motion%longest .or. (closed(i)%found .and. closed(i)%distance < ON_IT)) then
          endings(motion%id) = ending_t(settling_time=int(motion%longest, c_int32_t), exponent=closed(i)%exponent)
        else
          motion%pause = motion%age + PAUSE
          n_waiting = n_waiting + 1
          motions(n_waiting) = motion
        end if
      end associate
    end do
  end subroutine settle

  !> Motions that have not settled: chaotic where neighbours part.
  subroutine classify(n_steps, tired, endings)
    integer, intent(in) :: n_steps
    type(motion_t), intent(in) :: tired(:)
    type(ending_t), intent(inout) :: endings(:)
    type(mixed_batch_t) :: batch
    real(dp) :: rate(BLOCKS, WIDTH), mean, error
    integer :: first, n, i

    if (size(tired) == 0) return
    call make_mixed_batch(n_steps, batch)
    do first = 1, size(tired), WIDTH
      n = min(WIDTH, size(tired) - first + 1)
      do i = 1, n
        call load(batch, i, tired(first + i - 1))
      end do
      call growth(batch, n, rate)
      do i = 1, n
        mean = sum(rate(:, i))/BLOCKS
        error = sqrt(sum((rate(:, i) - mean)**2)/(BLOCKS*(BLOCKS - 1)))
        associate (motion => tired(first + i - 1))
          endings(motion%id) = ending_t(merge(CHAOTIC, OPEN, mean > CONFIDENCE*error), &
                                        settling_time=int(motion%longest, c_int32_t), exponent=mean)
        end associate
      end do
    end do
  end subroutine classify

  !> rate(b, i): how fast neighbours of lane i part in block b, per drive period.
  subroutine growth(batch, n, rate)
    type(mixed_batch_t), intent(inout) :: batch
    integer, intent(in) :: n
    real(dp), intent(out) :: rate(BLOCKS, WIDTH)
    type(track_t) :: track
    real(dp) :: matrix(2, 2, WIDTH), size_now
    integer :: b, t, i

    do i = 1, n
      matrix(:, :, i) = reshape([1, 0, 0, 1], [2, 2])
    end do
    rate = 0
    do b = 1, BLOCKS
      do t = 1, BLOCK
        call batch%advance_tangent(n, matrix, track)
        do i = 1, n
          size_now = norm2(matrix(:, :, i))
          rate(b, i) = rate(b, i) + log(size_now)/BLOCK
          matrix(:, :, i) = matrix(:, :, i)/size_now
        end do
      end do
    end do
  end subroutine growth

end module kz_plane_ends
