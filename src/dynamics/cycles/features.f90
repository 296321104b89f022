!> Features of an attractor over continuous time: mean, amplitude, centre.
module kz_cycles_features
  use, intrinsic :: iso_c_binding, only: dp => c_double, c_int32_t, c_int64_t
  use kz_vector_map, only: flow_t, PI
  use kz_model_pendulum, only: pendulum_t, acceleration
  use kz_cycles_cycles, only: attractor_t
  use kz_maps_states, only: angle_difference
  implicit none
  private
  public :: find_features, centre_of, SAMPLES

  !> Samples per drive period.
  integer, parameter :: SAMPLES = 96
  !> Centres (KZ_ABOUT_... of analysis.h).
  integer, parameter, public :: DOWN = 0, INVERTED = 1, ROTATING = 2, ELSEWHERE = 3

contains

  !> Sets mean, amplitude and centre from one closed orbit, or from `periods` periods of a chaotic orbit from (u, v). Of
  !> an orbit in pieces, each of `periods` periods, u and v are the starts, in the order of time: the pieces are
  !> followed together.
  subroutine find_features(sampling_flow, pendulum, attractor, u, v, periods)
    class(flow_t), intent(inout) :: sampling_flow !< a fine flow whose steps are not fused
    type(pendulum_t), intent(in) :: pendulum !< k, beta, m
    type(attractor_t), intent(inout) :: attractor !< its period and points, in; its features, out
    real(dp), intent(in) :: u(:), v(:) !< starts, at most WIDTH: half-turns, rad per drive radian
    integer, intent(in) :: periods !< drive periods of a piece
    real(dp), allocatable :: angle(:), velocity(:)
    integer :: n

    call sample_orbit(sampling_flow, u, v, periods, angle, velocity)
    n = ubound(angle, 1)
    attractor%mean = sum(angle(1:))/n
    attractor%mean_velocity = PI*(angle(n) - angle(0))/(2*PI*(n/SAMPLES))
    call place(attractor, pendulum, angle, velocity)
    attractor%mean = angle_difference(attractor%mean, 0.0_dp)
  end subroutine find_features

  !> The samples of an orbit in pieces, one behind the other; angles are not wrapped.
  subroutine sample_orbit(flow, u, v, periods, angle, velocity)
    class(flow_t), intent(inout) :: flow
    real(dp), intent(in) :: u(:), v(:)
    integer, intent(in) :: periods
    real(dp), allocatable, intent(out) :: angle(:), velocity(:) !< (0:)
    real(dp) :: shown_u(SAMPLES, size(u)), shown_v(SAMPLES, size(u))
    integer(c_int64_t) :: turns(size(u))
    integer :: period, piece, last

    allocate (angle(0:size(u)*periods*SAMPLES), velocity(0:size(u)*periods*SAMPLES))
    angle(0) = u(1)
    velocity(0) = v(1)
    call flow%put_all(u, v)
    do period = 1, periods
      turns = flow%turns(:size(u))
      call flow%sample(SAMPLES, shown_u, shown_v)
      do piece = 1, size(u)
        last = ((piece - 1)*periods + period)*SAMPLES
        angle(last - SAMPLES + 1:last) = shown_u(:, piece) + 2*turns(piece)
        velocity(last - SAMPLES + 1:last) = shown_v(:, piece)
      end do
    end do
    do piece = 2, size(u) ! goes on where the one before has ended
      last = piece*periods*SAMPLES
      associate (own => angle(last - periods*SAMPLES + 1:last))
        own = own + 2*anint((angle(last - periods*SAMPLES) - u(piece))/2)
      end associate
    end do
  end subroutine sample_orbit

  !> Centre of a motion: down or inverted if it stays within a half-turn of it and its mean within a quarter.
  pure function centre_of(rotates, mean, lowest, highest) result(centre)
    logical, intent(in) :: rotates !< it turns round
    real(dp), intent(in) :: mean, lowest, highest !< mean and range of its angle, half-turns
    integer :: centre
    real(dp) :: nearest

    nearest = anint(mean)
    centre = merge(ROTATING, ELSEWHERE, rotates)
    if (.not. rotates .and. abs(mean - nearest) < 0.25_dp .and. max(highest - nearest, nearest - lowest) < 1) &
      centre = merge(DOWN, INVERTED, modulo(nearest, 2.0_dp) < 0.5_dp)
  end function centre_of

  !> Implements kz_centre_of of dynamics_cycles.h.
  function centre_of_samples(rotates, n, theta, origin) bind(C, name='kz_centre_of') result(centre)
    integer(c_int32_t), value :: rotates
    integer(c_int64_t), value :: n
    real(dp), intent(in) :: theta(n)
    real(dp), intent(out) :: origin
    integer(c_int32_t) :: centre
    real(dp) :: mean

    mean = sum(theta)/(PI*n)
    centre = centre_of(rotates /= 0, mean, minval(theta)/PI, maxval(theta)/PI)
    origin = merge(PI*anint(mean), 0.0_dp, centre < ROTATING)
  end function centre_of_samples

  !> Amplitude and centre.
  subroutine place(attractor, pendulum, angle, velocity)
    type(attractor_t), intent(inout) :: attractor
    type(pendulum_t), intent(in) :: pendulum
    real(dp), intent(in) :: angle(0:), velocity(0:)
    real(dp) :: nearest

    attractor%centre = ROTATING
    attractor%amplitude = 0
    if (attractor%winding /= 0) return
    nearest = anint(attractor%mean)
    attractor%amplitude = largest(pendulum, angle, velocity, nearest)
    attractor%centre = centre_of(.false., attractor%mean, nearest - attractor%amplitude/PI, nearest)
  end subroutine place

  !> Largest |theta - centre| in rad over continuous time, by quintic Hermite interpolation where the velocity is 0.
  pure function largest(pendulum, angle, velocity, centre) result(most)
    type(pendulum_t), intent(in) :: pendulum
    real(dp), intent(in) :: angle(0:), velocity(0:), centre
    real(dp) :: most
    integer :: i

    most = PI*maxval(abs(angle - centre))
    do i = 0, ubound(angle, 1) - 1
      if (velocity(i)*velocity(i + 1) >= 0) cycle
      most = max(most, abs(turning_angle(PI*(angle(i:i + 1) - centre), velocity(i:i + 1), &
                                         [acceleration_at(i), acceleration_at(i + 1)])))
    end do
  contains
    !> theta'' at sample j
    pure function acceleration_at(j) result(rate)
      integer, intent(in) :: j
      real(dp) :: rate

      rate = acceleration(pendulum, 2*PI*j/SAMPLES, PI*angle(j), velocity(j))
    end function acceleration_at
  end function largest

  !> The extremum of the quintic with the given angles, velocities and accelerations at both ends of a sample interval.
  pure function turning_angle(angle, velocity, acceleration) result(extremum)
    real(dp), intent(in) :: angle(2), velocity(2), acceleration(2)
    real(dp) :: extremum
    real(dp), parameter :: H = 2*PI/SAMPLES
    real(dp) :: c(0:5), d, e, f, s
    integer :: i

    c(0:2) = [angle(1), H*velocity(1), 0.5_dp*H**2*acceleration(1)]
    d = angle(2) - c(0) - c(1) - c(2)
    e = H*velocity(2) - c(1) - 2*c(2)
    f = H**2*acceleration(2) - 2*c(2)
    c(3:5) = [10*d - 4*e + 0.5_dp*f, -15*d + 7*e - f, 6*d - 3*e + 0.5_dp*f]
    s = velocity(1)/(velocity(1) - velocity(2))
    do i = 1, 6
      s = s - (c(1) + s*(2*c(2) + s*(3*c(3) + s*(4*c(4) + s*5*c(5)))))/(2*c(2) + s*(6*c(3) + s*(12*c(4) + s*20*c(5))))
      s = min(max(s, 0.0_dp), 1.0_dp)
    end do
    extremum = c(0) + s*(c(1) + s*(c(2) + s*(c(3) + s*(c(4) + s*c(5)))))
  end function turning_angle

end module kz_cycles_features
