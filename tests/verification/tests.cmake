kapitza_test(truth LABEL verification FLOOR kernel)
