kapitza_power(measures FOLDERS study/measures study/resilience study/boundary analysis/boundary FILES include/kapitza/analysis_boundary.h
  STUDIES measures PARTS boundary shocks swept
  KEYS basin.boundary basin.shocks sweep.measure sweep.weight sweep.within sweep.sizes sweep.cells sweep.shock_scale sweep.shock_tolerance
  BESIDE tests/unit/study/measures.c tests/unit/study/shocks.c tests/python/basin/test_boundary_numbers.py tests/python/basin/test_shocks.py
    tests/python/parameters/test_measures.py tests/python/pictures/test_measure_pictures.py tests/python/parameters/test_measures_plane.py
    python/kapitza/measures.py python/kapitza/plots/passport.py python/kapitza/plots/measure_lines.py
    python/kapitza/plots/plane_measures.py docs/explanation/measures.md)
