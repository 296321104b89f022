"""Pictures of results: a module for each kind. A draw_* function draws one panel: it takes and returns an Axes."""
