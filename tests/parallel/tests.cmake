foreach(ranks 1 2 3 5)
  kapitza_test(stage LABEL parallel FLOOR parallel RANKS ${ranks} TIMEOUT 60)
endforeach()
