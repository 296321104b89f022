!> Cycles over a plane of two parameters: the equations of multiple shooting for cycles, for branches of them along a
!> line, and for the curves on which a multiplier is 1 or -1 (docs/explanation/atlas.md).
!>
!> The unknowns y are the points x(i) of a cycle, rad and rad per drive radian, not wrapped, and then its place, in the
!> rectangle's sides. F(x(i)) = x(i+1), side*(F(x(n)) - 2 pi turns) = x(1): side = 1 for cycles of n periods, side = -1
!> for those of 2 n periods that are their own mirror image, or, if the last F ends half a period before (kind%half),
!> for those of 2 n - 1 periods that are their own image half a period later. G is this map of x(1). The damping is
!> constant, so that det DG = exp(-2 pi beta n), and one of the multipliers is e where trace DG = e (1 + det DG).
module kz_cycles_curves
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t, c_bool, c_funptr, c_ptr, c_f_procpointer
  use kz_vector_map, only: PI
  use kz_model_pendulum, only: pendulum_t
  use kz_splitting_jets, only: jets_t, make_jets, set_pendulum, advance_jets, LANES, TERMS, DX, DY, DP_ => DP, DQ, &
                           DXX, DXY, DYY, DXP, DYP, DXQ, DYQ
  implicit none
  private
  public :: plane_t, kind_t, cycle_t, system_t, make_system, linearise, images, inner, metric, moved, wrapped, &
            unknowns_of, cycle_of, POINTS, UNKNOWNS, COARSE, FINE

  !> Points of a cycle, and unknowns, at most; the two numbers of steps a period.
  integer, parameter :: POINTS = 16, UNKNOWNS = 2*POINTS + 2, COARSE = 1, FINE = 2
  !> Weight of the points in distances; that of the place is 1.
  real(dp), parameter :: OF_POINTS = 0.04_dp

  type, bind(C) :: kind_t
    integer(c_int32_t) :: side, points, multiplier, turns, stride = 0, half = 0, rest = 0
  end type kind_t

  type, bind(C) :: cycle_t
    type(kind_t) :: kind
    integer(c_int32_t) :: event
    real(dp) :: place(2), point(2, POINTS), number(2)
  end type cycle_t

  type, bind(C) :: plane_t
    type(c_funptr) :: pendulum
    type(c_ptr) :: context
    real(dp) :: low(2), high(2)
    integer(c_int32_t) :: steps, mirrored, half_period
  end type plane_t

  !> The equations of one kind of cycles on a plane, and what they were at the last place.
  type :: system_t
    type(plane_t) :: plane
    type(kind_t) :: kind
    integer :: n = 0                          !< points
    integer :: stride = 1                     !< drive periods from one point to the next
    integer :: columns = 0                    !< directions in which the place may move
    logical :: on_curve = .false.             !< the trace has its own equation
    real(dp) :: basis(2, 2) = 0               !< these directions
    type(jets_t) :: jets(2)                   !< jets of COARSE and FINE steps
    real(dp) :: set_at(2, 2) = huge(1.0_dp)   !< the place of their pendulums; (place, fineness)
    real(dp) :: image(2, 0:TERMS, POINTS) = 0 !< image of each point, with its derivatives
    real(dp) :: trace = 0, determinant = 0, of_determinant(2) = 0
  end type system_t

  abstract interface
    function pendulum_at_i(context, at, pendulum) bind(C) result(exists)
      import :: c_ptr, c_bool, dp, pendulum_t
      type(c_ptr), value :: context
      real(dp), intent(in) :: at(2)
      type(pendulum_t), intent(out) :: pendulum
      logical(c_bool) :: exists
    end function pendulum_at_i
  end interface

