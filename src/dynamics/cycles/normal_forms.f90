!> Normal forms of bifurcations of cycles, from composed derivatives (Kuznetsov, Elements of Applied Bifurcation
!> Theory).
module kz_cycles_normal_forms
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t
  use kz_cycles_curves, only: plane_t, cycle_t, system_t, make_system, linearise, unknowns_of, UNKNOWNS, COARSE
  use kz_maps_matrices, only: inverse_of, IDENTITY
  use kz_splitting_jets, only: DX, DY, DP_ => DP, DQ, DXX, DXY, DYY, DXP, DYP, DXQ, DYQ, DXXX, DXXY, DXYY, DYYY
  implicit none
  private
  public :: form_t, normal_form

  !> Memory of kz_normal_form of dynamics_curves.h.
  type, bind(C) :: form_t
    real(dp) :: coefficient, side(2), vector(2)
  end type form_t

contains

  function form_at(plane, cycle, form) bind(C, name='kz_cycle_form') result(found)
    type(plane_t), intent(in) :: plane
    type(cycle_t), intent(in) :: cycle
    type(form_t), intent(out) :: form
    integer(c_int32_t) :: found
    real(dp) :: residual(UNKNOWNS), matrix(UNKNOWNS, UNKNOWNS)
    type(system_t) :: system
    logical :: exists

    call make_system(plane, cycle%kind, 2, .true., system)
    call linearise(system, COARSE, 3, unknowns_of(cycle), residual, matrix, exists)
    found = merge(1, 0, exists)
    if (exists) call normal_form(system, form)
  end function form_at

  !> The normal form at a point of a curve, from the images of third order. e = 1: half the second derivative along the
  !> eigenvector; the pair of cycles exists on the side `side`. e = -1: the cubic coefficient, > 0 where the child
  !> attracts beyond the curve; the cycle itself attracts on the side `side`. Both sides are gradients by the place.
  subroutine normal_form(system, form)
    type(system_t), intent(in) :: system !< at the point
    type(form_t), intent(out) :: form !< with the gradient by the place, and the unit eigenvector at the first point
    real(dp) :: jacobian(2, 2), hesse(2, 2, 2), third(2, 2, 2, 2), by_place(2, 2), mixed(2, 2, 2)
    real(dp) :: a(2, 2), q(2), p(2), bend(2), cubic, inverse(2, 2), shift(2), w(2)
    integer :: i, j, k

    call composed(system, jacobian, hesse, third, by_place, mixed)
    a = jacobian - system%kind%multiplier*IDENTITY
    q = [-a(2, 2), a(2, 1)]
    if (norm2(a(1, :)) > norm2(a(2, :))) q = [-a(1, 2), a(1, 1)]
    q = q/norm2(q)
    p = [-a(2, 2), a(1, 2)]
    if (norm2(a(:, 1)) > norm2(a(:, 2))) p = [-a(2, 1), a(1, 1)]
    p = p/dot_product(p, q)
    form%vector = q
    do i = 1, 2
      bend(i) = dot_product(q, matmul(hesse(i, :, :), q))
    end do
    if (system%kind%multiplier > 0) then
      form%coefficient = 0.5_dp*dot_product(p, bend)
      form%side = -sign(1.0_dp, form%coefficient)*matmul(p, by_place)
      return
    end if
    cubic = 0
    do i = 1, 2
      do j = 1, 2
        cubic = cubic + p(i)*q(j)*dot_product(q, matmul(third(i, j, :, :), q))
      end do
    end do
    inverse = inverse_of(jacobian - IDENTITY)
    w = matmul(inverse, bend)
    form%coefficient = cubic/6
    do i = 1, 2
      form%coefficient = form%coefficient - 0.5_dp*p(i)*dot_product(q, matmul(hesse(i, :, :), w))
    end do
    do k = 1, 2
      shift = -matmul(inverse, by_place(:, k))
      form%side(k) = mixed(1, 1, k) + mixed(2, 2, k) + dot_product(shift, hesse(1, 1, :) + hesse(2, 2, :)) &
                + system%of_determinant(k)
    end do
  end subroutine normal_form

  !> The derivatives of G at the first point: of first to third order, by the place, and of the first by the place.
  subroutine composed(system, jacobian, hesse, third, by_place, mixed)
    type(system_t), intent(in) :: system
    real(dp), intent(out) :: jacobian(2, 2), hesse(2, 2, 2), third(2, 2, 2, 2), by_place(2, 2), mixed(2, 2, 2)
    integer, parameter :: SECOND(2, 2) = reshape([DXX, DXY, DXY, DYY], [2, 2]), &
        MIXED_OF(2, 2) = reshape([DXP, DYP, DXQ, DYQ], [2, 2])
    integer, parameter :: THIRD_OF(0:3) = [DXXX, DXXY, DXYY, DYYY]
    real(dp) :: old_j(2, 2), old_h(2, 2, 2), old_t(2, 2, 2, 2), old_p(2, 2), old_m(2, 2, 2), f(2, 2), h(2, 2), &
        t(2, 2, 2)
    integer :: i, r, a, b, c, k, l

    jacobian = IDENTITY
    hesse = 0
    third = 0
    by_place = 0
    mixed = 0
    do i = 1, system%n
      old_j = jacobian
      old_h = hesse
      old_t = third
      old_p = by_place
      old_m = mixed
      f = system%image(:, DX:DY, i)
      jacobian = matmul(f, old_j)
      by_place = matmul(f, old_p) + system%image(:, DP_:DQ, i)
      do r = 1, 2
        do a = 1, 2
          do b = 1, 2
            h(a, b) = system%image(r, SECOND(a, b), i)
            do c = 1, 2
              t(a, b, c) = system%image(r, THIRD_OF(a + b + c - 3), i)
            end do
          end do
        end do
        do a = 1, 2
          do b = 1, 2
            hesse(r, a, b) = dot_product(f(r, :), old_h(:, a, b)) + dot_product(old_j(:, a), matmul(h, old_j(:, b)))
            mixed(r, a, b) = dot_product(f(r, :), old_m(:, a, b)) + dot_product(old_j(:, a), matmul(h, old_p(:, b))) &
                             + dot_product(system%image(r, MIXED_OF(:, b), i), old_j(:, a))
            do c = 1, 2
              third(r, a, b, c) = dot_product(f(r, :), old_t(:, a, b, c)) &
                                  + dot_product(old_j(:, a), matmul(h, old_h(:, b, c))) &
                                  + dot_product(old_j(:, b), matmul(h, old_h(:, a, c))) &
                                      + dot_product(old_j(:, c), matmul(h, old_h(:, a, b)))
              do k = 1, 2
                do l = 1, 2
                  third(r, a, b, c) = third(r, a, b, c) + old_j(k, a)*old_j(l, b)*dot_product(t(k, l, :), old_j(:, c))
                end do
              end do
            end do
          end do
        end do
      end do
    end do
    jacobian = system%kind%side*jacobian
    hesse = system%kind%side*hesse
    third = system%kind%side*third
    by_place = system%kind%side*by_place
    mixed = system%kind%side*mixed
  end subroutine composed

end module kz_cycles_normal_forms
