kapitza_test(stability LABEL extremes FLOOR analysis)
