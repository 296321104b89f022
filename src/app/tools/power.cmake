kapitza_power(tools FOLDERS app/tools COMMANDS plot info fit
  BESIDE tests/python/motion/test_fit.py)
