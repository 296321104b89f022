"""A package that the commands of the program need and that is missing, in one line."""

import sys
from typing import NoReturn


def refuse(command: str, error: ModuleNotFoundError) -> NoReturn:
    """Says which package `command` lacks, and ends."""
    print(f"kapitza: error: {command}: {sys.executable} lacks the package {error.name}; set KAPITZA_PYTHON to a "
          "Python that has those "
          "of scripts/requirements.txt (scripts/setup makes one: .venv/bin/python)", file=sys.stderr)
    sys.exit(1)
