#!/usr/bin/env python3
"""Draws the effective potential from a result file of kapitza: exact, and by the two formulas of Blackburn et al. (1992).

    .venv/bin/python scripts/plot_potential.py blackburn-fig05.h5
"""

import kapitza_style as style
import matplotlib.pyplot as plt
import numpy as np
from kapitza_file import Result, run
from kapitza_plot import argument_parser, entitle, parsed
from matplotlib.ticker import FuncFormatter, MultipleLocator

COLOURS = ["#6b747e", "#2f6db3", "#12806a", "#c2452f", "#5b2a7a", "#b08a1e"]


def full_circle(theta, values):
    """The same over 0 .. 2 pi, so that the inverted position is in the middle."""
    return np.append(theta[theta >= 0], theta[theta < 0][1:] + 2 * np.pi), np.append(values[theta >= 0], values[theta < 0][1:])


def draw(potential):
    figure, (above, below) = plt.subplots(2, 1, figsize=(7.2, 6.4), sharex=True, height_ratios=[3, 2], layout="constrained")
    theta = potential["theta"].values
    for row, amplitude in enumerate(potential["drive_amplitude"].values):
        colour = COLOURS[row % len(COLOURS)]
        exact = potential["energy"].values[row]
        above.plot(*full_circle(theta, exact), color=colour, linewidth=1.6, label=f"ε = {amplitude:g}")
        for name, dash in (("blackburn", (0, (4, 2))), ("simple", (0, (1, 1.5)))):
            values = potential[f"energy_{name}"].values[row]
            above.plot(*full_circle(theta, values), color=colour, linewidth=0.8, linestyle=dash)
            below.plot(*full_circle(theta, values - exact), color=colour, linewidth=1.1, linestyle=dash)
        rim = float(potential["rim_exact"].values[row])
        if np.isfinite(rim):
            top = np.interp(rim, theta, exact)
            above.plot([rim, 2 * np.pi - rim], [top, top], "o", markersize=4, color=colour)
    for dash, text in ((("-"), "exact, Eq. (10)"), ((0, (4, 2)), "Eq. (11)"), ((0, (1, 1.5)), "Eq. (12)")):
        above.plot([], [], color=style.INK, linestyle=dash, linewidth=1, label=text)
    above.plot([], [], "o", markersize=4, color=style.INK, label="rim of the well")
    above.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=8)
    above.set_ylabel("effective potential (I ω²)")
    below.set_ylabel("formula − exact (I ω²)")
    below.set_xlabel("slow angle from down (rad)")
    below.set_xlim(0, 2 * np.pi)
    below.xaxis.set_major_locator(MultipleLocator(np.pi / 2))
    below.xaxis.set_major_formatter(FuncFormatter(lambda x, _: style.pi_text(x / np.pi)))
    return figure


def main():
    arguments = parsed(argument_parser(__doc__, "a potential"))
    style.use()
    result = Result(arguments.file)
    figure = draw(result.group("potential"))
    entitle(figure, result, f"k = {result.pendulum['k']:.6g},  β = {result.pendulum['beta']:.6g}")
    style.save(figure, arguments.output, arguments.dpi)


if __name__ == "__main__":
    run(main)
