"""Draws the basins of attraction in a result file of kapitza.

    kapitza plot basin blackburn-fig12.h5                              every basin in its colour
    kapitza plot basin blackburn-fig12.h5 --attractor inverted         one basin, black on white, as the papers print it
    kapitza plot basin blackburn-fig12.h5 --quantity settling_time
        how long every start takes until its end is certain
    kapitza plot basin hubbard.h5 --quantity turns
        how often every start turns round before it ends (basin.turns)
"""

import argparse
from collections.abc import Sequence
from functools import partial
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LogNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from kapitza import style
from kapitza.plots.page import BadOption, entitle, lay_out, new_panels
from kapitza.plots.skeleton import mark_manifolds, mark_saddles
from kapitza.plots.strobe_dots import mark_strobe_points
from kapitza.plots.turns import draw_turns
from kapitza.plots.units import add_si
from kapitza.plots.window_axes import Plane, label_axes
from kapitza.result import BadFile, Result
from kapitza.units import drive_unit

EVIDENCE_COLOURS = ["#ffffff", "#35618f", "#a9c4df", "#8c1d18", "#e58a2b", "#e8c34a", "#3f8f5b", "#c9b8dd", "#5a3d7a",
                    "#d8b8b5", "#2b2b2b", "#c2447e", "#6fb7b7"]
STUDY = "a basin"
PAGE_WIDTH, PLANE_WIDTH, TITLES = 7.6, 5.3, 0.9  # inches, nearly the same in every figure


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quantity", choices=["attractor", "settling_time", "turns", "evidence", "common"],
                        help="turns: net turns until the end, of basin.turns; common: the attractor that a cell "
                             "reaches at all of "
                        "basin.phases")
    parser.add_argument("--attractor", metavar="ID|NAME",
                        help="black and white: the basin of one attractor, or of all of one name")
    parser.add_argument("--centre", choices=["down", "inverted"],
                        help="state in the middle of a whole-circle picture (default: down)")
    parser.add_argument("--saddles", action="store_true",
                        help="mark the unstable cycles of the study saddles by crosses")
    parser.add_argument("--manifolds", action="store_true",
                        help="draw the manifolds of the study manifolds: stable ones black, unstable ones white")
    parser.add_argument("--points", metavar="CSV",
                        help="measured releases with the columns theta (or theta_deg), velocity (or "
                        "velocity_rad_per_s) and end; circles agree with the basin, crosses do not")
    parser.add_argument("--shade", action="store_true", help="darken cells whose end is certain late")
    parser.add_argument("--degrees", action="store_true", help="angles in degrees instead of parts of pi")
    add_si(parser, "velocities in rad/s, times in s")
    parser.add_argument("--no-legend", action="store_true")
    parser.add_argument("--no-dots", action="store_true", help="leave out the strobe points of the attractors")


def chosen_ids(result: Result, attractors: xarray.Dataset, wanted: str) -> list[int]:
    """The ids that ID or NAME stands for."""
    names = [str(name) for name in attractors["name"].values]
    ids = [index for index, name in enumerate(names) if name == wanted]
    if not ids and wanted.lstrip("-").isdigit() and 0 <= int(wanted) < len(names):
        ids = [int(wanted)]
    if not ids:
        raise BadFile(
            f"{result.path}: has no attractor {wanted}; it has 0..{len(names) - 1}: {', '.join(dict.fromkeys(names))}")
    return ids


def draw_basins(axes: Axes, basin: xarray.Dataset, attractors: xarray.Dataset, *, colours: Sequence[str] | None = None,
                legend: bool = True, centre: str = "down", dots: bool = True, shade: bool = False) -> Axes:
    """Every basin in its colour (one per attractor; default: those of kapitza.style)."""
    plane, colours = Plane(basin, centre), colours or style.colours(attractors)
    table = np.array([to_rgb(colour) for colour in [*colours, style.UNSETTLED]])
    image = table[plane.cells(basin["attractor"])]  # -1 takes the last row
    if shade:
        image = image * (1 - 0.5 * _slowness(plane.cells(basin["settling_time"])))[..., None]
    plane.show(axes, image)
    if dots:
        dark = {index: style.shade(colour, -0.45) for index, colour in enumerate(colours)}
        mark_strobe_points(axes, plane, basin, attractors, colours=dark)
    if legend:
        write_legend(axes, basin_entries(attractors, colours, basin["attractor"].values))
    return label_axes(axes, plane)


def _slowness(periods: np.ndarray) -> np.ndarray:
    """0 for the faster half of the cells, 1 for the slowest percent, by the logarithm of the time between."""
    time = np.log1p(periods.astype(float))
    middle, last = np.percentile(time, (50, 99))
    return np.asarray(np.clip((time - middle) / max(last - middle, 1e-300), 0, 1))


