kapitza_test(scene LABEL unit FLOOR app)
