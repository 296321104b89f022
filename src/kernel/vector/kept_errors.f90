!> A cache of measured errors of a drive period: a study asks for them before a run, for checks, and after it.
module kz_vector_kept_errors
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t, c_ptr, c_null_ptr, c_associated, c_f_pointer
  use kz_vector_locks, only: take_lock, leave_lock
  implicit none
  private
  public :: kept_errors_t, recall_errors, keep_errors

  !> Capacity of the cache: a sweep tries 17 values.
  integer, parameter :: MEASURED = 24

  !> Errors, with the bits of all numbers that they depend on.
  type :: errors_t
    integer(c_int64_t), allocatable :: key(:)
    real(c_double), allocatable :: error(:)
  end type errors_t

  !> The first part of the target of kz_kept_series (kernel.h). The thread that holds the lock uses it.
  type :: kept_errors_t
    type(c_ptr) :: lock = c_null_ptr
    type(errors_t), private :: measured(MEASURED)
    integer, private :: n_measured = 0 !< Number of errors kept so far
  end type kept_errors_t

contains

  !> Returns true and the errors if they were measured before.
  logical function recall_errors(handle, key, error) result(known)
    type(c_ptr), intent(in) :: handle !< kz_kept_series of kernel.h; null = no cache
    integer(c_int64_t), intent(in) :: key(:) !< Bits of all numbers that the errors depend on
    real(c_double), intent(inout) :: error(:) !< rad; unchanged where they are not known
    type(kept_errors_t), pointer :: kept
    integer :: i

    known = .false.
    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, kept)
    call take_lock(kept%lock)
    do i = 1, min(kept%n_measured, MEASURED)
      if (size(kept%measured(i)%key) /= size(key)) cycle
      if (any(kept%measured(i)%key /= key)) cycle
      error = kept%measured(i)%error
      known = .true.
    end do
    call leave_lock(kept%lock)
  end function recall_errors

  !> Keeps errors in place of the oldest.
  subroutine keep_errors(handle, key, error)
    type(c_ptr), intent(in) :: handle !< Cache, see recall_errors
    integer(c_int64_t), intent(in) :: key(:)
    real(c_double), intent(in) :: error(:) !< rad
    type(kept_errors_t), pointer :: kept

    if (.not. c_associated(handle)) return
    call c_f_pointer(handle, kept)
    call take_lock(kept%lock)
    kept%measured(modulo(kept%n_measured, MEASURED) + 1) = errors_t(key, error)
    kept%n_measured = kept%n_measured + 1
    call leave_lock(kept%lock)
  end subroutine keep_errors

end module kz_vector_kept_errors
