#!/usr/bin/env python3
"""Draws one orbit from a result file of kapitza: time graph with harmonics, bob path, phase portrait, line spectrum.

    .venv/bin/python scripts/plot_orbit.py butikov-fig07.h5                               all four panels
    .venv/bin/python scripts/plot_orbit.py blackburn-fig08.h5 --panels time               only the time graph, its turning points marked
    .venv/bin/python scripts/plot_orbit.py blackburn-fig09c.h5 --panels phase,path
    .venv/bin/python scripts/plot_orbit.py FILE --last 20                                 its last 20 drive periods

An open record of more than 200 periods shows its last 100 unless --last says otherwise, a closed orbit of as many periods one round;
the spectrum is always that of the whole record.
"""

import argparse

import kapitza_style as style
import matplotlib.pyplot as plt
import numpy as np
from kapitza_file import BadFile, Result, run
from kapitza_plot import argument_parser, entitle, parsed
from matplotlib.ticker import MaxNLocator

PANELS = ("time", "path", "phase", "spectrum")
HARMONICS = ["#d1602f", "#12806a", "#8a5fb8", "#b08a1e"]  # the strongest lines, in this order
TURN = 2 * np.pi
LONG, LAST = 200, 100  # open records of more periods than LONG show their last ones
ROUNDING = 1e-9  # deg, and whatever else an axis counts in: what spans less is rounding noise, not motion


def parse_arguments():
    parser = argument_parser(__doc__, "an orbit")
    parser.add_argument("--panels", default=",".join(PANELS), help=f"some of {','.join(PANELS)} (default: all)")
    parser.add_argument("--harmonics", type=int, default=3, choices=range(5), help="lines drawn into the time graph (default: 3)")
    parser.add_argument("--last", type=periods, metavar="N", help="of an open record, the last N drive periods")
    arguments = parsed(parser)
    arguments.panels = arguments.panels.split(",")
    if not set(arguments.panels) <= set(PANELS):
        parser.error(f"--panels takes some of {','.join(PANELS)}")
    return arguments


def periods(text):
    """A number of drive periods."""
    if not float(text) > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return float(text)


def cut(data, start, end):
    """The orbit's data between two times (drive periods)."""
    for time in ("time", "strobe_time", "maximum_time"):
        inside = (data[time].values >= TURN * start - 1e-6) & (data[time].values <= TURN * end + 1e-6)
        data = data.isel({data[time].dims[0]: np.flatnonzero(inside)})
    return data


def shown(data, last):
    """(data, last periods that they are or None): of a long open record its last periods, of a long closed orbit one round."""
    length = float(data["time"].values[-1]) / TURN
    if data.attrs["closed"]:
        return (cut(data, 0, int(data.attrs["period"])) if length > LONG else data), None
    last = last or (LAST if length > LONG else length)
    return (cut(data, length - last, length), last) if last < length else (data, None)


