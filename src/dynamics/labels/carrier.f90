!> Carries orbits, with all that their errors need, through a period: by the scene's map alone, or with more precision
!> beside it (double precision with more steps, pairs of doubles, quad precision). Then the tangent map is still that of
!> the scene's map, which is enough for an error. Regions see the states in the coordinates of that map.
module kz_labels_carrier
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int64_t
  use kz_taylor_pairs, only: pairs_t, pair_lanes_t, advance_pairs, pair_of, quad_of
  use kz_taylor_taylor, only: drive_t, advance_period, doubles_of, qp, PI_QUAD
  use kz_labels_period_error, only: period_error_t, class_of, noise_at
  use kz_labels_spread, only: add_ellipse
  use kz_vector_map, only: flow_t, WIDTH, CAPACITY, PI
  implicit none
  private
  public :: orbit_t, carrier_t, make_carrier, make_exact_carrier

  !> Methods that carry orbits.
  integer, parameter, public :: BY_MAP = 0, BY_FINE_MAP = 1, BY_PAIRS = 2, BY_SERIES = 3

  !> An orbit at the end of a period.
  type :: orbit_t
    real(dp) :: u(3)  !< half-turns: the sum of three doubles
    real(dp) :: v(2)  !< rad per drive radian: the sum of two doubles
    real(dp) :: p(3)  !< covariance of the state's error: theta theta, theta v, v v (rad, rad per drive radian)
    real(dp) :: lost  !< further isotropic error
    integer(c_int64_t) :: age !< periods since it was released
    integer(c_int64_t) :: turns = 0 !< net turns by which its angle on the line is more than u
  end type orbit_t

  type :: carrier_t
    !> Jacobian of the last period: angle by angle and velocity, velocity by both
    real(dp) :: tangent(WIDTH, 4) = 0
    real(dp) :: noise(WIDTH) = 0           !< error added by steps and rounding in it, rad
    real(dp) :: region_error(CAPACITY) = 0 !< how far the states may be from where regions see them, rad
    class(flow_t), allocatable :: flow     !< the scene's map; between periods its lanes hold states as regions see them
    type(period_error_t) :: error          !< error of a period of that map
    integer :: means = BY_MAP              !< method that carries the orbits
    logical :: exact = .false.             !< their errors are not asked for: they stay as they are
    !> BY_FINE_MAP: with more steps; what takes its states to physical coordinates; its error
    class(flow_t), allocatable :: fine, shown
    type(period_error_t) :: fine_error
    !> BY_PAIRS: tables; states in physical coordinates
    type(pairs_t), pointer :: pairs => null()
    real(dp), private :: pair_u(CAPACITY, 2) = 0, pair_v(CAPACITY, 2) = 0
    !> BY_SERIES: quad Taylor series; error in a period relative to hypot(pi, v); states: rad, rad per radian
    type(drive_t), pointer :: drive => null()
    real(dp) :: drive_error = 0
    real(qp), private :: theta(CAPACITY) = 0, velocity(CAPACITY) = 0
    integer(c_int64_t), private :: turns(CAPACITY) = 0 !< net turns that the lanes of no map have counted
  contains
    !> Puts an orbit into a lane; its error grows by what that costs.
    procedure :: put
    !> The physical state of a lane.
    procedure :: take
    !> Net turns of a lane of `flow`.
    procedure :: turns_of
    !> Lanes first .. n become visible after they have been put.
    procedure :: to_map, move
    !> One period of the lanes 1 .. n.
    procedure :: advance
  end type carrier_t

