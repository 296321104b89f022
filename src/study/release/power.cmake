kapitza_power(release FOLDERS study/release dynamics/release model/release
  FILES include/kapitza/model_release.h include/kapitza/dynamics_release.h include/kapitza/study_release.h PARTS release ramp alike
  KEYS basin.start_phase basin.phases pendulum.ramp sweep.phases sweep.measure.phases sweep.parameter
  BESIDE tests/python/motion/test_release.py)
