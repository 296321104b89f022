!> Follows many starts with any map until each is trapped. Starts enter the coordinates of the map many at a time.
module kz_labels_label
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t, c_int32_t
  use kz_vector_map, only: map_t, WIDTH, CAPACITY
  use kz_maps_lanes, only: queued_lanes_t, list_flagged
  use kz_cycles_cycles, only: attractor_t
  use kz_computed_grid, only: regions_t, find_regions, chaos_region
  implicit none
  private
  public :: starts_t

  !> Starts in the lanes of a map. `run` follows start i for periods(i) at most. label(i) = attractor (from 1) that it
  !> ends on, 0 where it has not settled; periods(i) becomes its first period inside a trapping region, late by less
  !> than `apart`, or the periods followed. state: physical starts (half-turns, rad per drive radian); it becomes the
  !> states where the orbits were left, in the map's coordinates.
  type, extends(queued_lanes_t) :: starts_t
    class(map_t), pointer :: map => null()
    type(regions_t), pointer :: regions => null()
    type(attractor_t), pointer :: attractors(:) => null()
    real(dp), pointer :: state(:, :) => null()
    integer(c_int32_t), pointer :: label(:) => null()
    integer(c_int64_t), pointer :: periods(:) => null()
    integer(c_int64_t), pointer :: turns(:) => null() !< net turns to add to the angle of a last state
    integer(c_int64_t) :: most(CAPACITY) = 0 !< periods that the start of a lane is followed at most
    integer :: apart = 1 !< periods from one look at the regions to the next
  contains
    procedure :: admit, advance, is_done, move
  end type starts_t

contains

  subroutine admit(self, n)
    class(starts_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    do lane = WIDTH + 1, WIDTH + n
      associate (i => self%number(lane))
        self%most(lane) = self%periods(i)
        call self%map%put(lane, self%state(1, i), self%state(2, i))
      end associate
    end do
    self%age(WIDTH + 1:) = 0
    call self%map%to_map(WIDTH + n, first=WIDTH + 1)
    call find_regions(self%regions, self%attractors, n, self%map%u(WIDTH + 1:WIDTH + n), &
                      self%map%v(WIDTH + 1:WIDTH + n), self%region(WIDTH + 1:))
  end subroutine admit

  subroutine advance(self, list, n)
    class(starts_t), intent(inout) :: self
    integer, intent(out) :: list(WIDTH), n
    integer :: done(WIDTH), i

    associate (m => self%active)
      n = int(max(1_c_int64_t, min(int(self%apart, c_int64_t), minval(self%most(:m) - self%age(:m)))))
      do i = 1, n
        call self%map%advance(m)
      end do
      self%age(:m) = self%age(:m) + n
      call find_regions(self%regions, self%attractors, m, self%map%u(:m), self%map%v(:m), self%region)
      if (size(self%regions%covered) > 0) call visit_covers(self)
      done(:m) = min(1, self%region(:m))
      if (maxval(self%age(:m) - self%most(:m)) >= 0) where (self%age(:m) >= self%most(:m)) done(:m) = 1
      call list_flagged(m, done, list, n)
    end associate
  end subroutine advance

  function is_done(self, lane) result(yes)
    class(starts_t), intent(inout) :: self
    integer, intent(in) :: lane
    logical :: yes

    yes = self%region(lane) > 0 .or. self%age(lane) >= self%most(lane)
    if (.not. yes) return
    associate (i => self%number(lane))
      self%label(i) = self%region(lane)
      self%periods(i) = self%age(lane)
      self%state(:, i) = [self%map%u(lane), self%map%v(lane)]
      if (associated(self%turns)) self%turns(i) = self%map%turns(lane)
    end associate
  end function is_done

  subroutine move(self, from, to)
    class(starts_t), intent(inout) :: self
    integer, intent(in) :: from, to

    call self%map%move(from, to)
    call self%copy(from, to)
    self%most(to) = self%most(from)
  end subroutine move

  !> Records the lanes' visits to regions for covers.
  subroutine visit_covers(self)
    class(starts_t), intent(inout) :: self
    integer :: lane, owner

    do lane = 1, self%active
      if (self%region(lane) > 0) then
        self%in_cover(lane) = 0
      else
        owner = chaos_region(self%regions, self%map%u(lane), self%map%v(lane))
        if (self%is_captured(lane, owner)) self%region(lane) = owner
      end if
    end do
  end subroutine visit_covers

end module kz_labels_label