contains

  !> Carries orbits by the scene's map.
  subroutine make_carrier(flow, error, carrier)
    class(flow_t), intent(in) :: flow !< the map of one drive period
    type(period_error_t), intent(in) :: error !< its errors
    type(carrier_t), intent(out) :: carrier !< the carrier

    allocate (carrier%flow, source=flow)
    carrier%error = error
  end subroutine make_carrier

  !> Carries orbits by Taylor series in quad precision, without what their errors need.
  subroutine make_exact_carrier(flow, drive, carrier)
    class(flow_t), intent(in) :: flow !< in whose coordinates trapping regions are
    type(drive_t), intent(in), target :: drive !< drive of the pendulum
    type(carrier_t), intent(out) :: carrier !< the carrier

    allocate (carrier%flow, source=flow)
    carrier%error%noise = 0
    carrier%means = BY_SERIES
    carrier%exact = .true.
    carrier%drive => drive
  end subroutine make_exact_carrier

  !> A map leaves out what the state has below the last place of its doubles.
  subroutine put(self, lane, orbit)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit
    real(dp) :: noise

    noise = noise_of(self, orbit%v(1))
    self%turns(lane) = orbit%turns
    select case (self%means)
    case (BY_MAP)
      call self%flow%put(lane, orbit%u(1), orbit%v(1))
      noise = noise + PI*abs(orbit%u(2)) + abs(orbit%v(2))
    case (BY_FINE_MAP)
      call self%fine%put(lane, orbit%u(1), orbit%v(1))
    case (BY_PAIRS)
      self%pair_u(lane, :) = orbit%u(:2)
      self%pair_v(lane, :) = orbit%v
    case (BY_SERIES)
      self%theta(lane) = PI_QUAD*(orbit%u(1) + quad_of(orbit%u(2:)))
      self%velocity(lane) = quad_of(orbit%v)
    end select
    call add_ellipse(orbit%lost + noise, orbit%p)
  end subroutine put

  !> Error (rad) that a period adds to a state of speed v.
  pure function noise_of(self, v) result(noise)
    class(carrier_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp) :: noise

    select case (self%means)
    case (BY_FINE_MAP)
      noise = self%fine_error%noise(class_of(self%fine_error, v))
    case (BY_PAIRS)
      noise = max(self%pairs%error, 1e-31_dp*hypot(PI, v))
      if (abs(v) > self%pairs%fastest) noise = max(noise, self%pairs%series_error*hypot(PI, v))
    case (BY_SERIES)
      noise = self%drive_error*hypot(PI, v)
    case default
      noise = self%error%noise(class_of(self%error, v))
    end select
  end function noise_of

  subroutine take(self, lane, orbit)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: lane
    type(orbit_t), intent(inout) :: orbit

    orbit%turns = self%turns(lane)
    select case (self%means)
    case (BY_MAP)
      orbit%turns = self%turns_of(lane)
      orbit%u = [self%flow%u(lane), 0.0_dp, 0.0_dp]
      orbit%v = [self%flow%v(lane), 0.0_dp]
    case (BY_FINE_MAP)
      call show_fine(self, lane, lane)
      orbit%turns = orbit%turns + self%fine%turns(lane) + self%shown%turns(lane)
      orbit%u = [self%shown%u(lane), 0.0_dp, 0.0_dp]
      orbit%v = [self%shown%v(lane), 0.0_dp]
    case (BY_PAIRS)
      orbit%u = [self%pair_u(lane, :), 0.0_dp]
      orbit%v = self%pair_v(lane, :)
    case (BY_SERIES)
      orbit%u = doubles_of(self%theta(lane)/PI_QUAD, 3)
      orbit%v = pair_of(self%velocity(lane))
    end select
  end subroutine take

  pure function turns_of(self, lane) result(turns)
    class(carrier_t), intent(in) :: self
    integer, intent(in) :: lane
    integer(c_int64_t) :: turns

    turns = self%turns(lane) + self%flow%turns(lane)
    if (self%means == BY_FINE_MAP) turns = turns + self%fine%turns(lane) + self%shown%turns(lane)
  end function turns_of

  !> The physical states of lanes first .. n of the map with more steps.
  subroutine show_fine(self, first, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: first, n
    integer :: lane

    do lane = first, n
      call self%shown%put(lane, self%fine%u(lane), self%fine%v(lane))
    end do
    call self%shown%to_physical(n, first=first)
  end subroutine show_fine

  subroutine to_map(self, first, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: first, n

    if (self%means == BY_FINE_MAP) call self%fine%to_map(n, first=first)
    if (self%means /= BY_MAP) call put_shown(self, first, n)
    call self%flow%to_map(n, first=first)
  end subroutine to_map

  !> Puts the physical states of lanes first .. n, at most WIDTH, into the map.
  subroutine put_shown(self, first, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: first, n
    type(orbit_t) :: orbit
    integer :: lane

    if (self%means == BY_FINE_MAP) call show_fine(self, first, n)
    do lane = first, n
      if (self%means == BY_FINE_MAP) then
        call self%flow%put(lane, self%shown%u(lane), self%shown%v(lane))
      else
        call self%take(lane, orbit)
        call self%flow%put(lane, orbit%u(1), orbit%v(1))
      end if
      self%region_error(lane) = self%error%noise(class_of(self%error, self%flow%v(lane)))
    end do
  end subroutine put_shown

  subroutine move(self, from, to)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: from, to

    select case (self%means)
    case (BY_FINE_MAP)
      call self%fine%move(from, to)
      call self%shown%move(from, to)
    case (BY_PAIRS)
      self%pair_u(to, :) = self%pair_u(from, :)
      self%pair_v(to, :) = self%pair_v(from, :)
    case (BY_SERIES)
      self%theta(to) = self%theta(from)
      self%velocity(to) = self%velocity(from)
    end select
    call self%flow%move(from, to)
    self%turns(to) = self%turns(from)
    self%region_error(to) = self%region_error(from)
  end subroutine move

  subroutine advance(self, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: n
    integer :: lane

    if (self%means == BY_MAP) then
      call noise_at(self%error, n, self%flow%v(:n), self%noise)
    else
      do lane = 1, n
        self%noise(lane) = noise_of(self, self%flow%v(lane))
      end do
    end if
    if (.not. self%exact) call self%flow%advance_linear(n, self%tangent)
    if (self%means /= BY_MAP) then
      call advance_precisely(self, n)
      call put_shown(self, 1, n)
      call self%flow%to_map(n)
    end if
  end subroutine advance

  subroutine advance_precisely(self, n)
    class(carrier_t), intent(inout) :: self
    integer, intent(in) :: n
    type(pair_lanes_t) :: lanes

    select case (self%means)
    case (BY_FINE_MAP)
      call self%fine%advance(n)
    case (BY_PAIRS)
      lanes%u = self%pair_u(:WIDTH, :)
      lanes%v = self%pair_v(:WIDTH, :)
      call advance_pairs(self%pairs, n, lanes, self%turns(:WIDTH))
      self%pair_u(:n, :) = lanes%u(:n, :)
      self%pair_v(:n, :) = lanes%v(:n, :)
    case (BY_SERIES)
      call advance_period(self%drive, self%theta(:n), self%velocity(:n), self%turns(:n))
    end select
  end subroutine advance_precisely

end module kz_labels_carrier
