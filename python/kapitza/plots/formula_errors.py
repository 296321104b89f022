"""By how much the papers' formulas of transition curves are off."""

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from kapitza.plots.curves import K_LABEL, LABELS, M_LABEL, curve_names, exact_of, label
from kapitza.plots.page import current, new_panels
from kapitza.result import BadFile

MAP = "plasma_r"


def errors_of(chart: xarray.Dataset) -> dict[tuple[str, str], np.ndarray]:
    """(formula, exact curve) -> relative error of m over k; NaN where either is not known."""
    pairs = [(name, exact) for name in curve_names(chart, "k") if (exact := exact_of(name)) and exact in chart]
    with np.errstate(divide="ignore", invalid="ignore"):
        return {(name, exact): np.maximum(np.abs(chart[name].values / chart[exact].values - 1), 1e-12) for name,
                exact in pairs}


def draw_error_rows(axes: Axes, chart: xarray.Dataset, *, colours: str = MAP, legend: bool = True) -> Axes:
    """A bar of colours over k for each formula; `legend`: above it, what it stands for."""
    errors, k = errors_of(chart), chart["k"].values
    rows = np.full((2 * len(errors), len(k)), np.nan)
    rows[1::2] = list(errors.values())  # the empty rows between are for words
    axes.pcolormesh(k, np.arange(len(rows)) / 2, rows, cmap=colours, norm=LogNorm(1e-8, 1), shading="nearest",
                    rasterized=True)
    for row, pair in enumerate(errors if legend else ()):
        axes.text(0.01, row, error_label(*pair), transform=axes.get_yaxis_transform(), va="center",
                  fontsize="x-small" if current().narrow else "small")
    axes.set_yticks([])
    axes.invert_yaxis()
    axes.set_xlabel(K_LABEL)
    return axes


def draw_error_curves(axes: Axes, chart: xarray.Dataset, *, colours: str = MAP, legend: bool = True) -> Axes:
    """The exact curves in the colours of their formulas' errors, the best on top; `legend`: the bar of colours."""
    k, norm = chart["k"].values, LogNorm(1e-8, 1)
    for (_, exact), error in sorted(errors_of(chart).items(), key=lambda row: -np.nanmax(row[1])):
        points = np.column_stack([k, chart[exact].values])
        known = np.isfinite(error[:-1] + error[1:])
        lines = LineCollection(list(np.stack([points[:-1], points[1:]], axis=1)[known]), cmap=colours, norm=norm,
                               linewidth=2.6)
        lines.set_array(error[:-1][known])
        axes.add_collection(lines)
    axes.set(xlim=k[[0, -1]], ylim=chart["m"].values[[0, -1]], xlabel=K_LABEL, ylabel=M_LABEL)
    if legend:
        axes.figure.colorbar(axes.collections[-1], ax=axes, label="relative error of m", extend="both", pad=0.01)
    return axes


def error_figure(chart: xarray.Dataset) -> Figure:
    """Rows and curves side by side."""
    if not errors_of(chart):
        raise BadFile("this view needs curves by formulas together with the exact curves; add both to stability.curves")
    figure, (left, right) = (new_panels(6.4, 14, 2, height_ratios=[2, 1]) if current().narrow else
                             new_panels(12.5, 11, 1, 2, width_ratios=[3, 2]))
    draw_error_rows(left, chart)
    draw_error_curves(right, chart)
    return figure


def error_label(name: str, exact: str) -> str:
    """What a formula says, and whose it is: inverted stands above it (Butikov Eq. 3)."""
    curve = label(exact).removesuffix("_upper").split(": ")[-1] + (", upper" if exact.endswith("_upper") else "")
    formula = label(name).split(", ", 1)[-1] if "subharmonic" in name else LABELS.get(name.removesuffix("_upper"),
                                                                                      label(name))
    return f"{curve} ({formula})"
