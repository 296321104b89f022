!> Wraps the angles of lanes after a period to [-1, 1]; and flushes subnormal numbers within it.
module kz_vector_wrap
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use, intrinsic :: iso_fortran_env, only: rk => real64, ik => int64
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kz_vector_map, only: map_t
  use kz_vector_sine, only: ROUND_TO_INTEGER, VECTOR
  implicit none
  private
  public :: wrap_lanes, vectors_of, flush_subnormals, restore_control

  !> Largest number of turns with a fraction left; a state beyond it is lost.
  real(rk), parameter :: MOST_TURNS = 1e15_rk

  !> src/kernel/vector/flush.c
  interface
    function flush_subnormals() bind(C, name='kz_flush_subnormals') result(control)
      import :: c_int64_t
      integer(c_int64_t) :: control
    end function flush_subnormals

    subroutine restore_control(control) bind(C, name='kz_restore_control')
      import :: c_int64_t
      integer(c_int64_t), value :: control
    end subroutine restore_control
  end interface

contains

  !> Wraps the angles of some lanes to [-1, 1] and counts the turns. A lost state becomes NaN.
  subroutine wrap_lanes(map, first, last)
    class(map_t), intent(inout) :: map !< its lanes
    integer, intent(in) :: first, last !< lanes, from 1
    integer(ik), parameter :: NO_TURNS = transfer(ROUND_TO_INTEGER, 0_ik)
    real(rk) :: nan, shifted, turn
    integer :: i

    nan = ieee_value(nan, ieee_quiet_nan)
    do i = first, last ! vectorises because the turns are read off the bits
      shifted = 0.5_rk*map%u(i) + ROUND_TO_INTEGER
      turn = shifted - ROUND_TO_INTEGER
      map%u(i) = merge(map%u(i) - 2*turn, nan, abs(turn) < MOST_TURNS)
      map%turns(i) = map%turns(i) + merge(transfer(shifted, 0_ik) - NO_TURNS, 0_ik, abs(turn) < MOST_TURNS)
    end do
  end subroutine wrap_lanes

  !> Rounds n lanes up to whole vectors.
  pure integer function vectors_of(n) result(lanes)
    integer, intent(in) :: n !< lanes in use

    lanes = VECTOR*((n + VECTOR - 1)/VECTOR)
  end function vectors_of

end module kz_vector_wrap
