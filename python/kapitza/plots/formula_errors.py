"""By how much the papers' formulas of transition curves are off."""

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from kapitza.plots.common import new_figure
from kapitza.plots.curves import K_LABEL, LABELS, M_LABEL, curve_names, exact_of, label
from kapitza.plots.page import current
from kapitza.result import BadFile

MAP = "plasma_r"


def errors_of(chart: xarray.Dataset) -> dict[tuple[str, str], np.ndarray]:
    """(formula, exact curve) -> relative error of m over k; NaN where either is not known."""
    pairs = [(name, exact) for name in curve_names(chart) if (exact := exact_of(name)) and exact in chart]
    with np.errstate(divide="ignore", invalid="ignore"):
        return {(name, exact): np.maximum(np.abs(chart[name].values / chart[exact].values - 1), 1e-12) for name, exact in pairs}


def draw_error_rows(axes: Axes, chart: xarray.Dataset, *, colours: str = MAP, legend: bool = True) -> Axes:
    """A row of colours over k for each formula; `legend`: the formulas' names beside the rows."""
    errors = errors_of(chart)
    axes.pcolormesh(chart["k"].values, np.arange(len(errors)), np.array(list(errors.values())), cmap=colours, norm=LogNorm(1e-8, 1),
                    shading="nearest", rasterized=True)
    axes.set_yticks(range(len(errors)), [error_label(*pair) if legend else "" for pair in errors],
                    fontsize="x-small" if current().narrow else "medium")
    axes.set_yticks(np.arange(len(errors) + 1) - 0.5, minor=True)
    axes.grid(axis="y", which="minor", color="white", linewidth=3)
    axes.tick_params(which="both", length=0, axis="y")
    axes.invert_yaxis()
    axes.set_xlabel(K_LABEL)
    return axes


def draw_error_curves(axes: Axes, chart: xarray.Dataset, *, colours: str = MAP, legend: bool = True) -> Axes:
    """The exact curves in the colours of their formulas' errors, the best on top; `legend`: the bar of colours."""
    k, norm = chart["k"].values, LogNorm(1e-8, 1)
    for (_, exact), error in sorted(errors_of(chart).items(), key=lambda row: -np.nanmax(row[1])):
        points = np.column_stack([k, chart[exact].values])
        known = np.isfinite(error[:-1] + error[1:])
        lines = LineCollection(list(np.stack([points[:-1], points[1:]], axis=1)[known]), cmap=colours, norm=norm, linewidth=2.6)
        lines.set_array(error[:-1][known])
        axes.add_collection(lines)
    axes.set(xlim=k[[0, -1]], ylim=chart["m"].values[[0, -1]], xlabel=K_LABEL, ylabel=M_LABEL)
    if legend:
        axes.figure.colorbar(axes.collections[-1], ax=axes, label="relative error of m by the formula", extend="both", pad=0.01)
    return axes


def error_figure(chart: xarray.Dataset) -> Figure:
    """Rows and curves side by side."""
    if not errors_of(chart):
        raise BadFile("this view needs formulas beside their exact curves")
    narrow = current().narrow
    figure = new_figure(6.4, 14) if narrow else new_figure(12.5, 5.4)
    left, right = figure.subplots(2, 1, height_ratios=[2, 1]) if narrow else figure.subplots(1, 2, width_ratios=[3, 2])
    draw_error_rows(left, chart)
    draw_error_curves(right, chart)
    return figure


def error_label(name: str, exact: str) -> str:
    """Butikov Eq. 21: order 6: which formula stands for which curve."""
    branch = ", upper" if exact.endswith("_upper") else ""
    number = label(name).split(", ")[-1] if "subharmonic" in name else label(name)
    number = LABELS.get(name.removesuffix("_upper"), number)
    return f"{number}: {label(exact).split(':')[0].replace('subharmonic of order', 'order')}{branch}"
