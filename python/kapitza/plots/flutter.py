"""Flutter along a sweep: its amplitude, and how it grows. Both take what Result.flutter gives."""

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza import style
from kapitza.plots.branches import parameter_text
from kapitza.units import drive_unit, in_degrees

FLUTTER = style.KINDS["flutter"]


def draw_amplitude(axes: Axes, flutter: xarray.Dataset, *, colours: str = FLUTTER, legend: bool = True) -> Axes:
    """Amplitude over the parameter; `legend`: the value of the onset beside its line."""
    axes.plot(flutter["value"].values, in_degrees(flutter["amplitude"]), color=colours, lw=1.6)
    axes.set(xlabel=parameter_text(flutter), ylabel="amplitude / degrees", ylim=(0, None))
    onset = flutter.attrs["onset"]
    axes.axvline(onset, color=style.FAINT, lw=0.8, ls="--")
    if legend:
        axes.annotate(f"multiplier −1 at {onset:.9g}", (onset, axes.get_ylim()[1]), (4, -12),
                      textcoords="offset points", fontsize="small", color=style.FAINT)
    return axes


def draw_square(axes: Axes, flutter: xarray.Dataset, *, colours: str = FLUTTER, legend: bool = True) -> Axes:
    """Amplitude^2 from the onset on, with its tangent there; `legend`: with the numbers of the fit."""
    amplitude, fit, rad = flutter["amplitude"].values, flutter.attrs, drive_unit(flutter["amplitude"])
    there = np.isfinite(amplitude)
    distance = flutter["value"].values[there] - fit["onset"]
    axes.plot(distance, amplitude[there] ** 2, color=colours, lw=1.6, label="amplitude²")
    near = amplitude[there][np.argmin(np.abs(distance))] ** 2 / np.abs(distance).min() if there.any() else np.nan
    axes.plot(distance, near * distance, color=style.FAINT, lw=0.8, ls="--",
              label=f"tangent, {np.sqrt(near) / rad:.3f}² rad² per unit")
    unit = "rad²" if rad == 1 else "degrees²"
    axes.set(xlabel=f"{parameter_text(flutter)} − onset", ylabel=f"amplitude² / {unit}", ylim=(0, None))
    if legend:
        axes.plot([], [], " ", label=f"fitted slope {fit['slope']:.3f} ± {fit['slope_stderr']:.3f}")
        axes.plot([], [], " ", label=f"exponent {fit['exponent']:.4f} ± {fit['exponent_error']:.4f}")
        axes.legend(loc="upper left", fontsize="small")
    return axes
