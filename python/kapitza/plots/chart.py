"""Draws a sweep over a plane of two keys of the pendulum: where the same starts end, or a measure of attractors.

    kapitza plot plane measures-plane.h5 --measure share
        a panel for each name of attractors, a measure of the pendulum in one
    kapitza plot plane measures-plane.h5 --measure shock --attractor inverted --atlas atlas-blackburn.h5
        with the curves of an atlas
    kapitza plot plane chart-blackburn.h5
        the ends, with the curves of a study stability of the same file
    kapitza plot plane chart-blackburn.h5 --view exponent      the largest Lyapunov exponent
    kapitza plot plane chart-blackburn.h5 --view settling      how long the motions take
"""

import argparse
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, TwoSlopeNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from kapitza import style
from kapitza.plots.curves import curve_names, exact_of, is_branch, whole_curve
from kapitza.plots.page import BadOption, current, entitle, new_panels
from kapitza.plots.parameter_axes import label_keys
from kapitza.plots.plane_measures import MOST, measure_page
from kapitza.plots.units import add_si, fixed_si
from kapitza.result import BadFile, Result
from kapitza.units import unit_text, with_unit

STUDY = "ends or measures over a plane"
CYCLE, CHAOTIC = 0, 1  # codes of the variable `end`
LINEAR = "limits of rest (linear)"
VIEWS = ("ends", "exponent", "settling")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", choices=VIEWS, help="of ends (default: ends)")
    parser.add_argument("--measure", metavar="NAME",
                        help="the measure to draw (default: ends if there are any, else the first measure)")
    parser.add_argument("--attractor", metavar="NAME", nargs="+",
                        help=f"names, or numbers; left out: the {MOST} most frequent names")
    parser.add_argument("--atlas", metavar="FILE", type=Path,
                        help="result with the study atlas, whose curves are drawn on top (default: "
                        "those of the same file)")
    add_si(parser, "times in s and velocities in rad/s")


def kinds(chart: xarray.Dataset, colours: Mapping[str, str] | None = None) -> tuple[np.ndarray, list[str]]:
    """The colours (rgb) of one start's ends, and the kinds of motion among them, the most frequent first; `colours`: of
    a kind."""
    variables = [chart[name].values.ravel() for name in ("end", "end_period", "end_winding", "end_centre")]
    classes, place, counts = np.unique(np.stack(variables), axis=1, return_inverse=True, return_counts=True)
    rows = [tuple(int(value) for value in row) for row in classes.T]
    names = [style.kind(*row[1:]) if row[0] in (CYCLE, CHAOTIC) else "not settled" for row in rows]
    usual = [style.motion_colour(*row[1:]) if row[0] in (CYCLE, CHAOTIC) else style.UNSETTLED for row in rows]
    palette = np.array([to_rgb((colours or {}).get(name, colour)) for name, colour in zip(names, usual, strict=True)])
    share: dict[str, int] = {}
    for name, count in zip(names, counts, strict=True):
        share[name] = share.get(name, 0) + int(count)
    return palette[place.ravel()].reshape(*chart["end"].shape, 3), sorted(share, key=lambda name: -share[name])


def draw_ends(axes: Axes, chart: xarray.Dataset, *, colours: Mapping[str, str] | None = None, legend: bool = True,
              others: Iterable[str] = ()) -> Axes:
    """Ends of one start, coloured as the motions are in all figures, or by `colours` (kind of motion -> colour);
    `others`: kinds of motion that the legend has too."""
    image, names = kinds(chart, colours)
    names = list(dict.fromkeys([*names, *others]))
    axes.pcolormesh(chart["x"], chart["y"], image, shading="nearest", rasterized=True)
    if legend:
        known = style.KINDS | dict(colours or {})
        patches = [Patch(facecolor=known.get(name, style.UNSETTLED), edgecolor=style.FAINT, label=name)
                   for name in names]
        axes.legend(handles=[*patches, *axes.get_legend_handles_labels()[0]], loc="upper left",
                    bbox_to_anchor=(1.01, 1), title="paler: longer periods", alignment="left")
    return axes


def draw_number(axes: Axes, chart: xarray.Dataset, view: str, *, colours: str | None = None,
                legend: bool = True) -> Axes:
    """Exponents or settling times of one start; `colours`: name of a colour map; `legend`: the bar beside it."""
    if view == "exponent":
        values, text = chart["exponent"].values, with_unit("largest Lyapunov exponent", chart["exponent"])
        low, high = exponent_range(values)
        image = axes.pcolormesh(chart["x"], chart["y"], values, cmap=colours or "RdBu_r",
                                norm=TwoSlopeNorm(0, low, high), shading="nearest", rasterized=True)
    else:
        values, text = chart["settling_time"].values, with_unit("settling time", chart["settling_time"])
        values = np.maximum(values, np.min(values[values > 0], initial=np.inf))  # no time at all has no logarithm
        image = axes.pcolormesh(chart["x"], chart["y"], values, cmap=colours or "viridis", norm=LogNorm(),
                                shading="nearest", rasterized=True)
    if legend:
        bar = axes.figure.colorbar(image, ax=axes, label=text, fraction=0.05, pad=0.01)
        if view == "exponent":
            bar.set_ticks([*_ticks(low)[:0:-1], *_ticks(high)])
    return axes


