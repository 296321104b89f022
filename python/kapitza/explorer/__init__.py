"""The explorer: a local page on which basins are zoomed and dragged; frames come from `kapitza serve`."""