class Orbit:
    """The group orbit in the units of the pictures: degrees from the centre, drive periods."""

    def __init__(self, result, last=None):
        self.data, self.last = shown(result.group("orbit"), last)
        self.attributes = self.data.attrs
        self.closed = bool(self.attributes["closed"])
        self.rotating = int(self.attributes["centre"]) == 2
        self.period = int(self.attributes["period"])
        self.centre = self._centre()
        self.time = self.data["time"].values / TURN
        self.theta = self.data["theta"].values
        self.velocity = self.data["velocity"].values

    def _centre(self):
        """The copy of down or inverted that the orbit moves about; rad."""
        if int(self.attributes["centre"]) > 1:
            return 0.0
        offset = np.pi * int(self.attributes["centre"])
        mean = float(self.data["theta"].mean())
        return offset + TURN * np.rint((mean - offset) / TURN)

    @property
    def resting(self):
        """Whether nothing moves but the last digits."""
        return np.ptp(self.deflection()) < ROUNDING

    @property
    def place(self):
        return {0: "down", 1: "inverted"}.get(int(self.attributes["centre"]), "down")

    def rotation(self):
        """Turns per drive period that the lines leave out."""
        return int(self.attributes["winding"]) / max(self.period, 1) if self.rotating and self.period else 0.0

    def deflection(self, theta=None, time=None):
        """Degrees from the centre; of a rotation, from the steady turn."""
        theta, time = (self.theta, self.data["time"].values) if theta is None else (theta, time)
        return np.degrees(theta - self.centre - self.rotation() * time - self._mean())

    def _mean(self):
        """Mean angle of a rotation beside its steady turn; rad."""
        if not self.rotation():
            return 0.0
        return float(np.mean((self.theta - self.rotation() * self.data["time"].values)[:-1]))

    def wrapped(self, theta):
        """Degrees from the centre within half a turn."""
        return np.degrees(theta - self.centre - TURN * np.rint((theta - self.centre) / TURN))

    def strongest(self, count):
        """Numbers j >= 1 of the strongest lines."""
        amplitude = self.data["line_amplitude"].values[1:]
        order = 1 + np.argsort(-amplitude)[:count]
        return [j for j in order if amplitude[j - 1] > 0.01 * amplitude.max()]

    def line_text(self, j):
        """j/n of the drive."""
        whole = round(1 / float(self.data["line_frequency"].values[1]))
        return f"{j}/{whole}" if j % whole else str(j // whole)


def draw_time(axes, orbit, harmonics):
    """The angle against time; of a closed orbit its strongest harmonics beneath it, of an open one its turning points."""
    span = 2 * orbit.period if orbit.closed and orbit.period <= 4 else np.inf
    for t, y in repeated(orbit, span):
        axes.plot(t, y, color=style.INK, linewidth=1.3, zorder=3)
    start, end = axes.dataLim.intervalx
    if orbit.resting:
        axes.text(0.5, 0.8, "at rest: no motion beyond rounding", transform=axes.transAxes, ha="center", color=style.FAINT)
    else:
        pivot_axis(axes, orbit, start, end)
        draw_features(axes, orbit, end, harmonics)
    axes.set_xlim(start, end)
    axes.set_xlabel("time (drive periods)")
    what = "from the steady rotation" if orbit.rotation() else f"from {orbit.place}"
    axes.set_ylabel(f"angle {what} (deg)")
    axes.margins(y=0.08)
    hide_rounding(axes, y=2)
    if end - start <= 25:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    write_legend(axes)


def draw_features(axes, orbit, end, harmonics):
    """Harmonics and strobe points of a closed orbit, turning points of an open one, where there are few enough to be seen."""
    if orbit.closed:
        draw_harmonics(axes, orbit, end, harmonics)
    elif not orbit.rotating and orbit.data.sizes["maximum_time"] < 200:
        axes.plot(orbit.data["maximum_time"] / TURN, np.degrees(orbit.data["maximum_angle"]), "o", markersize=3.2,
                  color=style.KINDS["rotation -"], zorder=4, label="turning points")
    if orbit.closed and orbit.period <= 24:
        t, y = strobe_deflection(orbit)
        for shift in np.arange(0, end - 1e-9, orbit.time[-1]):
            keep = t + shift <= end + 1e-9
            axes.plot(t[keep] + shift, y[keep], "o", markersize=4, color=style.KINDS["rotation +"], zorder=4,
                      label="strobe points" if shift == 0 else None)


def hide_rounding(axes, **spans):
    """Gives an axis (x or y) whose data differ by rounding alone the span at which that is not seen."""
    for name, span in spans.items():
        low, high = getattr(axes.dataLim, f"interval{name}")
        if high - low < ROUNDING:
            axes.set(**{f"{name}lim": ((low + high - span) / 2, (low + high + span) / 2)})


def write_legend(axes):
    """Above the panel, where it hides nothing."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.985), ncols=7, fontsize=7.5, handlelength=1.4,
                    columnspacing=1.2)


def repeated(orbit, span):
    """(time, deflection), again and again up to `span` periods for a short closed orbit."""
    y, length = orbit.deflection(), orbit.time[-1]
    shifts = np.arange(0, span - 1e-9, length) if np.isfinite(span) else [0.0]
    return [(orbit.time + shift, y) for shift in shifts]


def strobe_deflection(orbit):
    time = orbit.data["strobe_time"].values
    return time / TURN, orbit.deflection(orbit.data["strobe_theta"].values, time)


def pivot_axis(axes, orbit, start, end):
    """The pivot's motion as a faint curve that fills a fifth of the height."""
    height = 0.2 * np.abs(orbit.deflection()).max()
    if not orbit.data["pivot"].values.any() or end - start > 40:
        return
    t = np.linspace(start, end, int(60 * (end - start)) + 1)
    sign = np.sign(orbit.data["pivot"].values[0])
    axes.plot(t, sign * height * np.cos(TURN * (t - start)), color="#b9c2cb", linewidth=0.9, zorder=1, label="pivot (not to scale)")


def draw_harmonics(axes, orbit, end, count):
    t = np.linspace(0, end, int(100 * end) + 1)
    constant, phase = float(orbit.data["line_amplitude"].values[0]), float(orbit.data["line_phase"].values[0])
    if not orbit.rotating and constant > 0.01 * orbit.data["line_amplitude"].values.max():
        axes.axhline(np.degrees(constant * np.cos(phase)), color=style.FAINT, linewidth=0.9, linestyle="--", zorder=2,
                     label=f"constant: {np.degrees(constant):.3g}°")
    for colour, j in zip(HARMONICS, orbit.strongest(count), strict=False):
        frequency, amplitude, phase = (float(orbit.data[f"line_{name}"].values[j]) for name in ("frequency", "amplitude", "phase"))
        axes.plot(t, np.degrees(amplitude) * np.cos(TURN * frequency * t + phase), color=colour, linewidth=0.9, zorder=2,
                  label=f"line {orbit.line_text(j)}: {np.degrees(amplitude):.3g}°")


def draw_path(axes, orbit):
    """Where the bob goes, in lengths of the pendulum; the pivot's stroke is the thick line."""
    pivot = orbit.data["pivot"].values
    x, y = np.sin(orbit.theta), pivot - np.cos(orbit.theta)
    axes.plot(x, y, color=style.INK, linewidth=0.9)
    stroke = np.abs(pivot).max()
    axes.plot([0, 0], [-stroke, stroke], color=style.KINDS["rotation -"], linewidth=2.5, solid_capstyle="round",
              label="stroke of the pivot")
    strobe = orbit.data["strobe_theta"].values
    axes.plot(np.sin(strobe), pivot[0] - np.cos(strobe), "o", markersize=3.5, color=style.KINDS["rotation +"])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x / length")
    axes.set_ylabel("y / length")
    write_legend(axes)


def draw_phase(axes, orbit):
    """Velocity against angle, strobe points as dots; a rotating orbit is cut where it passes the far side."""
    angle = orbit.wrapped(orbit.theta)
    cut = np.flatnonzero(np.abs(np.diff(angle)) > 180) + 1
    for part in np.split(np.arange(len(angle)), cut):
        axes.plot(angle[part], orbit.velocity[part], color=style.INK, linewidth=0.8 if orbit.closed else 0.45)
    strobe, velocity = orbit.wrapped(orbit.data["strobe_theta"].values), orbit.data["strobe_velocity"].values
    axes.plot(strobe, velocity, "o", markersize=4.5 if orbit.closed else 2, color=style.KINDS["rotation +"], zorder=3,
              label="strobe points")
    axes.set_xlabel(f"angle from {orbit.place} (deg)")
    axes.set_ylabel("velocity (rad per drive radian)")
    hide_rounding(axes, x=2, y=0.02)
    write_legend(axes)


def draw_spectrum(axes, orbit):
    """Amplitudes against frequency: stems for a closed orbit, a curve for an open record seen through its window."""
    frequency, amplitude = orbit.data["line_frequency"].values, orbit.data["line_amplitude"].values
    top = amplitude[1:].max()
    if top < ROUNDING:
        axes.text(0.5, 0.5, "no lines beyond rounding", transform=axes.transAxes, ha="center", va="center", color=style.FAINT)
        return
    floor = max(top * 1e-7, 1e-12)
    if orbit.closed:
        lines = (amplitude > floor) & (np.arange(len(amplitude)) >= orbit.rotating)  # the phase of a rotation is no line
        axes.vlines(frequency[lines], floor, amplitude[lines], color=style.KINDS["rotation +"], linewidth=1.6)
        for j in orbit.strongest(4):
            axes.annotate(orbit.line_text(j), (frequency[j], amplitude[j]), (0, 2), textcoords="offset points", ha="center",
                          fontsize=7)
    else:
        axes.plot(frequency[1:], np.maximum(amplitude[1:], floor), color=style.KINDS["rotation +"], linewidth=0.9)
    axes.set_yscale("log")
    axes.set_ylim(floor, top * 4)
    axes.set_xlim(-0.05, last_line(frequency, amplitude, floor))
    axes.set_xlabel("frequency / drive frequency")
    what = "velocity" if orbit.attributes.get("line_quantity") == "velocity" else "amplitude"
    axes.set_ylabel(f"{what} ({orbit.attributes.get('line_units', 'rad')})" + ("" if orbit.closed else ",\nthrough a window"))


def last_line(frequency, amplitude, floor):
    shown = frequency[amplitude > 10 * floor]
    return max(1.2, shown.max() + 0.2) if len(shown) else 1.2


def lay_out(panels):
    """The time graph over the whole width, the others beneath it side by side."""
    below = [name for name in panels if name != "time"]
    rows = [["time"] * max(1, len(below))] if "time" in panels else []
    rows += [below] if below else []
    width = 3.3 * max(2, len(below)) if below else 7.0
    figure, axes = plt.subplot_mosaic(rows, figsize=(width, 3.0 * len(rows)), layout="constrained")
    return figure, axes


def state_words(orbit):
    """What kind of motion it is, for the line under the picture."""
    name, end = (style.name_text(orbit.attributes.get(key, "")) for key in ("name", "settles_on"))
    if orbit.closed:
        return [name, f"period {orbit.period}"]
    return ["open record", name if name == "chaotic" else f"settles on {end}" if end else ""]


def write_title(figure, result, orbit):
    words = {"mathieu": "linear equation", "effective": "slow equation of the effective potential"}.get(
        str(orbit.attributes.get("model")), "")
    parts = [style.parameters_text(result.pendulum), words, *state_words(orbit),
             f"last {orbit.last:g} periods" if orbit.last else ""]
    entitle(figure, result, *parts)


def draw(arguments):
    result = Result(arguments.file)
    orbit = Orbit(result, arguments.last)
    if len(orbit.time) < 2:
        raise BadFile(f"{result.path}: the orbit has no length")
    figure, axes = lay_out(arguments.panels)
    if "time" in axes:
        draw_time(axes["time"], orbit, arguments.harmonics)
    for name, panel in (("path", draw_path), ("phase", draw_phase), ("spectrum", draw_spectrum)):
        if name in axes:
            panel(axes[name], orbit)
    write_title(figure, result, orbit)
    style.save(figure, arguments.output, arguments.dpi)


def main():
    arguments = parse_arguments()
    style.use()
    draw(arguments)


if __name__ == "__main__":
    run(main)
