kapitza_power(saddles FOLDERS study/saddles study/manifolds study/wada study/tangency dynamics/saddles
  FILES include/kapitza/dynamics_saddles.h include/kapitza/study_saddles.h
  STUDIES saddles manifolds wada tangency
  BESIDE tests/python/test_saddles.py tests/python/test_manifolds.py tests/python/test_wada.py tests/python/test_tangency.py
    python/kapitza/plots/skeleton.py docs/explanation/boundaries.md)
