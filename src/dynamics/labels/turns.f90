!> Net turns of motions: from the angle of release to the middle of the final cycle, on the line over the circle.
module kz_labels_turns
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_cycles, only: attractor_t
  use kz_cycles_features, only: SAMPLES, DOWN, INVERTED
  use kz_computed_ellipses, only: ellipse_square
  use kz_labels_orbits, only: decision_t
  use kz_maps_lanes, only: lanes_t
  use kz_vector_map, only: flow_t, WIDTH, PI
  implicit none
  private
  public :: count_turns

  !> KZ_NO_TURNS of dynamics_labels.h.
  integer(c_int32_t), parameter :: NO_TURNS = -huge(0_c_int32_t) - 1

  !> The middle of a cycle, half-turns, as seen from each strobe point.
  type :: middle_t
    real(dp), allocatable :: from(:)
  end type middle_t

  !> Trapped motions in the lanes of a flow, until an ellipse of their cycle holds them.
  type, extends(lanes_t) :: motions_t
    class(flow_t), pointer :: flow => null()
    type(attractor_t), pointer :: attractors(:) => null()
    type(middle_t), pointer :: middle(:) => null()
    type(decision_t), pointer :: decision(:) => null()
    integer(c_int64_t) :: most = 0       !< periods that a motion is followed
    integer(c_int64_t) :: next = 1       !< decision that enters next
    integer(c_int64_t) :: number(WIDTH) = 0 !< decision of a lane
    integer(c_int64_t) :: age(WIDTH) = 0 !< periods since it entered
  contains
    procedure :: fill, advance, is_done, move
  end type motions_t

contains

  !> Fills decision(:)%end%turns, NO_TURNS where a motion ends on no cycle or on one that rotates. Such a number is the
  !> same for all starts of a connected piece of a basin on the line of angles, so for all that a trapping region holds
  !> with the orbit: it is as certain as the label.
  subroutine count_turns(flow, sampling_flow, attractors, most, decision)
    class(flow_t), intent(inout), target :: flow !< the scene's map
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    type(attractor_t), intent(in), target :: attractors(:) !< the catalogue, numbered from 1
    integer(c_int64_t), intent(in) :: most !< periods that a trapped motion is followed
    type(decision_t), intent(inout), target :: decision(:) !< [n] in and out
    type(middle_t), target :: middle(size(attractors))
    type(motions_t) :: motions
    logical :: reached(0:size(attractors))
    integer :: i

    decision%end%turns = NO_TURNS
    reached = .false.
    reached(max(0, int(decision%end%label))) = .true.
    do i = 1, size(attractors)
      if (reached(i) .and. attractors(i)%period > 0 .and. attractors(i)%winding == 0) &
        call find_middle(sampling_flow, attractors(i), middle(i)%from)
    end do
    motions%flow => flow
    motions%attractors => attractors
    motions%middle => middle
    motions%decision => decision
    motions%most = most
    call motions%run()
  end subroutine count_turns

  !> The middle is straight down or up for cycles about these directions, else the mean angle.
  subroutine find_middle(sampling_flow, cycle, from)
    class(flow_t), intent(inout) :: sampling_flow
    type(attractor_t), intent(in) :: cycle
    real(dp), allocatable, intent(out) :: from(:)
    real(dp) :: mean, u(SAMPLES, 1), v(SAMPLES, 1), lifted(cycle%period)
    integer(c_int64_t) :: turns
    integer :: j

    mean = 0
    call sampling_flow%put(1, cycle%u(1), cycle%v(1))
    do j = 1, cycle%period
      turns = sampling_flow%turns(1)
      lifted(j) = sampling_flow%u(1) + 2*turns
      call sampling_flow%sample(SAMPLES, u, v)
      mean = mean + (sum(u)/SAMPLES + 2*turns)/cycle%period
    end do
    if (cycle%centre == DOWN .or. cycle%centre == INVERTED) mean = anint(mean)
    from = mean - 2*anint(0.5_dp*(lifted - cycle%kernel_u))
  end subroutine find_middle

  function fill(self, lane) result(yes)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    yes = .false.
    do while (self%next <= size(self%decision) .and. .not. yes)
      associate (decision => self%decision(self%next))
        if (decision%end%label > 0) yes = allocated(self%middle(decision%end%label)%from)
        if (yes) call self%flow%put(lane, decision%state(1), decision%state(2))
      end associate
      self%number(lane) = self%next
      self%age(lane) = 0
      self%next = self%next + 1
    end do
  end function fill

  subroutine advance(self, list, n)
    class(motions_t), intent(inout) :: self
    integer, intent(out) :: list(WIDTH), n

    call self%flow%advance(self%active)
    self%age(:self%active) = self%age(:self%active) + 1
    list = [(self%active + 1 - n, n=1, WIDTH)]
    n = self%active
  end subroutine advance

  function is_done(self, lane) result(yes)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes
    real(dp) :: to
    integer :: j

    associate (decision => self%decision(self%number(lane)), u => self%flow%u(lane), v => self%flow%v(lane))
      associate (end => self%attractors(decision%end%label))
        do j = 1, end%period
          yes = ellipse_square(end, j, u, v) < 1
          if (.not. yes) cycle
          to = self%middle(decision%end%label)%from(j) + 2*anint(0.5_dp*(u - end%kernel_u(j)))
          decision%end%turns = turns_between(decision%from, to, decision%turns + self%flow%turns(lane))
          return
        end do
      end associate
    end associate
    yes = self%age(lane) >= self%most
  end function is_done

  !> The number of whole turns, rounded to the nearest, from an angle (rad) to another one (half-turns) and so many
  !> turns more. Halves go towards 0; the double nearest to pi is less than pi.
  pure function turns_between(from, to, more) result(turns)
    real(dp), intent(in) :: from, to
    integer(c_int64_t), intent(in) :: more
    integer(c_int32_t) :: turns
    real(dp) :: begin, between
    integer(c_int64_t) :: least, most

    begin = from/PI
    if (abs(from) <= PI) begin = sign(min(abs(begin), 1 - epsilon(begin)), begin)
    between = 0.5_dp*(to - begin)
    least = more + ceiling(between - 0.5_dp, c_int64_t)
    most = more + floor(between + 0.5_dp, c_int64_t)
    if (abs(least) < abs(most)) most = least
    turns = NO_TURNS
    if (abs(most) < huge(turns)) turns = int(most, c_int32_t)
  end function turns_between

  subroutine move(self, from, to)
    class(motions_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call self%flow%move(from, to)
    self%number(to) = self%number(from)
    self%age(to) = self%age(from)
  end subroutine move

end module kz_labels_turns
