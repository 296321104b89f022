"""What lives where on an atlas: the kind of motion that colours each cell, words on the largest areas, points of a
file."""

import itertools
from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from scipy.ndimage import distance_transform_edt, label

from kapitza import style
from kapitza.bounded_reading import table_file
from kapitza.plots.atlas_classes import centre_of
from kapitza.reading import BadFile

POINTS = 7  # zorder of points from a file
LABELS = 4  # words on a map
# Kind of motion -> what it is called on a map. A cell has the colour of the first kind that lives there.
LIVING = {"inverted": "inverted", "flutter": "flutter", "inverted nodding": "nodding about inverted", "down": "down",
          "down nodding": "nodding about down", "rotation +": "rotations", "other": "other motions"}
NOBODY = len(LIVING)


def mark_points(axes: Axes, path: str) -> list[Line2D]:
    """Points of a CSV file, a mark for each label; the marks, for the legend."""
    import pandas

    try:
        table = pandas.read_csv(table_file(path), comment="#")
    except (OSError, ValueError) as error:
        raise BadFile(str(error)) from error
    if missing := {"x", "y", "label"} - set(table.columns):
        raise BadFile(f"{path}: lacks the column {sorted(missing)[0]}")
    handles = []
    for (name, rows), mark in zip(table.groupby("label", sort=False), itertools.cycle("osD^vPX*"), strict=False):
        handles += axes.plot(rows["x"], rows["y"], mark, markersize=4.6, markerfacecolor="white",
                             markeredgecolor=style.INK,
                             markeredgewidth=0.9, linestyle="", zorder=POINTS, label=str(name))
    return handles


def living(atlas: xarray.Dataset) -> np.ndarray:
    """For each cell the place in LIVING of the first kind of motion that attracts there; NOBODY, and -1 where the list
    is not known."""
    found = np.where(atlas["count"].values < 0, -1, NOBODY)
    names = [style.name_text(name) for name in atlas["class_name"].values]
    for kind in reversed(LIVING):
        for number, name in enumerate(names):
            own = style.kind(int(atlas["class_period"][number]), abs(int(atlas["class_winding"][number])),
                             centre_of(name))
            if own == kind:
                found[(atlas["attracting"].values[number] > 0) & (found >= 0)] = list(LIVING).index(kind)
    return found


def kind_colours(colours: Mapping[str, str]) -> list[str]:
    """A light colour for each kind of LIVING and for NOBODY: curves and words stay readable on it."""
    chosen = {"inverted": 0, "down": 0} | dict.fromkeys(("flutter", "inverted nodding", "down nodding", "rotation +",
                                                         "other"), 0.55)
    return [colours.get(kind) or style.shade(style.KINDS[kind], chosen[kind]) for kind in LIVING] + ["white"]


def label_areas(axes: Axes, atlas: xarray.Dataset, kinds: np.ndarray) -> None:
    """Words on the roomiest areas, each kind once, where the edges are farthest."""
    room = []
    for number, text in enumerate(LIVING.values()):
        areas, count = label(kinds == number)
        if count:
            largest = areas == np.argmax(np.bincount(areas.ravel())[1:]) + 1
            far = distance_transform_edt(np.pad(largest, 1))[1:-1, 1:-1]
            room.append((far.max(), text, np.unravel_index(np.argmax(far), far.shape)))
    for _, text, (row, column) in sorted(room, reverse=True)[:LABELS]:
        axes.text(float(atlas["column"][column]), float(atlas["row"][row]), text, ha="center", va="center",
                  color=style.INK, zorder=8)
