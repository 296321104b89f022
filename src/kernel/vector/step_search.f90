!> How many steps a drive period takes: the fewest found whose measured error is small enough. It serves every integrator whose
!> error can be measured. Enclosures have a bound instead, and series of any digits test their own convergence.
module kz_vector_step_search
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_funptr, c_ptr, c_f_procpointer
  implicit none
  private
  public :: trial_t, search_steps, expected_steps

  !> rad: a larger error says only that there are too few steps; and how much more are tried next at most.
  real(c_double), parameter :: LARGEST = 1, MOST_GROWTH = 2
  !> rad: below it an error that falls more slowly than as 1/steps is rounding, which more steps do not mend.
  real(c_double), parameter :: ROUNDED = 1e-3_c_double

  !> An integrator whose number of steps is searched.
  type, abstract :: trial_t
    integer :: order = 1  !< of convergence
    integer :: stride = 2 !< numbers of steps after the first are multiples of it
    !> How many more steps are tried than the order expects: 1 finds the fewest, more finds enough of them sooner.
    real(c_double) :: caution = 1
  contains
    procedure(measure), deferred :: measure
  end type trial_t

  abstract interface
    !> The error of a period of n steps, rad; huge() where it diverges.
    function measure(trial, n) result(error)
      import :: trial_t, c_double
      class(trial_t), intent(inout) :: trial !< the integrator
      integer, intent(in) :: n !< steps
      real(c_double) :: error
    end function measure

    !> kz_step_error of kernel.h.
    function c_measure(n, context) bind(C) result(error)
      import :: c_int32_t, c_ptr, c_double
      integer(c_int32_t), value :: n
      type(c_ptr), value :: context
      real(c_double) :: error
    end function c_measure
  end interface

  !> An integrator of C.
  type, extends(trial_t) :: c_trial_t
    procedure(c_measure), pointer, nopass :: function => null()
    type(c_ptr) :: context
  contains
    procedure :: measure => measure_in_c
  end type c_trial_t

contains

  !> Tries numbers of steps from `fewest` on, each the one that the order expects from the error of the former, until an error is at most
  !> the tolerance. Where `most` steps, or any, do not reach it, the last error is above the tolerance.
  subroutine search_steps(trial, tolerance, fewest, most, n, error)
    class(trial_t), intent(inout) :: trial !< the integrator; comes back with n steps
    real(c_double), intent(in) :: tolerance !< rad, of one drive period
    integer, intent(in) :: fewest, most !< first number of steps; last one allowed
    integer, intent(out) :: n !< the last number tried; 0 where fewest exceeds most
    real(c_double), intent(out) :: error !< its error, rad
    real(c_double) :: former, wanted
    integer :: next, former_n

    n = 0
    error = huge(error)
    next = fewest
    do while (next <= most)
      former = error
      former_n = n
      n = next
      error = trial%measure(n)
      if (error <= tolerance) exit
      if (former < ROUNDED .and. error*n > former*former_n) exit
      wanted = trial%caution*expected_steps(int(n, c_int32_t), min(error, LARGEST), tolerance, int(trial%order, c_int32_t))
      next = max(n + trial%stride, trial%stride*int(min(MOST_GROWTH*n, wanted)/trial%stride))
    end do
  end subroutine search_steps

  !> kz_expected_steps of kernel.h.
  pure real(c_double) function expected_steps(n, error, tolerance, order) bind(C, name='kz_expected_steps') result(steps)
    integer(c_int32_t), value :: n !< a number of steps
    real(c_double), value :: error !< its error, rad
    real(c_double), value :: tolerance !< the error that is asked for, rad
    integer(c_int32_t), value :: order !< of convergence

    steps = n*(error/tolerance)**(1.0_c_double/order)
  end function expected_steps

  !> kz_steps_search of kernel.h.
  real(c_double) function c_search(function, context, order, tolerance, fewest, most, n) bind(C, name='kz_steps_search') result(error)
    type(c_funptr), value :: function
    type(c_ptr), value :: context
    integer(c_int32_t), value :: order
    real(c_double), value :: tolerance
    integer(c_int32_t), value :: fewest, most
    integer(c_int32_t), intent(out) :: n
    real(c_double), parameter :: CAUTION = 1.125_c_double !< so few tries that a hopeless case is refused quickly
    type(c_trial_t) :: trial
    integer :: tried

    trial%order = order
    trial%caution = CAUTION
    trial%context = context
    call c_f_procpointer(function, trial%function)
    call search_steps(trial, tolerance, int(fewest), int(most), tried, error)
    n = tried
  end function c_search

  real(c_double) function measure_in_c(trial, n) result(error)
    class(c_trial_t), intent(inout) :: trial
    integer, intent(in) :: n

    error = trial%function(int(n, c_int32_t), trial%context)
  end function measure_in_c

end module kz_vector_step_search
