# Every power, those that another needs first.
kapitza_power(saddles FOLDERS study/saddles study/manifolds study/wada study/tangency study/edge dynamics/saddles
  STUDIES saddles manifolds wada tangency edge)
kapitza_power(deep FOLDERS study/window kernel/digits FILES include/kapitza/kernel_digits.h SCRIPT cmake/Flint.cmake PARTS deep
  KEYS basin.theta.centre basin.theta.width basin.velocity.centre basin.velocity.width basin.undecided)
kapitza_power(proof FOLDERS study/proof dynamics/trapping/proved kernel/enclosure
  FILES include/kapitza/dynamics_proof.h include/kapitza/kernel_enclosure.h PARTS proof KEYS basin.proof NEEDS deep)
kapitza_power(atlas FOLDERS study/atlas FILES include/kapitza/study_atlas.h STUDIES atlas NEEDS saddles)
kapitza_power(live FOLDERS study/live study/where app/live FILES include/kapitza/study_live.h include/kapitza/study_where.h
  COMMANDS where view serve NEEDS atlas deep)
