"""Draws one orbit from a result file of kapitza: time graph with harmonics, bob path, phase portrait, line spectrum.

    kapitza plot orbit butikov-fig07.h5                               all four panels
    kapitza plot orbit blackburn-fig08.h5 --panels time               only the time graph, its turning points marked
    kapitza plot orbit blackburn-fig09c.h5 --panels phase,path
    kapitza plot orbit FILE --last 20                                 its last 20 drive periods

An open record of more than 200 periods shows its last 100 unless --last says otherwise, a closed orbit of as many
periods one round; the spectrum is always that of the whole record.
"""

import argparse
from collections.abc import Callable, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style
from kapitza.plots.orbit_panels import draw_path, draw_phase, draw_spectrum
from kapitza.plots.orbit_record import Orbit
from kapitza.plots.orbit_time import draw_time
from kapitza.plots.page import current, entitle, new_figure, new_panels
from kapitza.plots.units import add_si
from kapitza.result import Result

PANELS: dict[str, Callable[..., Axes]] = {"time": draw_time, "path": draw_path, "phase": draw_phase,
                                          "spectrum": draw_spectrum}
STUDY = "an orbit"
PANEL = 2.3  # inches of usual letters that a panel needs


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--panels", type=panel_names, help=f"some of {','.join(PANELS)} (default: all)")
    parser.add_argument("--harmonics", type=int, choices=range(5), help="lines drawn into the time graph (default: 3)")
    parser.add_argument("--last", type=periods, metavar="N", help="of an open record, the last N drive periods")
    parser.add_argument("--degrees", action="store_true",
                        help="the lines of the spectrum in degrees too, as all angles are")
    add_si(parser, "time in s, velocities in rad/s, frequencies in Hz")


def panel_names(text: str) -> list[str]:
    """Some of PANELS, each once."""
    names = text.split(",")
    if not set(names) <= PANELS.keys() or len(set(names)) < len(names):
        raise argparse.ArgumentTypeError(f"give one or more of {','.join(PANELS)}")
    return names


def periods(text: str) -> float:
    """A number of drive periods."""
    if not float(text) > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return float(text)


def lay_out(panels: Sequence[str]) -> tuple[Figure, dict[str, Axes]]:
    """The time graph over the whole width, the others beneath it, as many side by side as the page has place for."""
    if len(panels) == 1:
        figure, (axes,) = new_panels(*((6.4, 4.4) if current().inches < 2 * PANEL else (6.6, 3.0)))
        return figure, {panels[0]: axes}
    below = [name for name in panels if name != "time"]
    columns = int(max(1, min(len(below), current().inches // PANEL)))
    rows: list[Any] = [["time"] * columns] if "time" in panels else []
    for first in range(0, len(below), columns):
        row = below[first:first + columns]
        rows.append(row + row[-1:] * (columns - len(row)))
    figure = new_figure(6.4, 4.4 * len(rows)) if current().inches < 2 * PANEL else new_figure(max(6.6, 3.3 * columns),
                                                                                              3.0 * len(rows))
    return figure, figure.subplot_mosaic(rows)


def state_words(orbit: Orbit) -> list[str]:
    """What kind of motion it is, for the line under the picture."""
    name, end = (style.name_text(orbit.attributes.get(key, "")) for key in ("name", "settles_on"))
    if orbit.closed:
        return [name, f"period {orbit.period}"]
    return ["open record", name if name == "chaotic" else f"settles on {end}" if end else ""]


def write_title(figure: Figure, result: Result, orbit: Orbit) -> None:
    """The scene's title, its parameters, and what is seen of which motion."""
    words = {"mathieu": "linear equation", "effective": "slow equation of the effective potential"}.get(
        str(orbit.attributes.get("model")), "")
    parts = [style.parameters_text(result.pendulum), words, *state_words(orbit),
             f"last {orbit.last:g} periods" if orbit.last else ""]
    entitle(figure, result, *parts)


def draw(result: Result, *, panels: Sequence[str] = tuple(PANELS), harmonics: int = 3, last: float | None = None,
         degrees: bool = False, si: bool = False) -> Figure:
    """The page: the panels that were asked for."""
    orbit = Orbit(result, last, si=si)
    figure, axes = lay_out(panels)
    for name, panel in axes.items():
        options: dict[str, dict[str, Any]] = {"time": {"harmonics": harmonics}, "spectrum": {"degrees": degrees}}
        PANELS[name](panel, orbit, **options.get(name, {}))
    write_title(figure, result, orbit)
    return figure
