"""Draws the basins of two results side by side, and where they differ.

    kapitza plot compare ONE.h5 OTHER.h5
        attractors matched by their strobe points, in the colours of the first
    kapitza plot compare ONE.h5 OTHER.h5 --centre inverted --width 178mm
"""

import argparse

import numpy as np
import pandas
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from kapitza import style
from kapitza.compare import Comparison
from kapitza.plots.basin import draw_basins, write_legend
from kapitza.plots.page import Picture, current, entitle, new_panels, title_text
from kapitza.plots.units import add_si
from kapitza.plots.window_axes import Plane, label_axes
from kapitza.result import BadFile, Result
from kapitza.units import in_units

STUDY, LEGEND = "a basin", "below"
DIFFERENT = style.INK


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("other", help="result file with the other basin")
    parser.add_argument("--centre", choices=["down", "inverted"],
                        help="state in the middle of a whole circle (default: down)")
    add_si(parser, "velocities in rad/s")


def matched_colours(comparison: Comparison) -> tuple[list[str], list[str]]:
    """A colour for each attractor of the first, and of the second: the same for the same motion."""
    first = style.colours(comparison.first.group("attractors"))
    second = style.colours(comparison.second.group("attractors"))
    for one, other in comparison.matched.items():
        second[other] = first[one]
    return first, second


def draw_differing(axes: Axes, comparison: Comparison, *, colours: str = DIFFERENT, legend: bool = True,
                   centre: str = "down", si: bool = False) -> Axes:
    """The cells that end elsewhere, in one colour on white; `legend`: with their share; `si`: velocities in rad/s."""
    cells = in_units(comparison.cells, comparison.first.pivot_frequency) if si else comparison.cells
    plane, differing = Plane(cells, centre), comparison.differing.values
    plane.show(axes, np.where(differing[:, plane.order, None], to_rgb(colours), to_rgb("white")))
    if legend:
        write_legend(axes, [(colours, "ends elsewhere", float(differing.mean()))])
    return label_axes(axes, plane)


def comparison_panels(comparison: Comparison, centre: str, si: bool = False) -> Figure:
    """Three panels: first, second, difference; one above the other on a narrow page."""
    plane = Plane(comparison.first.group("basin"), centre)
    narrow = current().narrow
    figure, panels = (new_panels(6.4, 3 * 4.0 * plane.shape + 1.2, 3, sharex=True) if narrow else
                      new_panels(14.0, 4.0 * plane.shape + 1.2, 1, 3, sharey=True))
    for axes, result, colours in zip(panels, (comparison.first, comparison.second), matched_colours(comparison),
                                     strict=False):
        basin, attractors = result.group("basin", si=si), result.group("attractors", si=si)
        draw_basins(axes, basin, attractors, colours=colours, centre=centre, legend=False, dots=False)
        axes.set_title(_difference(result, comparison), fontsize="medium", fontweight="normal", parse_math=False)
    draw_differing(panels[2], comparison, centre=centre, legend=False, si=si)
    panels[2].set_title(f"{style.share_text(comparison.differing_share)} end elsewhere", fontsize="medium",
                        fontweight="normal")
    for axes in panels[1:] if not narrow else ():
        axes.set_ylabel("")
    for axes in panels[:-1] if narrow else ():
        axes.set_xlabel("")
    _write_both(panels[-1], comparison)
    entitle(figure, comparison.first, "shares of the starts: first → second")
    if comparison.first.title != comparison.second.title and isinstance(
        figure, Picture) and figure.heading and not current().heading:
        figure.heading.set_text(f"{title_text(comparison.first)} → {title_text(comparison.second)}")
    return figure


def _write_both(axes: Axes, comparison: Comparison) -> None:
    """The legend: every motion that has a permille of one of the two planes, with its shares in both."""
    first, second = matched_colours(comparison)
    rows = comparison.table[comparison.table[["fraction_first", "fraction_second"]].max(axis="columns") >= 0.001]
    patches = []
    for _, row in rows.sort_values("fraction_first", ascending=False, kind="stable").iterrows():
        mine = not pandas.isna(row["first"])
        index = int(row["first" if mine else "second"])
        colour = (first if mine else second)[index]
        shares = f"{style.share_text(row['fraction_first'])} → {style.share_text(row['fraction_second'])}"
        name = row["name"] if list(rows["name"]).count(row["name"]) == 1 else f"{row['name']} ({index})"
        patches.append(Patch(facecolor=colour, edgecolor=style.INK, linewidth=0.5,
                             label=f"{style.name_text(name)} {shares}"))
    axes.legend(handles=patches, loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")


def _difference(result: Result, comparison: Comparison) -> str:
    """What of the pendulum tells this result from the other one; else its title."""
    pair = comparison.first.pendulum, comparison.second.pendulum
    known = [key for key in ("drive_amplitude", "drive_frequency", "quality_factor", "m", "k", "beta")
             if key in result.pendulum]
    papers = [key for key in known if key in ("drive_amplitude", "drive_frequency", "quality_factor")] or known
    words = [f"{key.replace('_', ' ')} {result.pendulum[key]:.6g}" for key in papers
             if pair[0].get(key) != pair[1].get(key)]
    return ", ".join(words) or (title_text(result) if comparison.first.title != comparison.second.title
                                else str(result.path.name))


def draw(result: Result, *, other: Result | str, centre: str = "down", si: bool = False) -> Figure:
    """The page of the two results."""
    comparison = result.compare(other)
    files = f"{result.path}, {comparison.second.path}"
    if si and result.pivot_frequency != comparison.second.pivot_frequency:
        raise BadFile(f"{files}: their pivots have different frequencies, so that a cell is not the same start in "
                      "rad/s; leave out --si")
    try:
        comparison.differing  # noqa: B018  # which needs one window
    except ValueError as error:
        raise BadFile(f"{files}: {error}") from error
    return comparison_panels(comparison, centre, si)
