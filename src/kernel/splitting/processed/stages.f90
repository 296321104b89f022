!> The stages of a period of the processed splitting in double precision, and their derivative.
module kz_processed_stages
  use, intrinsic :: iso_c_binding, only: c_double, c_float, c_int32_t, c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use kz_vector_map, only: WIDTH, PI
  use kz_vector_sine, only: ROUND_TO_INTEGER
  use kz_processed_tables, only: processed_t
  implicit none
  private
  public :: stages_t, make_stages, advance_stages, single_stages, linear_stages, displaced_stages, tangent_stages, &
            GROUP, TERMS

  !> Coefficients of the slope of a kick as a polynomial of the square (tangents.c), exact to 1e-4 or better.
  integer, parameter :: TERMS = 5
  !> Orbits whose neighbours are moved together, and neighbours of each (tangents.c).
  integer, parameter :: GROUP = 16, POINTS = 2

  !> The tables of a period, and those of its tangents.
  type :: stages_t
    type(processed_t) :: table
    real(c_float), allocatable :: row(:, :)   !< Stages in single precision
    real(c_float), allocatable :: slope(:, :) !< (1 + 2*TERMS, steps): drift, slope of the kick
    real(c_float), allocatable :: kept(:, :)  !< (WIDTH, steps): angles at the kicks of the last period
    real(c_float), allocatable :: chosen(:, :)  !< (GROUP, steps): those of the lanes with displaced neighbours
  end type stages_t

  interface
    !> Stages of a period for the lanes 1 .. n, or some more, with the reduced angles if present (stages.c).
    subroutine run_stages(mirrored, n_drift, n_kick, n_stages, row, n, u, v, kept) bind(C, name='kz_processed_kicks')
      import :: c_double, c_float, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: mirrored, n_drift, n_kick
      integer(c_int64_t), value :: n_stages
      real(c_double), intent(in) :: row(*)
      integer(c_int64_t), value :: n
      real(c_double), intent(inout) :: u(WIDTH), v(WIDTH)
      real(c_float), intent(out), optional :: kept(WIDTH, *)
    end subroutine run_stages

    !> Stages in single precision (stages.c).
    subroutine run_single_stages(mirrored, n_drift, n_kick, n_stages, row, n, u, v) &
        bind(C, name='kz_processed_kicks_single')
      import :: c_double, c_float, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: mirrored, n_drift, n_kick
      integer(c_int64_t), value :: n_stages
      real(c_float), intent(in) :: row(*)
      integer(c_int64_t), value :: n
      real(c_double), intent(inout) :: u(WIDTH), v(WIDTH)
    end subroutine run_single_stages

    !> Derivative from the reduced angles (tangents.c).
    subroutine run_tangents(mirrored, n_stages, row, last, decay, kept, n, c) bind(C, name='kz_processed_tangents')
      import :: c_float, c_int32_t, c_int64_t, WIDTH
      integer(c_int32_t), value :: mirrored
      integer(c_int64_t), value :: n_stages
      real(c_float), intent(in) :: row(*)
      real(c_float), value :: last, decay
      real(c_float), intent(in) :: kept(WIDTH, *)
      integer(c_int64_t), value :: n
      real(c_float), intent(out) :: c(WIDTH, 4)
    end subroutine run_tangents

    !> Neighbours of orbits (tangents.c).
    subroutine run_displaced(mirrored, n_stages, row, last, decay, n, angle, by) bind(C, name='kz_processed_displaced')
      import :: c_float, c_int32_t, c_int64_t, GROUP, POINTS
      integer(c_int32_t), value :: mirrored
      integer(c_int64_t), value :: n_stages
      real(c_float), intent(in) :: row(*)
      real(c_float), value :: last, decay
      integer(c_int64_t), value :: n
      real(c_float), intent(in) :: angle(GROUP, *)
      real(c_float), intent(inout) :: by(GROUP, 2, POINTS)
    end subroutine run_displaced
  end interface

