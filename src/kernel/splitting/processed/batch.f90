!> A batch of lanes that the processed splitting advances. States are kernel coordinates, P of the physical ones. Lanes
!> too fast for the tables keep physical coordinates, and another flow advances them.
module kz_processed_batch
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_locks, only: look
  use kz_vector_map, only: flow_t, put_state, move_state, WIDTH, CAPACITY
  use kz_vector_sine, only: INVERSE_PI
  use kz_vector_wrap, only: wrap_lanes, vectors_of, flush_subnormals, restore_control
  use kz_processed_processor, only: change_coordinates, change_derivative
  use kz_processed_stages, only: stages_t, make_stages, advance_stages, single_stages, linear_stages, &
                                 displaced_stages, tangent_stages, GROUP
  use kz_processed_tables, only: processed_t, processor_t
  implicit none
  private
  public :: make_processed_batch

  type, extends(flow_t) :: processed_batch_t
    type(stages_t) :: stages
    real(rk) :: fastest                  !< Largest speed that the tables serve, rad per drive radian
    logical :: physical(CAPACITY) = .false.  !< Lanes that are faster
    logical :: was_physical(WIDTH) = .false. !< `physical` before the last period of advance_linear
    class(flow_t), allocatable :: fallback
  contains
    procedure :: put => processed_put
    procedure :: move => processed_move
    procedure :: advance => processed_advance
    procedure :: advance_tangent => processed_tangent
    procedure :: advance_linear => processed_linear
    procedure :: displace => processed_displace
    procedure :: sample => processed_sample
    procedure :: to_map => processed_to_map
    procedure :: to_physical => processed_to_physical
  end type processed_batch_t