def basin_entries(attractors: xarray.Dataset, colours: Sequence[str],
                  labels: np.ndarray) -> list[tuple[str, str, float]]:
    """Legend entries (colour, name, share) of the basins that have cells here, largest first; the unsettled cells
    last."""
    entries = [(colour, name, float(np.mean(labels == index)))
               for index, (name, colour) in enumerate(zip(style.names_with_ids(attractors["name"].values), colours,
                                                          strict=True))]
    entries.sort(key=lambda entry: -entry[2])
    entries.append((style.UNSETTLED, "not settled", float(np.mean(labels < 0))))
    return [entry for entry in entries if entry[2] > 0]


def draw_one(axes: Axes, basin: xarray.Dataset, attractors: xarray.Dataset, ids: Sequence[int], *,
             colour: str = "black", legend: bool = True, centre: str = "down", dots: bool = True) -> Axes:
    """The basins of the ids in one colour on white, their strobe points as open rings."""
    plane, mine = Plane(basin, centre), np.isin(basin["attractor"].values, ids)
    plane.show(axes, np.where(mine[:, plane.order, None], to_rgb(colour), to_rgb("white")))
    if dots:
        mark_strobe_points(axes, plane, basin, attractors, colours=dict.fromkeys(ids, "white"), edge=colour)
    if legend:
        write_legend(axes, [(colour, attractors["name"].values[ids[0]], float(np.mean(mine)))])
    return label_axes(axes, plane)


def draw_settling_time(axes: Axes, basin: xarray.Dataset, *, colours: Colormap | None = None, legend: bool = True,
                       centre: str = "down") -> Axes:
    """The time after which it is certain where a start ends, on a logarithmic scale; unsettled cells stay white."""
    plane, one = Plane(basin, centre), drive_unit(basin["settling_time"])  # a drive period
    time = np.ma.masked_where(plane.cells(basin["attractor"]) < 0, plane.cells(basin["settling_time"]) + one)
    image = plane.show(axes, time, cmap=(colours or mpl.colormaps["cividis"]).with_extremes(bad="white"),
                       norm=LogNorm(one, max(2 * one, time.max() if time.count() else 0)))
    if legend:
        bar = axes.figure.colorbar(image, cax=axes.inset_axes((1.02, 0, 0.025, 1)))
        bar.set_label("certain after (drive periods, plus one)" if one == 1
                      else "certain after (s, plus one drive period)")
        bar.outline.set_linewidth(0.7)
    return label_axes(axes, plane)


def draw_evidence(axes: Axes, basin: xarray.Dataset, *, colours: Sequence[str] = EVIDENCE_COLOURS, legend: bool = True,
                  centre: str = "down") -> Axes:
    """On what ground every cell got its label (one colour per code)."""
    plane = Plane(basin, centre)
    evidence = plane.cells(basin["evidence"])
    plane.show(axes, np.array([to_rgb(colour) for colour in colours])[evidence])
    words = str(basin["evidence"].attrs["flag_meanings"]).split()
    if legend:
        write_legend(axes, [(colour, word.replace("_", " "), float(np.mean(evidence == code)))
                            for code, (colour, word) in enumerate(zip(colours, words, strict=False))
                            if np.any(evidence == code)])
    return label_axes(axes, plane)


def draw_common(axes: Axes, basin: xarray.Dataset, attractors: xarray.Dataset, phases: xarray.Dataset, *,
                colours: Sequence[str] | None = None, legend: bool = True, centre: str = "down") -> Axes:
    """What a cell reaches at every phase of release, in the colours of the basins; other cells as the unsettled
    ones."""
    common, colours = phases["common"].values, colours or style.colours(attractors)
    plane = basin.assign(attractor=basin["attractor"].copy(data=common))
    draw_basins(axes, plane, attractors, colours=colours, legend=False, centre=centre, dots=False)
    if legend:
        write_legend(axes, [(colour, "depends on the phase" if name == "not settled" else name, share)
                            for colour, name, share in basin_entries(attractors, colours, common)])
    return axes


def write_legend(axes: Axes, entries: Sequence[tuple[str, str, float]]) -> Axes:
    """Colour and name in one column, the share in the next, digits under digits."""
    shares = [style.share_text(share) for _, _, share in entries]
    digits = max((share.find(".") if "." in share else share.find(" ") for share in shares), default=0)
    patches = [Patch(facecolor=colour, edgecolor=style.INK, linewidth=0.5, label=style.name_text(name))
               for colour, name, _ in entries]
    columns = [Line2D([], [], linestyle="", label=style.FIGURE_SPACE * (digits - max(share.find("."), 1)) + share)
               for share in shares]
    legend = axes.legend(handles=[*patches, *columns], ncols=2, loc="upper left", bbox_to_anchor=(1.01, 1.0),
                         borderaxespad=0, handlelength=1.1, handleheight=1.1, columnspacing=-0.2, fontsize="small")
    legend.set_gid(style.WITH_SHARES)
    return axes


