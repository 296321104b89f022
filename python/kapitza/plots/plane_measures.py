"""Measures over a plane of two keys: a panel for each name of attractors, or one for a measure of the whole
pendulum."""

import math
import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import xarray
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from kapitza import style
from kapitza.plots.atlas_curves import curve_points, mark_curves
from kapitza.plots.page import entitle, new_panels
from kapitza.plots.parameter_axes import label_keys
from kapitza.plots.units import fixed_si, group_beside
from kapitza.result import BadFile, Result
from kapitza.scene import tree_of
from kapitza.units import unit_text, with_unit

OVER = {("attractor", "y", "x"), ("y", "x")}  # dimensions of measures: of each attractor, of the pendulum
ADD = {"share", "weighted_share", "share_within", "integrity_global"}  # added over attractors of one name
COLUMNS, MOST = 3, 6  # panels side by side, and in all unless names are given
CURVES = 2  # longest period of the atlas' curves on top


def measures_of(plane: xarray.Dataset) -> list[str]:
    """The measures that the plane has; the ends of their intervals are left out."""
    return [str(name) for name, values in plane.data_vars.items()
            if values.dims in OVER and not str(name).endswith(("_low", "_high"))]


def of_name(plane: xarray.Dataset, measure: str, chosen: list[int]) -> tuple[np.ndarray, bool]:
    """The measure of the chosen attractors over (y, x), NaN where none has a value; whether some point has several of
    them.

    Shares and areas are added; of other measures it is the smallest.
    """
    values = plane[measure].values[chosen]
    known = np.isfinite(values)
    together = np.nansum(values, axis=0) if measure in ADD else np.where(known, values, np.inf).min(axis=0)
    return np.where(known.any(axis=0), together, np.nan), bool((known.sum(axis=0) > 1).any())


def panels_of(result: Result, plane: xarray.Dataset, wanted: Iterable[str] | None) -> dict[str, list[int]]:
    """Title of a panel -> numbers of its attractors: the names that are asked for, else those that the most pendulums
    have."""
    names = [str(name) for name in plane["name"].values]
    if wanted is None:
        points = {name: int(plane["points"].values[[other == name for other in names]].sum()) for name in names}
        wanted = sorted(points, key=lambda name: -points[name])[:MOST]
    full = [f"{name} ({number})" for number, name in enumerate(names)]
    found = {name: [number for number in range(len(names)) if name in (names[number], full[number], str(number))]
             for name in wanted}
    for name, numbers in found.items():
        if not numbers:
            raise BadFile(f"{result.path}: has no attractor {name}; it has {', '.join(dict.fromkeys(names))}")
    return {full[numbers[0]] if name.isdigit() else name: numbers for name, numbers in found.items()}


def draw_plane(axes: Axes, plane: xarray.Dataset, values: np.ndarray, *, colours: str = "viridis", legend: bool = True,
               norm: Normalize | None = None, label: str = "") -> Axes:
    """Values over (y, x); hatched where there are none. `colours`: name of a colour map; `legend`: the bar beside it,
    with `label`."""
    norm = norm or norm_of(values)
    axes.patch.set(facecolor="white", hatch="////", edgecolor="#c4cbd2", linewidth=0)
    image = axes.pcolormesh(plane["x"], plane["y"], np.ma.masked_invalid(values), cmap=colormaps[colours], norm=norm,
                            shading="nearest", rasterized=True)
    if legend:
        axes.figure.colorbar(image, ax=axes, label=label, fraction=0.05, pad=0.01)
    for centres, limit in ((plane["x"].values, axes.set_xlim), (plane["y"].values, axes.set_ylim)):
        half = (centres[-1] - centres[0]) / (len(centres) - 1) / 2
        limit(centres[0] - half, centres[-1] + half)
    return axes


def norm_of(values: np.ndarray) -> Normalize:
    """One scale for all panels, from 0 where nothing is below it."""
    known = values[np.isfinite(values)]
    return Normalize(min(0.0, float(known.min())), float(known.max())) if known.size else Normalize(0, 1)


def atlas_of(result: Result, plane: xarray.Dataset, path: Path | None) -> xarray.Dataset | None:
    """The atlas of the file, or of another one, of the same pendulum over the same keys; None if there is none."""
    if path is None and "atlas" not in result.groups:
        return None
    other = result if path is None else Result(path)
    atlas = group_beside(other, "atlas", plane)
    keys, wanted = ([data.attrs[f"{which}_parameter"] for which in "xy"] for data in (atlas, plane))
    if keys != wanted:
        raise BadFile(f"{other.path}: its atlas is over {' and '.join(keys)}, the plane over {' and '.join(wanted)}")
    pendulums = [tree_of(one.scene).get("pendulum") for one in (result, other)]
    ours, theirs = (found if isinstance(found, dict) else {} for found in pendulums)
    for key in sorted((ours.keys() | theirs.keys()) - set(keys)):
        if ours.get(key) != theirs.get(key):
            raise BadFile(f"{other.path}: its atlas is of another pendulum: {key} is {theirs.get(key)}, that of the "
                          f"plane {ours.get(key)}")
    return atlas


