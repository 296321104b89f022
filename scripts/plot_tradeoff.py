#!/usr/bin/env python3
"""Draws the trade between speed and accuracy from a result file: `kapitza-plot tradeoff` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("tradeoff")
