!> Constants of sin(pi u) in doubles (sine.inc): reduction to half a turn, polynomial, length of vectors.
module kz_vector_sine
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  implicit none
  private
  public :: SINE_COEFFICIENTS, ROUND_TO_INTEGER, SIGN_SHIFT, INVERSE_PI, VECTOR

  !> Lanes of the longest vector, of which loops run over a multiple.
  integer, parameter :: VECTOR = 16
  !> Number whose addition rounds to an integer, with the parity in the lowest bit.
  real(rk), parameter :: ROUND_TO_INTEGER = 1.5_rk*2.0_rk**(digits(1.0_rk) - 1)
  integer, parameter :: SIGN_SHIFT = bit_size(0_ik) - 1
  real(rk), parameter :: INVERSE_PI = 0.318309886183790671537767526745028724_rk

  !> sin(pi r)/r as a polynomial in r**2 on |r| <= 1/2, minimax, relative error 3.0e-19 (Remez exchange in 60 digits).
  real(rk), parameter :: SINE_COEFFICIENTS(9) = [ &
    3.14159265358979323765_rk, &
    -5.16771278004996952865_rk, &
    2.55016403987729393818_rk, &
    -0.599264529318738216301_rk, &
    0.0821458865698926095193_rk, &
    -0.00737043047876246099464_rk, &
    0.000466299688773173555302_rk, &
    -0.0000219031854208053767726_rk, &
    7.69472732830679049614e-7_rk]

end module kz_vector_sine
