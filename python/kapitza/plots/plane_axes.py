"""The axes of a plane of two keys of the pendulum."""

import xarray
from matplotlib.axes import Axes

NAMES = {"k": "gravity k", "m": "drive amplitude m", "drive_frequency": "drive frequency Ω (natural frequencies)",
         "drive_amplitude": "drive amplitude ε", "damping": "damping β", "quality_factor": "quality factor Q"}


def key_text(plane: xarray.Dataset, which: str) -> str:
    """The label of the axis x or y: its key, in the unit in which the scene is written."""
    key, unit = plane.attrs[f"{which}_parameter"], str(plane.attrs.get(f"{which}_units", "1"))
    words = str(key).replace("_", " ")
    return str(NAMES.get(key, words)) if unit == "1" else f"{words} ({unit})"


def label_keys(axes: Axes, plane: xarray.Dataset, *, x: bool = True, y: bool = True) -> Axes:
    """The labels of both axes, or of one."""
    if x:
        axes.set_xlabel(key_text(plane, "x"))
    if y:
        axes.set_ylabel(key_text(plane, "y"))
    return axes
