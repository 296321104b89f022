kapitza_test(stability LABEL literature FLOOR analysis)
