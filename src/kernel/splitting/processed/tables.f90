!> The processed splitting in double precision: its tables, and its series, which may be kept.
module kz_processed_tables
  use, intrinsic :: iso_c_binding, only: c_double, c_ptr, c_null_ptr, c_associated, c_f_pointer, c_loc
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_locks, only: create_lock, free_lock, take_lock, leave_lock
  use kz_model_pendulum, only: pendulum_t, exact_stiffness, is_same
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_series_r64, only: series_t, make_series, ORDER, HARMONICS
  implicit none
  private
  public :: series_t, kept_series_t, processed_t, processor_t, make_processed_series, make_processed, ORDER, HARMONICS, NODES

  !> Powers of the velocity in a drift (1, 3, 5, ..) and coefficients of a kick that are of use.
  integer, parameter, public :: MOST_DRIFTS = 4, MOST_KICKS = 11
  !> The velocity is carried as v exp(beta t) through a period: more damping than this would overflow.
  real(c_double), parameter, public :: MOST_DAMPING = 16/(2*3.14159265358979323846_c_double)

  !> Pendulums that a hand moved whose series are kept. Over a plane, functions of degree 5 have 21 coefficients.
  integer, parameter :: NODES = 24

  !> What kz_kept_series of kernel.h points at: the series that was made last, which a scene asks for several times, and series of pendulums that a
  !> hand moves. The caller owns it; the thread that holds the lock uses it.
  type :: kept_series_t
    type(pendulum_t) :: pendulum
    type(series_t), allocatable :: made
    type(pendulum_t) :: place(NODES)
    type(series_t), allocatable :: node(:)
    type(c_ptr) :: lock = c_null_ptr
    integer :: n_nodes = 0
  end type kept_series_t

  !> Kicks sum their grades for each step anew.
  logical, parameter :: SUMS_GRADES = .false.

  include 'tables.inc'

  !> The series of a pendulum, right to 1e-15 of the force itself.
  subroutine make_processed_series(pendulum, kept, series)
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(c_ptr), intent(in) :: kept !< series that are kept, kz_kept_series of kernel.h; null = none are
    type(series_t), intent(out) :: series !< what does not depend on the number of steps
    type(kept_series_t), pointer :: last

    if (.not. c_associated(kept)) then
      call make_series(pendulum, series)
      return
    end if
    call c_f_pointer(kept, last)
    call take_lock(last%lock)
    if (allocated(last%made)) then
      if (.not. is_same(pendulum, last%pendulum)) deallocate (last%made)
    end if
    if (.not. allocated(last%made)) then
      allocate (last%made)
      call make_series(pendulum, last%made)
      last%pendulum = pendulum
    end if
    series = last%made
    call leave_lock(last%lock)
  end subroutine make_processed_series

  type(c_ptr) function series_create() bind(C, name='kz_kept_series_create') result(handle)
    type(kept_series_t), pointer :: kept

    allocate (kept)
    kept%lock = create_lock()
    handle = c_loc(kept)
  end function series_create

  subroutine series_free(handle) bind(C, name='kz_kept_series_free')
    type(c_ptr), value :: handle
    type(kept_series_t), pointer :: kept

    call c_f_pointer(handle, kept)
    if (.not. associated(kept)) return
    call free_lock(kept%lock)
    deallocate (kept)
  end subroutine series_free

end module kz_processed_tables
