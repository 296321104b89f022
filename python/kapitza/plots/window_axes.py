"""The window of starts as it is drawn: the order of its cells, its edges, its ticks, in the units of the dataset
(kapitza.units)."""

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza import style
from kapitza.units import TURN, drive_unit

DEEP = 1e-9  # width of a window whose axis no tick label could tell from its centre


class Plane:
    """The window of starts as drawn: cells in the order of the picture, and its edges."""

    def __init__(self, basin: xarray.Dataset, centre: str) -> None:
        deep = [name for name in ("theta", "velocity") if _is_deep(basin, name)]
        self.centres = {name: str(basin.attrs[f"{name}_centre"]) for name in deep}
        self.widths = {name: str(basin.attrs[f"{name}_width"]) for name in deep}
        theta, velocity = (basin[f"{name}_offset" if name in self.centres else name].values
                           for name in ("theta", "velocity"))
        width = _step(theta) * len(theta)
        # One rad, one rad per drive radian
        self.rad, self.speed = (drive_unit(basin[name]) for name in ("theta", "velocity"))
        self.turn = TURN * self.rad
        self.whole_circle = abs(width / self.rad - TURN) < 1e-9
        turn = len(theta) // 2 if self.whole_circle and centre == "inverted" else 0
        self.order = np.roll(np.arange(len(theta)), -turn)
        left = theta[0] - _step(theta) / 2 + turn * _step(theta)
        self.theta_range = (left, left + width)
        half = _step(velocity) / 2
        self.velocity_range = (velocity[0] - half, velocity[-1] + half)

    def cells(self, variable: xarray.DataArray) -> np.ndarray:
        """A (velocity, theta) variable in the order of the picture."""
        return variable.values[:, self.order]

    def show(self, axes: Axes, image: np.ndarray, **colours: Any) -> Any:
        """Draws an image of the cells over the window."""
        return axes.imshow(image, extent=(*self.theta_range, *self.velocity_range), origin="lower", aspect="auto",
                           **colours)

    def inside(self, theta: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Every image of the points, whole turns apart, in the window (edges included); none where they are not known
        so finely."""
        theta, velocity = np.ravel(theta), np.ravel(velocity)
        known = np.isfinite(theta) & (not self.centres)
        theta, velocity = theta[known], velocity[known]
        (left, right), (low, high) = self.theta_range, self.velocity_range
        turns = np.arange(np.floor(left / self.turn - 0.5), np.ceil(right / self.turn + 0.5) + 1)
        images = theta[:, None] + self.turn * turns
        heights = np.broadcast_to(velocity[:, None], images.shape)
        edge = 1e-9
        keep = (images >= left - edge) & (images <= right + edge) & (heights >= low) & (heights <= high)
        return images[keep], heights[keep]

    def label_at(self, basin: xarray.Dataset, theta: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """The labels of the cells in which points of the window lie."""
        (left, right), (low, high) = self.theta_range, self.velocity_range
        labels = self.cells(basin["attractor"])
        rows, columns = (np.clip(np.floor((place - start) / (end - start) * count).astype(int), 0, count - 1) for place,
                         start, end, count
                         in ((velocity, low, high, labels.shape[0]), (theta, left, right, labels.shape[1])))
        return np.asarray(labels[rows, columns])

    @property
    def place(self) -> str:
        """Where a deep window lies: its centre, shortened; empty for another one."""
        names = {"theta": "θ", "velocity": "dθ/d(ωt)"}
        return ", ".join(f"{names[name]} ≈ {shortened(centre)}" for name, centre in self.centres.items())

    @property
    def shape(self) -> float:
        """Height over width of the picture: a radian is as long on both axes where that gives a readable shape."""
        width, height = np.ptp(self.theta_range) / self.rad, np.ptp(self.velocity_range) / self.speed
        return float(height / width) if 1 / 3 <= height / width <= 1.5 else 0.7


def _is_deep(basin: xarray.Dataset, name: str) -> bool:
    """Whether an axis is narrower than its values can tell, so that it is drawn in units of its width, from its
    centre."""
    return f"{name}_width" in basin.attrs and _number(basin.attrs[f"{name}_width"]) < DEEP


def _number(text: str) -> float:
    """The double of a decimal text, maybe with " deg" behind it."""
    return float(np.radians(float(text.removesuffix(" deg")))) if text.endswith(" deg") else float(text)


def _step(centres: np.ndarray) -> float:
    """Width of a cell; a single cell is drawn one unit wide."""
    return (centres[-1] - centres[0]) / (len(centres) - 1) if len(centres) > 1 else 1.0


def shortened(text: str, digits: int = 12) -> str:
    """A long decimal number by its first digits."""
    number, unit = (text.removesuffix(" deg"), "°") if text.endswith(" deg") else (text, "")
    mantissa, e, exponent = number.partition("e")
    place = next((i for i, letter in enumerate(mantissa) if letter in "123456789"), 0) + digits + 1
    cut = mantissa if len(mantissa) <= place + 2 else mantissa[:place] + "…"
    return (cut + e + exponent).replace("-", "−") + unit


def label_axes(axes: Axes, plane: Plane) -> Axes:
    """Angle in degrees or in parts of pi, velocity in rad/s or rad per drive radian: as the data of the plane are."""
    axes.set_xlim(plane.theta_range)
    axes.set_ylim(plane.velocity_range)
    degrees = plane.rad != 1
    unit, steps = (1, (1, 2, 5, 10, 15, 30, 45, 90)) if degrees else (np.pi, (1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2))
    width = np.ptp(plane.theta_range) / unit
    step = min(steps, key=lambda step: abs(width / step - 5))
    first = np.ceil(plane.theta_range[0] / unit / step - 1e-9)
    ticks = np.arange(first, plane.theta_range[1] / unit / step + 1e-9) * step
    if width > 2 * steps[0] and "theta" not in plane.widths:
        axes.set_xticks(ticks * unit, [f"{round(tick)}°".replace("-", "−") if degrees else style.pi_text(tick)
                                       for tick in ticks])
    elif degrees and "theta" not in plane.widths:
        axes.xaxis.set_major_formatter(lambda theta, _: f"{theta:.6g}°".replace("-", "−"))
    if "theta" in plane.widths:
        axes.set_xlabel(f"angle θ less the centre's (units of {plane.widths['theta']} rad)")
    else:
        axes.set_xlabel("angle θ from down" + ("" if degrees else " (rad)"))
    if "velocity" in plane.widths:
        axes.set_ylabel(f"velocity dθ/d(ωt) less the centre's (units of {plane.widths['velocity']})")
    else:
        axes.set_ylabel("velocity dθ/d(ωt) (rad per drive radian)" if plane.speed == 1 else "velocity dθ/dt (rad/s)")
    axes.tick_params(direction="out", length=3)
    return axes
