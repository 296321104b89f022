kapitza_power(ends FOLDERS study/ends dynamics/lanes kernel/mixed FILES include/kapitza/dynamics_ends.h PARTS ends KEYS sweep.ends sweep.measure.ends
  BESIDE tests/python/parameters/test_final_states_plane.py)
