!> A part of a drive period in which damping and drive may change.
module kz_model_stretch
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: real128
  implicit none
  private
  public :: stretch_t, course, CUBIC

  !> Highest power of time in a change.
  integer, parameter :: CUBIC = 3

  abstract interface
    !> Beta and the drive relative to the final one as polynomials in x, at `turn` + x width drive periods.
    pure subroutine course(along, beta, turn, width, damping, drive)
      import :: c_double, real128, CUBIC
      real(c_double), intent(in) :: along(4) !< Field `along` of the stretch
      real(c_double), intent(in) :: beta !< Damping after the change
      real(real128), intent(in) :: turn, width !< drive periods from a strobe
      real(real128), intent(out) :: damping(0:CUBIC), drive(0:CUBIC)
    end subroutine course
  end interface

  !> A stretch; by default a whole drive period without changes.
  type :: stretch_t
    real(real128) :: begin = 0 !< drive periods
    real(real128) :: span = 1  !< drive periods, at most 1
    procedure(course), pointer, nopass :: changes => null() !< null = nothing changes
    real(c_double) :: along(4) = 0 !< Arguments of `changes`
  end type stretch_t

end module kz_model_stretch