contains

  !> Makes a batch with the tables of one period. `fallback` advances lanes that are faster than `fastest`.
  subroutine make_processed_batch(table, fastest, fallback, flow)
    type(processed_t), intent(in) :: table !< Tables of one period
    real(rk), intent(in) :: fastest !< rad per drive radian
    class(flow_t), allocatable, intent(inout) :: fallback !< Flow of faster lanes, taken over
    class(flow_t), allocatable, intent(out) :: flow !< the map of one drive period
    type(processed_batch_t), allocatable :: batch

    allocate (batch)
    call make_stages(table, batch%stages)
    batch%fastest = fastest
    call move_alloc(fallback, batch%fallback)
    call move_alloc(batch, flow)
  end subroutine make_processed_batch

  subroutine processed_advance(self, n)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk) :: u(WIDTH), v(WIDTH)

    call look()
    u = self%u(:WIDTH)
    v = self%v(:WIDTH)
    if (self%single) then
      call single_stages(self%stages, n, u, v)
    else
      call advance_stages(self%stages%table, n, u, v)
    end if
    call take_images(self, n, u, v)
  end subroutine processed_advance

  !> One period, and the tangent map in kernel coordinates in single precision, without slow subnormal numbers.
  subroutine processed_linear(self, n, tangent)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: tangent(WIDTH, 4)
    real(rk) :: u(WIDTH), v(WIDTH)
    real(rk), parameter :: UNIT(2, 2) = reshape([1, 0, 0, 1], [2, 2])
    integer(c_int64_t) :: control
    integer :: i

    control = flush_subnormals()
    u = self%u(:WIDTH)
    v = self%v(:WIDTH)
    call linear_stages(self%stages, n, u, v, tangent)
    self%was_physical(:n) = self%physical(:n)
    do i = 1, n
      if (self%physical(i)) tangent(i, :) = reshape(transpose(fall_back_tangent(self, i, UNIT)), [4])
    end do
    call take_images(self, n, u, v)
    call restore_control(control)
  end subroutine processed_linear

  !> Displaces by the angles that advance_linear has kept, or by the other flow in lanes that it advances.
  subroutine processed_displace(self, lane, u, v, by)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: lane(:)
    real(rk), intent(in) :: u(:), v(:)
    real(rk), intent(inout) :: by(:, :, :)
    integer(c_int64_t) :: control
    integer :: first, i

    control = flush_subnormals()
    do first = 1, size(lane), GROUP
      associate (group_lane => lane(first:min(size(lane), first + GROUP - 1)), &
                 group_by => by(:, :, first:min(size(lane), first + GROUP - 1)))
        if (any(self%was_physical(group_lane))) then
          do i = 1, size(group_lane)
            if (self%was_physical(group_lane(i))) &
              call self%fallback%displace(group_lane(i:i), u, v, group_by(:, :, i:i))
            if (.not. self%was_physical(group_lane(i))) &
              call displaced_stages(self%stages, group_lane(i:i), group_by(:, :, i:i))
          end do
        else
          call displaced_stages(self%stages, group_lane, group_by)
        end if
      end associate
    end do
    call restore_control(control)
  end subroutine processed_displace

  !> Stores the images of n lanes that the tables have advanced.
  subroutine take_images(self, n, u, v)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)

    if (count(abs(v(:n)) > self%fastest .or. self%physical(:n)) > 0) then
      call fall_back(self, n, u, v)
      call change_fast_lanes(self, n, u, v)
      call change_fast_lanes(self, n, u, v) ! lanes within the hysteresis band keep their coordinates
    end if
    self%u(:n) = u(:n)
    self%v(:n) = v(:n)
    call wrap_lanes(self, 1, n)
  end subroutine take_images

  !> Replaces the images of lanes in physical coordinates by another flow's.
  subroutine fall_back(self, n, u, v)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)
    integer :: lane(WIDTH), i, fast

    if (.not. allocated(self%fallback)) return ! errors are being measured: a lost motion stays lost
    fast = 0
    do i = 1, n
      if (.not. self%physical(i)) cycle
      fast = fast + 1
      lane(fast) = i
      call self%fallback%put(fast, self%u(i), self%v(i))
    end do
    call self%fallback%advance(fast)
    do i = 1, fast
      u(lane(i)) = self%fallback%u(i) + 2*real(self%fallback%turns(i), rk)
      v(lane(i)) = self%fallback%v(i)
    end do
  end subroutine fall_back

  !> Takes lanes that have become too fast for the tables to physical coordinates, and slow ones back.
  subroutine change_fast_lanes(self, n, u, v)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)
    logical :: fast
    integer :: i

    do i = 1, n
      fast = abs(v(i)) > self%fastest
      if (fast .eqv. self%physical(i)) cycle
      if (fast) call change_coordinates(self%stages%table%from_kernel, 1, u(i:i), v(i:i))
      if (.not. fast) call change_coordinates(self%stages%table%to_kernel, 1, u(i:i), v(i:i))
      self%physical(i) = fast
    end do
  end subroutine change_fast_lanes

  !> One period with the tangent map in kernel coordinates, the derivative of the arithmetic itself.
  subroutine processed_tangent(self, n, matrix)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout) :: matrix(2, 2, WIDTH)
    real(rk) :: c(WIDTH, 2, 2)
    integer :: lanes, i

    do i = 1, n
      c(i, :, :) = matrix(:, :, i)
    end do
    c(n + 1:, :, :) = 0
    c(:, 1, :) = c(:, 1, :)*INVERSE_PI
    lanes = merge(1, vectors_of(n), n == 1)
    call tangent_stages(self%stages%table, lanes, self%u(:lanes), self%v(:lanes), c)
    c(:, 1, :) = c(:, 1, :)/INVERSE_PI
    do i = 1, n
      if (self%physical(i)) c(i, :, :) = fall_back_tangent(self, i, matrix(:, :, i))
    end do
    call processed_advance(self, n)
    do i = 1, n
      matrix(:, :, i) = c(i, :, :)
    end do
  end subroutine processed_tangent

  !> Multiplies a matrix by the tangent map of a lane that another flow advances.
  function fall_back_tangent(self, lane, matrix) result(product)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(rk), intent(in) :: matrix(2, 2)
    real(rk) :: product(2, 2), one(2, 2, WIDTH)

    one(:, :, 1) = matrix
    call self%fallback%put(1, self%u(lane), self%v(lane))
    call self%fallback%advance_tangent(1, one)
    product = one(:, :, 1)
  end function fall_back_tangent

  subroutine processed_put(self, lane, u, v)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: lane
    real(rk), intent(in) :: u, v

    call put_state(self, lane, u, v)
    self%physical(lane) = .not. abs(self%v(lane)) <= self%fastest
  end subroutine processed_put

  subroutine processed_move(self, from, to)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call move_state(self, from, to)
    self%physical(to) = self%physical(from)
  end subroutine processed_move

  subroutine processed_to_map(self, n, matrix, first)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first

    call change_lanes(self, self%stages%table%to_kernel, .true., n, matrix, first)
  end subroutine processed_to_map

  subroutine processed_to_physical(self, n, matrix, first)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first

    call change_lanes(self, self%stages%table%from_kernel, .false., n, matrix, first)
  end subroutine processed_to_physical

  !> Changes the coordinates of the lanes first .. n (at most WIDTH) that the tables serve; matrix(:, :, lane) is
  !> multiplied by the derivative of the change, in rad.
  subroutine change_lanes(self, processor, to_map, n, matrix, first)
    class(processed_batch_t), intent(inout) :: self
    type(processor_t), intent(in) :: processor
    logical, intent(in) :: to_map
    integer, intent(in) :: n
    real(rk), intent(inout), optional :: matrix(2, 2, WIDTH)
    integer, intent(in), optional :: first
    real(rk) :: u(WIDTH), v(WIDTH)
    integer(c_int64_t) :: control
    integer :: from, lane

    from = 1
    if (present(first)) from = first
    if (to_map) self%physical(from:n) = .not. abs(self%v(from:n)) <= self%fastest
    control = flush_subnormals()
    do lane = from, merge(n, 0, present(matrix))
      if (.not. self%physical(lane)) &
        matrix(:, :, lane) = matmul(change_derivative(processor, self%u(lane), self%v(lane)), matrix(:, :, lane))
    end do
    u(:n - from + 1) = self%u(from:n)
    v(:n - from + 1) = self%v(from:n)
    call change_coordinates(processor, n - from + 1, u, v)
    do lane = from, n
      if (self%physical(lane)) cycle
      self%u(lane) = u(lane - from + 1)
      self%v(lane) = v(lane - from + 1)
    end do
    call wrap_lanes(self, from, n)
    call restore_control(control)
    if (.not. to_map) self%physical(from:n) = .true.
  end subroutine change_lanes

  !> Samples the motion within a period by the fallback.
  subroutine processed_sample(self, n, u, v)
    class(processed_batch_t), intent(inout) :: self
    integer, intent(in) :: n
    real(rk), intent(out) :: u(:, :), v(:, :)

    call self%to_physical(size(u, 2))
    call self%fallback%put_all(self%u(:size(u, 2)), self%v(:size(u, 2)))
    call self%fallback%sample(n, u, v)
    self%u(:size(u, 2)) = u(n, :)
    self%v(:size(u, 2)) = v(n, :)
    call self%to_map(size(u, 2))
  end subroutine processed_sample

end module kz_processed_batch