def draw_curves(axes: Axes, atlas: xarray.Dataset, name: str | None = None, *, colours: dict[int, str] | None = None,
                legend: bool = False) -> Axes:
    """The curves of an atlas with a white rim; `name`: those of this motion alone; `colours`: of periods."""
    if name is not None:
        names = {name, re.sub("^rotation [+-]", "rotation ", name)}  # an atlas has one name for both mirror images
        own = [str(text).rpartition(": ")[0] in names for text in atlas["curve_name"].values]
        for number in np.flatnonzero(own):
            axes.plot(*curve_points(atlas, int(number)), color=style.INK, linewidth=0.9)
    else:
        mark_curves(axes, atlas, CURVES, colours)
    for line in axes.lines:
        line.set_path_effects([withStroke(linewidth=line.get_linewidth() + 1.1, foreground="white")])
    if legend:
        axes.legend(fontsize="small")
    return axes


def bar_text(values: xarray.DataArray) -> str:
    """The long name of a measure, with its unit."""
    return with_unit(str(values.attrs.get("long_name", values.name)).removesuffix(f", in {unit_text(values)}"), values)


def grid_of(count: int) -> tuple[Figure, list[Axes]]:
    """A page with so many panels of one scale."""
    columns = min(COLUMNS, count)
    rows = math.ceil(count / columns)
    width, height = (7.2, 4.8) if count == 1 else (2.0 + 2.6 * columns, 1.1 + 2.2 * rows)
    figure, panels = new_panels(width, height, rows, columns, sharex=True, sharey=True)
    for axes in panels[count:]:
        axes.set_visible(False)
    for axes in panels[max(0, count - columns):count]:
        axes.tick_params(labelbottom=True)
    return figure, panels[:count]


def measure_page(result: Result, plane: xarray.Dataset, measure: str | None, attractor: Iterable[str] | None,
                 path: Path | None) -> Figure:
    """The page of one measure, the first where none is given; `attractor`: names; `path`: of the atlas whose curves lie
    on top."""
    known = measures_of(plane)
    measure = measure or next(iter(known), "measure")
    if measure not in known:
        raise BadFile(
            f"{result.path}: its plane has no {measure}; it has {', '.join(known) or 'no measure of attractors'}")
    atlas = atlas_of(result, plane, path)
    single = plane[measure].dims == ("y", "x")
    chosen: dict[str, list[int]] = {"": []} if single else panels_of(result, plane, attractor)
    images = [(plane[measure].values, False)] if single else [of_name(plane, measure, numbers)
                                                              for numbers in chosen.values()]
    norm = norm_of(np.array([values for values, _ in images]))
    figure, panels = grid_of(len(images))
    for axes, name, (values, _) in zip(panels, chosen, images, strict=True):
        draw_plane(axes, plane, values, norm=norm, legend=False)
        if atlas is not None:
            draw_curves(axes, atlas, None if single else str(plane["name"].values[chosen[name][0]]))
        axes.set_title(style.name_text(name), fontsize="medium", loc="left")
        place = panels.index(axes)
        label_keys(axes, plane, x=place >= len(panels) - COLUMNS, y=place % COLUMNS == 0)
    figure.colorbar(panels[0].collections[0], ax=panels, label=bar_text(plane[measure]), fraction=0.05, pad=0.01)
    curves = "lines: curves of the atlas" if atlas is not None else ""
    entitle(figure, result, *footer(result, plane, measure, chosen, images, single), curves)
    return figure


def footer(result: Result, plane: xarray.Dataset, measure: str, chosen: dict[str, list[int]],
           images: list[tuple[np.ndarray, bool]], single: bool) -> list[str]:
    """What is drawn: how many points, what hatching means, which names are left out, what attractors of one name
    make."""
    words = [f"{plane.sizes['x']} × {plane.sizes['y']} points", fixed_si(result, plane) if result.pivot_frequency
             else ""]
    if any(np.isnan(values).any() for values, _ in images):
        words.append("hatched: no value" if single else "hatched: no value, or the attractor is not seen")
    if not single:
        names = len(set(plane["name"].values))
        words.append(f"{len(chosen)} of {names} names" if len(chosen) < names else "")
    if any(several for _, several in images):
        words.append("attractors of one name are added" if measure in ADD else "the smallest of attractors of one name")
    return words
