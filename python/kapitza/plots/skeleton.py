"""Unstable cycles and their manifolds over the basins that they divide."""

from collections.abc import Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza import style
from kapitza.plots.window_axes import Plane, label_axes


def mark_saddles(axes: Axes, basin: xarray.Dataset, saddles: xarray.Dataset, *, colour: str = style.INK,
                 rim: str = "white", centre: str = "down") -> Axes:
    """A cross at every strobe point of every unstable cycle; longer cycles are drawn smaller."""
    plane = Plane(basin, centre)
    for period in np.unique(saddles["period"].values)[::-1]:
        cycles = saddles["period"].values == period
        points = plane.inside(saddles["strobe_theta"].values[cycles], saddles["strobe_velocity"].values[cycles])
        size = 7 / np.sqrt(period)
        axes.plot(*points, "x", markersize=size + 1.5, markeredgewidth=2.2, color=rim, zorder=4)
        axes.plot(*points, "x", markersize=size + 1.0, markeredgewidth=1.0, color=colour, zorder=5)
    return label_axes(axes, plane)


def mark_manifolds(axes: Axes, basin: xarray.Dataset, manifolds: xarray.Dataset, *,
                   colours: Sequence[str] = ("white", "black"), centre: str = "down") -> Axes:
    """Every polyline at every image that lies in the window, in the colours of unstable and stable ones, each with a
    thin rim."""
    theta, velocity, kind = (manifolds[name].values for name in ("theta", "velocity", "kind"))
    plane = Plane(basin, centre)
    if plane.centres:  # curves are not known as finely as such a window is
        return label_axes(axes, plane)
    joined = (np.diff(manifolds["polyline"].values) == 0) & (np.abs(np.diff(theta)) < plane.turn / 2)
    pieces = np.split(np.arange(len(theta)), np.flatnonzero(~joined) + 1)
    for number, (colour, rim) in enumerate(zip(colours, (style.INK, "white"), strict=True)):
        for piece in pieces:
            if len(piece) < 2 or kind[piece[0]] != number:
                continue
            for turn in (-plane.turn, 0, plane.turn):
                axes.plot(theta[piece] + turn, velocity[piece], color=rim, linewidth=1.5, zorder=2)
                axes.plot(theta[piece] + turn, velocity[piece], color=colour, linewidth=0.8, zorder=2.1)
    return label_axes(axes, plane)
