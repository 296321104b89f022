"""Draws an atlas of kapitza: motions over a plane of two keys of the pendulum.

    kapitza plot atlas atlas-blackburn.h5                      the map: the curves, over what lives where
    kapitza plot atlas atlas-blackburn.h5 --view motions       small maps: where each motion attracts
    kapitza plot atlas atlas-blackburn.h5 --view line --x 11
        all branches along the line where x is 11; those that repel are dashed
    kapitza plot atlas atlas-blackburn.h5 --longest 2          cycles of up to two periods alone
    kapitza plot atlas atlas-blackburn.h5 --points fig4.csv    with published points on top
    kapitza plot atlas atlas-blackburn.h5 --theme dark         on dark paper, for slides
"""

import argparse
import math
from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from kapitza import style
from kapitza.plots.atlas_classes import (
    BREAKING,
    DOUBLING,
    FOLD,
    LEANS,
    SWINGS,
    belongs,
    centre_of,
    gives_birth,
    missing_text,
    motion_text,
)
from kapitza.plots.atlas_curves import DASHES, GREY, curve_points, mark_curves
from kapitza.plots.atlas_labels import LIVING, kind_colours, label_areas, living, mark_points
from kapitza.plots.atlas_line import draw_line
from kapitza.plots.page import BadOption, entitle, new_panels
from kapitza.plots.parameter_axes import key_text
from kapitza.result import Result

NOT_KNOWN, UNKNOWN = 255, "#e7b9c4"  # `attracting` where a curve is missing, and its colour
LONGEST = 16  # periods of the cycles whose curves are drawn
STUDY = "an atlas"
VIEWS = ("map", "motions", "line")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", choices=VIEWS)
    parser.add_argument("--longest", type=int, help="longest period of the cycles that are drawn")
    parser.add_argument("--x", type=float,
                        help="the line of the view `line`: value of the key along the horizontal axis, "
                        "in the unit of that axis")
    parser.add_argument("--y", type=float,
                        help="or of that along the vertical axis (default: the middle of the horizontal one)")
    parser.add_argument("--points", metavar="CSV",
                        help="points on the map, with the columns x, y and label; points with one label have "
                        "one mark")
    parser.add_argument("--theme", choices=("light", "dark"), help="the paper")


def set_axes(axes: Axes, atlas: xarray.Dataset, *, labels: bool = True) -> None:
    """Limits and names; frequencies over a wide range have a logarithmic axis."""
    for which, cells in (("x", "column"), ("y", "row")):
        key, values = atlas.attrs[f"{which}_parameter"], atlas[cells].values
        half = (values[1] - values[0]) / 2
        low, high = values[0] - half, values[-1] + half
        if which == "x" and "frequency" in key and low > 0 and high / low > 4:
            axes.set_xscale("log")
            decade = 10 ** math.floor(math.log10(low))
            ticks = [tick * scale for scale in (decade, 10 * decade) for tick in (1, 2, 3, 4, 5, 6, 8, 10, 15)
                     if low <= tick * scale <= high]
            axes.xaxis.set_major_locator(FixedLocator(sorted(set(ticks))))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_locator(NullLocator())
        (axes.set_xlim if which == "x" else axes.set_ylim)(low, high)
        if labels:
            (axes.set_xlabel if which == "x" else axes.set_ylabel)(key_text(atlas, which))


def write_legend(axes: Axes, atlas: xarray.Dataset, kinds: np.ndarray, shades: list[str], marks: list[Line2D]) -> None:
    """Beside the map: what lives where, the kinds of curves, the marks."""
    there = np.unique(kinds)
    handles: list[Patch | Line2D] = [Patch(facecolor=shades[i], edgecolor=style.INK, linewidth=0.4, label=text)
                                     for i, text in enumerate(LIVING.values()) if i in there]
    if (kinds < 0).any():
        handles.append(Patch(facecolor=UNKNOWN, label="not known: a curve is missing"))
    words = {SWINGS: "rest: period doubling", LEANS: "rest: pitchfork", FOLD: "fold", DOUBLING: "period doubling",
             BREAKING: "symmetry breaking"}
    drawn = set(atlas["curve_kind"].values.tolist())
    handles += [Line2D([], [], color=style.INK if kind in (SWINGS, LEANS) else GREY,
                       linewidth=1.2 if kind in (SWINGS, LEANS) else 0.8,
                       linestyle=DASHES[kind], label=word) for kind, word in words.items() if kind in drawn]
    axes.legend(handles=handles + marks, loc="upper left", bbox_to_anchor=(1.02, 1), handlelength=2, borderaxespad=0,
                frameon=False)


def draw_map(axes: Axes, atlas: xarray.Dataset, *, colours: Mapping[str, str] | None = None, legend: bool = True,
             longest: int = LONGEST, points: str | None = None) -> Axes:
    """The plane with the curves of cycles of up to `longest` periods. Each cell has the colour of the first kind of
    motion of LIVING that attracts there: `colours` (kind -> colour), else light shades of those of all pictures.

    `points`: a CSV file of points on top.
    """
    kinds, shades = living(atlas), kind_colours(colours or {})
    axes.set_facecolor(UNKNOWN if (kinds < 0).any() else "white")
    axes.pcolormesh(atlas["column"], atlas["row"], np.ma.masked_less(kinds, 0), cmap=ListedColormap(shades), vmin=0,
                    vmax=len(LIVING), shading="nearest", rasterized=True)
    set_axes(axes, atlas)
    mark_curves(axes, atlas, longest)
    label_areas(axes, atlas, kinds)
    marks = mark_points(axes, points) if points else []
    if legend:
        write_legend(axes, atlas, kinds, shades, marks)
    return axes


