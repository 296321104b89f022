kapitza_power(library FOLDERS library app/calls study/flutter
  FILES include/kapitza.h include/kapitza/study_flutter.h COMMANDS where view needs NEEDS atlas live saddles release tools
  BESIDE tests/python/package/test_pendulum.py tests/python/package/test_library.py tests/python/package/test_live.py python/kapitza/pendulum.py
    python/kapitza/library.py python/kapitza/live.py python/kapitza/starts.py python/kapitza/shaker.py
    tests/python/parameters/test_needs.py python/kapitza/datasets.py docs/howto/library.md docs/howto/other-languages.md)
