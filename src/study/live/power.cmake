kapitza_power(live FOLDERS study/live study/where app/live dynamics/live FILES include/kapitza/dynamics_live.h include/kapitza/study_live.h include/kapitza/study_where.h
  COMMANDS where view serve NEEDS atlas deep tools ends release
  BESIDE tests/unit/study/rasters.c tests/tools/fake_serve.py tests/tools/explored.h tests/tools/page_access.py
    tests/python/explorer/test_explorer*.py tests/python/explorer_page.py tests/python/serving.py tests/python/explorer/test_serve.py
    tests/python/explorer/test_client.py tests/python/explorer/test_protocol.py tests/python/motion/test_where.py
    python/kapitza/explorer python/kapitza/client.py python/kapitza/engine.py web/explorer
    docs/reference/explorer.md docs/reference/serve.md)
