!> Where motions of many pendulums end: each is followed until it comes back to a point of its own; then Newton's method
!> finds the cycle. Those that never come back count as chaotic if neighbours separate.
module kz_lanes_ends
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_vector_map, only: WIDTH
  use kz_maps_lanes, only: lanes_t, list_flagged
  use kz_mixed_mixed_batch, only: mixed_batch_t, track_t, make_mixed_batch
  use kz_model_pendulum, only: pendulum_t
  use kz_lanes_closing, only: closed_t, close_motions
  use kz_lanes_recurrence, only: past_t, make_past
  implicit none
  private

  !> Periods after a cycle that does not attract before the next one is tried.
  integer, parameter :: PAUSE = 32
  !> rad: a motion so near a cycle that does not attract does not leave it for long.
  real(dp), parameter :: ON_IT = 1e-9_dp
  !> Exponent of an unsettled motion: blocks of periods, and the standard errors that it must exceed.
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

  !> Motions in the lanes of a batch.
  type, extends(lanes_t) :: motions_t
    integer :: n_steps = 0
    type(mixed_batch_t) :: batch
    type(past_t) :: past
    type(motion_t) :: motion(WIDTH)
    integer :: n_waiting = 0
    type(motion_t), allocatable :: waiting(:)   !< the first n_waiting of them, to be begun or gone on with
    type(motion_t), allocatable :: near(:)      !< motions that have come back
    type(motion_t), allocatable :: unsettled(:) !< motions that have gone on for too long
    type(ending_t), pointer :: endings(:) => null()
  contains
    procedure :: fill, advance, is_done, move
  end type motions_t

