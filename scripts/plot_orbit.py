#!/usr/bin/env python3
"""Draws an orbit from a result file: `kapitza-plot orbit` without installing it."""

from kapitza.command import main

if __name__ == "__main__":
    main("orbit")
