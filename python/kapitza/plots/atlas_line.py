"""One line through an atlas: the branches of all cycles, as a bifurcation diagram."""

from collections.abc import Mapping

import numpy as np
import pandas
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from kapitza import style
from kapitza.plots.atlas_classes import motion_text

CENTRES = {"down": 0, "inverted": 1, "rotating": 2, "neither": 3}


def parts(attracts: np.ndarray) -> list[tuple[slice, bool]]:
    """Pieces of a branch on which it attracts, or repels; neighbours share a point."""
    changes = np.flatnonzero(attracts[1:] != attracts[:-1]) + 1
    edges = [0, *changes.tolist(), len(attracts)]
    return [(slice(first, last + 1), bool(attracts[first])) for first, last in zip(edges[:-1], edges[1:], strict=True)]


def draw_line(axes: Axes, table: pandas.DataFrame, *, colours: Mapping[int, str] | None = None,
              legend: bool = True) -> Axes:
    """Branches as `Result.line` returns them: mean height of the bob at the strobe points over the key; dashed where
    they repel.

    `colours`: of periods, in place of those of motions.
    """
    named: dict[str, str] = {}
    for _, rows in table.groupby("branch", sort=False):
        first = rows.iloc[0]
        period = int(first["period"])
        colour = (colours or {}).get(period) or style.motion_colour(period, int(first["winding"]),
                                                                    CENTRES[first["centre"]])
        value, height, multiplier = (rows[name].to_numpy(float) for name in ("value", "height", "multiplier"))
        for part, attracts in parts(multiplier < 1):
            axes.plot(value[part], height[part], color=colour, zorder=3 if attracts else 2,
                      linestyle="-" if attracts else (0, (3, 1.6)), linewidth=(1.9 if period <= 2 else 1.2) if attracts
                      else 0.8, alpha=1 if attracts else 0.75, solid_capstyle="round")
            if attracts and period <= 4:
                named.setdefault(motion_text(first["name"]), colour)
        mark_ends(axes, value, height, multiplier)
    if legend:
        handles = [Line2D([], [], color=colour, linewidth=1.9, label=name) for name, colour in named.items()]
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    axes.set_ylabel("mean height of the bob at the strobe points")
    axes.set_ylim(-1.06, 1.06)
    axes.set_yticks([-1, -0.5, 0, 0.5, 1], ["down −1", "−0.5", "0", "0.5", "inverted 1"])
    return axes


def mark_ends(axes: Axes, value: np.ndarray, height: np.ndarray, multiplier: np.ndarray) -> None:
    """Dots where a branch gains or loses its stability: where the multiplier passes 1 between two points."""
    for at in np.flatnonzero((multiplier[1:] < 1) != (multiplier[:-1] < 1)):
        ends = np.log(multiplier[at:at + 2])
        share = ends[0] / (ends[0] - ends[1])
        axes.plot(value[at] + share * (value[at + 1] - value[at]), height[at] + share * (height[at + 1] - height[at]),
                  "o", markersize=2.6, color=style.INK, zorder=5)
