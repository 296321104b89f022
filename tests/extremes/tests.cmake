kapitza_test(critical LABEL extremes LAYER dynamics COST 15 BESIDE doublet.f90)
kapitza_test(stability LABEL extremes LAYER analysis)
kapitza_test(numbers LABEL extremes LAYER dynamics)
kapitza_test(step_error LABEL extremes LAYER dynamics)
