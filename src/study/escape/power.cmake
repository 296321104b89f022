kapitza_power(escape FOLDERS study/escape kernel/paths FILES include/kapitza/kernel_paths.h STUDIES escape NEEDS saddles
  BESIDE tests/unit/kernel/paths.c tests/python/motion/test_escape.py python/kapitza/plots/escape.py python/kapitza/ways_out.py docs/explanation/ways-out.md)
