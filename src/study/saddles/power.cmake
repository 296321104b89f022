kapitza_power(saddles FOLDERS study/saddles dynamics/saddles
  FILES include/kapitza/dynamics_saddles.h include/kapitza/study_saddles.h
  STUDIES saddles
  BESIDE tests/python/test_saddles.py tests/python/test_boundaries.py
    python/kapitza/plots/skeleton.py python/kapitza/boundaries docs/explanation/boundaries.md)