def exponent_range(values: np.ndarray) -> tuple[float, float]:
    """The ends of the scale: regular motions (negative, blue) and chaotic ones (positive, red) have a range each, so
    that neither hides the differences of the other; half a percent of the points may lie beyond."""
    sides = [side[np.isfinite(side) & (side > 0)] for side in (-values, values)]
    low, high = (float(np.quantile(side, 0.995)) if side.size else 0.0 for side in sides)
    return -(low or high or 1.0), high or low or 1.0


def _ticks(end: float) -> list[float]:
    """0 and some round numbers towards the end of one side."""
    return [math.copysign(tick, end) for tick in MaxNLocator(3, steps=[1, 2, 5, 10]).tick_values(0, abs(end))
            if 0 <= tick <= abs(end)]


def linear_curves(result: Result, chart: xarray.Dataset) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The exact curves of a study stability of the same file, in the coordinates of the chart where they have any."""
    keys = chart.attrs["x_parameter"], chart.attrs["y_parameter"]
    if "stability" not in result.groups or keys not in (("k", "m"), ("drive_frequency", "drive_amplitude")):
        return
    stability = result.group("stability")
    for name in curve_names(stability):
        if exact_of(name) is not None or is_branch(stability, name):
            continue
        k, m = whole_curve(stability, name)
        if keys[0] == "k":
            yield k, m
            continue
        for sign in (-1, 1):  # about inverted, about down
            inside = sign * k > 0
            yield 1 / np.sqrt(sign * k[inside]), m[inside]


def panel(axes: Axes, result: Result, chart: xarray.Dataset, view: str, *, legend: bool = True,
          others: Iterable[str] = ()) -> Axes:
    """One start; `others`: kinds of motion of panels beside it."""
    for number, (x, y) in enumerate(linear_curves(result, chart)):
        axes.plot(x, y, color=style.INK, linewidth=0.8, label="_" * (number > 0) + LINEAR)
    if view == "ends":
        draw_ends(axes, chart, legend=legend, others=others)
    else:
        draw_number(axes, chart, view, legend=legend)
    axes.set(xlim=chart["x"].values[[0, -1]], ylim=chart["y"].values[[0, -1]])
    label_keys(axes, chart)
    speed = " rad/s" if unit_text(chart["start_velocity"]) == "rad/s" else ""
    axes.set_title(f"start: θ = {float(chart['start_theta']):g}, velocity {float(chart['start_velocity']):g}{speed}",
                   fontsize="medium")
    return axes


def draw(result: Result, *, view: str | None = None, measure: str | None = None, attractor: Sequence[str] | None = None,
         atlas: Path | None = None, si: bool = False) -> Figure:
    """The page: of a measure, or one panel for each start."""
    if view and (measure or attractor or atlas):
        raise BadOption("--view cannot be combined with --measure, --attractor or --atlas")
    chart = result.group("plane", si=si, written=True)
    if chart.sizes["x"] < 2 or chart.sizes["y"] < 2:
        raise BadFile(f"{result.path}: the chart has one value only along an axis, so there is no area to draw")
    if not view and (measure or attractor or atlas or "end" not in chart):
        return measure_page(result, chart, measure, attractor, atlas)
    if "end" not in chart:
        raise BadFile(f"{result.path}: the plane has no ends; add ends to sweep.measure")
    starts = [chart.isel(start=place) for place in range(chart.sizes["start"])]
    beside = len(starts) == 2 and not view and not current().narrow  # one legend is for both
    figure, panels = new_panels(9.4, 4.2, 1, 2, sharey=True) if beside else new_panels(8.2, 4.8 * len(starts),
                                                                                       len(starts))
    for start, axes in zip(starts, panels, strict=True):
        others = [name for one in starts for name in kinds(one)[1]] if beside else []
        panel(axes, result, start, view or "ends", legend=not beside or axes is panels[-1], others=others)
    if beside:
        panels[1].set_ylabel("")
    swept = {chart.attrs["x_parameter"], chart.attrs["y_parameter"]}
    names = {"beta": "β"} if swept & {"k", "m", "damping"} else {"quality_factor": "Q"}
    kept = [f"{symbol} = {result.pendulum[name]:.6g}" for name, symbol in names.items()
            if name in result.pendulum and not swept & {name, "damping"}]
    words = fixed_si(result, chart) if result.pivot_frequency else ",  ".join(kept)
    entitle(figure, result, f"{chart.sizes['x']} × {chart.sizes['y']} points", words)
    return figure
