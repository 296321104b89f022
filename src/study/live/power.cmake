kapitza_power(live FOLDERS study/live study/where dynamics/live FILES include/kapitza/dynamics_live.h include/kapitza/study_live.h include/kapitza/study_where.h
  NEEDS atlas deep ends release
  BESIDE tests/unit/study/rasters.c tests/tools/explored.h tests/tools/page_access.py
    tests/python/explorer/test_explorer*.py tests/python/explorer_page.py tests/python/serving.py tests/python/explorer/test_answers.py
    tests/python/explorer/test_engine.py tests/python/motion/test_where.py tests/tools/striped_view.py
    python/kapitza/explorer python/kapitza/engine.py web/explorer web/page scripts/page*
    docs/reference/explorer.md docs/howto/page.md)
