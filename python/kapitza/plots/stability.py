"""Draws a stability chart of kapitza: zones, transition curves, and by how much the papers' formulas are off.

    kapitza plot stability butikov-fig01.h5                      zones and curves over (k, m)
    kapitza plot stability blackburn-fig02.h5 --view growth      the growth rate in the tongues
    kapitza plot stability blackburn-fig04.h5 --view frequency   down and inverted over the drive frequency
    kapitza plot stability paul-trap.h5 --view trap              where ions are held in both directions
    kapitza plot stability formula-errors.h5 --view errors       every formula against its exact curve
"""

import argparse
from collections.abc import Callable, Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from kapitza import style
from kapitza.plots.curves import (
    A_LABEL,
    Q_LABEL,
    axes_of,
    curve_names,
    draw_curves,
    exact_of,
    is_branch,
    lowest_point,
    whole_curve,
)
from kapitza.plots.formula_errors import error_figure
from kapitza.plots.page import current, entitle, new_panels
from kapitza.result import BadFile, Result

STUDY = "a stability chart"
STABLE = "#e4e9ee"
# View frequency: largest relative distance of neighbouring columns, and least number of them
WIDEST, FEWEST = 0.03, 40
RESTS = ("white", style.KINDS["inverted"], style.KINDS["down"], "#a9c8a4")  # stable: neither, inverted, down, both


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", choices=list(VIEWS))


def frame(axes: Axes, chart: xarray.Dataset) -> Axes:
    """The chart's edges and what its axes are."""
    across, up, xlabel, ylabel = axes_of(chart)
    axes.set(xlim=across * chart["k"].values[[0, -1]], ylim=up * chart["m"].values[[0, -1]], xlabel=xlabel,
             ylabel=ylabel)
    return axes


def draw_zones(axes: Axes, chart: xarray.Dataset, *, colours: Sequence[str] = ("white", STABLE),
               legend: bool = True) -> Axes:
    """Zones (colours: unstable, stable) and curves over (k, m)."""
    across, up, *_ = axes_of(chart)
    axes.pcolormesh(across * chart["k"], up * chart["m"], chart["stable"], cmap=ListedColormap(list(colours)), vmin=0,
                    vmax=1, shading="nearest", rasterized=True)
    draw_curves(axes, chart, legend=legend,
                zones=[Patch(facecolor=colours[1], edgecolor=style.FAINT, label="rest is stable")])
    mark_thresholds(axes, chart)
    return frame(axes, chart)


def mark_thresholds(axes: Axes, chart: xarray.Dataset) -> Axes:
    """The lowest points of the damped tongues; their numbers stand in the legend."""
    for tongue in (1, 2):
        lowest = lowest_point(chart, f"damped_{tongue}")
        if lowest is not None:
            across, up, *_ = axes_of(chart)
            axes.plot(across * lowest[0], up * lowest[1], "o", markersize=4, color=style.INK, zorder=5)
    return axes


def draw_growth(axes: Axes, chart: xarray.Dataset, *, colours: Sequence[str] = ("OrRd", "Blues"),
                legend: bool = True) -> Axes:
    """Growth rate per period in the tongues, Floquet angle between them (colours: names of their colour maps)."""
    across, up, *_ = axes_of(chart)
    stable = chart["stable"].values == 1
    growth = np.where(stable, np.nan, chart["log_multiplier"])
    angle = np.where(stable, chart["angle"], np.nan)
    for values, cmap, text in ((growth, colours[0], "growth: ln |multiplier| per period"),
                               (angle, colours[1], "Floquet angle / 2π")):
        image = axes.pcolormesh(across * chart["k"], up * chart["m"], values, cmap=cmap, shading="nearest",
                                rasterized=True, vmin=0)
        if legend:
            place = {"location": "bottom", "pad": 0.02} if current().narrow else {"pad": 0.01}
            axes.figure.colorbar(image, ax=axes, label=text, fraction=0.05, **place)
    for name in curve_names(chart):
        if exact_of(name) is None and not is_branch(chart, name):
            k, m = whole_curve(chart, name)
            axes.plot(across * k, up * m, color=style.INK, linewidth=0.7)
    return frame(axes, chart)


def draw_frequency(axes: Axes, chart: xarray.Dataset, *, colours: Sequence[str] = RESTS, legend: bool = True) -> Axes:
    """Which position is stable at drive frequency Omega: down is k = 1/Omega^2, inverted its negative."""
    if not chart.attrs.get("odd_harmonics", 1):
        raise BadFile("this view needs a wave form whose second half is its first one with the other sign")
    k = chart["k"].values
    down, inverted = columns_of_both(k)
    omega = 1 / np.sqrt(k[down])
    both = chart["stable"].values[:, inverted] + 2 * chart["stable"].values[:, down]
    axes.pcolormesh(omega, chart["m"], both, cmap=ListedColormap(list(colours)), vmin=0, vmax=3, shading="nearest",
                    rasterized=True)
    for name in curve_names(chart, "k"):
        for sign in (-1, 1):
            inside = (sign * k > 0) & np.isfinite(chart[name].values)
            if inside.any():
                axes.plot(1 / np.sqrt(np.abs(k[inside])), chart[name].values[inside], color=style.INK,
                          linestyle="-" if exact_of(name) is None else (0, (4, 2)), linewidth=0.9)
    if legend:
        _frequency_legend(axes, colours)
    axes.set(xlim=omega[[0, -1]], ylim=chart["m"].values[[0, -1]], xlabel="drive frequency Ω (natural frequencies)",
             ylabel="drive amplitude ε")
    return axes


