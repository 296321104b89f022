!> Carries starts to the first strobe from which on the drive is that of every period; a power extends it.
module kz_labels_onset
  use, intrinsic :: iso_c_binding, only: dp => c_double
  use kz_labels_carrier, only: orbit_t
  use kz_model_pendulum, only: pendulum_t
  implicit none
  private
  public :: onset_t

  type, abstract :: onset_t
  contains
    procedure(prepare_onset), deferred :: prepare
    procedure(carry_orbits), deferred :: carry
  end type onset_t

  abstract interface
    !> Makes, at the first call, what carrying takes. One thread at a time may call it.
    subroutine prepare_onset(onset, pendulum, fastest)
      import :: dp, onset_t, pendulum_t
      class(onset_t), intent(inout) :: onset
      type(pendulum_t), intent(in) :: pendulum !< as it is in the end
      real(dp), intent(in) :: fastest !< speeds that occur, rad per drive radian
    end subroutine prepare_onset

    !> Carries orbits to the strobe, and sets their age to that of the strobe.
    subroutine carry_orbits(onset, pendulum, precisely, orbit)
      import :: onset_t, orbit_t, pendulum_t
      class(onset_t), intent(in) :: onset
      type(pendulum_t), intent(in) :: pendulum !< as it is in the end
      logical, intent(in) :: precisely !< in quad precision, else in double precision
      type(orbit_t), intent(inout) :: orbit(:) !< [n] in and out
    end subroutine carry_orbits
  end interface

end module kz_labels_onset
