"""The option --si of pictures, and what their pages say in SI units."""

import argparse

import xarray

from kapitza import layout, units
from kapitza.result import Result


def add_si(parser: argparse.ArgumentParser, what: str) -> None:
    """The option --si; `what` says which axes it changes."""
    parser.add_argument("--si", action="store_true", help=f"{what}, of a scene in SI units")


def fixed_si(result: Result, drawn: xarray.Dataset) -> str:
    """The parameters of a scene in SI units that are not swept in the group `drawn`."""
    swept = {str(drawn.attrs.get(key, "")).removeprefix("pivot_")
             for key in ("parameter", "x_parameter", "y_parameter")}
    return ",  ".join(text for name, text in units.si_parameters(result.pendulum).items() if name not in swept)


def group_beside(result: Result, name: str, drawn: xarray.Dataset) -> xarray.Dataset:
    """A group with its values of swept keys in the units that the group `drawn`, over the same keys, is drawn in."""
    dataset = result.group(name).copy()
    others = {key: value for key, value in dataset.attrs.items() if "_written_" not in str(key)}
    dataset.attrs = others | {key: value for key, value in drawn.attrs.items() if "_written_" in str(key)}
    return units.in_written_units(dataset, name, layout.axes_of(name))
