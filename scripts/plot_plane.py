#!/usr/bin/env python3
"""Draws ends over a plane from a result file: `kapitza plot plane` without installing it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
from kapitza.command import main

if __name__ == "__main__":
    main("plane")
