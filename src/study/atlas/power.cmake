kapitza_power(atlas FOLDERS study/atlas dynamics/curves FILES include/kapitza/study_atlas.h include/kapitza/dynamics_trace.h STUDIES atlas NEEDS saddles
  BESIDE tests/unit/study/atlas_cycles.c tests/unit/study/bands.c tests/python/parameters/test_atlas*.py python/kapitza/plots/atlas*.py
    docs/explanation/atlas.md docs/tutorials/map.md)
