"""Strobe points of attractors over their basins, as dots that never hide a small basin."""

from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza.plots.page import current
from kapitza.plots.window_axes import Plane


def mark_strobe_points(axes: Axes, plane: Plane, basin: xarray.Dataset, attractors: xarray.Dataset, *,
                       colours: Mapping[int, str], edge: str = "white") -> Axes:
    """Every strobe point of the attractors in `colours` (id -> colour), at every place of the window where it shows;
    many points are drawn smaller, and what would hide a small basin is smaller still or left out."""
    room, strokes = Room(axes, plane, basin), current().scale  # by which the page will draw them larger
    for index, face in colours.items():
        size, line = (4.6, 0.9) if attractors["period"].values[index] <= 2 else (3.2, 0.6)
        points = plane.inside(attractors["strobe_theta"].values[index], attractors["strobe_velocity"].values[index])
        scale = room.taken_by(*points, strokes * (size + line))
        if scale and points[0].size:  # a line without points would count as one at the corner of the page
            axes.plot(*points, "o", markersize=scale * size, markerfacecolor=face, markeredgecolor=edge,
                      markeredgewidth=scale * line, clip_on=False, zorder=3)
    return axes


class Room:
    """How much of every basin is still to be seen under the dots."""

    HIDDEN = 0.2  # share of a basin's picture that dots may cover

    def __init__(self, axes: Axes, plane: Plane, basin: xarray.Dataset) -> None:
        self.plane, self.basin = plane, basin
        place, figure = axes.get_position(), axes.get_figure(root=True)
        assert figure is not None
        # Points
        self.width, self.height = 72 * place.width * figure.get_figwidth(), 72 * place.height * figure.get_figheight()
        labels, counts = np.unique(basin["attractor"].values, return_counts=True)
        self.left = dict(zip(labels, self.HIDDEN * self.width * self.height * counts / counts.sum(), strict=True))
        across = np.linspace(-1, 1, 15)
        disk = np.array(np.meshgrid(across, across)).reshape(2, -1)
        self.disk = disk[:, np.hypot(*disk) <= 1]

    def taken_by(self, theta: np.ndarray, velocity: np.ndarray, diameter: float) -> float:
        """The scale (1, 1/2, 1/4 or 0) at which the dots of an attractor leave every basin under them visible; takes
        their place."""
        for scale in (1, 0.5, 0.25):
            covered = self._covered(theta, velocity, scale * diameter)
            if all(area <= self.left[label] for label, area in covered.items()):
                self.left.update({label: self.left[label] - area for label, area in covered.items()})
                return scale
        return 0

    def _covered(self, theta: np.ndarray, velocity: np.ndarray, diameter: float) -> dict[int, float]:
        """Label -> square points under the dots."""
        x = theta[:, None] + diameter / 2 / self.width * np.ptp(self.plane.theta_range) * self.disk[0]
        y = velocity[:, None] + diameter / 2 / self.height * np.ptp(self.plane.velocity_range) * self.disk[1]
        labels, counts = np.unique(self.plane.label_at(self.basin, x, y), return_counts=True)
        return dict(zip(labels, np.pi / 4 * diameter**2 * counts / self.disk.shape[1], strict=True))
