kapitza_power(tools FOLDERS app/tools COMMANDS plot info fit needs
  BESIDE tests/python/test_needs.py tests/python/test_fit.py)
