"""Draws the effective potential from a result file of kapitza: exact, and by the two formulas of Blackburn et al.
(1992).

    kapitza plot potential blackburn-fig05.h5
"""

import argparse
from collections.abc import Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator

from kapitza import style
from kapitza.plots.page import entitle, new_panels
from kapitza.result import Result
from kapitza.units import TURN, drive_unit

STUDY = "a potential"
COLOURS = ["#6b747e", "#2f6db3", "#12806a", "#c2452f", "#5b2a7a", "#b08a1e"]  # colours of the drive amplitudes, in turn
# Name, dashes, label
FORMULAS = (("blackburn", (0, (4, 2)), "Blackburn Eq. 11"), ("simple", (0, (1, 1.5)), "leading order (Eq. 12)"))


def full_circle(angle: xarray.DataArray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same over a turn from 0, so that the inverted position is in the middle."""
    theta, turn = angle.values, TURN * drive_unit(angle)
    return np.append(theta[theta >= 0], theta[theta < 0][1:] + turn), np.append(values[theta >= 0],
                                                                                values[theta < 0][1:])


def draw_energy(axes: Axes, potential: xarray.Dataset, *, colours: Sequence[str] = COLOURS,
                legend: bool = True) -> Axes:
    """The exact potential of every drive amplitude with the rim of its well, and the formulas, dashed."""
    theta, turn = potential["theta"], TURN * drive_unit(potential["theta"])
    for row, amplitude in enumerate(potential["drive_amplitude"].values):
        colour, exact = colours[row % len(colours)], potential["energy"].values[row]
        axes.plot(*full_circle(theta, exact), color=colour, linewidth=1.6, label=f"ε = {amplitude:g}")
        for name, dash, _ in FORMULAS:
            axes.plot(*full_circle(theta, potential[f"energy_{name}"].values[row]), color=colour, linewidth=0.8,
                      linestyle=dash)
        rim = float(potential["rim_exact"].values[row])
        if np.isfinite(rim):
            top = np.interp(rim, theta.values, exact)
            axes.plot([rim, turn - rim], [top, top], "o", markersize=4, color=colour)
    if legend:
        axes.plot([], [], color=style.INK, linestyle="-", linewidth=1, label="exact")
        for _, dash, text in FORMULAS:
            axes.plot([], [], color=style.INK, linestyle=dash, linewidth=1, label=text)
        axes.plot([], [], "o", markersize=4, color=style.INK, label="rim of the well")
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    axes.set_ylabel("effective potential (I ω²)")
    return _over_the_circle(axes, theta)


def draw_differences(axes: Axes, potential: xarray.Dataset, *, colours: Sequence[str] = COLOURS,
                     legend: bool = True) -> Axes:
    """What the formulas are off by."""
    theta = potential["theta"]
    for row, exact in enumerate(potential["energy"].values):
        for name, dash, text in FORMULAS:
            axes.plot(*full_circle(theta, potential[f"energy_{name}"].values[row] - exact),
                      color=colours[row % len(colours)], linewidth=1.1, linestyle=dash, label=None if row else text)
    if legend:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize="small")
    axes.set_ylabel("formula − exact (I ω²)")
    return _over_the_circle(axes, theta)


def _over_the_circle(axes: Axes, theta: xarray.DataArray) -> Axes:
    rad = drive_unit(theta)
    degrees = rad != 1
    axes.set_xlabel("slow angle from down" if degrees else "slow angle from down (rad)")
    axes.set_xlim(0, TURN * rad)
    axes.xaxis.set_major_locator(MultipleLocator(np.pi * rad / 2))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.0f}°" if degrees else style.pi_text(x / np.pi)))
    return axes


def draw(result: Result, *, degrees: bool = False) -> Figure:
    """The page: the potentials above, the formulas' differences below."""
    potential = result.group("potential", degrees=degrees, written=True)
    figure, (above, below) = new_panels(7.2, 6.4, 2, sharex=True, height_ratios=[3, 2])
    draw_energy(above, potential)
    draw_differences(below, potential, legend=False)
    above.set_xlabel("")
    entitle(figure, result, f"k = {result.pendulum['k']:.6g},  β = {result.pendulum['beta']:.6g}")
    return figure


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--degrees", action="store_true", help="angles in degrees instead of parts of pi")
