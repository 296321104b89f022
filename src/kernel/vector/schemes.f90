!> Table of the integration schemes: name, order, coefficients, source.
  !>
  !> A split scheme alternates an exact damped drift with a kick, drifts first and last. Its row gives one half of two
  !> palindromes (drifts, kicks);
!> The middle entries follow from consistency: the drifts of a step sum to 1, and so do the kicks.
module kz_vector_schemes
  use, intrinsic :: iso_fortran_env, only: real128
  implicit none
  private
  public :: scheme_t, stage_t, SCHEMES, scheme_stages

  integer, parameter :: qp = real128

  !> Kinds of scheme; SPLIT rows alone have coefficients.
  integer, parameter, public :: RUNGE_KUTTA = 0, SPLIT = 1, PROCESSED = 2

  type :: scheme_t
    character(16) :: name
    integer :: order
    integer :: kicks, default_steps !< Sines per step; steps per drive period
    integer :: form
    integer :: n_drift, n_kick !< Numbers of given drift and kick coefficients
    real(qp) :: drift(7), kick(6)
    character(120) :: source
  end type scheme_t

  !> One entry of a step: a drift or a kick over the given share of the step.
  type :: stage_t
    logical :: is_kick
    real(qp) :: share
  end type stage_t

  real(qp), parameter :: ZERO = 0.0_qp
  character(*), parameter :: BLANES_MOAN = 'Blanes and Moan, J. Comput. Appl. Math. 142 (2002) 313, '

  type(scheme_t), parameter :: SCHEMES(*) = [ &
    scheme_t('rk4', 4, 4, 100, RUNGE_KUTTA, 0, 0, ZERO, ZERO, &
             'classical fourth-order Runge-Kutta, the method of BSG 1992'), scheme_t('split6', 6, 14, 24, SPLIT, 7, 6, &
             [0.0378593198406116_qp, 0.102635633102435_qp, -0.0258678882665587_qp, 0.314241403071447_qp, &
              -0.130144459517415_qp, 0.106417700369543_qp, -0.00879424312851058_qp], &
             [0.09171915262446165_qp, 0.183983170005006_qp, -0.05653436583288827_qp, 0.004914688774712854_qp, &
              0.143761127168358_qp, 0.328567693746804_qp], BLANES_MOAN//'SRKN, 14 stages, order 6'), &
    scheme_t('processed', 14, 1, 40, PROCESSED, 0, 0, ZERO, ZERO, &
             'one modified kick a step between two changes of coordinates (docs/explanation/theory.md)')]

  !> Rows of split6, which published values rest on, and of processed, the fastest, counted from 0 as numerics_t%scheme.
  integer, public, parameter :: SPLIT6_ROW = 1, PROCESSED_ROW = 2

contains

  !> Drifts and kicks of one step of a split scheme, in order.
  pure function scheme_stages(scheme) result(stages)
    type(scheme_t), intent(in) :: scheme !< a row with a split form
    type(stage_t) :: stages(2*scheme%kicks + 1)
    integer :: n

    n = size(stages)
    stages(1:n:2)%is_kick = .false.
    stages(1:n:2)%share = palindrome(scheme%drift(:scheme%n_drift), scheme%kicks + 1)
    stages(2:n:2)%is_kick = .true.
    stages(2:n:2)%share = palindrome(scheme%kick(:scheme%n_kick), scheme%kicks)
  end function scheme_stages

  !> Completes a palindrome of length n with sum 1 from its first entries.
  pure function palindrome(given, n) result(whole)
    real(qp), intent(in) :: given(:) !< the first (n - 1)/2 entries
    integer, intent(in) :: n !< length of the whole
    real(qp) :: whole(n)
    integer :: half

    half = size(given)
    whole(:half) = given
    if (mod(n, 2) == 1) then
      whole(half + 1) = 1 - 2*sum(given)
    else
      whole(half + 1:half + 2) = 0.5_qp - sum(given)
    end if
    whole(n - half + 1:) = given(half:1:-1)
  end function palindrome

end module kz_vector_schemes
