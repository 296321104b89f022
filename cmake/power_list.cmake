# Every power, those that another needs first.
kapitza_power(saddles FOLDERS study/saddles study/manifolds study/wada study/tangency study/edge
              STUDIES saddles manifolds wada tangency edge)
kapitza_power(atlas FOLDERS study/atlas STUDIES atlas NEEDS saddles)
