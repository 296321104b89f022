"""The axes of keys of the pendulum: of a sweep, of a plane of two keys."""

import xarray
from matplotlib.axes import Axes

NAMES = {"k": "gravity k", "m": "drive amplitude m", "drive_frequency": "drive frequency Ω (natural frequencies)",
         "drive_amplitude": "drive amplitude ε", "damping": "damping β", "quality_factor": "quality factor Q"}


def key_text(dataset: xarray.Dataset, which: str = "") -> str:
    """The label of the axis x or y of a plane, or of the axis of a sweep: its key, and the unit of its values."""
    key = dataset.attrs[f"{which}_parameter" if which else "parameter"]
    unit = str(dataset.attrs.get(f"{which or 'parameter'}_units", "1"))
    words = str(key).replace("_", " ")
    return str(NAMES.get(key, words)) if unit == "1" else f"{words} ({unit})"


def label_keys(axes: Axes, plane: xarray.Dataset, *, x: bool = True, y: bool = True) -> Axes:
    """The labels of both axes of a plane, or of one."""
    if x:
        axes.set_xlabel(key_text(plane, "x"))
    if y:
        axes.set_ylabel(key_text(plane, "y"))
    return axes
