!> Searches the fewest steps per drive period whose measured error is small enough, for any integrator whose error can
!> be measured. (Enclosures have a bound instead, and series of any digits test their own convergence.)
module kz_vector_step_search
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_funptr, c_ptr, c_f_procpointer
  implicit none
  private
  public :: integrator_t, search_steps, expected_steps

  !> Error above which the next number of steps cannot be predicted, rad; largest ratio of two tries.
  real(c_double), parameter :: LARGEST_ERROR = 1, MAX_GROWTH = 2
  !> Error below which a decrease slower than 1/steps means rounding, which more steps do not reduce, rad.
  real(c_double), parameter :: ROUNDING_ERROR = 1e-3_c_double

  !> An integrator whose number of steps is searched.
  type, abstract :: integrator_t
    integer :: order = 1  !< Order of convergence
    integer :: stride = 2 !< Numbers of steps after the first are multiples of it
    !> Factor on the steps that the order predicts: 1 finds the fewest, more finds enough of them sooner.
    real(c_double) :: growth_margin = 1
  contains
    procedure(measure_error), deferred :: measure_error
  end type integrator_t

  abstract interface
    !> The error of a period of n steps, rad; huge() where it diverges.
    function measure_error(integrator, n) result(error)
      import :: integrator_t, c_double
      class(integrator_t), intent(inout) :: integrator !< numerics of the integrator
      integer, intent(in) :: n !< steps
      real(c_double) :: error
    end function measure_error

    !> Implements kz_step_error of kernel.h.
    function c_measure(n, context) bind(C) result(error)
      import :: c_int32_t, c_ptr, c_double
      integer(c_int32_t), value :: n
      type(c_ptr), value :: context
      real(c_double) :: error
    end function c_measure
  end interface

  !> An integrator of C.
  type, extends(integrator_t) :: c_integrator_t
    procedure(c_measure), pointer, nopass :: function => null()
    type(c_ptr) :: context
  contains
    procedure :: measure_error => measure_in_c
  end type c_integrator_t

contains

  !> Tries numbers of steps from `fewest` on, each predicted by the order from the last error, until an error is at most
  !> the tolerance. If no number up to `most` reaches it, the last error is above the tolerance.
  subroutine search_steps(integrator, tolerance, fewest, most, n, error)
    class(integrator_t), intent(inout) :: integrator !< Integrator; returned with n steps
    real(c_double), intent(in) :: tolerance !< Largest error of one drive period, rad
    integer, intent(in) :: fewest, most !< first number of steps; last one allowed
    integer, intent(out) :: n !< Last number tried; 0 if fewest exceeds most
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
      error = integrator%measure_error(n)
      if (error <= tolerance) exit
      if (former < ROUNDING_ERROR .and. error*n > former*former_n) exit
      wanted = integrator%growth_margin*expected_steps(int(n, c_int32_t), min(error, LARGEST_ERROR), tolerance, &
                                                       int(integrator%order, c_int32_t))
      next = max(n + integrator%stride, integrator%stride*int(min(MAX_GROWTH*n, wanted)/integrator%stride))
    end do
  end subroutine search_steps

  !> Implements kz_expected_steps of kernel.h.
  pure real(c_double) function expected_steps(n, error, tolerance, order) bind(C, name='kz_expected_steps') &
      result(steps)
    integer(c_int32_t), value :: n !< a number of steps
    real(c_double), value :: error !< its error, rad
    real(c_double), value :: tolerance !< the error that is asked for, rad
    integer(c_int32_t), value :: order !< Order of convergence

    steps = n*(error/tolerance)**(1.0_c_double/order)
  end function expected_steps

  !> Implements kz_steps_search of kernel.h.
  real(c_double) function c_search(function, context, order, tolerance, fewest, most, n) &
      bind(C, name='kz_steps_search') result(error)
    type(c_funptr), value :: function
    type(c_ptr), value :: context
    integer(c_int32_t), value :: order
    real(c_double), value :: tolerance
    integer(c_int32_t), value :: fewest, most
    integer(c_int32_t), intent(out) :: n
    real(c_double), parameter :: GROWTH_MARGIN = 1.125_c_double !< Refuses hopeless cases after few tries
    type(c_integrator_t) :: integrator
    integer :: tried

    integrator%order = order
    integrator%growth_margin = GROWTH_MARGIN
    integrator%context = context
    call c_f_procpointer(function, integrator%function)
    call search_steps(integrator, tolerance, int(fewest), int(most), tried, error)
    n = tried
  end function c_search

  real(c_double) function measure_in_c(integrator, n) result(error)
    class(c_integrator_t), intent(inout) :: integrator
    integer, intent(in) :: n

    error = integrator%function(int(n, c_int32_t), integrator%context)
  end function measure_in_c

end module kz_vector_step_search
