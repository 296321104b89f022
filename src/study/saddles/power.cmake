kapitza_power(saddles FOLDERS study/saddles dynamics/saddles
  FILES include/kapitza/dynamics_saddles.h include/kapitza/study_saddles.h
  STUDIES saddles
  BESIDE tests/python/motion/test_saddles.py tests/python/motion/test_manifolds.py
    python/kapitza/plots/skeleton.py python/kapitza/boundaries docs/explanation/boundaries.md)
