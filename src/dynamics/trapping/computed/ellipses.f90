!> Trapping regions: around every strobe point the largest ellipse that the n-period map is seen to carry inside itself.
!>
!> The map is a homeomorphism of the plane: where the boundary of a region goes strictly inside, the whole region does.
!> Every ring of an ellipse is tried from a tiny one on, so that the cycle is the only invariant set in it. The norm is
!> that of the eigenbasis of the monodromy: for complex multipliers the linear map contracts it by exactly |mu|.
module kz_computed_ellipses
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_vector_map, only: flow_t, WIDTH, PI
  use kz_cycles_cycles, only: attractor_t, is_slow
  use kz_cycles_newton, only: n_periods
  use kz_maps_matrices, only: inverse_of, eigenvector, IDENTITY
  use kz_model_pendulum, only: MIRROR
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: rings_t, find_ellipses, in_ellipse, ellipse_square

  !> Radii of rings, rad; where none up to LATEST is carried inside, none is looked for beyond.
  real(dp), parameter :: SMALLEST = 1e-7_dp, LATEST = 1e-2_dp, LARGEST = 2.0_dp
  !> Effect of rounding on a ring, in units of the map's rounding: a ring shrinks only if it shrinks by more.
  real(dp), parameter :: ROUNDING = 18
  !> Slow spirals: the factor by which an ellipse is widened at once; the time that a ring may take, in units of what
  !> the multiplier says; in radii, how far outside images of its points may lie meanwhile, and how far apart those of
  !> neighbours in the end; points of the ring, and returns between two looks at them.
  real(dp), parameter :: STEP = 1.5_dp, PATIENCE = 4, FAR = 2, APART = 0.5_dp
  integer, parameter :: FEW = 32, LOOKED_AT = 4

  !> How closely rings are tried.
  type :: rings_t
    integer :: points = WIDTH !< points of a ring, at most WIDTH
    real(dp) :: growth = 2    !< growth of the radius from one ring to the next
    integer :: halvings = 5   !< halvings of the interval between the last good radius and the next one
    integer :: between = 16   !< parts of the radius in the end, at each of which a ring is tried
  end type rings_t

  !> A strobe point, and the norm of its ellipses.
  type :: site_t
    class(flow_t), pointer :: flow => null() !< the map whose orbits are to be trapped
    type(rings_t) :: rings
    integer :: period = 0                    !< period of the cycle
    real(dp) :: shrinking = 0                !< modulus of the larger multiplier
    real(dp) :: u = 0, v = 0                 !< the point in the coordinates of the flow
    real(dp) :: basis(2, 2) = 0, inverse(2, 2) = 0 !< eigenbasis of the monodromy, rad
  end type site_t

