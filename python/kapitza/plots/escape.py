"""Draws a path of least action: above in the plane of angle and velocity, below its torque in time.

    kapitza plot escape escape-fig12.h5 --attractor inverted
    kapitza plot escape FILE --attractor down --into inverted       with escape.into_every_basin
"""

import argparse

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style
from kapitza.plots.page import entitle, new_panels
from kapitza.result import BadFile, Result

STUDY = "ways out"
PATH, SADDLE, TORQUE = style.INK, style.KINDS["rotation -"], style.KINDS["rotation +"]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--attractor", metavar="ID|NAME",
                        help="which motion is left; default: the first one with a path")
    parser.add_argument("--into", metavar="ID|NAME", help="into which basin; default: out of its own")


def chosen_path(result: Result, attractor: str | None = None, into: str | None = None) -> int:
    """The place of a path in `route`.

    :raises BadFile: if the file holds no such path
    """
    escape = result.group("escape")
    ways = escape["way_out"].values
    number = int(np.argmax(ways >= 0)) if attractor is None else _number(result, attractor)
    if into is not None and "way_into" not in escape:
        raise BadFile(f"{result.path}: holds paths out of basins only; escape.into_every_basin gives the others")
    way = int(ways[number] if into is None else escape["way_into"].values[number, _number(result, into)])
    if way not in escape["path"].values:
        raise BadFile(f"{result.path}: holds no such path of attractor {number}")
    return way


def _number(result: Result, wanted: str) -> int:
    names = [str(name) for name in result.group("attractors")["name"].values]
    full = style.names_with_ids(names)
    found = [number for number in range(len(names)) if wanted in (names[number], full[number], str(number))]
    if not found:
        raise BadFile(f"{result.path}: has no attractor {wanted}; it has 0..{len(names) - 1}: {', '.join(full)}")
    return found[0]


def draw_plane(axes: Axes, result: Result, way: int, *, colours: tuple[str, str] = (PATH, SADDLE),
               legend: bool = True) -> Axes:
    """The path in units of pi and rad per drive radian; its strobe points, and those of both cycles. Colours: of path
    and saddle."""
    escape = result.group("escape").isel(point=result.group("escape")["path"].values == way)
    theta, velocity, time = (escape[name].values for name in ("theta", "velocity", "time"))
    strobe = np.isclose(time, np.round(time))
    axes.plot(theta / np.pi, velocity, color=colours[0], linewidth=0.7)
    axes.plot(theta[strobe] / np.pi, velocity[strobe], "o", markersize=2.5, color=colours[0],
              label="path, at each strobe")
    ends = (("attractors", "from", "s", colours[0], theta[0]), ("saddles", "saddle", "D", colours[1], theta[-1]))
    for group, variable, marker, colour, near in ends:
        table, number = result.group(group), int(escape[variable].values[way])
        x, y = (table[f"strobe_{name}"].values[number] for name in ("theta", "velocity"))
        x = x + 2 * np.pi * np.round((near - x) / (2 * np.pi))
        axes.plot(x / np.pi, y, marker, markersize=6, color=colour, fillstyle="none", linestyle="none",
                  label=style.name_text(table["name"].values[number]))
    axes.set_xlabel("angle from down (π)")
    axes.set_ylabel("velocity (rad per drive radian)")
    if legend:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    return axes


def draw_torque(axes: Axes, result: Result, way: int, *, colours: tuple[str] = (TORQUE,), legend: bool = False) -> Axes:
    """The torque that leads along the path. Colours: of the torque."""
    escape = result.group("escape")
    here = escape["path"].values == way
    axes.axhline(0, color=style.FAINT, linewidth=0.6)
    axes.plot(escape["time"].values[here], escape["torque"].values[here], color=colours[0], linewidth=0.9,
              label="torque")
    if legend:
        axes.legend(fontsize="small")
    axes.set_xlabel("drive periods")
    axes.set_ylabel("torque (I ω²)")
    return axes


def draw(result: Result, *, attractor: str | None = None, into: str | None = None) -> Figure:
    """The page: the path above, its torque below."""
    way = chosen_path(result, attractor, into)
    figure, (above, below) = new_panels(7.2, 6.4, 2, height_ratios=[3, 1.4])
    draw_plane(above, result, way)
    draw_torque(below, result, way)
    barrier = float(result.group("escape")["barrier"].values[way])
    entitle(figure, result, f"action {barrier:.6g} I ω²", style.parameters_text(result.pendulum))
    return figure
