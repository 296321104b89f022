# Every power, those that another needs first.
kapitza_power(saddles FOLDERS study/saddles study/manifolds study/wada study/tangency study/edge dynamics/saddles
  FILES include/kapitza/dynamics_saddles.h
  STUDIES saddles manifolds wada tangency edge
  BESIDE tests/python/test_saddles.py tests/python/test_manifolds.py tests/python/test_wada.py tests/python/test_tangency.py
    python/kapitza/plots/skeleton.py docs/explanation/boundaries.md)
kapitza_power(deep FOLDERS study/window kernel/digits FILES include/kapitza/kernel_digits.h SCRIPT cmake/Flint.cmake PARTS deep
  KEYS basin.theta.centre basin.theta.width basin.velocity.centre basin.velocity.width basin.undecided
  BESIDE tests/verification/depth.c tests/unit/kernel/arbitrary.c tests/tools/own_orbit.py tests/python/test_depth.py)
kapitza_power(proof FOLDERS study/proof dynamics/trapping/proved kernel/enclosure
  FILES include/kapitza/dynamics_proof.h include/kapitza/kernel_enclosure.h PARTS proof KEYS basin.proof NEEDS deep
  BESIDE tests/unit/kernel/enclosure.c tests/unit/kernel/sums.c tests/unit/kernel/rounding.c tests/unit/dynamics/proof.c
    tests/tools/enclosed.h tests/tools/enclosed_orbit.h tests/python/test_proof.py
    docs/explanation/proof.md docs/explanation/bounds.md docs/validation/proofs.md)
kapitza_power(atlas FOLDERS study/atlas dynamics/curves FILES include/kapitza/study_atlas.h include/kapitza/dynamics_trace.h STUDIES atlas NEEDS saddles
  BESIDE tests/unit/study/atlas_cycles.c tests/unit/study/bands.c tests/python/test_atlas*.py python/kapitza/plots/atlas*.py
    docs/explanation/atlas.md docs/tutorials/map.md)
kapitza_power(tools FOLDERS app/tools COMMANDS plot info fit needs
  BESIDE tests/python/test_needs.py tests/python/test_fit.py)
kapitza_power(ends FOLDERS study/ends dynamics/plane FILES include/kapitza/dynamics_ends.h PARTS ends KEYS sweep.ends sweep.measure.ends
  BESIDE tests/python/test_chart.py)
kapitza_power(live FOLDERS study/live study/where app/live dynamics/live FILES include/kapitza/dynamics_live.h include/kapitza/study_live.h include/kapitza/study_where.h
  COMMANDS where view serve NEEDS atlas deep tools ends
  BESIDE tests/unit/study/rasters.c tests/tools/fake_serve.py tests/tools/explored.h tests/tools/page_access.py
    tests/python/test_explorer*.py tests/python/explorer_page.py tests/python/serving.py tests/python/test_serve.py
    tests/python/test_client.py tests/python/test_protocol.py tests/python/test_where.py
    python/kapitza/explorer python/kapitza/client.py python/kapitza/engine.py web/explorer
    docs/reference/explorer.md docs/reference/serve.md docs/howto/stories.md)
kapitza_power(measures FOLDERS study/measures study/resilience study/boundary STUDIES measures PARTS boundary shocks swept
  KEYS basin.boundary basin.shocks sweep.measure sweep.weight sweep.within sweep.sizes sweep.cells sweep.shock_scale sweep.shock_tolerance
  BESIDE tests/unit/study/measures.c tests/unit/study/shocks.c tests/python/test_boundary.py tests/python/test_shocks.py
    tests/python/test_measures.py tests/python/test_measures_pictures.py tests/python/test_plane.py
    python/kapitza/measures.py python/kapitza/plots/passport.py python/kapitza/plots/line.py
    python/kapitza/plots/plane_measures.py docs/explanation/measures.md)