contains

  !> Sets up the equations.
  subroutine make_system(plane, kind, columns, on_curve, system)
    type(plane_t), intent(in) :: plane !< gives the pendulum of a place
    type(kind_t), intent(in) :: kind !< kind of the cycles
    integer, intent(in) :: columns !< 0: the place is fixed; 1: on a line, whose direction is basis(:, 1); 2: free
    logical, intent(in) :: on_curve !< whether a multiplier is kind%multiplier
    type(system_t), intent(out) :: system !< the equations

    system%plane = plane
    system%kind = kind
    system%n = kind%points
    system%stride = max(1, kind%stride)
    system%columns = columns
    system%on_curve = on_curve
    system%basis = reshape([1, 0, 0, 1], [2, 2])
  end subroutine make_system

  !> Sets the pendulum of a place and, by differences, its derivatives: convergence needs these, the result does not.
  subroutine set_place(system, jets, at, exists)
    type(system_t), intent(in) :: system
    type(jets_t), intent(inout) :: jets
    real(dp), intent(in) :: at(2)
    logical, intent(out) :: exists
    real(dp), parameter :: BESIDE = 1e-5_dp
    procedure(pendulum_at_i), pointer :: pendulum_at
    type(pendulum_t) :: pendulum(0:2), up, down
    real(dp) :: place(2), width
    logical :: there(2)
    integer :: i

    call c_f_procpointer(system%plane%pendulum, pendulum_at)
    exists = pendulum_at(system%plane%context, at, pendulum(0))
    do i = 1, merge(2, 0, exists)
      place = at
      place(i) = at(i) + BESIDE
      there(1) = pendulum_at(system%plane%context, place, up)
      place(i) = at(i) - BESIDE
      there(2) = pendulum_at(system%plane%context, place, down)
      if (.not. there(1)) up = pendulum(0)
      if (.not. there(2)) down = pendulum(0)
      exists = exists .and. any(there)
      width = BESIDE*count(there)
      pendulum(i) = up
      pendulum(i)%k = (up%k - down%k)/width
      pendulum(i)%beta = (up%beta - down%beta)/width
      pendulum(i)%m = (up%m - down%m)/width
      pendulum(i)%torque = (up%torque - down%torque)/width
      pendulum(i)%torque_amplitude = (up%torque_amplitude - down%torque_amplitude)/width
      pendulum(i)%vertical = (up%vertical - down%vertical)/width
      pendulum(i)%horizontal = (up%horizontal - down%horizontal)/width
    end do
    exists = pendulum(0)%beta > 0
    if (exists) call set_pendulum(jets, pendulum)
  end subroutine set_place

  !> image = that of each of the first n points after one or both halves of a period, with derivatives up to `order`.
  function images(system, fineness, order, y, halves, image, ends_early) result(exists)
    type(system_t), intent(inout) :: system !< system whose tables serve
    integer, intent(in) :: fineness !< COARSE or FINE
    integer, intent(in) :: order !< 0 .. 3
    real(dp), intent(in) :: y(:) !< points: rad, rad per drive radian; behind them their place
    integer, intent(in) :: halves !< half periods until the image
    real(dp), intent(out) :: image(2, 0:TERMS, POINTS) !< (angle and velocity, value and derivatives, point): rad
    logical, intent(in), optional :: ends_early !< the image of the last point is that of half a period before
    logical :: exists !< whether there is a damped pendulum
    real(dp), dimension(LANES) :: u, v
    real(dp), dimension(LANES, TERMS) :: theta, velocity
    integer :: n, first, lane, period, n_steps
    logical :: early

    n = size(y)/2 - 1
    if (system%jets(fineness)%n_steps == 0) call make_jets(int(system%plane%steps)*fineness/FINE, system%jets(fineness))
    associate (at => y(2*n + 1:))
      exists = maxval(abs(system%set_at(:, fineness) - at)) <= 0
      if (.not. exists) call set_place(system, system%jets(fineness), at, exists)
      system%set_at(:, fineness) = merge(at, [huge(at), huge(at)], exists)
    end associate
    if (.not. exists) return
    do first = 1, n, LANES
      theta = 0
      velocity = 0
      theta(:, DX) = 1
      velocity(:, DY) = 1
      u = [(y(2*min(first + lane - 1, n) - 1)/PI, lane=1, LANES)]
      v = [(y(2*min(first + lane - 1, n)), lane=1, LANES)]
      n_steps = system%jets(fineness)%n_steps
      early = .false.
      if (present(ends_early)) early = ends_early .and. first + LANES > n
      do period = 1, halves/2 - merge(1, 0, early)
        call advance_jets(system%jets(fineness), order, 1, n_steps, u, v, theta, velocity)
      end do
      if (early .or. mod(halves, 2) == 1) &
        call advance_jets(system%jets(fineness), order, 1, n_steps/2, u, v, theta, velocity)
      if (early) then
        image(1, :, n) = [PI*u(n - first + 1), theta(n - first + 1, :)]
        image(2, :, n) = [v(n - first + 1), velocity(n - first + 1, :)]
        call advance_jets(system%jets(fineness), order, n_steps/2 + 1, n_steps, u, v, theta, velocity)
      end if
      do lane = 1, min(LANES, n - first + merge(0, 1, early))
        image(1, :, first + lane - 1) = [PI*u(lane), theta(lane, :)]
        image(2, :, first + lane - 1) = [v(lane), velocity(lane, :)]
      end do
    end do
    exists = all(abs(image(:, 0, :n)) < 1e6_dp)
  end function images

  function orbit(plane, at, halves, n, state) bind(C, name='kz_curve_orbit') result(exists)
    type(plane_t), intent(in) :: plane
    real(dp), intent(in) :: at(2)
    integer(c_int32_t), value :: halves
    integer(c_int64_t), value :: n
    real(dp), intent(inout) :: state(2, 0:n)
    integer(c_int32_t) :: exists
    type(system_t) :: system
    real(dp) :: image(2, 0:TERMS, POINTS)
    integer(c_int64_t) :: i

    call make_system(plane, kind_t(1, 1, 1, 0), 0, .false., system)
    exists = 1
    do i = 1, n
      exists = merge(1, 0, images(system, COARSE, 0, [state(:, i - 1), at], int(halves), image))
      if (exists == 0) return
      state(:, i) = image(:, 0, 1)
    end do
  end function orbit

  !> Residuals and matrix of the equations at y, by the unknowns: points first, then each direction of the place.
  subroutine linearise(system, fineness, order, y, residual, matrix, exists)
    type(system_t), intent(inout) :: system !< takes image, trace and determinant
    integer, intent(in) :: fineness !< COARSE or FINE
    integer, intent(in) :: order !< 1 .. 3; the matrix of a trace needs 2
    real(dp), intent(in) :: y(:) !< the unknowns
    real(dp), intent(out) :: residual(:) !< residuals of the equations, rad
    real(dp), intent(out) :: matrix(:, :) !< its derivatives; (equation, unknown)
    logical, intent(out) :: exists !< whether there is a damped pendulum
    real(dp) :: before(2, 2, 0:POINTS), after(2, 2, POINTS + 1), gradient(UNKNOWNS), by_place(2)
    integer :: n, i, next, side

    n = system%n
    exists = images(system, fineness, order, y(:2*n + 2), 2*system%stride, system%image, system%kind%half /= 0)
    if (.not. exists) return
    associate (image => system%image, kind => system%kind, basis => system%basis(:, :system%columns))
      residual = 0
      matrix = 0
      before(:, :, 0) = reshape([1, 0, 0, 1], [2, 2])
      do i = 1, n
        next = mod(i, n) + 1
        side = merge(kind%side, 1, i == n)
        residual(2*i - 1:2*i) = side*image(:, 0, i) - y(2*next - 1:2*next)
        matrix(2*i - 1:2*i, 2*i - 1:2*i) = side*image(:, DX:DY, i)
        matrix(2*i - 1, 2*next - 1) = matrix(2*i - 1, 2*next - 1) - 1
        matrix(2*i, 2*next) = matrix(2*i, 2*next) - 1
        matrix(2*i - 1:2*i, 2*n + 1:2*n + system%columns) = matmul(side*image(:, DP_:DQ, i), basis)
        before(:, :, i) = matmul(image(:, DX:DY, i), before(:, :, i - 1))
      end do
      residual(2*n - 1) = residual(2*n - 1) - 2*PI*kind%side*kind%turns
      system%trace = kind%side*(before(1, 1, n) + before(2, 2, n))
      call set_determinant(system, fineness)
      if (.not. system%on_curve) return
      residual(2*n + 1) = system%trace - kind%multiplier*(1 + system%determinant)
      if (order < 2) return
      after(:, :, n + 1) = before(:, :, 0)
      do i = n, 1, -1
        after(:, :, i) = matmul(after(:, :, i + 1), image(:, DX:DY, i))
      end do
      by_place = -kind%multiplier*system%of_determinant
      do i = 1, n
        call add_trace(image(:, :, i), real(kind%side, dp)*matmul(before(:, :, i - 1), after(:, :, i + 1)), &
                       gradient(2*i - 1:2*i), by_place)
      end do
      matrix(2*n + 1, :2*n) = gradient(:2*n)
      matrix(2*n + 1, 2*n + 1:2*n + system%columns) = matmul(by_place, basis)
    end associate
  end subroutine linearise

  !> The gradient of trace(others*DF), by the state of one point and by the place.
  pure subroutine add_trace(image, others, by_state, by_place)
    real(dp), intent(in) :: image(2, 0:TERMS), others(2, 2)
    real(dp), intent(out) :: by_state(2)
    real(dp), intent(inout) :: by_place(2)

    by_state = [part(DXX, DXY), part(DXY, DYY)]
    by_place = by_place + [part(DXP, DYP), part(DXQ, DYQ)]
  contains
    pure real(dp) function part(first, second)
      integer, intent(in) :: first, second !< derivatives of the two columns of DF

      part = dot_product(others(1, :), image(:, first)) + dot_product(others(2, :), image(:, second))
    end function part
  end subroutine add_trace

  subroutine set_determinant(system, fineness)
    type(system_t), intent(inout) :: system
    integer, intent(in) :: fineness
    real(dp) :: decay(0:2), lacking

    decay = system%jets(fineness)%damping
    lacking = merge(PI, 0.0_dp, system%kind%half /= 0)
    system%determinant = exp(-2*PI*system%n*system%stride*decay(0) + lacking*decay(0))
    system%of_determinant = (-2*PI*system%n*system%stride*decay(1:2) + lacking*decay(1:2))*system%determinant
  end subroutine set_determinant

  !> a with the weights of the inner product.
  pure function metric(system, a) result(weighted)
    type(system_t), intent(in) :: system !< the equations
    real(dp), intent(in) :: a(:) !< a step of the unknowns
    real(dp) :: weighted(size(a))

    weighted = a
    weighted(:2*system%n) = a(:2*system%n)*(OF_POINTS/system%n)
  end function metric

  !> The inner product of two steps of the unknowns.
  pure function inner(system, a, b) result(product)
    type(system_t), intent(in) :: system !< the equations
    real(dp), intent(in) :: a(:) !< a step
    real(dp), intent(in) :: b(:) !< another one
    real(dp) :: product

    product = dot_product(metric(system, a), b)
  end function inner

  !> The step of the unknowns from one y to another.
  pure function moved(system, to, from) result(step)
    type(system_t), intent(in) :: system !< the equations
    real(dp), intent(in) :: to(:) !< unknowns
    real(dp), intent(in) :: from(:) !< others
    real(dp) :: step(2*system%n + system%columns)
    integer :: n

    n = 2*system%n
    step(:n) = to(:n) - from(:n)
    step(n + 1:) = matmul(to(n + 1:n + 2) - from(n + 1:n + 2), system%basis(:, :system%columns))
  end function moved

  !> The unknowns of a cycle, 0 behind them.
  pure function unknowns_of(cycle) result(y)
    type(cycle_t), intent(in) :: cycle
    real(dp) :: y(UNKNOWNS)
    integer :: n

    n = 2*cycle%kind%points
    y = 0
    y(:n) = reshape(cycle%point(:, :cycle%kind%points), [n])
    y(n + 1:n + 2) = cycle%place
  end function unknowns_of

  !> The cycle of some unknowns, with trace and determinant where the equations were last.
  pure function cycle_of(system, y) result(cycle)
    type(system_t), intent(in) :: system
    real(dp), intent(in) :: y(:)
    type(cycle_t) :: cycle

    cycle%kind = system%kind
    cycle%event = 0
    cycle%place = y(2*system%n + 1:2*system%n + 2)
    cycle%point = reshape(y(:2*system%n), [2, POINTS], [0.0_dp])
    cycle%number = [system%trace, system%determinant]
  end function cycle_of

  !> An angle without whole turns.
  elemental real(dp) function wrapped(angle)
    real(dp), intent(in) :: angle !< rad

    wrapped = angle - 2*PI*anint(angle/(2*PI))
  end function wrapped

end module kz_cycles_curves
