kapitza_power(proof FOLDERS study/proof dynamics/trapping/proved kernel/enclosure
  FILES include/kapitza/dynamics_proof.h include/kapitza/kernel_enclosure.h PARTS proof KEYS basin.proof NEEDS deep
  BESIDE tests/unit/kernel/enclosure.c tests/unit/kernel/sums.c tests/unit/kernel/rounding.c tests/unit/dynamics/proof.c
    tests/tools/enclosed.h tests/tools/enclosed_orbit.h tests/python/basin/test_proof.py
    docs/explanation/proof.md docs/explanation/bounds.md)
