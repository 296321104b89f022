!> The catalogue of attractors: its order, which depends on them alone, and its travel between ranks as doubles.
module kz_attractors_catalogue
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use, intrinsic :: iso_fortran_env, only: int64
  use kz_vector_map, only: PI
  use kz_cycles_cycles, only: numbers_t, attractor_t, RUNNING
  use kz_computed_curves, only: NODES
  use kz_computed_grid, only: COVER
  use kz_maps_states, only: rounded
  implicit none
  private
  public :: order_of, packed, packed_cycle_size, packed_chaos_size, unpack

  !> Doubles in front of the arrays of an attractor: the bits of its numbers.
  integer, parameter :: HEAD = storage_size(numbers_t())/storage_size(0.0_dp)
  !> Cells of a cover in a double, one bit each; doubles of a cover.
  integer, parameter :: BITS = 32, COVER_SIZE = COVER**2/BITS

contains

  !> order(r) = number of the attractor of rank r: by centre, period (0 last), |winding|/period, + before -, first
  !> strobe velocity, first strobe angle, each compared rounded to 1e-9; chaotic ones by mean velocity, larger first,
  !> then mean angle.
  function order_of(attractors) result(order)
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    integer :: order(size(attractors))
    real(dp) :: keys(6, size(attractors))
    integer :: i, j, moving

    do i = 1, size(attractors)
      keys(:, i) = key(attractors(i))
      moving = i
      j = i - 1
      do while (j >= 1)
        if (.not. before(keys(:, moving), keys(:, order(j)))) exit
        order(j + 1) = order(j)
        j = j - 1
      end do
      order(j + 1) = moving
    end do
  end function order_of

  pure function before(a, b)
    real(dp), intent(in) :: a(6), b(6)
    logical :: before
    integer :: i

    before = .false.
    do i = 1, size(a)
      if (a(i) < b(i)) before = .true.
      if (abs(a(i) - b(i)) > 0) return
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

  !> The whole catalogue as doubles.
  function packed(attractors) result(flat)
    type(attractor_t), intent(in) :: attractors(:) !< the catalogue, numbered from 1
    real(dp), allocatable :: flat(:), bits(:)
    integer :: i

    flat = [real(size(attractors), dp)]
    do i = 1, size(attractors)
      associate (a => attractors(i))
        flat = [flat, transfer(a%numbers_t, flat, HEAD)]
        if (a%period > 0) then
          flat = [flat, a%u, a%v, reshape(a%form, [3*a%period])]
        else
          bits = as_bits(a%cover) ! not on the stack
          flat = [flat, bits]
          if (a%period == RUNNING) flat = [flat, real(size(a%band, 2), dp), reshape(a%band, [size(a%band)])]
        end if
      end associate
    end do
  end function packed

  !> The largest number of doubles of a catalogue with one cycle of up to this period and its mirror image.
  pure function packed_cycle_size(max_period) result(n)
    integer, intent(in) :: max_period !< longest period of a cycle, drive periods
    integer :: n

    n = 1 + 2*(HEAD + 5*max_period)
  end function packed_cycle_size

  !> The largest number of doubles of a catalogue with one attractor without a period and its mirror image.
  pure function packed_chaos_size() result(n)
    integer :: n

    n = 1 + 2*(HEAD + COVER_SIZE + 1 + 2*NODES)
  end function packed_chaos_size

  !> A list of cells as a bit for each cell of the cover.
  pure function as_bits(cells) result(flat)
    integer, intent(in) :: cells(:)
    real(dp) :: flat(COVER_SIZE)
    integer(int64) :: words(COVER_SIZE)
    integer :: i, word

    words = 0
    do i = 1, size(cells)
      word = 1 + (cells(i) - 1)/BITS
      words(word) = ibset(words(word), mod(cells(i) - 1, BITS))
    end do
    flat = real(words, dp)
  end function as_bits

  pure function of_bits(flat) result(cells)
    real(dp), intent(in) :: flat(COVER_SIZE)
    integer, allocatable :: cells(:)
    integer(int64) :: words(COVER_SIZE)
    integer :: word, bit, n

    words = nint(flat, int64)
    allocate (cells(sum(popcnt(words))))
    n = 0
    do word = 1, COVER_SIZE
      do bit = 0, BITS - 1
        if (.not. btest(words(word), bit)) cycle
        n = n + 1
        cells(n) = BITS*(word - 1) + bit + 1
      end do
    end do
  end function of_bits

  !> The catalogue from the doubles that `packed` returns; further doubles are ignored.
  subroutine unpack(flat, attractors)
    real(dp), intent(in) :: flat(:) !< attractors as `packed` returns them
    type(attractor_t), allocatable, intent(out) :: attractors(:) !< the catalogue
    integer :: i, p, n

    allocate (attractors(nint(flat(1))))
    p = 1
    do i = 1, size(attractors)
      associate (a => attractors(i))
        a%numbers_t = transfer(flat(p + 1:p + HEAD), a%numbers_t)
        p = p + HEAD
        n = max(0, a%period)
        allocate (a%u, source=flat(p + 1:p + n))
        allocate (a%v, source=flat(p + n + 1:p + 2*n))
        allocate (a%form, source=reshape(flat(p + 2*n + 1:p + 5*n), [3, n]))
        p = p + 5*n
        if (n > 0) cycle
        a%cover = of_bits(flat(p + 1:p + COVER_SIZE))
        p = p + COVER_SIZE
        if (a%period /= RUNNING) cycle
        n = nint(flat(p + 1))
        a%band = reshape(flat(p + 2:p + 1 + 2*n), [2, n])
        p = p + 1 + 2*n
      end associate
    end do
  end subroutine unpack

end module kz_attractors_catalogue
