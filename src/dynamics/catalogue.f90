!> The catalogue of attractors: its order, which depends on the attractors alone, and its travel between ranks as doubles.
module kz_dynamics_catalogue
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_kernel_map, only: PI
  use kz_dynamics_cycles, only: attractor_t
  use kz_dynamics_states, only: rounded
  implicit none
  private
  public :: order_of, packed, unpacked

  !> Doubles in front of the arrays of an attractor.
  integer, parameter :: HEAD = 15

contains

  !> order(r) = number of the attractor of rank r: by centre, period (0 last), |winding|/period, + before -, first strobe
  !> velocity, first strobe angle, each compared rounded to 1e-9; chaotic ones by mean velocity, larger first, then mean angle.
  function order_of(attractors) result(order)
    type(attractor_t), intent(in) :: attractors(:)
    integer :: order(size(attractors))
    integer :: i, j, moving

    do i = 1, size(attractors)
      moving = i
      j = i - 1
      do while (j >= 1)
        if (.not. before(attractors(moving), attractors(order(j)))) exit
        order(j + 1) = order(j)
        j = j - 1
      end do
      order(j + 1) = moving
    end do
  end function order_of

  function before(a, b)
    type(attractor_t), intent(in) :: a
    type(attractor_t), intent(in) :: b
    logical :: before
    real(dp) :: key_a(6), key_b(6)
    integer :: i

    key_a = key(a)
    key_b = key(b)
    before = .false.
    do i = 1, size(key_a)
      if (key_a(i) < key_b(i)) before = .true.
      if (abs(key_a(i) - key_b(i)) > 0) return
    end do
  end function before

  function key(a)
    type(attractor_t), intent(in) :: a
    real(dp) :: key(6)

    if (a%period > 0) then
      key = [real(a%centre, dp), real(a%period, dp), rounded(abs(real(a%winding, dp))/a%period), real(-a%winding, dp), &
             rounded(a%v(1)), rounded(PI*a%u(1))]
    else
      key = [real(a%centre, dp), huge(1.0_dp), 0.0_dp, 0.0_dp, rounded(-a%mean_velocity), rounded(PI*a%mean)]
    end if
  end function key

  !> The whole catalogue as doubles; integers are exact in them.
  function packed(attractors) result(flat)
    type(attractor_t), intent(in) :: attractors(:)
    real(dp), allocatable :: flat(:)
    integer :: i, n_cover

    flat = [real(size(attractors), dp)]
    do i = 1, size(attractors)
      associate (a => attractors(i))
        n_cover = 0
        if (allocated(a%cover)) n_cover = size(a%cover)
        flat = [flat, real([a%period, a%winding, merge(1, 0, a%symmetric), a%mirror, a%centre, n_cover], dp), &
                a%mean, a%mean_velocity, a%amplitude, a%lyapunov, a%lyapunov_error, &
                real(a%multiplier(1), dp), aimag(a%multiplier(1)), real(a%multiplier(2), dp), aimag(a%multiplier(2))]
        if (a%period > 0) flat = [flat, a%u, a%v, reshape(a%form, [3*a%period])]
        if (n_cover > 0) flat = [flat, real(a%cover, dp)]
      end associate
    end do
  end function packed

  function unpacked(flat) result(attractors)
    real(dp), intent(in) :: flat(:)
    type(attractor_t), allocatable :: attractors(:)
    integer :: i, p, n, n_cover

    allocate (attractors(nint(flat(1))))
    p = 1
    do i = 1, size(attractors)
      associate (a => attractors(i))
        n = nint(flat(p + 1))
        n_cover = nint(flat(p + 6))
        a%period = n
        a%winding = nint(flat(p + 2))
        a%symmetric = nint(flat(p + 3)) == 1
        a%mirror = nint(flat(p + 4))
        a%centre = nint(flat(p + 5))
        a%mean = flat(p + 7)
        a%mean_velocity = flat(p + 8)
        a%amplitude = flat(p + 9)
        a%lyapunov = flat(p + 10)
        a%lyapunov_error = flat(p + 11)
        a%multiplier = [cmplx(flat(p + 12), flat(p + 13), dp), cmplx(flat(p + 14), flat(p + 15), dp)]
        p = p + HEAD
        allocate (a%u, source=flat(p + 1:p + n))
        allocate (a%v, source=flat(p + n + 1:p + 2*n))
        allocate (a%form, source=reshape(flat(p + 2*n + 1:p + 5*n), [3, n]))
        p = p + 5*n
        allocate (a%cover, source=nint(flat(p + 1:p + n_cover)))
        p = p + n_cover
      end associate
    end do
  end function unpacked

end module kz_dynamics_catalogue
