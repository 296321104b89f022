"""Draws measures of attractors along a key of the pendulum: a panel for each measure, a line for each attractor,
intervals as bands.

    kapitza plot line erosion.h5
"""

import argparse
import math
from collections.abc import Mapping, Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style
from kapitza.plots.branches import parameter_text
from kapitza.plots.page import entitle, new_panels
from kapitza.plots.units import add_si, fixed_si, group_beside
from kapitza.result import Result
from kapitza.units import with_unit

STUDY = "measures along a line"


def measures_of(line: xarray.Dataset) -> list[str]:
    """The measures that belong to each attractor; their bounds, and measures of the whole window, are left out."""
    return [str(name) for name, values in line.data_vars.items()
            if values.dims == ("attractor", "value") and not str(name).endswith(("_low", "_high"))]


def draw_measure(axes: Axes, line: xarray.Dataset, name: str, *, colours: Mapping[str, str] | None = None,
                 legend: bool = True) -> Axes:
    """One measure of every attractor over the key; a band is its interval, a dot a value without neighbours. `colours`:
    of names."""
    value, styles = line["value"].values, ("-", (0, (4, 1.5)), (0, (1, 1.2)))
    seen: dict[str, int] = {}
    for i, title in enumerate(style.names_with_ids(line["name"].values)):
        colour = (colours or {}).get(title) or style.motion_colour(*(int(line[word].values[i])
                                                                     for word in ("period", "winding", "centre")))
        dashes = styles[seen.setdefault(colour, 0) % len(styles)]
        seen[colour] += 1
        # Pale colours need a rim
        axes.plot(value, line[name].values[i], color=style.INK, lw=2.2, marker=".", markersize=5)
        axes.plot(value, line[name].values[i], color=colour, lw=1.4, ls=dashes, marker=".", markersize=3.5, label=title)
        if f"{name}_low" in line:
            axes.fill_between(value, line[f"{name}_low"].values[i], line[f"{name}_high"].values[i],
                              color=style.shade(colour, 0.6), lw=0)
    axes.set_ylabel(with_unit(name.replace("_", " "), line[name]))
    axes.set_ylim(0, None)
    if legend:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    return axes


def mark_tangency(axes: Axes, tangency: xarray.Dataset, *, named: bool) -> Axes:
    """The value at which manifolds begin to cross."""
    value, error = float(tangency.attrs["value"]), float(tangency.attrs["error"])
    decimals = int(np.clip(-math.floor(math.log10(error)) if error > 0 else 12, 0, 12))
    axes.axvline(value, color=style.INK, lw=0.8, ls="--")
    if named:
        axes.annotate(f"manifolds touch at {value:.{decimals}f}", (value, 0.5), (4, 0),
                      xycoords=("data", "axes fraction"),
                      textcoords="offset points", va="center", fontsize="small", color=style.INK)
    return axes


def draw(result: Result, *, measure: Sequence[str] | None = None, si: bool = False) -> Figure:
    """The page: the panels over each other, with one legend."""
    line = result.group("line", si=si, written=True)
    names = measure or measures_of(line)
    figure, panels = new_panels(7.2, 1.2 + 2.2 * len(names), len(names), sharex=True)
    tangency = group_beside(result, "tangency", line) if "tangency" in result.groups else None
    for axes, name in zip(panels, names, strict=True):
        draw_measure(axes, line, name, legend=axes is panels[0])
        if tangency is not None and tangency.attrs["parameter"] == line.attrs["parameter"]:
            mark_tangency(axes, tangency, named=axes is panels[0])
    panels[-1].set_xlabel(parameter_text(line))
    entitle(figure, result, f"{line.sizes['value']} values", fixed_si(result, line) if result.pivot_frequency else "")
    return figure


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--measure", nargs="+", metavar="NAME", help="the measures to draw; left out: all")
    add_si(parser, "measures with times in s and velocities in rad/s")
