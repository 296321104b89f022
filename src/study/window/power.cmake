kapitza_power(deep FOLDERS study/window kernel/digits FILES include/kapitza/kernel_digits.h SCRIPT cmake/Flint.cmake PARTS deep
  KEYS basin.theta.centre basin.theta.width basin.velocity.centre basin.velocity.width basin.undecided
  NEEDS release
  BESIDE tests/verification/depth.c tests/unit/kernel/arbitrary.c tests/tools/own_orbit.py tests/python/basin/test_deep_windows.py)