def map_page(result: Result, atlas: xarray.Dataset, longest: int, points: str | None = None) -> Figure:
    """The plane with its curves; `points`: a CSV file of points on top."""
    figure, (axes,) = new_panels(8.6, 5.6)
    draw_map(axes, atlas, longest=longest, points=points)
    longest_sought = int(atlas.attrs["max_period"])
    entitle(figure, result,
            f"motions of up to {longest_sought} periods: {atlas.sizes['curve']} curves{missing_text(atlas)}")
    return figure


def motions(atlas: xarray.Dataset) -> list[int]:
    """The classes that fill most of the plane, the shortest first: what small maps show."""
    attracting = atlas["attracting"].values
    filled = ((attracting > 0) & (attracting != NOT_KNOWN)).mean(axis=(1, 2))
    chosen = [i for i in np.argsort(-filled, kind="stable")[:12] if filled[i] > 0]
    return sorted(chosen)


def motions_page(result: Result, atlas: xarray.Dataset) -> Figure:
    """Small maps, one for each motion, with its own curves and those where it branches off another motion."""
    chosen = motions(atlas)
    columns = 4 if len(chosen) > 6 else max(1, min(3, len(chosen)))
    rows = max(1, math.ceil(len(chosen) / columns))
    figure, panels = new_panels(9.2, 2.1 * rows + 0.5, rows, columns, sharex=True, sharey=True)
    for axes, number in zip(panels, chosen, strict=False):
        attracting = atlas["attracting"].values[number]
        known = attracting != NOT_KNOWN
        axes.set_facecolor("white" if known.all() else UNKNOWN)
        centre = centre_of(atlas["class_name"].values[number])
        colour = style.motion_colour(int(atlas["class_period"][number]), int(atlas["class_winding"][number]), centre)
        shades = ListedColormap(["white", style.shade(colour, 0.35), colour, style.shade(colour, -0.25)])
        axes.pcolormesh(atlas["column"], atlas["row"], np.ma.masked_where(~known, np.clip(attracting, 0, 3)),
                        cmap=shades, vmin=0, vmax=3, shading="nearest", rasterized=True)
        for curve in range(atlas.sizes["curve"]):
            if belongs(atlas, curve, number) or gives_birth(atlas, curve, number):
                axes.plot(*curve_points(atlas, curve), color=style.INK, linewidth=0.7,
                          linestyle=DASHES[int(atlas["curve_kind"][curve])])
        set_axes(axes, atlas, labels=False)
        axes.set_title(motion_text(style.name_text(atlas["class_name"].values[number])), fontsize="medium", loc="left")
    for axes in panels[len(chosen):]:
        axes.set_visible(False)
    for axes in panels[max(0, len(chosen) - columns):len(chosen)]:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel(key_text(atlas, "x"))
    entitle(figure, result, "where each motion attracts; deeper shades: two or more of them")
    return figure


def line_page(result: Result, atlas: xarray.Dataset, x: float | None, y: float | None, longest: int) -> Figure:
    """One line through the map as a bifurcation diagram."""
    middle = float(atlas["column"].values[[0, -1]].mean())
    fixed, varies, value = ("y", "x", y) if y is not None else ("x", "y", middle if x is None else x)
    unit = str(atlas.attrs.get(f"{fixed}_units", "1"))
    figure, (axes,) = new_panels(8.6, 5.4)
    # Units of the program in one unit of an axis
    scale = {which: float(atlas.attrs.get(f"{which}_written_scale", 1)) for which in "xy"}
    table = result.line(**{fixed: value * scale[fixed]})
    table["value"] /= scale[varies]
    draw_line(axes, table[table["period"] <= longest])
    axes.set_xlabel(key_text(atlas, varies))
    half = (atlas["row" if varies == "y" else "column"].values[[0, -1]])
    axes.set_xlim(half[0] - (half[1] - half[0]) / 2000, half[1] + (half[1] - half[0]) / 2000)
    entitle(figure, result, f"all cycles of up to {min(longest, int(atlas.attrs['max_period']))} periods where "
            f"{atlas.attrs[f'{fixed}_parameter'].replace('_', ' ')} is {value:g}{'' if unit == '1' else f' {unit}'}",
            "solid: attracts; dashed: repels")
    return figure


def draw(result: Result, *, view: str = "map", longest: int = LONGEST, x: float | None = None, y: float | None = None,
         points: str | None = None) -> Figure:
    """The page of the view that is asked for."""
    if x is not None and y is not None:
        raise BadOption("a line has --x or --y, not both")
    atlas = result.group("atlas", written=True)
    if view == "line":
        return line_page(result, atlas, x, y, longest)
    return map_page(result, atlas, longest, points) if view == "map" else motions_page(result, atlas)
