kapitza_test(depth LABEL verification LAYER app)
kapitza_test(orders LABEL verification LAYER kernel)
kapitza_test(reference LABEL verification LAYER kernel)
kapitza_test(stability LABEL verification LAYER analysis)
