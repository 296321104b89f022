kapitza_test(scene LABEL unit FLOOR app)
kapitza_test(spectrum LABEL unit FLOOR analysis)
kapitza_test(turning LABEL unit FLOOR analysis)
kapitza_test(models LABEL unit FLOOR kernel)
