#!/usr/bin/env python3
"""Draws a chart of ends from a result file: `kapitza-plot chart` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("chart")
