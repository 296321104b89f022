"""Path of the bob, phase portrait and line spectrum of an orbit."""

import numpy as np
from matplotlib.axes import Axes

from kapitza import style
from kapitza.plots.orbit_record import ROUNDING, Orbit
from kapitza.plots.orbit_time import hide_rounding, write_legend

STROBE, STROKE = style.KINDS["rotation +"], style.KINDS["rotation -"]


def draw_path(axes: Axes, orbit: Orbit, *, colours: tuple[str, str, str] = (style.INK, STROBE, STROKE),
              legend: bool = True) -> Axes:
    """Where the bob goes, in lengths of the pendulum; the pivot's stroke is the thick line. Colours: of path, strobe
    points, stroke."""
    height = orbit.data["pivot"].values
    aside = orbit.data["pivot_aside"].values if "pivot_aside" in orbit.data else np.zeros_like(height)
    axes.plot(aside + np.sin(orbit.theta), height - np.cos(orbit.theta), color=colours[0], linewidth=0.9)
    axes.plot(aside, height, color=colours[2], linewidth=2.5, solid_capstyle="round", label="stroke of the pivot")
    strobe = orbit.data["strobe_theta"].values
    axes.plot(aside[0] + np.sin(strobe), height[0] - np.cos(strobe), "o", markersize=3.5, color=colours[1])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x / length")
    axes.set_ylabel("y / length")
    return write_legend(axes) if legend else axes


def draw_phase(axes: Axes, orbit: Orbit, *, colours: tuple[str, str] = (style.INK, STROBE),
               legend: bool = True) -> Axes:
    """Velocity against angle, strobe points as dots; a rotating orbit is cut where it passes the far side. Colours: of
    curve and strobe points."""
    angle = orbit.wrapped(orbit.theta)
    cut = np.flatnonzero(np.abs(np.diff(angle)) > 180) + 1
    for part in np.split(np.arange(len(angle)), cut):
        axes.plot(angle[part], orbit.speed * orbit.velocity[part], color=colours[0], linewidth=0.8 if orbit.closed
                  else 0.45)
    strobe, velocity = orbit.wrapped(orbit.data["strobe_theta"].values), orbit.data["strobe_velocity"].values
    axes.plot(strobe, orbit.speed * velocity, "o", markersize=4.5 if orbit.closed else 2, color=colours[1], zorder=3,
              label="strobe points")
    axes.set_xlabel(f"angle from {orbit.place} (deg)")
    axes.set_ylabel("velocity (rad/s)" if orbit.si else "velocity (rad per drive radian)")
    hide_rounding(axes, x=2, y=0.02 * orbit.speed)
    return write_legend(axes) if legend else axes


def draw_spectrum(axes: Axes, orbit: Orbit, *, colours: str = STROBE, legend: bool = True,
                  degrees: bool = False) -> Axes:
    """Amplitudes against frequency: stems for a closed orbit, a curve for an open record seen through its window;
    `legend`: the numbers of the strongest lines; `degrees`: amplitudes of angles in degrees."""
    of_velocity = orbit.attributes.get("line_quantity") == "velocity"
    per_speed = orbit.attributes.get("line_units") == "1"
    frequency = orbit.data["line_frequency"].values / orbit.clock
    amplitude = orbit.data["line_amplitude"].values * (orbit.speed if per_speed else np.degrees(1) if degrees else 1)
    top = amplitude[1:].max()
    if orbit.data["line_amplitude"].values[1:].max() < ROUNDING:
        axes.text(0.5, 0.5, "no lines beyond rounding", transform=axes.transAxes, ha="center", va="center",
                  color=style.FAINT)
        return axes
    floor = max(top * 1e-7, 1e-12)
    if orbit.closed:
        # The phase of a rotation is no line
        lines = (amplitude > floor) & (np.arange(len(amplitude)) >= orbit.rotating)
        axes.vlines(frequency[lines], floor, amplitude[lines], color=colours, linewidth=1.6)
        for j in orbit.strongest(4) if legend else []:
            axes.annotate(orbit.line_text(j), (frequency[j], amplitude[j]), (0, 2), textcoords="offset points",
                          ha="center", fontsize="x-small")
    else:
        axes.plot(frequency[1:], np.maximum(amplitude[1:], floor), color=colours, linewidth=0.9)
    axes.set_yscale("log")
    axes.set_ylim(floor, top * 4)
    axes.set_xlim(-0.05 / orbit.clock, _last_line(frequency * orbit.clock, amplitude, floor) / orbit.clock)
    axes.set_xlabel("frequency (Hz)" if orbit.si else "frequency / drive frequency")
    unit = ("rad/s" if orbit.si else "rad per drive radian") if per_speed else "deg" if degrees else "rad"
    axes.set_ylabel(f"{'velocity' if of_velocity else 'amplitude'} ({unit})"
                    + ("" if orbit.closed else ",\nthrough a window"))
    return axes


def _last_line(frequency: np.ndarray, amplitude: np.ndarray, floor: float) -> float:
    """Where the axis ends: beyond the last line that stands out."""
    shown = frequency[amplitude > 10 * floor]
    return max(1.2, float(shown.max()) + 0.2) if len(shown) else 1.2
