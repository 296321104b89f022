#!/usr/bin/env python3
"""Draws an effective potential from a result file: `kapitza-plot potential` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("potential")
