"""Words on an atlas: what its motions are called, and what each region has more than the one below it."""

import itertools

import matplotlib.patheffects as effects
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text

from kapitza import style
from kapitza.reading import BadFile

POINTS = 7  # zorder of points from a file
LABELLED = 0.004  # share of the plane from which on a region has a label, if it has room


def motion_text(name: str) -> str:
    """What a class of attractors is called in a picture."""
    words = {"down": "hanging rest", "inverted": "upright rest", "down 2-nodding": "nodding in 2"}
    if name in words:
        return words[name]
    if name.startswith("rotation"):
        return name.replace("rotation", "rotations")
    for kind, text in (("asymmetric ", "lopsided nodding"), ("down ", "nodding"), ("inverted ", "flutter"), ("", "motion")):
        if name.startswith(kind) and name.endswith("-nodding"):
            return f"{text} in {name.removeprefix(kind).removesuffix('-nodding')}"
    return name


def mark_points(axes: Axes, path: str) -> list[Line2D]:
    """Points of a CSV file, a mark for each label; the marks, for the legend."""
    import pandas

    table = pandas.read_csv(path, comment="#")
    if missing := {"x", "y", "label"} - set(table.columns):
        raise BadFile(f"{path}: lacks the column {sorted(missing)[0]}")
    handles = []
    for (label, rows), mark in zip(table.groupby("label", sort=False), itertools.cycle("osD^vPX*"), strict=False):
        handles += axes.plot(rows["x"], rows["y"], mark, markersize=4.6, markerfacecolor="#ffd24a", markeredgecolor=style.INK,
                             markeredgewidth=0.8, linestyle="", zorder=POINTS, label=str(label))
    return handles


def lower_neighbour(atlas: xarray.Dataset, row: int, column: int) -> tuple[int, int] | None:
    """The cell of the nearest wide band below a cell."""
    lists = atlas["list"].values[:, column]
    thin, below = len(lists) // 60, row
    while below >= 0:
        if 0 <= lists[below] != lists[row] and below >= thin and (lists[below - thin:below + 1] == lists[below]).all():
            return below, column
        below -= 1
    return None


def region_text(atlas: xarray.Dataset, region: int) -> str:
    """What a region has more than the one below it; all that it has, where that is little."""
    column = int(np.argmin(abs(atlas["column"].values - float(atlas["region_x"][region]))))
    row = int(np.argmin(abs(atlas["row"].values - float(atlas["region_y"][region]))))
    names = [motion_text(style.name_text(name)) for name in atlas["class_name"].values]
    here = atlas["attracting"].values[:, row, column].astype(int)
    below = lower_neighbour(atlas, row, column)
    if here.sum() == 0:
        return f"nothing of up to {int(atlas.attrs['max_period'])} periods"
    if below is None or here.sum() == 1:
        return "only " + " and ".join(names[i] for i in np.flatnonzero(here))
    change = here - atlas["attracting"].values[:, below[0], below[1]].astype(int)
    gained, lost = [names[i] for i in np.flatnonzero(change > 0)], [names[i] for i in np.flatnonzero(change < 0)]
    parts = [f"+ {name}" for name in gained[:2]] if len(gained) <= 2 else [f"+ {len(gained)} motions"]
    return "\n".join(parts + [f"− {name}" for name in lost[:1] if len(lost) == len(gained) == 1])


def label_regions(axes: Axes, atlas: xarray.Dataset, points: np.ndarray) -> list[Text]:
    """Labels at the places farthest from the edges, the roomiest first; none where it would lie on another or on one of the points
    [n][2], or outside of the map.
    """
    figure = axes.figure
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    placed: list[Text] = []
    inside = axes.get_window_extent(renderer)
    marks = axes.transData.transform(points) if len(points) else points
    for region in np.argsort(-atlas["region_radius"].values, kind="stable"):
        text = region_text(atlas, int(region))
        if float(atlas["region_share"][region]) < LABELLED or not text:
            continue
        label = axes.text(float(atlas["region_x"][region]), float(atlas["region_y"][region]), text, ha="center", va="center",
                          fontsize="small", color=style.INK, zorder=8,
                          path_effects=[effects.withStroke(linewidth=2.2, foreground="white", alpha=0.85)])
        move_inside(axes, label)
        box = label.get_window_extent(renderer).expanded(1.06, 1.25)
        tall = 2.6 * float(atlas["region_radius"][region]) * inside.height
        if tall < box.height or not inside.contains(box.x0, box.y0) or not inside.contains(box.x1, box.y1) or any(
                box.overlaps(other.get_window_extent(renderer)) for other in placed) or box.expanded(1.04, 1.3).count_contains(marks):
            label.remove()
        else:
            placed.append(label)
    return placed


def move_inside(axes: Axes, label: Text) -> None:
    """Moves a label that passes the left or right edge of the map to it."""
    box, inside = label.get_window_extent().expanded(1.15, 1), axes.get_window_extent()
    by = max(0.0, inside.x0 - box.x0) - max(0.0, box.x1 - inside.x1)
    x, y = axes.transData.transform(label.get_position())
    x, y = axes.transData.inverted().transform((x + by, y))
    label.set_position((float(x), float(y)))
