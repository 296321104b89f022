"""Curves of an atlas: how they are drawn, and which of them separate what can be seen."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza import style
from kapitza.plots.atlas_classes import BREAKING, DOUBLING, FOLD, LEANS, SWINGS, belongs

GREY = "#59626b"
DASHES: dict[int, Any] = {FOLD: "-", DOUBLING: (0, (5, 2)), BREAKING: (0, (1.2, 1.4)), SWINGS: (0, (5, 2)),
                          LEANS: (0, (1.2, 1.4))}
BOLD_UP_TO = 4  # longer cycles live in thin bands: their curves are thin
SEEN = 1 / 110  # share of the map's height: narrower bands are not seen
FIRST = 2  # zorder of the thinnest
SHORT = 8  # points of a curve: shorter pieces look like the piece before


def curve_points(atlas: xarray.Dataset, number: int) -> tuple[np.ndarray, np.ndarray]:
    """x and y of a curve."""
    first, n = int(atlas["curve_first"][number]), int(atlas["curve_points"][number])
    return atlas["x"].values[first:first + n], atlas["y"].values[first:first + n]


def is_seen(axes: Axes, atlas: xarray.Dataset, number: int) -> np.ndarray:
    """Whether the motion of a curve attracts on one side of each point and not on the other, so far away that readers
    see the band.

    Limits and scales of the axes must be set.
    """
    classes = [i for i in range(atlas.sizes["class"]) if belongs(atlas, number, i)]
    at = axes.transData.transform(np.column_stack(curve_points(atlas, number)))
    if not classes or len(at) < 2:
        return np.zeros(len(at), dtype=bool)
    along = np.gradient(at, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(np.hypot(*along.T), 1e-12)[:, None]
    count = []
    for side in (-1, 1):
        x, y = axes.transData.inverted().transform(at + side * SEEN * axes.bbox.height * normal).T
        column, row = (np.clip(np.rint((value - cells[0]) / (cells[1] - cells[0])).astype(int), 0, len(cells) - 1)
                       for value, cells in ((x, atlas["column"].values), (y, atlas["row"].values)))
        count.append(atlas["attracting"].values[classes[0], row, column])
    return np.asarray(count[0] != count[1])


def pieces(seen: np.ndarray) -> Iterator[tuple[slice, bool]]:
    """Pieces of a curve that are seen, or not; neighbours share a point, and short ones belong to the piece before."""
    edges = [0, *(np.flatnonzero(seen[1:] != seen[:-1]) + 1).tolist(), len(seen)]
    kept = [0]
    for first, last in zip(edges[1:-1], edges[2:], strict=True):
        if first - kept[-1] >= SHORT and last - first >= SHORT and seen[first] != seen[kept[-1]]:
            kept.append(first)
    for first, last in zip(kept, [*kept[1:], len(seen)], strict=True):
        yield slice(max(0, first - 1), last), bool(2 * seen[first:last].sum() >= last - first)


def mark_curves(axes: Axes, atlas: xarray.Dataset, longest: int, colours: Mapping[int, str] | None = None) -> None:
    """All curves of cycles of up to `longest` periods, grey or in `colours` (of periods); those of rest in ink. What
    bounds bands that nobody sees is faint, and lies below. Limits and scales of the axes must be set."""
    for number in np.argsort(-atlas["curve_period"].values, kind="stable"):
        period, kind = int(atlas["curve_period"][number]), int(atlas["curve_kind"][number])
        if period > longest:
            continue
        x, y = curve_points(atlas, number)
        rest, bold = kind in (SWINGS, LEANS), period <= BOLD_UP_TO
        colour = (colours or {}).get(period, style.INK if rest else GREY)
        for piece, seen in [(slice(None), True)] if rest else pieces(is_seen(axes, atlas, number)):
            axes.plot(x[piece], y[piece], linestyle=DASHES[kind], color=colour, linewidth=1.2 if rest else 0.6 if seen
                      and bold else 0.25,
                      alpha=1 if rest else 0.9 if seen else 0.3, zorder=4 if rest else FIRST + 0.5 * bold + 0.25 * seen,
                      solid_capstyle="round")
