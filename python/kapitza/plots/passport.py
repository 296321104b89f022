"""Draws one page about an attractor: its orbit on the phase plane, in time and its spectrum, its multipliers, its
basin, its measures.

    kapitza plot passport blackburn-fig12.h5 --attractor inverted
    kapitza plot passport blackburn-fig12.h5 --attractor 5
        by its number in the table of attractors, or of measures

The program computes the orbit. What the file does not hold is left out: the basin, multipliers, measures.
"""

import argparse
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style
from kapitza.measures import rows_of
from kapitza.plots.basin import draw_one
from kapitza.plots.orbit_panels import STROBE, draw_phase, draw_spectrum
from kapitza.plots.orbit_record import Orbit
from kapitza.plots.orbit_time import draw_time
from kapitza.plots.page import entitle, new_figure
from kapitza.plots.units import add_si
from kapitza.result import BadFile, Result
from kapitza.session import orbit

STUDY = "attractors or measures"
CHAOTIC_PERIODS, CHAOTIC_TRANSIENT = 200, 200  # drive periods of the record of a chaotic motion, and before it
MOST_LINES = 13  # lines of a table in one column
SAME = 1e-6  # rad: strobe points of one attractor in two groups differ less


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--attractor", metavar="ID|NAME", help="default: the first one")
    add_si(parser, "times in s, velocities in rad/s, frequencies in Hz")


def chosen_row(result: Result, wanted: str) -> tuple[str, int]:
    """The group that tells attractors, and the number of the one that is wanted; of several of one name the first."""
    group = next((name for name in ("attractors", "measures") if name in result.groups), None)
    if group is None:
        raise BadFile(f"{result.path}: holds neither attractors nor measures")
    names = [str(name) for name in result.group(group)["name"].values]
    full = style.names_with_ids(names)
    found = [number for number in range(len(names)) if wanted in (names[number], full[number], str(number))]
    if not found:
        raise BadFile(f"{result.path}: has no attractor {wanted}; it has 0..{len(names) - 1}: {', '.join(full)}")
    return group, found[0]


def start_of(result: Result, group: str, number: int) -> tuple[float, float]:
    """The first strobe point of an attractor; of chaos in the group measures its means."""
    table, words = result.group(group), ("strobe_theta",
                                         "strobe_velocity") if group == "attractors" else ("theta", "velocity")
    theta, velocity = (float(np.ravel(table[word].values[number])[0]) for word in words)
    if not np.isfinite(theta):
        raise BadFile(f"{style.name_text(table['name'].values[number])} never closes, and the file holds no state of "
                      "it to start from")
    return theta, velocity


def orbit_of(result: Result, group: str, number: int, si: bool) -> Orbit:
    """The closed orbit from the first strobe point, as the program computes it; a record of a chaotic motion."""
    theta, velocity = start_of(result, group, number)
    if int(result.group(group)["period"].values[number]) > 0:
        return Orbit(orbit(result.scene, theta, velocity, closed=True, progress=False), si=si)
    return Orbit(orbit(result.scene, theta, velocity, periods=CHAOTIC_PERIODS, transient=CHAOTIC_TRANSIENT,
                       progress=False), si=si)


def measures_row(result: Result, group: str, number: int) -> int | None:
    """The row of the group measures with the same attractor; None if there is none."""
    if "measures" not in result.groups or group == "measures":
        return number if group == "measures" else None
    measures, attractors = result.group("measures"), result.group("attractors")
    theta, velocity = (attractors[f"strobe_{word}"].values[number] for word in ("theta", "velocity"))
    for row in np.flatnonzero(measures["period"].values == attractors["period"].values[number]):
        apart = np.remainder(theta - float(measures["theta"][row]) + np.pi, 2 * np.pi) - np.pi
        if np.nanmin(np.hypot(apart, velocity - float(measures["velocity"][row]))) < SAME:
            return int(row)
    return None


def draw_multipliers(axes: Axes, multipliers: np.ndarray, *, colours: str = STROBE, legend: bool = True) -> Axes:
    """Floquet multipliers (complex) and the unit circle; `legend`: their moduli."""
    angle = np.linspace(0, 2 * np.pi, 181)
    axes.plot(np.cos(angle), np.sin(angle), color=style.FAINT, linewidth=0.8)
    axes.axhline(0, color=style.FAINT, linewidth=0.4)
    axes.axvline(0, color=style.FAINT, linewidth=0.4)
    axes.plot(multipliers.real, multipliers.imag, "o", color=colours, markeredgecolor=style.INK, markeredgewidth=0.6,
              markersize=5)
    reach = 1.15 * max(1.0, float(np.abs(multipliers).max()))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="real part of the multiplier", ylabel="imaginary part",
             aspect="equal")
    if legend:
        moduli = sorted({f"{abs(value):.4g}" for value in multipliers}, key=float, reverse=True)
        axes.set_title("modulus " + ", ".join(moduli), fontsize="small", fontweight="normal", loc="left")
    return axes


