"""Draws a sweep of kapitza: quantities along one parameter of the pendulum.

    kapitza plot sweep blackburn-walk.h5                       basins along the parameter, branches under them
    kapitza plot sweep blackburn-fig10.h5 --view flutter       amplitude of the flutter, and its square
    kapitza plot sweep blackburn-fig06-omega11.h5              releases from rest that stay
    kapitza plot sweep bifurcation.h5                          strobe points, up and down
    kapitza plot sweep FILE --view phases                      how much ends alike at all phases of release
    kapitza plot sweep FILE --view branches                    one view of a file that holds several
"""

import argparse
from collections.abc import Callable, Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from kapitza import style
from kapitza.flutter import flutter
from kapitza.plots.branches import (
    attracting_branches,
    branch_colours,
    draw_lives,
    draw_shares,
    named_branches,
    parameter_text,
)
from kapitza.plots.flutter import draw_amplitude, draw_square
from kapitza.plots.page import current, entitle, new_panels
from kapitza.plots.units import fixed_si
from kapitza.result import BadFile, Result
from kapitza.units import drive_unit, in_degrees

STUDY = "a sweep"
UP, DOWN = "#2f6db3", "#c2452f"
STAYS = "#f2d08a"
NARROWEST = 0.04                                        # least part of the circle, in units of pi
PI_STEPS = [1 / 4, 1 / 8, 1 / 16, 1 / 32, 0.01]         # between ticks, in parts of pi: the last one for the narrowest
DEGREE_STEPS = [45, 15, 5, 2]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", choices=[name for name, _, _ in VIEWS], help="default: the first that the file has")
    parser.add_argument("--degrees", action="store_true",
                        help="strobe points and squared amplitudes in degrees too, as all other angles are")


def draw_releases(axes: Axes, sweep: xarray.Dataset, *,
                  colours: tuple[str, str, str, str] = (STAYS, style.FAINT, DOWN, style.INK),
                  legend: bool = True) -> Axes:
    """The set of releases that stay, its last edge, what a scan finds, its first gap (colours: of these four)."""
    value, angle = sweep["value"].values, in_degrees(sweep["release"])
    edges = np.concatenate([value[:1], (value[1:] + value[:-1]) / 2, value[-1:]])
    stays = np.where(sweep["release_stays"].values.T == 1, 1.0, np.nan)
    axes.pcolormesh(edges, np.concatenate([[angle[0] / 2], angle + angle[0] / 2]), stays,
                    cmap=ListedColormap([colours[0]]), rasterized=True)
    axes.plot(value, in_degrees(sweep["release_angle_largest"]), "_", color=colours[1], markersize=3,
              label="last angle that stays")
    axes.plot(value, in_degrees(sweep["release_angle_scan"]), ".", color=colours[2], markersize=4,
              label="first failure of a scan in whole degrees")
    axes.plot(value, in_degrees(sweep["release_angle"]), color=colours[3], lw=1.1, label="first gap")
    if legend:
        handles = [*axes.get_legend_handles_labels()[0], Patch(color=colours[0], label="releases that stay")]
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    top = np.nanmax(in_degrees(sweep["release_angle_largest"]))
    axes.set(xlabel=parameter_text(sweep), ylabel="release angle from inverted (deg)", ylim=(0, min(180, 1.35 * top)))
    return axes


def draw_alike(axes: Axes, sweep: xarray.Dataset, *, colours: str = UP, legend: bool = True) -> Axes:
    """The share that ends alike at all phases of release over the parameter, with its 95 % interval."""
    value, share, low, high = (sweep[name].values for name in ("value", "alike", "alike_low", "alike_high"))
    axes.fill_between(value, 100 * low, 100 * high, color=colours, alpha=0.25, lw=0, label="95 % interval")
    axes.plot(value, 100 * share, color=colours, marker="o", markersize=3,
              label=f"alike at all {sweep.attrs['phases']} phases")
    axes.set(xlabel=parameter_text(sweep), ylabel="share of the starts (%)", xlim=(value[0], value[-1]), ylim=(0, None))
    if legend:
        axes.legend(fontsize="small")
    return axes


def draw_strobe(axes: Axes, sweep: xarray.Dataset, *, up: bool = True, colours: str | None = None,
                legend: bool = True) -> Axes:
    """Strobe points of the walk up or down over the parameter, inverted in the middle; `legend`: which walk, as the
    title."""
    value, walk, rad = sweep["value"].values, sweep["sample_walk"].values, drive_unit(sweep["strobe_theta"])
    points = np.mod(sweep["strobe_theta"].values, 2 * np.pi * rad)[:, walk == (0 if up else 1)]
    size = float(np.clip(60 / np.sqrt(points.size), 1.2, 3.2))
    axes.plot(np.repeat(value, points.shape[1]), points.ravel(), "o", markersize=size, markeredgewidth=0,
              color=colours or (UP if up else DOWN), rasterized=True)
    if legend:
        axes.set_title("going up" if up else "going down", fontsize="medium", fontweight="normal")
    axes.set(xlabel=parameter_text(sweep), ylabel="θ at the strobe", xlim=(value[0], value[-1]))
    axes.set_ylim(strobe_range(sweep))
    if rad == 1:
        show_angles(axes, np.pi, PI_STEPS, lambda tick: f"{tick:.2f}π" if 32 * tick % 1 else style.pi_text(tick))
    else:
        show_angles(axes, 1, DEGREE_STEPS, lambda tick: f"{tick:g}°")
    return axes


