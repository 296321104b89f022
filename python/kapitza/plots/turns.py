"""Draws the net turns of every start of a basin: the lakes of J. H. Hubbard."""

import matplotlib as mpl
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, Colormap

from kapitza.plots.window_axes import Plane, label_axes


def draw_turns(axes: Axes, basin: xarray.Dataset, *, colours: Colormap | None = None, legend: bool = True,
               centre: str = "down") -> Axes:
    """The net turns until the end, a colour for each number that is not rare; cells that end on no oscillation stay
    white."""
    plane = Plane(basin, centre)
    turns = np.ma.masked_invalid(plane.cells(basin["turns"]))
    most = max(1, int(np.percentile(np.abs(turns.compressed()), 90, method="lower"))) if turns.count() else 1
    shown = (colours or mpl.colormaps["RdYlBu_r"]).with_extremes(bad="white")
    image = plane.show(axes, turns, cmap=shown, norm=BoundaryNorm(np.arange(-most - 0.5, most + 1), shown.N,
                                                                  extend="both"))
    if legend:
        bar = axes.figure.colorbar(image, cax=axes.inset_axes((1.02, 0, 0.025, 1)), ticks=range(-most, most + 1))
        bar.set_label("net turns until the end, counterclockwise +")
        bar.outline.set_linewidth(0.7)
    return label_axes(axes, plane)
