"""Draws the trade between speed and accuracy from a result file of kapitza: share of wrong labels against time,
log-log.

    kapitza plot tradeoff tradeoff-fig13.h5
    kapitza plot tradeoff tradeoff-fig13.h5 --per-cell -o cells.svg       time for the labels alone

A line is one way to label, its points are steps or table nodes; bars are 95 % intervals; a ring marks what nothing
beats. A setting without a wrong label stands at the upper end of its interval, as an open triangle. Dashed: the share
that one unit in the last place of the start flips.
"""

import argparse
from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from kapitza import style
from kapitza.plots.page import entitle, new_panels
from kapitza.result import Result

STUDY = "a trade-off"
METHODS = ("icm", "direct", "exact")
INTERPOLATIONS = ("linear", "quintic")
# Way to label -> colour and marker.
WAYS = {
    "direct, split6": ("#2f6db3", "o"),
    "direct, rk4": ("#7a4fa3", "s"),
    "direct, processed": ("#12806a", "v"),
    "exact": (style.INK, "*"),
    "table, linear": ("#c2452f", "D"),
    "table, quintic": ("#f2b233", "P"),
}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--per-cell", action="store_true",
                        help="time of the labels alone, without table and trapping regions")


def way(method_code: int, scheme: str, interpolation_code: int) -> str:
    """A key of WAYS."""
    method = METHODS[method_code]
    if method == "exact":
        return method
    name = "direct" if method == "direct" else "table"
    return f"{name}, {scheme if name == 'direct' else INTERPOLATIONS[interpolation_code]}"


def grouped(trade: xarray.Dataset) -> dict[str, list[int]]:
    """Way to label -> indices of its settings, from the quickest."""
    groups: dict[str, list[int]] = {}
    rows = zip(trade["method"].values, trade["scheme"].values, trade["interpolation"].values, strict=True)
    for index, row in enumerate(rows):
        groups.setdefault(way(*row), []).append(index)
    return groups


def _draw_way(axes: Axes, trade: xarray.Dataset, x: np.ndarray, name: str, rows: list[int], colour: str,
              marker: str) -> None:
    """One line: its points, bars and rings, from the quickest setting."""
    index = np.array(sorted(rows, key=lambda i: x[i]))
    wrong, low, high = (100 * trade[key].values[index] for key in ("wrong", "wrong_low", "wrong_high"))
    seen = wrong > 0
    height = np.where(seen, wrong, high)
    axes.plot(x[index][seen], height[seen], color=colour, lw=1.2, zorder=2)
    axes.errorbar(x[index][seen], wrong[seen], [(wrong - low)[seen], (high - wrong)[seen]], fmt=marker, color=colour,
                  ms=5, lw=0.8, zorder=3)
    axes.plot(x[index][~seen], height[~seen], "v", mfc="white", mec=colour, ms=5, zorder=3)
    best = trade["pareto"].values[index] == 1
    axes.plot(x[index][best], height[best], "o", mfc="none", mec=style.INK, ms=11, mew=0.9, zorder=4)


def _mark_1992(axes: Axes, trade: xarray.Dataset, x: np.ndarray) -> None:
    """The settings of the 1992 paper."""
    for i, label in enumerate(trade["label"].values):
        if label.endswith("-1992"):
            height = 100 * max(trade["wrong"].values[i], 0) or 100 * trade["wrong_high"].values[i]
            axes.annotate("1992", (x[i], height), xytext=(7, 7), textcoords="offset points", fontsize="small",
                          fontweight="bold")


def _marks(trade: xarray.Dataset, floor: float) -> list[Line2D]:
    """What the signs mean, as entries of a legend."""
    marks = [Line2D([], [], ls="", marker="o", mfc="none", mec=style.INK, ms=9, mew=0.9, label="nothing beats it")]
    if (trade["wrong"].values == 0).any():
        marks.append(Line2D([], [], ls="", marker="v", mfc="white", mec=style.INK, ms=5,
                            label="none wrong: at most this"))
    if floor > 0:
        marks.append(Line2D([], [], color=style.INK, lw=1, ls="--", label="last place of the start"))
    return marks


def draw_tradeoff(axes: Axes, trade: xarray.Dataset, *, per_cell: bool = False,
                  colours: Mapping[str, str] | None = None, legend: bool = True) -> Axes:
    """Share of wrong labels against time; `colours`: of the keys of WAYS."""
    x = trade["seconds_per_million_cells" if per_cell else "seconds"].values
    for name, index in grouped(trade).items():
        colour, marker = WAYS.get(name, (style.FAINT, "o"))
        _draw_way(axes, trade, x, name, index, (colours or {}).get(name, colour), marker)
    _mark_1992(axes, trade, x)
    floor = 100 * float(trade.attrs["floor"])
    if floor > 0:
        axes.axhline(floor, color=style.INK, lw=1, ls="--", zorder=1)
    axes.margins(0.07, 0.11)
    axes.set(xscale="log", yscale="log", ylabel="wrong labels / %",
             xlabel="processor time per million cells (s)" if per_cell
             else "processor time for the map of this scene (s)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    axes.grid(which="both", color="#e3e7eb", lw=0.6)
    axes.set_axisbelow(True)
    if legend:
        looks = [(name, *WAYS.get(name, (style.FAINT, "o"))) for name in grouped(trade)]
        handles = [Line2D([], [], color=(colours or {}).get(name, colour), marker=marker, label=name) for name, colour,
                   marker in looks]
        axes.legend(handles=[*handles, *_marks(trade, floor)], loc="upper left", bbox_to_anchor=(1.01, 1),
                    fontsize="small")
    return axes


def draw(result: Result, *, per_cell: bool = False) -> Figure:
    """The page: one panel, its legend beside it."""
    trade = result.group("tradeoff")
    figure, (axes,) = new_panels(7.2, 4.8)
    draw_tradeoff(axes, trade, per_cell=per_cell)
    parameters = [f"{symbol} = {result.pendulum[name]:.6g}" for symbol, name in (("k", "k"), ("β", "beta"), ("m", "m"))]
    entitle(figure, result, ",  ".join(parameters), f"{int(trade.attrs['samples'])} cells compared with quad precision")
    return figure
