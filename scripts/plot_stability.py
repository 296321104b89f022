#!/usr/bin/env python3
"""Draws a stability chart from a result file: `kapitza-plot stability` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("stability")
