#!/usr/bin/env python3
"""Draws basins of attraction from a result file: `kapitza-plot basin` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("basin")
