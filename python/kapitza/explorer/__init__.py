"""The explorer: a local page on which basins are zoomed and dragged; each view has an engine in a process of its
own."""