def show_angles(axes: Axes, unit: float, steps: Sequence[float], text: Callable[[float], str]) -> None:
    """Ticks of angles within the limits: the widest of the steps (in units) that gives three of them."""
    low, high = np.array(axes.get_ylim()) / unit
    inside = (np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step for step in steps)
    ticks = next(found for found in inside if len(found) >= 3)
    axes.set_yticks(ticks * unit, [text(float(tick)) for tick in ticks])
    axes.set_ylim(low * unit, high * unit)


def strobe_range(sweep: xarray.Dataset) -> tuple[float, float]:
    """What of the circle the strobe points of both walks take, with a margin; the whole where they take most of it."""
    half = np.pi * drive_unit(sweep["strobe_theta"])
    points = np.mod(sweep["strobe_theta"].values, 2 * half) / half
    low, high = (float(edge) for edge in (np.nanmin(points), np.nanmax(points)))
    margin = max(0.1 * (high - low), NARROWEST / 2)
    return ((low - margin) * half, (high + margin) * half) if high - low < 1 else (0, 2 * half)


def fractions_figure(sweep: xarray.Dataset) -> Figure:
    """Shares of the starts; under them the lives of the branches that the legend names."""
    named = named_branches(sweep)
    figure, (top, bottom) = new_panels(8.6, 8.2, 2, sharex=True, height_ratios=[3, 2])
    colours = branch_colours(sweep, named)
    draw_shares(top, sweep, colours=colours)
    draw_lives(bottom, sweep, colours=colours, only=named, names=True)
    top.set_xlabel("")
    return figure


def branches_figure(sweep: xarray.Dataset) -> Figure:
    """The life of every branch, named, and where it repels."""
    width, line = (6.4, 0.18) if current().narrow else (8.6, 0.16)
    figure, (axes,) = new_panels(width, 1.6 + line * len(attracting_branches(sweep)))
    draw_lives(axes, sweep, names=True)
    return figure


def flutter_figure(sweep: xarray.Dataset) -> Figure:
    """Amplitude and its square side by side; one above the other on a narrow page."""
    figure, (left, right) = new_panels(6.4, 8, 2) if current().narrow else new_panels(9, 3.9, 1, 2)
    found = flutter(sweep)
    draw_amplitude(left, found)
    draw_square(right, found)
    return figure


def one_panel(panel: Callable[..., Axes], width: float, height: float,
              **options: bool) -> Callable[[xarray.Dataset], Figure]:
    """What makes a page of one panel."""
    def make(sweep: xarray.Dataset) -> Figure:
        figure, (axes,) = new_panels(width, height)
        panel(axes, sweep, **options)
        return figure
    return make


def strobe_figure(sweep: xarray.Dataset) -> Figure:
    """The walk up above the walk down."""
    figure, (above, below) = new_panels(8.6, 7, 2, sharex=True, sharey=True)
    draw_strobe(above, sweep)
    draw_strobe(below, sweep, up=False)
    above.set_xlabel("")
    return figure


# name, a variable that it needs, what makes its page
VIEWS: list[tuple[str, str, Callable[[xarray.Dataset], Figure]]] = [
    ("fractions", "fraction", fractions_figure),
    ("phases", "alike", one_panel(draw_alike, 8.6, 4.4)),
    ("branches", "branch_start", branches_figure),
    ("flutter", "branch_amplitude", flutter_figure),
    ("releases", "release_stays", one_panel(draw_releases, 10, 4.8)),
    ("strobe", "strobe_theta", strobe_figure),
    ("up", "strobe_theta", one_panel(draw_strobe, 8.6, 4.2, legend=False)),
]


def chosen_view(result: Result, sweep: xarray.Dataset, wanted: str | None) -> Callable[[xarray.Dataset], Figure]:
    """The function that draws the view asked for, or the first one that the file has."""
    there = {name: draw for name, variable, draw in VIEWS if variable in sweep}
    if not there:
        raise BadFile(f"{result.path}: the sweep contains no measure")
    if wanted and wanted not in there:
        raise BadFile(f"{result.path}: has no {wanted}; it has {', '.join(there)}")
    return there[wanted or next(iter(there))]


def fixed_text(result: Result, sweep: xarray.Dataset) -> str:
    """The parameters that were not swept: in SI if the scene is, else where the papers' symbols are defined."""
    swept = sweep.attrs["parameter"]
    if result.pivot_frequency:
        return fixed_si(result, sweep)
    names = {"quality_factor": "Q", "drive_frequency": r"$\Omega$", "drive_amplitude": r"$\epsilon$"}
    if not result.pendulum.get("drive_amplitude", np.nan):  # a pivot at rest, under a torque
        names = {"beta": r"$\beta$"}
    kept = [f"{symbol} = {result.pendulum[name]:.6g}" for name, symbol in names.items()
            if name != swept and np.isfinite(result.pendulum.get(name, np.nan))]
    return ",  ".join(kept)


def draw(result: Result, *, view: str | None = None, degrees: bool = False) -> Figure:
    """The page of the view that was asked for, or of the first that the file has."""
    sweep = result.group("sweep", degrees=degrees, written=True)
    figure = chosen_view(result, sweep, view)(sweep)
    entitle(figure, result, f"{sweep.sizes['value']} values", fixed_text(result, sweep))
    return figure