contains

  !> Implements kz_ends_follow of dynamics_ends.h.
  subroutine ends_follow(n_steps, n, pendulum, start, max_period, max_periods, endings) bind(C, name='kz_ends_follow')
    integer(c_int32_t), value :: n_steps
    integer(c_int64_t), value :: n
    type(pendulum_t), intent(in) :: pendulum(n)
    real(dp), intent(in) :: start(2)
    integer(c_int32_t), value :: max_period
    integer(c_int64_t), intent(in) :: max_periods(n)
    type(ending_t), intent(out), target :: endings(n)
    type(motion_t), allocatable :: motions(:)
    type(motions_t), allocatable :: lanes ! too large for the stack
    integer :: i

    allocate (motions(n), lanes)
    do i = 1, int(n)
      motions(i) = motion_t(id=i, longest=max_periods(i), pendulum=pendulum(i), u=start(1), v=start(2))
    end do
    lanes%waiting = pack(motions, max_periods > 0)
    lanes%n_waiting = size(lanes%waiting)
    lanes%n_steps = n_steps
    lanes%endings => endings
    call make_mixed_batch(lanes%n_steps, lanes%batch)
    call make_past(int(max_period), lanes%past)
    allocate (lanes%near(0), lanes%unsettled(0))
    call lanes%run()
    call classify(lanes%n_steps, lanes%unsettled, endings)
  end subroutine ends_follow

  !> The last motion that waits. Those that have come back are tried when they are many, or nothing else is left.
  function fill(self, lane) result(yes)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    if (size(self%near) >= WIDTH .or. (self%active == 0 .and. self%n_waiting == 0 .and. size(self%near) > 0)) &
      call try_cycles(self)
    yes = self%n_waiting > 0
    if (.not. yes) return
    self%motion(lane) = self%waiting(self%n_waiting)
    self%n_waiting = self%n_waiting - 1
    call load(self%batch, lane, self%motion(lane))
    call self%past%begin(lane, self%batch)
  end function fill

  subroutine load(batch, lane, motion)
    type(mixed_batch_t), intent(inout) :: batch
    integer, intent(in) :: lane
    type(motion_t), intent(in) :: motion

    call batch%set_pendulum(lane, motion%pendulum)
    call batch%put(lane, motion%u, motion%v)
  end subroutine load

  subroutine advance(self, list, n)
    class(motions_t), intent(inout) :: self
    integer, intent(out) :: list(WIDTH), n
    integer :: back(WIDTH), leaves(WIDTH)

    associate (m => self%active)
      call self%batch%advance(m)
      call self%past%find(m, self%batch, back)
      call self%past%note(m, self%batch)
      associate (motion => self%motion(:m))
        motion%age = motion%age + 1
        motion%back = back(:m)
        leaves(:m) = merge(1, 0, (motion%back > 0 .and. motion%age >= motion%pause) .or. motion%age >= motion%longest)
      end associate
      call list_flagged(m, leaves, list, n)
    end associate
  end subroutine advance

  !> A motion has come back, or has gone on for too long.
  function is_done(self, lane) result(yes)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    yes = .true.
    associate (motion => self%motion(lane))
      motion%u = self%batch%u(lane)
      motion%v = self%batch%v(lane)
      if (motion%back > 0) then
        self%near = [self%near, motion]
      else
        self%unsettled = [self%unsettled, motion]
      end if
    end associate
  end function is_done

  subroutine move(self, from, to)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: from, to

    self%motion(to) = self%motion(from)
    call self%batch%move(from, to)
    call self%past%move(from, to)
  end subroutine move

  !> The cycles of up to a batch of motions that have come back; those whose cycle does not attract go on later.
  subroutine try_cycles(self)
    class(motions_t), intent(inout) :: self
    type(mixed_batch_t) :: batch
    type(motion_t) :: lane(WIDTH)
    type(closed_t) :: closed(WIDTH)
    integer :: n, i, j

    n = 0
    call make_mixed_batch(self%n_steps, batch)
    do j = maxval(self%near%back), 1, -1
      do i = 1, min(size(self%near), WIDTH)
        if (self%near(i)%back /= j) cycle
        n = n + 1
        lane(n) = self%near(i)
        call load(batch, n, lane(n))
      end do
    end do
    self%near = self%near(n + 1:)
    call close_motions(batch, n, lane(:n)%back, closed)
    do i = 1, n
      associate (motion => lane(i))
        if (closed(i)%found .and. closed(i)%attracts) then
          self%endings(motion%id) = ending_t(closed(i)%period, closed(i)%winding, closed(i)%centre, &
                                             int(motion%age, c_int32_t), closed(i)%exponent)
        else if (motion%age >= motion%longest .or. (closed(i)%found .and. closed(i)%distance < ON_IT)) then
          self%endings(motion%id) = ending_t(settling_time=int(motion%longest, c_int32_t), exponent=closed(i)%exponent)
        else
          motion%pause = motion%age + PAUSE
          self%n_waiting = self%n_waiting + 1
          self%waiting(self%n_waiting) = motion
        end if
      end associate
    end do
  end subroutine try_cycles

  !> Motions that have not settled: chaotic where neighbours part.
  subroutine classify(n_steps, unsettled, endings)
    integer, intent(in) :: n_steps
    type(motion_t), intent(in) :: unsettled(:)
    type(ending_t), intent(inout) :: endings(:)
    type(mixed_batch_t) :: batch
    real(dp) :: rate(BLOCKS, WIDTH), mean, error
    integer :: first, n, i

    if (size(unsettled) == 0) return
    call make_mixed_batch(n_steps, batch)
    do first = 1, size(unsettled), WIDTH
      n = min(WIDTH, size(unsettled) - first + 1)
      do i = 1, n
        call load(batch, i, unsettled(first + i - 1))
      end do
      call growth(batch, n, rate)
      do i = 1, n
        mean = sum(rate(:, i))/BLOCKS
        error = sqrt(sum((rate(:, i) - mean)**2)/(BLOCKS*(BLOCKS - 1)))
        associate (motion => unsettled(first + i - 1))
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

end module kz_lanes_ends
