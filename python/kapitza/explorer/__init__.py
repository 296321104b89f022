"""The explorer: a local page on which basins are zoomed and dragged; every view is computed by the program (`kapitza view`)."""
