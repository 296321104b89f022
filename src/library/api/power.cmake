kapitza_power(library FOLDERS library
  FILES include/kapitza.h NEEDS atlas live saddles release
  BESIDE tests/python/package/test_pendulum.py tests/python/package/test_library.py tests/python/package/test_live.py python/kapitza/pendulum.py
    python/kapitza/library.py python/kapitza/live.py python/kapitza/datasets.py docs/howto/library.md)
