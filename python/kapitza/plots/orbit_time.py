"""The time graph of an orbit: angle, pivot, harmonics, strobe points, turning points."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from kapitza import style
from kapitza.plots.orbit_record import ROUNDING, Orbit
from kapitza.plots.page import current
from kapitza.units import TURN

HARMONICS = ["#d1602f", "#12806a", "#8a5fb8", "#b08a1e"]  # the strongest lines, in this order


def draw_time(axes: Axes, orbit: Orbit, *, harmonics: int = 3, colours: Sequence[str] = HARMONICS,
              legend: bool = True) -> Axes:
    """The angle against time; of a closed orbit its strongest harmonics beneath it, of an open one its turning
    points."""
    span = 2 * orbit.period if orbit.closed and orbit.period <= 4 else np.inf
    for t, y in _repeated(orbit, span):
        axes.plot(orbit.clock * t, y, color=style.INK, linewidth=1.3, zorder=3)
    if "xi" in orbit.data:
        axes.plot(orbit.clock * orbit.time, orbit.deflection() + np.degrees(orbit.data["xi"].values),
                  color=HARMONICS[0], linewidth=0.9, zorder=2, label="with the fast motion ξ")
    start, end = axes.dataLim.intervalx / orbit.clock
    if orbit.resting:
        axes.text(0.5, 0.8, "at rest: no motion beyond rounding", transform=axes.transAxes, ha="center",
                  color=style.FAINT)
    else:
        _draw_pivot(axes, orbit, start, end)
        _draw_features(axes, orbit, end, colours[:harmonics])
    axes.set_xlim(orbit.clock * start, orbit.clock * end)
    axes.set_xlabel("time (s)" if orbit.si else "time (drive periods)")
    what = "from the steady rotation" if orbit.rotation() else f"from {orbit.place}"
    axes.set_ylabel(f"angle {what} (deg)")
    axes.margins(y=0.08)
    hide_rounding(axes, y=2)
    if end - start <= 25 and not orbit.si:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    return write_legend(axes) if legend else axes


def _draw_features(axes: Axes, orbit: Orbit, end: float, colours: Sequence[str]) -> None:
    """Harmonics and strobe points of a closed orbit, turning points of an open one, where there are few enough to be
    seen."""
    if orbit.closed:
        _draw_harmonics(axes, orbit, end, colours)
    elif not orbit.rotating and orbit.data.sizes["maximum_time"] < 200:
        axes.plot(orbit.clock * orbit.data["maximum_time"] / TURN, np.degrees(orbit.data["maximum_angle"]), "o",
                  markersize=3.2, color=style.KINDS["rotation -"], zorder=4, label="turning points")
    if orbit.closed and orbit.period <= 24:
        t, y = _strobe_deflection(orbit)
        for shift in np.arange(0, end - 1e-9, orbit.time[-1]):
            keep = t + shift <= end + 1e-9
            axes.plot(orbit.clock * (t[keep] + shift), y[keep], "o", markersize=4, color=style.KINDS["rotation +"],
                      zorder=4, label="strobe points" if shift == 0 else None)


def hide_rounding(axes: Axes, **spans: float) -> None:
    """Gives an axis (x or y) whose data differ by rounding alone the span at which that is not seen."""
    for name, span in spans.items():
        low, high = getattr(axes.dataLim, f"interval{name}")
        if high - low < ROUNDING:
            axes.set(**{f"{name}lim": ((low + high - span) / 2, (low + high + span) / 2)})


def write_legend(axes: Axes) -> Axes:
    """Above the panel, where it hides nothing."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.985), ncols=2 if current().narrow else 7,
                    fontsize="small", handlelength=1.4, columnspacing=1.2)
    return axes


def _repeated(orbit: Orbit, span: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """(time, deflection), again and again up to `span` periods for a short closed orbit."""
    y, length = orbit.deflection(), orbit.time[-1]
    shifts = np.arange(0, span - 1e-9, length) if np.isfinite(span) else np.zeros(1)
    return [(orbit.time + shift, y) for shift in shifts]


def _strobe_deflection(orbit: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """(time, deflection) of the strobe points."""
    time = orbit.data["strobe_time"].values
    return time / TURN, orbit.deflection(orbit.data["strobe_theta"].values, time)


def _draw_pivot(axes: Axes, orbit: Orbit, start: float, end: float) -> None:
    """The pivot's motion as a faint curve that fills a fifth of the height."""
    height = 0.2 * np.abs(orbit.deflection()).max()
    if not orbit.data["pivot"].values.any() or end - start > 40:
        return
    t = np.linspace(start, end, int(60 * (end - start)) + 1)
    sign = np.sign(orbit.data["pivot"].values[0])
    axes.plot(orbit.clock * t, sign * height * np.cos(TURN * (t - start)), color="#b9c2cb", linewidth=0.9, zorder=1,
              label="pivot (not to scale)")


def _draw_harmonics(axes: Axes, orbit: Orbit, end: float, colours: Sequence[str]) -> None:
    """The constant part, and as many of the strongest lines as there are colours."""
    t = np.linspace(0, end, int(100 * end) + 1)
    constant, phase = float(orbit.data["line_amplitude"].values[0]), float(orbit.data["line_phase"].values[0])
    if not orbit.rotating and constant > 0.01 * orbit.data["line_amplitude"].values.max():
        axes.axhline(np.degrees(constant * np.cos(phase)), color=style.FAINT, linewidth=0.9, linestyle="--", zorder=2,
                     label=f"constant: {np.degrees(constant):.3g}°")
    for colour, j in zip(colours, orbit.strongest(len(colours)), strict=False):
        frequency, amplitude, phase = (float(orbit.data[f"line_{name}"].values[j])
                                       for name in ("frequency", "amplitude", "phase"))
        axes.plot(orbit.clock * t, np.degrees(amplitude) * np.cos(TURN * frequency * t + phase), color=colour,
                  linewidth=0.9, zorder=2, label=f"line {orbit.line_text(j)}: {np.degrees(amplitude):.3g}°")
