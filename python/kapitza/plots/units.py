"""The option --si of pictures, and the groups of a result in the units that a picture has."""

import argparse
from collections.abc import Callable

import xarray

from kapitza.result import Result


def add_si(parser: argparse.ArgumentParser, what: str) -> None:
    """The option --si; `what` says which axes it changes."""
    parser.add_argument("--si", action="store_true", help=f"{what}, of a scene in SI units")


def groups_of(result: Result, arguments: argparse.Namespace) -> Callable[[str], xarray.Dataset]:
    """A function from the name of a group to its numbers in the units of the picture: by --si, and by --degrees."""
    return lambda name: result.group(name, si=getattr(arguments, "si", False), degrees=getattr(arguments, "degrees", False))