contains

  !> Sets attractor%form. For a symmetric cycle half of the points follow from the other half. A cycle that motions
  !> spiral into slowly has the ellipse of its first point alone, which is wide: motions come by there every period of
  !> the cycle.
  subroutine find_ellipses(flow, fine, attractor, others, rings)
    class(flow_t), intent(inout), target :: flow !< the map whose orbits are to be trapped
    class(flow_t), intent(inout) :: fine !< the map of the published strobe points
    type(attractor_t), intent(inout) :: attractor !< its points and multipliers, in; the ellipses, out
    type(attractor_t), intent(in) :: others(:) !< attractors whose strobe points no ellipse may contain
    type(rings_t), intent(in) :: rings !< how closely they are tried
    integer :: j, n_own

    n_own = attractor%period
    if (attractor%symmetric .and. attractor%symmetry == MIRROR .and. n_own > 1) n_own = n_own/2
    attractor%form = 0
    do j = 1, merge(1, n_own, is_slow(attractor))
      attractor%form(:, j) = ellipse(flow, fine, attractor, j, others, rings)
    end do
    if (n_own < attractor%period) attractor%form(:, n_own + 1:) = attractor%form(:, :n_own)
  end subroutine find_ellipses

  !> True if the trapping ellipse of strobe point j holds (u, v).
  pure function in_ellipse(attractor, j, u, v) result(inside)
    type(attractor_t), intent(in) :: attractor !< the attractor
    integer, intent(in) :: j !< strobe point, from 1
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    logical :: inside

    inside = ellipse_square(attractor, j, u, v) < 1
  end function in_ellipse

  !> The square of (u, v) in the norm of that ellipse, 1 on its rim; huge where there is none.
  pure function ellipse_square(attractor, j, u, v) result(square)
    type(attractor_t), intent(in) :: attractor !< the attractor
    integer, intent(in) :: j !< strobe point, from 1
    real(dp), intent(in) :: u, v !< half-turns in [-1, 1], rad per drive radian
    real(dp) :: square, du, dv

    du = angle_difference(u, attractor%kernel_u(j))
    dv = v - attractor%kernel_v(j)
    square = attractor%form(1, j)*du**2 + 2*attractor%form(2, j)*du*dv + attractor%form(3, j)*dv**2
    if (.not. attractor%form(1, j) > 0) square = huge(square)
  end function ellipse_square

  !> The form of the largest trapping ellipse of strobe point j; 0 where none was found.
  function ellipse(flow, fine, attractor, j, others, rings) result(form)
    class(flow_t), intent(inout), target :: flow
    class(flow_t), intent(inout) :: fine
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: j
    type(attractor_t), intent(in) :: others(:)
    type(rings_t), intent(in) :: rings
    real(dp) :: form(3)
    type(site_t) :: site
    real(dp) :: first, last, residual(2), matrix(2, 2)

    form = 0
    site = site_t(flow, rings, attractor%period, abs(attractor%multiplier(1)), attractor%kernel_u(j), &
                  attractor%kernel_v(j))
    call n_periods(fine, attractor%period, 1, [attractor%u(j), attractor%v(j)], residual, matrix)
    call eigenbasis(matrix, attractor%multiplier, change(flow, attractor, j), site%basis, site%inverse)
    first = ROUNDING*epsilon(1.0_dp)*maxval(hypot(PI*attractor%u, attractor%v))*norm2(site%inverse)/(1 - site%shrinking)
    call find_radii(site, max(first, SMALLEST), first, last)
    if (first <= 0) return
    if (j == 1 .and. is_slow(attractor)) call widen(site, last)
    if (clearance(site, attractor, others) < max(last, 4*first)) return
    associate (inverse => site%inverse)
      form = [PI**2*(inverse(1, 1)**2 + inverse(2, 1)**2), &
              PI*(inverse(1, 1)*inverse(1, 2) + inverse(2, 1)*inverse(2, 2)), &
              inverse(1, 2)**2 + inverse(2, 2)**2]/last**2
    end associate
  end function ellipse

  !> The first and the last radius of rings that are carried inside themselves; first = 0: none is. `least`: where their
  !> shrinking shows above rounding and above the distance by which the map's own cycle misses the fine one.
  subroutine find_radii(site, least, first, last)
    type(site_t), intent(inout) :: site
    real(dp), intent(in) :: least
    real(dp), intent(out) :: first, last
    real(dp) :: tried

    tried = least
    first = 0
    last = 0
    do while (tried < LARGEST)
      if (carried_inside(site, tried)) then
        if (first <= 0) first = tried
        last = tried
      else if (first > 0 .or. tried > LATEST) then
        exit
      end if
      tried = tried*site%rings%growth
    end do
    if (first > 0) call refine(site, first, last)
  end subroutine find_radii

  !> `last` becomes the largest good radius between it and the next tried one, with rings from `first` on good too.
  subroutine refine(site, first, last)
    type(site_t), intent(inout) :: site
    real(dp), intent(in) :: first
    real(dp), intent(inout) :: last
    real(dp) :: tried, interval
    integer :: i

    interval = (site%rings%growth - 1)*last
    do i = 1, site%rings%halvings
      tried = last + interval*0.5_dp**i
      if (carried_inside(site, tried)) last = tried
    end do
    do i = 1, site%rings%between - 1
      tried = last*i/site%rings%between
      if (tried < first) cycle
      if (carried_inside(site, tried)) cycle
      last = max(first, 0.9_dp*last*(i - 1)/site%rings%between)
      exit
    end do
  end subroutine refine

  !> Whether the points of a ring are all carried inside it, by half of what the multiplier says or by 5 %.
  function carried_inside(site, radius) result(inside)
    type(site_t), intent(inout) :: site
    real(dp), intent(in) :: radius
    logical :: inside

    call put_ring(site, radius, site%rings%points)
    call return_once(site, site%rings%points)
    inside = all(norm2(normed(site, site%flow%u(:site%rings%points), site%flow%v(:site%rings%points)), 1) < &
                 radius*(1 - min(0.05_dp, 0.5_dp*(1 - site%shrinking))))
  end function carried_inside

  !> Widens an ellipse as long as the ring outside of it is carried inside in the end: then the ring's inside is too.
  subroutine widen(site, radius)
    type(site_t), intent(inout) :: site
    real(dp), intent(inout) :: radius

    do while (radius < LARGEST)
      if (.not. comes_inside(site, STEP*radius, radius)) exit
      radius = STEP*radius
    end do
  end subroutine widen

  !> Whether all points of a ring are inside the ellipse of another radius at once, soon enough, with neighbours beside
  !> each other: then what lies between them is inside, too.
  function comes_inside(site, radius, goal) result(inside)
    type(site_t), intent(inout) :: site
    real(dp), intent(in) :: radius, goal
    logical :: inside
    real(dp) :: x(2, FEW), rate
    integer :: returns

    call put_ring(site, radius, FEW)
    inside = .false.
    rate = -log(site%shrinking)/site%period
    do returns = 1, ceiling(PATIENCE*log(radius/goal)/(site%period*rate))
      call return_once(site, FEW)
      if (mod(returns, LOOKED_AT) /= 0) cycle
      x = normed(site, site%flow%u(:FEW), site%flow%v(:FEW))
      if (maxval(norm2(x, 1)) > FAR*radius) return
      if (maxval(norm2(x, 1)) >= goal) cycle
      inside = maxval(norm2(x - cshift(x, 1, 2), 1)) < APART*goal
      return
    end do
  end function comes_inside

  !> Puts n points of a ring into the lanes.
  subroutine put_ring(site, radius, n)
    type(site_t), intent(inout) :: site
    real(dp), intent(in) :: radius
    integer, intent(in) :: n
    real(dp) :: x(2)
    integer :: i

    do i = 1, n
      x = radius*matmul(site%basis, [cos(2*PI*i/n), sin(2*PI*i/n)])
      call site%flow%put(i, site%u + x(1)/PI, site%v + x(2))
    end do
  end subroutine put_ring

  !> The lanes 1 .. n through a period of the cycle.
  subroutine return_once(site, n)
    type(site_t), intent(inout) :: site
    integer, intent(in) :: n
    integer :: i

    do i = 1, site%period
      call site%flow%advance(n)
    end do
  end subroutine return_once

  !> States, from the strobe point on, in the eigenbasis.
  pure function normed(site, u, v) result(x)
    type(site_t), intent(in) :: site
    real(dp), intent(in) :: u(:), v(:) !< half-turns, rad per drive radian
    real(dp) :: x(2, size(u))
    integer :: i

    do i = 1, size(u)
      x(:, i) = matmul(site%inverse, [PI*angle_difference(u(i), site%u), v(i) - site%v])
    end do
  end function normed

  !> Distance, in the norm of the ellipse, from its strobe point to the nearest one of another attractor, its mirror
  !> image included. A larger ellipse is rejected: the scene's map then differs too much from the fine one. So is one
  !> whose first ring is not small against this distance: it would not decide at which of the two an orbit ends.
  pure function clearance(site, attractor, others) result(distance)
    type(site_t), intent(in) :: site
    type(attractor_t), intent(in) :: attractor, others(:)
    real(dp) :: distance
    integer :: a

    distance = huge(1.0_dp)
    if (attractor%symmetry == MIRROR .and. .not. attractor%symmetric) & ! the mirror image's
      distance = minval(norm2(normed(site, -attractor%kernel_u, -attractor%kernel_v), 1))
    do a = 1, size(others)
      if (others(a)%period > 0) &
        distance = min(distance, minval(norm2(normed(site, others(a)%kernel_u, others(a)%kernel_v), 1)))
    end do
  end function clearance

  !> Derivative, at strobe point j, of the change to the flow's coordinates.
  function change(flow, attractor, j) result(matrix)
    class(flow_t), intent(inout) :: flow
    type(attractor_t), intent(in) :: attractor
    integer, intent(in) :: j
    real(dp) :: matrix(2, 2), tangent(2, 2, WIDTH)

    call flow%put(1, attractor%u(j), attractor%v(j))
    tangent(:, :, 1) = IDENTITY
    call flow%to_map(1, tangent)
    matrix = tangent(:, :, 1)
  end function change

  !> Columns [Re w, Im w] of a complex eigenvector w, or the two real eigenvectors; scaled to a largest column of 1,
  !> then brought to other coordinates.
  subroutine eigenbasis(matrix, multiplier, to_kernel, basis, inverse)
    real(dp), intent(in) :: matrix(2, 2)
    complex(dp), intent(in) :: multiplier(2)
    real(dp), intent(in) :: to_kernel(2, 2)
    real(dp), intent(out) :: basis(2, 2), inverse(2, 2)
    complex(dp) :: w(2)

    if (abs(aimag(multiplier(1))) > 0) then
      w = eigenvector(matrix, multiplier(1))
      basis(:, 1) = real(w, dp)
      basis(:, 2) = aimag(w)
      basis = basis/max(norm2(basis(:, 1)), norm2(basis(:, 2)))
    else
      w = eigenvector(matrix, multiplier(1))
      basis(:, 1) = real(w, dp)/norm2(real(w, dp))
      w = eigenvector(matrix, multiplier(2))
      basis(:, 2) = real(w, dp)/norm2(real(w, dp))
    end if
    basis = matmul(to_kernel, basis)
    if (abs(basis(1, 1)*basis(2, 2) - basis(1, 2)*basis(2, 1)) < 1e-6_dp) basis = IDENTITY ! any norm serves
    inverse = inverse_of(basis)
  end subroutine eigenbasis

end module kz_computed_ellipses
