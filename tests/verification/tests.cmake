kapitza_test(orders LABEL verification FLOOR kernel)
kapitza_test(truth LABEL verification FLOOR kernel)
kapitza_test(stability LABEL verification FLOOR analysis)
