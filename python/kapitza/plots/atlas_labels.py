"""Words on an atlas: what its motions are called, and what each region has more than the one below it."""

import itertools
import textwrap

import matplotlib.patheffects as effects
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from kapitza import style
from kapitza.bounded_reading import table_file
from kapitza.plots.atlas_classes import motion_text
from kapitza.reading import BadFile

POINTS = 7  # zorder of points from a file
LABELLED = 0.004  # share of the plane from which on a region has a label, if it has room
NARROW, GAP = 16, (0.8, 0.4)  # letters a line of a label that finds no room as one line; letters' heights that are left free about a label
AGAIN, FARTHEST = 0.3, 0.25  # widths of the map: a label is not repeated nearer than this, and lies no farther from its region's place
TRIED = 40  # places where a label has room: beyond a thin band another one may be the region below


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


def cell_of(atlas: xarray.Dataset, region: int) -> tuple[int, int]:
    """Row and column of the cell of a region that is farthest from its edge."""
    column = int(np.argmin(abs(atlas["column"].values - float(atlas["region_x"][region]))))
    return int(np.argmin(abs(atlas["row"].values - float(atlas["region_y"][region])))), column


def region_text(atlas: xarray.Dataset, region: int) -> str:
    """What a region has more than the one below it; all that it has, where that is little."""
    return cell_text(atlas, *cell_of(atlas, region))


def cell_text(atlas: xarray.Dataset, row: int, column: int) -> str:
    """The same of the region of a cell."""
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


def label_regions(axes: Axes, atlas: xarray.Dataset, curves: list[Line2D], points: list[Line2D]) -> list[Text]:
    """Labels of the roomiest regions first, each as near to the place farthest from the edges as it crosses none of the curves, points and
    other labels, or at least none but faint curves; none where there is no such place.
    """
    renderer = axes.figure.canvas.get_renderer()  # type: ignore[attr-defined]
    taken = [Taken(axes, some, points) for some in (curves, [line for line in curves if line.get_alpha() == 1])]
    placed: list[Text] = []
    for region in np.argsort(-atlas["region_radius"].values, kind="stable"):
        if float(atlas["region_share"][region]) < LABELLED:
            continue
        cells, places = places_of(axes, atlas, int(region), FARTHEST * axes.bbox.width)
        text = region_text(atlas, int(region))
        wrapped = textwrap.fill(text, NARROW) if "\n" not in text else text
        for pixels, words in itertools.product(taken, dict.fromkeys((text, wrapped))):
            label = axes.text(0, 0, words, ha="center", va="center", fontsize="small", color=style.INK, zorder=8,
                              path_effects=[effects.withStroke(linewidth=2.2, foreground="white", alpha=0.85)])
            box, letter = label.get_window_extent(renderer), float(label.get_fontsize()) * axes.figure.dpi / 72
            free = pixels.free(places, box.width + GAP[0] * letter, box.height + GAP[1] * letter)
            for other in placed:
                if other.get_text().split() == words.split():
                    free &= np.hypot(*(places - axes.transData.transform(other.get_position())).T) > AGAIN * axes.bbox.width
            chosen = next((i for i in np.flatnonzero(free)[:TRIED] if cell_text(atlas, *cells[i]) == text), None)
            if chosen is not None:
                x, y = axes.transData.inverted().transform(places[chosen])
                label.set_position((float(x), float(y)))
                for each in taken:
                    each.add(label.get_window_extent(renderer))
                placed.append(label)
                break
            label.remove()
    return placed


def places_of(axes: Axes, atlas: xarray.Dataset, region: int, farthest: float) -> tuple[np.ndarray, np.ndarray]:
    """The cells with the list of a region, and where they lie on the screen, the nearest to its place farthest from the edges first."""
    row, column = cell_of(atlas, region)
    lists = atlas["list"].values
    cells = np.argwhere(lists == lists[row, column])
    at = axes.transData.transform(np.column_stack([atlas["column"].values[cells[:, 1]], atlas["row"].values[cells[:, 0]]]))
    place = axes.transData.transform((float(atlas["column"][column]), float(atlas["row"][row])))
    far = np.hypot(*(at - place).T)
    order = np.argsort(far, kind="stable")[:int((far < farthest).sum())]
    return cells[order], at[order]


class Taken:
    """Which pixels of a map are those of curves, points or labels."""

    def __init__(self, axes: Axes, curves: list[Line2D], points: list[Line2D]) -> None:
        self.inside = axes.get_window_extent()
        self.pixels = np.zeros((int(self.inside.height) + 1, int(self.inside.width) + 1), dtype=bool)
        for line in curves:
            at = axes.transData.transform(line.get_xydata())
            steps = np.maximum(1, np.ceil(np.abs(np.diff(at, axis=0)).max(axis=1, initial=0))).astype(int)
            for start, end, n in zip(at[:-1], at[1:], steps, strict=True):
                self.mark(start + np.linspace(0, 1, n + 1)[:, None] * (end - start))
        for line in points:
            half = np.ceil(0.5 * line.get_markersize() * axes.figure.dpi / 72)
            around = np.arange(-half, half + 1)
            for by in np.stack(np.meshgrid(around, around), axis=-1).reshape(-1, 2):
                self.mark(axes.transData.transform(line.get_xydata()) + by)

    def mark(self, at: np.ndarray) -> None:
        column, row = np.rint(at - (self.inside.x0, self.inside.y0)).astype(int).T
        within = (column >= 0) & (row >= 0) & (column < self.pixels.shape[1]) & (row < self.pixels.shape[0])
        self.pixels[row[within], column[within]] = True

    def add(self, box: Bbox) -> None:
        x, y = box.x0 - self.inside.x0, box.y0 - self.inside.y0
        self.pixels[max(0, int(y)):int(y + box.height) + 1, max(0, int(x)):int(x + box.width) + 1] = True

    def free(self, places: np.ndarray, width: float, height: float) -> np.ndarray:
        """At which places the middle of a box can lie that has nothing taken inside, and lies on the map."""
        total = np.zeros((self.pixels.shape[0] + 1, self.pixels.shape[1] + 1), dtype=np.int64)
        total[1:, 1:] = self.pixels.cumsum(axis=0).cumsum(axis=1)
        low = np.floor(places - (self.inside.x0 + width / 2, self.inside.y0 + height / 2)).astype(int)
        high = low + np.ceil((width, height)).astype(int) + 1
        within = (low >= 0).all(axis=1) & (high[:, 0] <= self.pixels.shape[1]) & (high[:, 1] <= self.pixels.shape[0])
        (left, bottom), (right, top) = (np.clip(edge, 0, np.array(self.pixels.shape[::-1])).T for edge in (low, high))
        return np.asarray(within & (total[top, right] - total[bottom, right] - total[top, left] + total[bottom, left] == 0))
