!> Solutions followed by pseudo-arclength until they leave the plane, close or end: branches and curves extend it.
module kz_cycles_continuation
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_cycles_curves, only: UNKNOWNS
  use kz_cycles_placed, only: outside, LEFT, CLOSED, LONG, STUCK, NO_SEED
  use kz_cycles_walker, only: walker_t, parents_t, advance, set_parents
  implicit none
  private
  public :: way_t, end_t, continuation_t, GOES_ON

  !> No ending of a continuation.
  integer, parameter :: GOES_ON = -1

  !> kz_branch_way and kz_branch_end of dynamics_curves.h.
  type, bind(C) :: way_t
    real(dp) :: along(2), longest, step
    integer(c_int64_t) :: most, most_events
    integer(c_int32_t) :: side
  end type way_t

  type, bind(C) :: end_t
    integer(c_int64_t) :: rows = 0, events = 0
    real(dp) :: step = 0
    integer(c_int32_t) :: ending = NO_SEED
  end type end_t

  type, abstract :: continuation_t
    type(way_t) :: way
    type(end_t) :: reached
    type(walker_t) :: walker
    type(parents_t) :: was !< differences from the parents at the point before
    real(dp), dimension(UNKNOWNS) :: first = 0, before = 0, heading = 0 !< the first point; that before, its tangent
  contains
    procedure :: follow
    procedure(ending_i), deferred :: ending
    procedure(put_i), deferred :: put
    procedure(closed_i), deferred :: is_closed
  end type continuation_t

  abstract interface
    !> Looks at what lies between the last two points; GOES_ON, or how the continuation ends there.
    integer function ending_i(self, is)
      import :: continuation_t, parents_t
      class(continuation_t), intent(inout) :: self
      type(parents_t), intent(in) :: is
    end function ending_i

    !> Writes a row.
    subroutine put_i(self)
      import :: continuation_t
      class(continuation_t), intent(inout) :: self
    end subroutine put_i

    !> Whether the continuation is at its first point again.
    logical function closed_i(self)
      import :: continuation_t
      class(continuation_t), intent(inout) :: self
    end function closed_i
  end interface

contains

  subroutine follow(self)
    class(continuation_t), intent(inout) :: self !< with its first row
    type(parents_t) :: is

    associate (walker => self%walker, reached => self%reached, n => 2*self%walker%system%n)
      do while (reached%rows < self%way%most)
        self%before = walker%y
        self%heading = walker%tangent
        reached%ending = STUCK
        if (.not. advance(walker)) return
        reached%step = walker%step
        call set_parents(walker%system, walker%y, is)
        reached%ending = self%ending(is)
        if (reached%ending /= GOES_ON) return
        self%was = is
        call self%put()
        reached%ending = LEFT
        if (outside(walker%system%plane, walker%y(n + 1:n + 2))) return
        reached%ending = CLOSED
        if (self%is_closed()) return
      end do
      reached%ending = LONG
    end associate
  end subroutine follow

end module kz_cycles_continuation
