kapitza_test(critical LABEL extremes FLOOR dynamics BESIDE doublet.f90)
kapitza_test(stability LABEL extremes FLOOR analysis)
kapitza_test(numbers LABEL extremes FLOOR dynamics)
kapitza_test(trial LABEL extremes FLOOR dynamics)
