"""Boundaries of basins: manifolds of saddles, basins that share one boundary, and where manifolds begin to cross. A
module for each."""
