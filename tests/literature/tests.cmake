kapitza_test(stability LABEL literature LAYER analysis)
