#!/usr/bin/env python3
"""Draws a sweep from a result file: `kapitza-plot sweep` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("sweep")
