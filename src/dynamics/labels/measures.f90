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
    real(dp) :: total, minus_log(BOX**2, BOX**2)
    integer(c_int16_t) :: low(n_theta), high(n_theta)
    integer(c_int64_t) :: i, j, boxes, mixed

    call fill_logarithms(minus_log)
    total = 0
    boxes = 0
    mixed = 0
    do j = 1, n_velocity - BOX + 1, BOX
      low = minval(label(:, j:j + BOX - 1), dim=2)
      high = maxval(label(:, j:j + BOX - 1), dim=2)
      do i = 1, n_theta - BOX + 1, BOX
        if (maxval(high(i:i + BOX - 1)) < 0) cycle
        boxes = boxes + 1
        if (minval(low(i:i + BOX - 1)) == maxval(high(i:i + BOX - 1))) cycle
        call add_box(reshape(label(i:i + BOX - 1, j:j + BOX - 1), [BOX**2]), minus_log, total, mixed)
      end do
    end do
    entropy = 0
    boundary_entropy = 0
    if (boxes > 0) entropy = total/boxes
    if (mixed > 0) boundary_entropy = total/mixed
  end subroutine basin_entropy

  !> minus_log(n, settled) = -log(n/settled).
  pure subroutine fill_logarithms(minus_log)
    real(dp), intent(out) :: minus_log(BOX**2, BOX**2)
    integer :: n, settled

    do settled = 1, BOX**2
      minus_log(:, settled) = [(-log(n/real(settled, dp)), n=1, BOX**2)]
    end do
  end subroutine fill_logarithms

  !> Adds the entropy of a box to the total, and the box to the mixed ones where it has more than one settled label.
  pure subroutine add_box(label, minus_log, total, mixed)
    integer(c_int16_t), intent(in) :: label(BOX**2)
    real(dp), intent(in) :: minus_log(BOX**2, BOX**2)
    real(dp), intent(inout) :: total
    integer(c_int64_t), intent(inout) :: mixed
    real(dp) :: s
    integer :: i, settled

    settled = count(label >= 0)
    s = 0
    do i = 1, BOX**2
      if (label(i) >= 0) s = s + minus_log(count(label == label(i)), settled)
    end do
    s = s/settled
    total = total + s
    if (s > 0) mixed = mixed + 1
  end subroutine add_box

  !> Share of the cells whose label differs from that of a cell `distance` columns to the left or right (around the circle
  !> where `circle` is 1). Cells that are unsettled (-1), or one of these two is, are left out.
  subroutine uncertain_share(n_theta, n_velocity, label, distance, circle, share) bind(C, name='kz_uncertain_share')
    integer(c_int64_t), value :: n_theta
    integer(c_int64_t), value :: n_velocity
    integer(c_int16_t), intent(in) :: label(n_theta, n_velocity)
    integer(c_int64_t), value :: distance
    integer(c_int64_t), value :: circle
    real(dp), intent(out) :: share
    integer(c_int16_t) :: row(1 - distance:n_theta + distance)
    integer(c_int64_t) :: i, j, uncertain, cells, settled, unlike

    uncertain = 0
    cells = 0
    row = -1
    do j = 1, n_velocity
      row(1:n_theta) = label(:, j)
      do i = 1, merge(distance, 0_c_int64_t, circle == 1)
        row(1 - i) = label(1 + modulo(n_theta - i, n_theta), j)
        row(n_theta + i) = label(1 + modulo(i - 1, n_theta), j)
      end do
      call compare(n_theta, row(1 - distance), row(1), row(1 + distance), settled, unlike)
      cells = cells + settled
      uncertain = uncertain + unlike
    end do
    share = 0
    if (cells > 0) share = real(uncertain, dp)/cells
  end subroutine uncertain_share

  !> How many of n cells are settled, as those on their left and right are; how many of these differ from one of the two.
  pure subroutine compare(n, left, own, right, settled, unlike)
    integer(c_int64_t), intent(in) :: n
    integer(c_int16_t), intent(in) :: left(n)
    integer(c_int16_t), intent(in) :: own(n)
    integer(c_int16_t), intent(in) :: right(n)
    integer(c_int64_t), intent(out) :: settled
    integer(c_int64_t), intent(out) :: unlike
    integer :: n_settled, n_unlike, counts
    integer(c_int64_t) :: i

    n_settled = 0
    n_unlike = 0
    do i = 1, n
      counts = merge(1, 0, iand(iand(not(int(left(i))), not(int(own(i)))), not(int(right(i)))) < 0)
      n_settled = n_settled + counts
      n_unlike = n_unlike + merge(counts, 0, ior(ieor(left(i), own(i)), ieor(right(i), own(i))) /= 0)
    end do
    settled = n_settled
    unlike = n_unlike
  end subroutine compare

end module kz_dynamics_measures
