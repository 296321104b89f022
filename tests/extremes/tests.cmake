kapitza_test(stability LABEL extremes FLOOR analysis)
kapitza_test(numbers LABEL extremes FLOOR dynamics)
