"""The option --si of pictures, and the groups of a result in the units that a picture has."""

import argparse
from collections.abc import Callable

import xarray

from kapitza import layout, units
from kapitza.result import Result


def add_si(parser: argparse.ArgumentParser, what: str) -> None:
    """The option --si; `what` says which axes it changes."""
    parser.add_argument("--si", action="store_true", help=f"{what}, of a scene in SI units")


def groups_of(result: Result, arguments: argparse.Namespace) -> Callable[[str], xarray.Dataset]:
    """A function from the name of a group to its numbers in the units of the picture: by --si, by --degrees, and of
    a swept key as its scene is written."""
    return lambda name: result.group(name, si=getattr(arguments, "si", False), degrees=getattr(arguments, "degrees", False), written=True)


def fixed_si(result: Result, drawn: xarray.Dataset) -> str:
    """The parameters of a scene in SI units that are not swept in the group `drawn`."""
    swept = {str(drawn.attrs.get(key, "")).removeprefix("pivot_") for key in ("parameter", "x_parameter", "y_parameter")}
    return ",  ".join(text for name, text in units.si_parameters(result.pendulum).items() if name not in swept)


def group_beside(result: Result, name: str, drawn: xarray.Dataset) -> xarray.Dataset:
    """A group with its values of swept keys in the units that the group `drawn`, over the same keys, is drawn in."""
    dataset = result.group(name).copy()
    others = {key: value for key, value in dataset.attrs.items() if "_written_" not in str(key)}
    dataset.attrs = others | {key: value for key, value in drawn.attrs.items() if "_written_" in str(key)}
    return units.in_written_units(dataset, name, layout.axes_of(name))
