!> The processed splitting in double precision: its tables, and its series with their cache.
module kz_processed_tables
  use, intrinsic :: iso_c_binding, only: c_double, c_ptr, c_associated, c_f_pointer, c_loc
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_kept_errors, only: kept_errors_t
  use kz_vector_locks, only: create_lock, free_lock, take_lock, leave_lock
  use kz_model_pendulum, only: pendulum_t, exact_stiffness, is_same
  use kz_processed_harmonics, only: sine_polynomials, cosine_polynomials
  use kz_processed_series_r64, only: series_t, make_series, ORDER, HARMONICS
  implicit none
  private
  public :: series_t, kept_series_t, processed_t, processor_t, make_processed_series, make_processed, ORDER, &
            HARMONICS, NODES

  !> Largest useful numbers of powers of the velocity in a drift (1, 3, 5, ..) and of coefficients of a kick.
  integer, parameter, public :: MOST_DRIFTS = 4, MOST_KICKS = 11
  !> Largest damping: the factor exp(beta t) of the velocity within a period would overflow beyond it.
  real(c_double), parameter, public :: MOST_DAMPING = 16/(2*3.14159265358979323846_c_double)

  !> Series kept for interpolation between pendulums. Over a plane, functions of degree 5 have 21 coefficients.
  integer, parameter :: NODES = 24

  !> The cache kz_kept_series of kernel.h: the series made last, which a scene asks for several times, and the nodes of
  !> the interpolation. The thread that holds the lock uses it.
  type, extends(kept_errors_t) :: kept_series_t
    type(pendulum_t) :: pendulum
    type(series_t), allocatable :: made
    type(pendulum_t) :: place(NODES)
    type(series_t), allocatable :: node(:)
    integer :: n_nodes = 0
  end type kept_series_t

  include 'tables.inc'

  subroutine set_kicks(pendulum, series, table)
    type(pendulum_t), intent(in) :: pendulum
    type(series_t), intent(in) :: series
    type(processed_t), intent(inout) :: table
    real(rk) :: h, scale, sines(HARMONICS, table%n_kick), cosines(0:HARMONICS, table%n_kick), of_sines(0:HARMONICS), &
                of_cosines(0:HARMONICS)
    integer :: s, n

    h = 2*PI/table%n_steps
    n = table%n_drift + table%n_kick
    sines = real(sine_polynomials(table%n_kick), rk)
    if (.not. table%mirrored) cosines = real(cosine_polynomials(table%n_kick), rk)
    do s = 1, table%n_steps
      scale = exp(real(pendulum%beta, rk)*((s - 0.5_rk)*h))
      call kick_harmonics(series, h, (s - 0.5_rk)*h, of_sines, of_cosines)
      table%row(table%n_drift + 1:n, s) = scale*matmul(of_sines(1:), sines)
      if (.not. table%mirrored) table%row(n + table%n_drift + 1:, s) = scale*matmul(of_cosines, cosines)
    end do
  end subroutine set_kicks

  !> Harmonics of the kick at a time: the velocity loses the sum of `of_sines` sin(j theta) + `of_cosines` cos(j theta).
  pure subroutine kick_harmonics(series, h, time, of_sines, of_cosines)
    type(series_t), intent(in) :: series
    real(rk), intent(in) :: h, time
    real(rk), intent(out) :: of_sines(0:HARMONICS), of_cosines(0:HARMONICS)
    real(rk) :: cosine(0:series%times), sine(0:series%times), amplitude(2)
    integer :: q, j, l, top, trig

    cosine(0) = 1
    sine(0) = 0
    cosine(1) = cos(time)
    sine(1) = sin(time)
    do l = 2, series%times
      cosine(l) = cosine(l - 1)*cosine(1) - sine(l - 1)*sine(1)
      sine(l) = sine(l - 1)*cosine(1) + cosine(l - 1)*sine(1)
    end do
    of_sines = 0
    of_cosines = 0
    do q = 2, ORDER, 2
      top = q/2*(series%times/HARMONICS)
      do j = 1, q/2
        amplitude = 0
        do trig = 1, merge(1, 2, series%mirrored)
          amplitude(trig) = dot_product(cosine(:top), series%kick(:top, j, q, trig, 1)) + &
                            dot_product(sine(:top), series%kick(:top, j, q, trig, 2))
        end do
        of_sines(j) = of_sines(j) - h**(q - 1)*j*amplitude(1)
        of_cosines(j) = of_cosines(j) + h**(q - 1)*j*amplitude(2)
      end do
      of_cosines(0) = of_cosines(0) + h**(q - 1)*(dot_product(cosine(:1), series%slope(:, q, 1)) &
                                                  + sine(1)*series%slope(1, q, 2))
    end do
  end subroutine kick_harmonics

  !> Makes the series of a pendulum, or takes it from the cache. Its error is 1e-15 of the force.
  subroutine make_processed_series(pendulum, kept, series)
    type(pendulum_t), intent(in) :: pendulum !< Pendulum
    type(c_ptr), intent(in) :: kept !< Cache, kz_kept_series of kernel.h; null = none
    type(series_t), intent(out) :: series !< Series, for any number of steps
    type(kept_series_t), pointer :: last

    if (.not. c_associated(kept)) then
      call make_series(pendulum, ORDER, series)
      return
    end if
    call c_f_pointer(kept, last)
    call take_lock(last%lock)
    if (allocated(last%made)) then
      if (.not. is_same(pendulum, last%pendulum)) deallocate (last%made)
    end if
    if (.not. allocated(last%made)) then
      allocate (last%made)
      call make_series(pendulum, ORDER, last%made)
      last%pendulum = pendulum
    end if
    series = last%made
    call leave_lock(last%lock)
  end subroutine make_processed_series

  type(c_ptr) function series_create() bind(C, name='kz_kept_series_create') result(handle)
    type(kept_series_t), pointer :: kept

    allocate (kept)
    kept%lock = create_lock()
    handle = c_loc(kept%kept_errors_t) ! its address is that of `kept`
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
