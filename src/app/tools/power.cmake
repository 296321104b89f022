kapitza_power(tools FOLDERS app/tools study/flutter FILES include/kapitza/study_flutter.h COMMANDS plot info fit needs
  BESIDE tests/python/test_needs.py tests/python/test_fit.py)
