kapitza_power(tools FOLDERS app/tools study/flutter FILES include/kapitza/study_flutter.h COMMANDS plot info fit needs
  BESIDE tests/python/parameters/test_needs.py tests/python/motion/test_fit.py)