contains

  !> Makes the stages of a period.
  subroutine make_stages(table, stages)
    type(processed_t), intent(in) :: table !< Tables of a period
    type(stages_t), intent(out) :: stages !< Stages
    integer :: i, n

    stages%table = table
    stages%row = real(table%row, c_float)
    n = table%n_drift + table%n_kick
    allocate (stages%slope(1 + 2*TERMS, table%n_steps), stages%kept(WIDTH, table%n_steps), &
              stages%chosen(GROUP, table%n_steps))
    stages%chosen = 0
    stages%slope(TERMS + 2:, :) = 0
    do i = 1, table%n_steps
      stages%slope(1, i) = real(table%row(1, i), c_float)
      stages%slope(2:TERMS + 1, i) = real(slope_of(table%row(table%n_drift + 1:n, i), .true.), c_float)
      if (.not. table%mirrored) &
        stages%slope(TERMS + 2:, i) = real(slope_of(table%row(n + table%n_drift + 1:, i), .false.), c_float)
    end do
  end subroutine make_stages

  !> The derivative (1 - 3 q) C + 2 q (1 - q) C' of a kick (r - r**3) C(q), q = r**2, interpolated at the Chebyshev
  !> nodes of [0, 1]; or 2 C', the derivative of an even kick C(q) over r.
  pure function slope_of(kick, odd) result(slope)
    real(rk), intent(in) :: kick(:)
    logical, intent(in) :: odd
    real(rk) :: slope(TERMS), node(TERMS), value(TERMS), c, derivative
    integer :: i, j

    do i = 1, TERMS
      node(i) = 0.5_rk - 0.5_rk*cos(PI*(2*i - 1)/(2*TERMS))
      c = 0
      derivative = 0
      do j = size(kick), 1, -1
        derivative = derivative*node(i) + c
        c = c*node(i) + kick(j)
      end do
      value(i) = merge((1 - 3*node(i))*c + 2*node(i)*(1 - node(i))*derivative, 2*derivative, odd)
    end do
    do j = 1, TERMS - 1 ! divided differences
      value(j + 1:) = (value(j + 1:) - value(j:TERMS - 1))/(node(j + 1:) - node(:TERMS - j))
    end do
    slope = 0
    do j = TERMS, 1, -1
      slope(2:) = slope(:TERMS - 1) - node(j)*slope(2:)
      slope(1) = value(j) - node(j)*slope(1)
    end do
  end function slope_of

  !> Advances n lanes by a period, with the derivatives of angle and velocity by both in single precision, rad.
  subroutine linear_stages(self, n, u, v, tangent)
    type(stages_t), intent(inout) :: self !< tables of a period
    integer, intent(in) :: n !< lanes
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH) !< half-turns; rad per drive radian
    real(rk), intent(inout) :: tangent(WIDTH, 4) !< Derivative of each lane
    real(c_float) :: c(WIDTH, 4)
    integer(c_int64_t) :: steps

    steps = self%table%n_steps
    call advance_stages(self%table, n, u, v, self%kept)
    call run_tangents(merge(1_c_int32_t, 0_c_int32_t, self%table%mirrored), steps, self%slope, &
                      real(self%table%last(1), c_float), &
                      real(self%table%decay, c_float), self%kept, int(n, c_int64_t), c)
    tangent(:n, 1) = c(:n, 1)
    tangent(:n, 2) = PI*c(:n, 2)
    tangent(:n, 3) = (1/PI)*c(:n, 3)
    tangent(:n, 4) = c(:n, 4)
  end subroutine linear_stages

  !> Advances displacements of neighbours of some lanes, at most GROUP, through the last period of linear_stages.
  subroutine displaced_stages(self, lane, by)
    type(stages_t), intent(inout) :: self !< tables of a period
    integer, intent(in) :: lane(:) !< [n] lanes
    real(rk), intent(inout) :: by(:, :, :) !< (2, :, n), in pairs: rad, velocity times exp(beta t)
    real(c_float) :: c(GROUP, 2, POINTS)
    integer :: i, j, s, n

    n = size(lane)
    do s = 1, self%table%n_steps
      do i = 1, n
        self%chosen(i, s) = self%kept(lane(i), s)
      end do
    end do
    do j = 1, size(by, 2), POINTS
      c = 0
      do i = 1, n
        c(i, 1, :) = real((1/PI)*by(1, j:j + POINTS - 1, i), c_float)
        c(i, 2, :) = real(by(2, j:j + POINTS - 1, i), c_float)
      end do
      call run_displaced(merge(1_c_int32_t, 0_c_int32_t, self%table%mirrored), int(self%table%n_steps, c_int64_t), &
                         self%slope, &
                         real(self%table%last(1), c_float), real(self%table%decay, c_float), int(n, c_int64_t), &
                             self%chosen, c)
      do i = 1, n
        by(1, j:j + POINTS - 1, i) = PI*c(i, 1, :)
        by(2, j:j + POINTS - 1, i) = c(i, 2, :)
      end do
    end do
  end subroutine displaced_stages

  !> Advances n lanes by a period: stages, last drift, factor exp(-2 pi beta) of the velocity.
  subroutine advance_stages(table, n, u, v, kept)
    type(processed_t), intent(in) :: table !< Tables of a period
    integer, intent(in) :: n !< lanes
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH) !< half-turns; rad per drive radian
    real(c_float), intent(out), optional :: kept(WIDTH, *) !< stages_t%kept

    call run_stages(merge(1_c_int32_t, 0_c_int32_t, table%mirrored), int(table%n_drift, c_int32_t), &
                    int(table%n_kick, c_int32_t), &
                    int(table%n_steps, c_int64_t), table%row, int(n, c_int64_t), u, v, kept)
    call end_period(table, n, u, v)
  end subroutine advance_stages

  !> Advances n lanes by a period with the stages in single precision.
  subroutine single_stages(self, n, u, v)
    type(stages_t), intent(in) :: self !< tables of a period
    integer, intent(in) :: n !< lanes
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH) !< half-turns; rad per drive radian

    associate (table => self%table)
      call run_single_stages(merge(1_c_int32_t, 0_c_int32_t, table%mirrored), int(table%n_drift, c_int32_t), &
                             int(table%n_kick, c_int32_t), int(table%n_steps, c_int64_t), self%row, int(n, c_int64_t), &
                                 u, v)
      call end_period(table, n, u, v)
    end associate
  end subroutine single_stages

  !> Ends a period: last drift, factor exp(-2 pi beta) of the velocity.
  subroutine end_period(table, n, u, v)
    type(processed_t), intent(in) :: table
    integer, intent(in) :: n
    real(rk), intent(inout) :: u(WIDTH), v(WIDTH)
    real(rk) :: step(WIDTH), even(WIDTH)
    integer :: i, j

    step(:n) = table%last(table%n_drift)
    do j = table%n_drift - 1, 1, -1
      do i = 1, n
        step(i) = step(i)*v(i)**2 + table%last(j)
      end do
    end do
    even(:n) = 0
    if (.not. table%mirrored) then
      do j = 2*table%n_drift, table%n_drift + 1, -1
        even(:n) = even(:n)*v(:n)**2 + table%last(j)
      end do
    end if
    do i = 1, n
      u(i) = u(i) + v(i)*step(i) + even(i)
      v(i) = table%decay*v(i)
    end do
  end subroutine end_period

  !> Multiplies c by the derivative along the stages from the present states; c(i, :, j): column j, half-turns.
  subroutine tangent_stages(table, n, start_u, start_v, c)
    type(processed_t), intent(in) :: table !< Tables of a period
    integer, intent(in) :: n !< lanes
    real(rk), intent(in) :: start_u(n) !< half-turns
    real(rk), intent(in) :: start_v(n) !< Velocities times exp(beta t)
    real(rk), intent(inout) :: c(WIDTH, 2, 2) !< Columns of the tangent map, lane by lane
    real(rk), dimension(n) :: u, v, r, q, kick, slope, even, even_slope
    integer :: s, j, m

    m = table%n_drift + table%n_kick
    u = start_u
    v = start_v
    do s = 1, table%n_steps
      call drift_tangent(table%row(:table%n_drift, s), 1, n, u, v, c)
      if (.not. table%mirrored) call drift_tangent(table%row(m + 1:m + table%n_drift, s), 0, n, u, v, c)
      r = u - 2*((0.5_rk*u + ROUND_TO_INTEGER) - ROUND_TO_INTEGER)
      q = r*r
      kick = 0
      slope = 0
      do j = table%n_drift + table%n_kick, table%n_drift + 1, -1
        slope = slope*q + kick
        kick = kick*q + table%row(j, s)
      end do
      v = v - (r - r*q)*kick
      slope = (1 - 3*q)*kick + 2*q*(1 - q)*slope
      if (.not. table%mirrored) then
        even = 0
        even_slope = 0
        do j = 2*m, m + table%n_drift + 1, -1
          even_slope = even_slope*q + even
          even = even*q + table%row(j, s)
        end do
        v = v - even
        slope = slope + 2*r*even_slope
      end if
      c(:n, 2, 1) = c(:n, 2, 1) - slope*c(:n, 1, 1)
      c(:n, 2, 2) = c(:n, 2, 2) - slope*c(:n, 1, 2)
    end do
    call drift_tangent(table%last(:table%n_drift), 1, n, u, v, c)
    if (.not. table%mirrored) call drift_tangent(table%last(table%n_drift + 1:), 0, n, u, v, c)
    c(:n, 2, :) = table%decay*c(:n, 2, :)
  end subroutine tangent_stages

  !> Adds v (d(1) + d(2) v**2 + ..), or d(1) + d(2) v**2 + .. if odd = 0, to u, with its derivative.
  subroutine drift_tangent(drift, odd, n, u, v, c)
    real(rk), intent(in) :: drift(:)
    integer, intent(in) :: odd, n
    real(rk), intent(inout) :: u(n)
    real(rk), intent(in) :: v(n)
    real(rk), intent(inout) :: c(WIDTH, 2, 2)
    real(rk), dimension(n) :: square, step, shear
    integer :: j

    square = v*v
    step = 0
    shear = 0
    do j = size(drift), 1, -1
      step = step*square + drift(j)
      if (j > 1 .or. odd == 1) shear = shear*square + (2*j - 2 + odd)*drift(j)
    end do
    if (odd == 1) then
      u = u + v*step
    else
      u = u + step
      shear = shear*v
    end if
    c(:n, 1, 1) = c(:n, 1, 1) + shear*c(:n, 2, 1)
    c(:n, 1, 2) = c(:n, 1, 2) + shear*c(:n, 2, 2)
  end subroutine drift_tangent

end module kz_processed_stages