def multipliers_of(result: Result, group: str, number: int) -> np.ndarray:
    """Those that the file has, over the period of the orbit."""
    table = result.group(group)
    if "multiplier_re" not in table:
        return np.array([])
    values = table["multiplier_re"].values[number] + 1j * table["multiplier_im"].values[number]
    return np.asarray(values[np.isfinite(values)])


def draw_table(axes: Axes, rows: list[tuple[str, str]], *, colours: str = style.FAINT, legend: bool = False) -> Axes:
    """Words and values below each other, many in two columns if there is room; `colours`: of the words; `legend`: a
    line above them."""
    axes.axis("off")
    if legend:
        axes.set_title("measures", fontsize="medium", loc="left")
    place_of = axes.get_subplotspec()
    wide = place_of is not None and len(place_of.colspan) > 1
    length = -(-len(rows) // 2) if wide and len(rows) > MOST_LINES else len(rows)
    step = min(0.075, 1 / max(1, length))
    for place, (word, value) in enumerate(rows):
        left, right = ((0, 1) if length == len(rows) else (0, 0.48), (0.52, 1))[place // length]
        top = 1 - place % length * step
        axes.plot([left, right], [top - step] * 2, transform=axes.transAxes, color=colours, linewidth=0.25)
        axes.text(left, top - step / 2, word, transform=axes.transAxes, fontsize="small", va="center", color=colours)
        axes.text(right, top - step / 2, value, transform=axes.transAxes, fontsize="small", va="center", ha="right")
    return axes


def panels_of(result: Result, group: str, number: int, si: bool) -> tuple[list[str], dict[str, Any]]:
    """Names of the panels besides phase, time and spectrum, and what they show."""
    shown: dict[str, Any] = {}
    multipliers, row = multipliers_of(result, group, number), measures_row(result, group, number)
    if multipliers.size:
        shown["multipliers"] = multipliers
    if "basin" in result.groups and group == "attractors":
        shown["basin"] = result.group("basin", si=si)
    if row is not None:
        shown["table"] = rows_of(result.group("measures", si=si), row)
    return list(shown), shown


def new_page(more: list[str]) -> tuple[Figure, dict[str, Axes]]:
    """Time over the whole width, three panels in each row below it, of which the last fills the row."""
    below = ["phase", "spectrum", *more]
    rows: list[Any] = [["time"] * 3]
    for first in range(0, len(below), 3):
        row = below[first:first + 3]
        rows.append(row + row[-1:] * (3 - len(row)))
    figure = new_figure(9.6, 2.9 * len(rows))
    return figure, figure.subplot_mosaic(rows)


def fill(axes: dict[str, Axes], motion: Orbit, shown: dict[str, Any], attractors: xarray.Dataset, number: int) -> None:
    """Draws every panel."""
    draw_time(axes["time"], motion)
    draw_phase(axes["phase"], motion)
    draw_spectrum(axes["spectrum"], motion)
    if "multipliers" in shown:
        draw_multipliers(axes["multipliers"], shown["multipliers"])
    if "basin" in shown:
        centre = "down" if int(attractors["centre"].values[number]) == style.DOWN else "inverted"
        draw_one(axes["basin"], shown["basin"], attractors, [number], centre=centre, legend=False)
        share = style.share_text(np.mean(shown["basin"]["attractor"].values == number))
        axes["basin"].set_title(f"{share} of the starts", fontsize="small", fontweight="normal", loc="left")
    if "table" in shown:
        draw_table(axes["table"], shown["table"], legend=True)


def draw(result: Result, *, attractor: int | str = 0, si: bool = False) -> Figure:
    """The page of one attractor."""
    group, number = chosen_row(result, str(attractor))
    more, shown = panels_of(result, group, number, si)
    figure, axes = new_page(more)
    table = result.group(group, si=si)
    fill(axes, orbit_of(result, group, number, si), shown, table, number)
    period = int(table["period"].values[number])
    name = style.name_text(style.names_with_ids(table["name"].values)[number])
    left_out = {"multipliers": "no multipliers", "basin": "no basin", "table": "no measures"}
    missing = [words for panel, words in left_out.items() if panel not in shown]
    entitle(figure, result, name, f"period {period}" if period else "", style.parameters_text(result.pendulum),
            f"in the file: {', '.join(missing)}" if missing else "")
    return figure
