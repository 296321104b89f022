!> Locks of threads: include/kapitza/common_threads.h. Stop requests of a caller of the library: common_border.h.
module kz_vector_locks
  use, intrinsic :: iso_c_binding, only: c_ptr
  implicit none
  private
  public :: create_lock, free_lock, take_lock, leave_lock, look

  interface
    !> A lock that nobody holds.
    type(c_ptr) function create_lock() bind(C, name='kz_lock_create')
      import :: c_ptr
    end function create_lock

    !> Frees a lock that nobody holds; null is none.
    subroutine free_lock(lock) bind(C, name='kz_lock_free')
      import :: c_ptr
      type(c_ptr), value :: lock
    end subroutine free_lock

    !> Waits until no other thread holds the lock, and takes it.
    subroutine take_lock(lock) bind(C, name='kz_lock_take')
      import :: c_ptr
      type(c_ptr), value :: lock
    end subroutine take_lock

    subroutine leave_lock(lock) bind(C, name='kz_lock_leave')
      import :: c_ptr
      type(c_ptr), value :: lock
    end subroutine leave_lock
    !> Leaves the call of the library that this thread works for, if its caller wants that.
    subroutine look() bind(C, name='kz_look')
    end subroutine look
  end interface

end module kz_vector_locks
