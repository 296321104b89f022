"""Flutter along a sweep: its amplitude, and where it begins and ends."""

import numpy as np
import xarray
from matplotlib.axes import Axes

from kapitza import style
from kapitza.plots.branches import parameter_text
from kapitza.units import drive_unit, in_degrees

FLUTTER = style.KINDS["flutter"]
ZONE = (FLUTTER, FLUTTER, FLUTTER, style.INK, style.KINDS["inverted"])  # area, end, asymmetry, releases, onset


def draw_amplitude(axes: Axes, sweep: xarray.Dataset, *, colours: str = FLUTTER, legend: bool = True) -> Axes:
    """Amplitude over the parameter; `legend`: the critical value beside its line."""
    axes.plot(sweep["value"].values, in_degrees(sweep["flutter_amplitude"]), color=colours, lw=1.6)
    axes.set(xlabel=parameter_text(sweep), ylabel="amplitude / degrees", ylim=(0, None))
    critical = sweep.attrs["critical_value"]
    axes.axvline(critical, color=style.FAINT, lw=0.8, ls="--")
    if legend:
        axes.annotate(f"multiplier −1 at {critical:.9g}", (critical, axes.get_ylim()[1]), (4, -12), textcoords="offset points",
                      fontsize="small", color=style.FAINT)
    return axes


def draw_square(axes: Axes, sweep: xarray.Dataset, *, colours: str = FLUTTER, legend: bool = True) -> Axes:
    """Amplitude^2 from the critical value on, with its tangent there; `legend`: with the numbers of the fit."""
    amplitude, fit, rad = sweep["flutter_amplitude"].values, sweep.attrs, drive_unit(sweep["flutter_amplitude"])
    there = np.isfinite(amplitude)
    distance = sweep["value"].values[there] - fit["critical_value"]
    axes.plot(distance, amplitude[there] ** 2, color=colours, lw=1.6, label="amplitude²")
    near = amplitude[there][np.argmin(np.abs(distance))] ** 2 / np.abs(distance).min() if there.any() else np.nan
    axes.plot(distance, near * distance, color=style.FAINT, lw=0.8, ls="--",
              label=f"tangent, {np.sqrt(near) / rad:.3f}² rad² per unit")
    unit = "rad²" if rad == 1 else "degrees²"
    axes.set(xlabel=f"{parameter_text(sweep)} − critical value", ylabel=f"amplitude² / {unit}", ylim=(0, None))
    if legend:
        axes.plot([], [], " ", label=f"fitted slope {fit['fit_slope']:.3f} ± {fit['fit_slope_stderr']:.3f}")
        axes.plot([], [], " ", label=f"exponent {fit['fit_exponent']:.4f} ± {fit['fit_exponent_error']:.4f}")
        axes.legend(loc="upper left", fontsize="small")
    return axes


def draw_zone(axes: Axes, sweep: xarray.Dataset, *, colours: tuple[str, str, str, str, str] = ZONE, legend: bool = True) -> Axes:
    """Where flutter begins and ends in the drive amplitude (colours: of area, end, asymmetry, releases, onset)."""
    value = sweep["value"].values
    onset, asymmetry, end, release = (sweep[f"flutter_{name}"].values for name in ("onset", "asymmetry", "end", "release_end"))
    axes.fill_between(value, onset, end, color=style.shade(colours[0], 0.8), lw=0)
    axes.plot(value, end, color=colours[1], lw=1, ls=":", label="asymmetric cycles double their period")
    axes.plot(value, asymmetry, color=colours[2], lw=1.4, label="flutter loses its mirror symmetry")
    axes.plot(value, release, "o", color=colours[3], markersize=4, label="a release of 1° from rest fails (the dots)")
    axes.plot(value, onset, color=colours[4], lw=1.8, label="inverted gives way to flutter")
    axes.set(xlabel=parameter_text(sweep), ylabel=r"drive amplitude $\epsilon$ = m", xlim=(value[0], value[-1]))
    if legend:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    return axes