def _method(basin: xarray.Dataset) -> str:
    words = {"icm": "interpolated cell mapping", "direct": "integrated directly"}
    method = str(basin.attrs.get("method", ""))
    return words.get(method, method)


def draw(result: Result, *, quantity: str = "attractor", attractor: int | str | None = None, centre: str = "down",
         saddles: bool = False,
         manifolds: bool = False, points: Any = None, shade: bool = False, degrees: bool = False, si: bool = False,
         no_dots: bool = False) -> Figure:
    """The page: one plane, and what is asked about it."""
    if attractor is not None and (quantity != "attractor" or shade):
        raise BadOption("--attractor cannot be combined with --quantity or --shade")
    group = partial(result.group, si=si, degrees=degrees, written=True)
    basin, attractors = group("basin"), group("attractors")
    labels = basin["attractor"].values
    if labels.size == 0 or labels.dtype.kind not in "iu" or not -1 <= labels.min() <= labels.max() < attractors.sizes[
        "attractor"]:
        raise BadFile(f"{result.path}: is damaged: some cells have ids of attractors that the file does not list")
    plane = Plane(basin, centre)
    figure, (axes,) = new_panels(PAGE_WIDTH, PLANE_WIDTH * plane.shape + TITLES)
    ids = [] if attractor is None else chosen_ids(result, attractors, str(attractor))
    if ids:
        draw_one(axes, basin, attractors, ids, centre=centre, dots=False)
    elif quantity == "attractor":
        draw_basins(axes, basin, attractors, centre=centre, dots=False, shade=shade)
    elif quantity == "evidence":
        draw_evidence(axes, basin, centre=centre)
    elif quantity == "turns":
        if "turns" not in basin:
            raise BadFile(f"{result.path}: has no turns; a run with basin.turns: true counts them")
        draw_turns(axes, basin, centre=centre)
    elif quantity == "common":
        draw_common(axes, basin, attractors, result.group("phases"), centre=centre)
    else:
        draw_settling_time(axes, basin, centre=centre)
    if manifolds:
        mark_manifolds(axes, basin, group("manifolds"), centre=centre)
    if saddles:
        mark_saddles(axes, basin, group("saddles"), centre=centre)
    if points is not None:
        mark_releases(axes, plane, result, points)
    if plane.place:
        axes.set_title(plane.place, fontsize="medium", fontweight="normal", parse_math=False)
    rows, columns = basin["attractor"].shape
    entitle(figure, result, style.parameters_text(result.pendulum), f"{columns} × {rows} starts", _method(basin))
    if not no_dots and quantity == "attractor":
        lay_out(figure)  # dots are as large as the cells beneath them allow
        mark_attractors(axes, plane, basin, attractors, ids)
    return figure


def mark_releases(axes: Axes, plane: Plane, result: Result, table: Any) -> Axes:
    """Measured releases: circles where the basin says the same, crosses where it does not, in the colours of the ends
    that were seen."""
    try:
        found = result.agree(table).table
    except (OSError, ValueError) as error:
        raise BadFile(f"{'points' if hasattr(table, 'columns') else table}: {error}") from error
    colours: dict[str, str] = dict(zip(result.attractors["name"], style.colours(result.group("attractors")),
                                       strict=True))
    centres: dict[str, str] = dict(zip(result.attractors["centre"], colours.values(), strict=False))
    for agrees, mark, gid in ((True, "o", "agree"), (False, "X", "differ")):
        places: list[np.ndarray] = []
        faces: list[str] = []
        for _, row in found[found["agrees"] == agrees].iterrows():
            points = np.column_stack(plane.inside(row["theta"] * plane.rad, row["velocity"] * plane.speed))
            places.append(points)
            faces += [colours.get(row["measured"], centres.get(row["measured"], style.UNSETTLED))] * len(points)
        if faces:
            theta, velocity = np.vstack(places).T
            axes.scatter(theta, velocity, s=38, marker=mark, c=faces, edgecolors=style.INK, linewidths=1.1, zorder=6,
                         gid=gid)
    return axes


def mark_attractors(axes: Axes, plane: Plane, basin: xarray.Dataset, attractors: xarray.Dataset,
                    ids: Sequence[int]) -> None:
    """The strobe points: white rings of the attractors `ids`, or dots of all in darker shades of their basins."""
    if ids:
        mark_strobe_points(axes, plane, basin, attractors, colours=dict.fromkeys(ids, "white"), edge="black")
    else:
        mark_strobe_points(axes, plane, basin, attractors,
                           colours={index: style.shade(colour, -0.45) for index,
                                    colour in enumerate(style.colours(attractors))})
