# Every power, those that another needs first.
kapitza_power(boundaries FOLDERS study/manifolds study/wada study/tangency study/edge STUDIES manifolds wada tangency edge)
