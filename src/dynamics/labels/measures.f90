!> Measures of a labelled grid: basin entropy (Daza et al., Sci. Rep. 6 (2016) 31416) and the uncertain share at a distance
!> (Grebogi et al., Phys. Lett. A 99 (1983) 415).
module kz_dynamics_measures
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int16_t, c_int64_t
  implicit none
  private

  integer, parameter :: BOX = 5

contains

  !> Mean Gibbs entropy of boxes of 5 x 5 cells (natural logarithm, partial boxes dropped): over all boxes, and over those with more
  !> than one label. Unsettled cells (-1) belong to no basin and are left out, boxes of nothing else too.
  subroutine basin_entropy(n_theta, n_velocity, label, entropy, boundary_entropy) bind(C, name='kz_basin_entropy')
    integer(c_int64_t), value :: n_theta
    integer(c_int64_t), value :: n_velocity
    integer(c_int16_t), intent(in) :: label(n_theta, n_velocity)
    real(dp), intent(out) :: entropy
    real(dp), intent(out) :: boundary_entropy
    real(dp) :: s, total
    integer(c_int64_t) :: i, j, boxes, mixed, settled

    total = 0
    boxes = 0
    mixed = 0
    do j = 1, n_velocity - BOX + 1, BOX
      do i = 1, n_theta - BOX + 1, BOX
        settled = count(label(i:i + BOX - 1, j:j + BOX - 1) >= 0)
        if (settled == 0) cycle
        s = box_entropy(label(i:i + BOX - 1, j:j + BOX - 1), settled)
        total = total + s
        boxes = boxes + 1
        if (s > 0) mixed = mixed + 1
      end do
    end do
    entropy = 0
    boundary_entropy = 0
    if (boxes > 0) entropy = total/boxes
    if (mixed > 0) boundary_entropy = total/mixed
  end subroutine basin_entropy

  pure function box_entropy(label, settled) result(s)
    integer(c_int16_t), intent(in) :: label(BOX, BOX)
    integer(c_int64_t), intent(in) :: settled !< labels that are not -1
    real(dp) :: s
    integer :: i, j

    s = 0
    do j = 1, BOX
      do i = 1, BOX
        if (label(i, j) >= 0) s = s - log(count(label == label(i, j))/real(settled, dp))
      end do
    end do
    s = s/settled
  end function box_entropy

  !> Share of the cells whose label differs from that of a cell `distance` columns to the left or right (around the circle
  !> where `circle` is 1). Cells that are unsettled (-1), or one of these two is, are left out.
  subroutine uncertain_share(n_theta, n_velocity, label, distance, circle, share) bind(C, name='kz_uncertain_share')
    integer(c_int64_t), value :: n_theta
    integer(c_int64_t), value :: n_velocity
    integer(c_int16_t), intent(in) :: label(0:n_theta - 1, n_velocity)
    integer(c_int64_t), value :: distance
    integer(c_int64_t), value :: circle
    real(dp), intent(out) :: share
    integer(c_int64_t) :: i, j, left, right, uncertain, cells

    uncertain = 0
    cells = 0
    do j = 1, n_velocity
      do i = 0, n_theta - 1
        left = i - distance
        right = i + distance
        if (circle == 1) then
          left = modulo(left, n_theta)
          right = modulo(right, n_theta)
        else if (left < 0 .or. right >= n_theta) then
          cycle
        end if
        if (min(label(i, j), label(left, j), label(right, j)) < 0) cycle
        cells = cells + 1
        if (label(left, j) /= label(i, j) .or. label(right, j) /= label(i, j)) uncertain = uncertain + 1
      end do
    end do
    share = 0
    if (cells > 0) share = real(uncertain, dp)/cells
  end subroutine uncertain_share

end module kz_dynamics_measures