def columns_of_both(k: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Columns of the chart at 1/Omega^2 and at -1/Omega^2, the frequencies upward; BadFile where there are too few.

    Stability is drawn where it was asked for alone: columns that are farther apart than WIDEST of their frequency are
    left out.
    """
    down = np.flatnonzero(k > 0)[::-1]
    inverted = np.array([np.abs(k + k[column]).argmin() for column in down], dtype=int)
    step = np.diff(k).min() if len(k) > 1 else 0
    paired = np.abs(k[inverted] + k[down]) <= 1e-6 * step
    near = np.append(1 - np.sqrt(k[down][1:] / k[down][:-1]) < WIDEST,
                     False) if len(down) else np.zeros(0, bool)
    keep = paired & np.logical_and.accumulate(near)
    if keep.sum() < FEWEST:
        raise BadFile("this view needs stability at k and at -k, close enough at small k; a scene with such a chart: "
                      "stability: {k: {min: -0.25, max: 0.25, count: 4001}, m: {min: 0, max: 0.6, count: 400}}")
    return down[keep], inverted[keep]


def draw_trap(axes: Axes, chart: xarray.Dataset, *, colours: Sequence[str] = RESTS, legend: bool = True) -> Axes:
    """Where a quadrupole holds ions: along one axis the field is (a, q), along the other (-a, -q)."""
    k = chart["k"].values
    opposite = np.searchsorted(k, -k - 1e-9 * np.ptp(k))
    if "a" not in chart or not np.allclose(k[opposite % len(k)], -k, rtol=0, atol=1e-9 * np.ptp(k)):
        raise BadFile("this view needs axes a and q, and as many values of a below 0 as above; such a chart: "
                      "stability: {a: {min: -1, max: 1, count: 401}, q: {min: 0, max: 2, count: 401}}")
    if not chart.attrs.get("odd_harmonics", 1):
        raise BadFile("this view needs a wave form whose second half is its first one with the other sign")
    stable = chart["stable"].values
    axes.pcolormesh(2 * chart["m"], 4 * k, (stable[:, opposite] + 2 * stable).T, cmap=ListedColormap(list(colours)),
                    vmin=0, vmax=3, shading="nearest", rasterized=True)
    for name in curve_names(chart):
        if exact_of(name) is None:
            k_of, m_of = whole_curve(chart, name)
            for sign in (-1, 1):
                axes.plot(2 * m_of, sign * 4 * k_of, color=style.INK, linewidth=0.9)
    if legend:
        patches = _patches(colours, ("neither", "y alone", "x alone", "both: trapped"))
        axes.legend(handles=patches, loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small", title="stable along",
                    title_fontsize="small")
    axes.set(xlim=2 * chart["m"].values[[0, -1]], ylim=4 * k[[0, -1]], xlabel=Q_LABEL, ylabel=A_LABEL)
    return axes


def _patches(colours: Sequence[str], words: Sequence[str]) -> list[Patch]:
    """Entries of a legend, the empty one last."""
    rows = list(zip(colours, words, strict=True))
    return [Patch(facecolor=colour, edgecolor=style.FAINT, label=text) for colour, text in [*rows[1:], rows[0]]]


def _frequency_legend(axes: Axes, colours: Sequence[str]) -> None:
    patches = _patches(colours, ("neither", "inverted", "down", "both"))
    lines = [Line2D([], [], color=style.INK, linewidth=0.9, label="exact"),
             Line2D([], [], color=style.INK, linewidth=0.9, linestyle=(0, (4, 2)), label="formulas of a paper")]
    axes.legend(handles=[*patches, *lines], loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small",
                title="stable at rest", title_fontsize="small")


def _page(panel: Callable[..., Axes]) -> Callable[[xarray.Dataset], Figure]:
    """What makes a page of one panel."""
    def make(chart: xarray.Dataset) -> Figure:
        figure, (axes,) = new_panels(8.2, 4.8)
        panel(axes, chart)
        return figure
    return make


VIEWS = {"zones": _page(draw_zones), "growth": _page(draw_growth), "frequency": _page(draw_frequency),
         "trap": _page(draw_trap), "errors": error_figure}


def damping_text(chart: xarray.Dataset) -> str:
    if "quality_factor" in chart.attrs:
        return f"Q = {chart.attrs['quality_factor']:g}"
    return f"β = {chart.attrs['damping']:g}" if chart.attrs.get("damping", 0) > 0 else "no damping"


def draw(result: Result, *, view: str = "zones") -> Figure:
    """The page of the view that was asked for."""
    chart = result.group("stability")
    if chart.sizes["k"] < 2 or chart.sizes["m"] < 2:
        raise BadFile(f"{result.path}: the chart has one value only along an axis, so there is no area to draw")
    figure = VIEWS[view](chart)
    entitle(figure, result, f"{chart.sizes['k']} x {chart.sizes['m']} points", damping_text(chart))
    return figure
