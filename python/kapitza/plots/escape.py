"""Draws a path of least action: above in the plane of angle and velocity, below its torque in time; or barriers over
one parameter or two.

    kapitza plot escape escape-fig12.h5 --attractor inverted
    kapitza plot escape FILE --attractor down --into inverted       with escape.into_every_basin
    kapitza plot escape escape-line.h5 --view barrier               with escape.x; a plane with escape.y too
"""

import argparse

import numpy as np
import pandas
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style, units
from kapitza.plots.page import entitle, new_figure, new_panels
from kapitza.plots.parameter_axes import key_text, label_keys
from kapitza.result import BadFile, Result

STUDY = "ways out"
PATH, SADDLE, TORQUE = style.INK, style.KINDS["rotation -"], style.KINDS["rotation +"]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", choices=("path", "barrier"),
                        help="one path, or the barrier over the parameters x and y of the file")
    parser.add_argument("--points", metavar="CSV",
                        help="counted slopes on a line of barriers, with the columns x, slope and error")
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
    unit = units.energy_unit(result.pendulum)
    axes.plot(escape["time"].values[here], escape["torque"].values[here] * (unit or 1), color=colours[0],
              linewidth=0.9, label="torque")
    if legend:
        axes.legend(fontsize="small")
    axes.set_xlabel("drive periods")
    axes.set_ylabel("torque (I ω²)" if unit is None else "torque (N m)")
    return axes


def _over_parameters(result: Result, attractor: str | None, wanted: str) -> tuple[xarray.Dataset, np.ndarray]:
    """The group, and the barrier over x, or y and x, of an attractor; default: of the first with one."""
    escape = result.group("escape")
    if wanted not in escape:
        raise BadFile(f"{result.path}: holds no barriers over parameters; escape.x and escape.y give them")
    barrier = escape[wanted].values
    known = np.isfinite(barrier.reshape(len(barrier), -1)).any(axis=1)
    return escape, barrier[int(np.argmax(known)) if attractor is None else _number(result, attractor)]


def draw_line(axes: Axes, result: Result, attractor: str | None = None, *, points: str | None = None,
              colours: tuple[str, str, str] = (PATH, SADDLE, TORQUE), legend: bool = True) -> Axes:
    """The barrier along one parameter, beside that of the averaged potential where the parameter is the drive's
    amplitude, and counted slopes. Colours: of the barrier, the averaged potential, the slopes."""
    escape, barrier = _over_parameters(result, attractor, "line_barrier")
    x = escape["x"].values
    axes.plot(x, barrier, ".-", color=colours[0], linewidth=0.9, markersize=3, label="least action found")
    if escape.attrs["x_parameter"] in ("drive_amplitude", "m"):
        averaged = (x / 2 - result.pendulum["k"] / x) ** 2
        axes.plot(x, averaged, "--", color=colours[1], linewidth=0.9, label="averaged potential, (12)")
    if points:
        table = pandas.read_csv(points, comment="#")
        axes.errorbar(table["x"], table["slope"], table["error"], fmt="o", markersize=3.5, color=colours[2],
                      label="slope of ln(counted life) over 1/T")
    axes.set_ylim(0, 1.7 * np.nanmax(barrier))
    axes.set_xlabel(key_text(escape, "x"))
    axes.set_ylabel("barrier R (I ω²)")
    if legend:
        axes.legend(fontsize="small")
    return axes


def draw_barriers(axes: Axes, result: Result, attractor: str | None = None, *, colours: str = "viridis",
                  legend: bool = True) -> Axes:
    """The barrier over the plane of two parameters; white where the motion has none. Colours: a map of matplotlib."""
    escape, barrier = _over_parameters(result, attractor, "plane_barrier")
    mesh = axes.pcolormesh(escape["x"].values, escape["y"].values, barrier, cmap=colours, shading="nearest",
                           rasterized=True)
    if legend:
        axes.figure.colorbar(mesh, ax=axes, label="barrier R (I ω²)")
    return label_keys(axes, escape)


def _draw_over_parameters(result: Result, attractor: str | None, points: str | None) -> Figure:
    figure = new_figure(6.4, 4.4)
    axes = figure.add_subplot()
    if "plane_barrier" in result.group("escape"):
        draw_barriers(axes, result, attractor)
    else:
        draw_line(axes, result, attractor, points=points)
    entitle(figure, result, "barriers of the least torque")
    return figure


def draw(result: Result, *, attractor: str | None = None, into: str | None = None, view: str = "path",
         points: str | None = None) -> Figure:
    """The page: the path above, its torque below; or barriers over parameters."""
    if view == "barrier":
        return _draw_over_parameters(result, attractor, points)
    way = chosen_path(result, attractor, into)
    figure, (above, below) = new_panels(7.2, 6.4, 2, height_ratios=[3, 1.4])
    draw_plane(above, result, way)
    draw_torque(below, result, way)
    barrier = float(result.group("escape")["barrier"].values[way])
    entitle(figure, result, f"action {barrier:.6g} I ω²", style.parameters_text(result.pendulum))
    return figure
