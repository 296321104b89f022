#!/usr/bin/env python3
"""Draws a stability chart of kapitza: zones, transition curves, and by how much the papers' formulas are off.

    .venv/bin/python scripts/plot_stability.py butikov-fig01.h5                      zones and curves over (k, m)
    .venv/bin/python scripts/plot_stability.py blackburn-fig02.h5 --view growth      the growth rate in the tongues
    .venv/bin/python scripts/plot_stability.py blackburn-fig04.h5 --view frequency   hanging and inverted over the drive frequency
    .venv/bin/python scripts/plot_stability.py formula-errors.h5 --view errors       every formula against its exact curve
"""

import re

import kapitza_style as style
import matplotlib.pyplot as plt
import numpy as np
from kapitza_file import BadFile, Result, run
from kapitza_plot import argument_parser, entitle, parsed
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.patches import Patch

VIEWS = ("zones", "growth", "frequency", "errors")
STABLE = "#e4e9ee"
BOTH = "#a9c8a4"
MAP = "plasma_r"
COLOURS = ["#12806a", "#2f6db3", "#5b2a7a", "#c2452f", "#b08a1e", "#3b3f45"]

# Formula -> the exact curve that it approximates; subharmonics and upper branches by rule.
EXACT = {
    "blackburn_lower": "exact_1", "blackburn_upper": "exact_2", "blackburn_down_upper": "exact_2",
    "butikov_4_refined": "exact_4", "butikov_5_refined": "exact_5", "butikov_5_refined_upper": "exact_5_upper",
}
# What people read instead of a variable's name.
LABELS = {
    "butikov_1": "(3)", "butikov_2": "(4)", "butikov_3": "(5)", "butikov_4": "(6)", "butikov_5": "(7)",
    "butikov_4_refined": "(17)", "butikov_5_refined": "(19)", "butikov_damped_1": "(25)", "butikov_damped_2": "(26)",
    "blackburn_lower": "BSG (5)", "blackburn_upper": "BSG (6)", "blackburn_down_upper": "BSG (6), hanging",
}


def parse_arguments():
    parser = argument_parser(__doc__, "a stability chart")
    parser.add_argument("--view", choices=VIEWS, default="zones")
    return parsed(parser)


def curve_names(chart):
    return [name for name in chart.data_vars if chart[name].dims == ("k",)]


def exact_of(name):
    """The exact curve behind a formula, None for a curve that is exact itself."""
    if name in EXACT:
        return EXACT[name]
    match = re.fullmatch(r"butikov_(subharmonic_\d+|damped_\d(_upper)?)", name)
    if match:
        return match[1]
    return name.replace("butikov", "exact") if name.startswith("butikov") else None


def label(name):
    if name in LABELS:
        return LABELS[name]
    match = re.fullmatch(r"(butikov_)?subharmonic_(\d+)", name)
    if match:
        return f"n = {match[2]}" + (", (21)" if match[1] else "")
    kind, number = name.split("_")[:2]
    if kind == "damped":
        return "lower boundary, damped" if number == "0" else f"tongue {number}, damped"
    return f"curve {number}"


def family(name):
    """Formula and exact curve share a colour."""
    number = int(re.search(r"\d+", exact_of(name) or name)[0])
    if "subharmonic" in name:
        return COLOURS[(number // 2 + 1) % len(COLOURS)]
    return {0: COLOURS[0], 1: COLOURS[1], 2: COLOURS[3]}[number] if "damped" in name else COLOURS[(number - 1) % len(COLOURS)]


def whole_curve(chart, name):
    """(k, m) of a curve from the axis over its turn to its upper branch, where it has one."""
    k, m = chart["k"].values, chart[name].values
    order = re.search(r"subharmonic_(\d+)", name)
    if order and k[0] < 1 / int(order[1]) ** 2 < k[-1]:  # its foot on the axis, between two values of the chart
        place = np.searchsorted(k, 1 / int(order[1]) ** 2)
        return np.insert(k, place, 1 / int(order[1]) ** 2), np.insert(m, place, 0)
    upper = chart.get(f"{name}_upper")
    if upper is None or name.startswith("blackburn"):
        return k, m
    first, second = np.isfinite(m), np.isfinite(upper.values)
    gap = [np.nan] * int(first[-1] and second[-1])  # the turn lies beyond the chart
    return np.concatenate([k[first], gap, k[second][::-1]]), np.concatenate([m[first], gap, upper.values[second][::-1]])


def is_branch(chart, name):
    """An upper branch, drawn with the rest of its curve."""
    return name.endswith("_upper") and name.removesuffix("_upper") in chart and not name.startswith("blackburn")


def draw_curves(axes, chart):
    """Exact curves solid, formulas dashed, undamped ones faint where damped ones stand beside them."""
    names = [name for name in curve_names(chart) if not is_branch(chart, name)]
    damped = any(name.startswith("damped") for name in names)
    for name in names:
        formula, faint = exact_of(name) is not None, damped and name.startswith("exact")
        axes.plot(*whole_curve(chart, name), color=style.FAINT if faint else family(name),
                  linestyle=(0, (1, 1.2)) if "refined" in name else (0, (4, 2)) if formula else "-",
                  linewidth=0.7 if faint else 1.3 if formula else 1.6, label=label(name) + (", undamped" if faint else ""))
    if names:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=8)


def frame(axes, chart):
    axes.set_xlim(chart["k"].values[[0, -1]])
    axes.set_ylim(chart["m"].values[[0, -1]])
    axes.set_xlabel("k = (natural / drive frequency)², negative about the inverted position")
    axes.set_ylabel("drive amplitude m")


def draw_zones(chart):
    figure, axes = plt.subplots(figsize=(8.2, 4.8), layout="constrained")
    colours = ListedColormap(["white", STABLE])
    axes.pcolormesh(chart["k"], chart["m"], chart["stable"], cmap=colours, vmin=0, vmax=1, shading="nearest", rasterized=True)
    draw_curves(axes, chart)
    mark_thresholds(axes, chart)
    frame(axes, chart)
    return figure


def mark_thresholds(axes, chart):
    for tongue in (1, 2):
        k, m = (chart.attrs.get(f"tongue_{tongue}_lowest_{axis}", np.nan) for axis in "km")
        if f"damped_{tongue}" in chart and np.isfinite(k):
            axes.plot(k, m, "o", markersize=4, color=style.INK, zorder=5)
            axes.annotate(f"{k:.5f}, {m:.5f}", (k, m), (4, -11), textcoords="offset points", fontsize=7.5)


def draw_growth(chart):
    """Growth rate per period in the tongues, Floquet angle between them."""
    figure, axes = plt.subplots(figsize=(8.2, 4.8), layout="constrained")
    stable = chart["stable"].values == 1
    growth = np.where(stable, np.nan, chart["log_multiplier"])
    angle = np.where(stable, chart["angle"], np.nan)
    for values, cmap, text in ((growth, "OrRd", "growth: ln |multiplier| per period"),
                               (angle, "Blues", "Floquet angle / 2π")):
        image = axes.pcolormesh(chart["k"], chart["m"], values, cmap=cmap, shading="nearest", rasterized=True, vmin=0)
        figure.colorbar(image, ax=axes, label=text, fraction=0.05, pad=0.01)
    for name in curve_names(chart):
        if exact_of(name) is None and not is_branch(chart, name):
            axes.plot(*whole_curve(chart, name), color=style.INK, linewidth=0.7)
    frame(axes, chart)
    return figure


def draw_frequency(chart):
    """Which position is stable at drive frequency Omega: hanging is k = 1/Omega^2, inverted its negative."""
    k = chart["k"].values
    if not (k.min() < 0 < k.max()):
        raise BadFile("this view needs a chart on both sides of k = 0")
    omega = np.linspace(1 / np.sqrt(min(-k.min(), k.max())), 30, 900)
    column = lambda sign: np.abs(k[:, None] - sign / omega**2).argmin(axis=0)  # noqa: E731
    inverted, hanging = (chart["stable"].values[:, column(sign)] for sign in (-1, 1))
    figure, axes = plt.subplots(figsize=(8.2, 4.8), layout="constrained")
    colours = ListedColormap(["white", style.KINDS["inverted"], style.KINDS["down"], BOTH])
    axes.pcolormesh(omega, chart["m"], inverted + 2 * hanging, cmap=colours, vmin=0, vmax=3, shading="nearest", rasterized=True)
    for name in curve_names(chart):
        formula = exact_of(name) is not None
        for sign in (-1, 1):
            inside = (sign * k > 0) & np.isfinite(chart[name].values)
            if not inside.any():
                continue
            axes.plot(1 / np.sqrt(np.abs(k[inside])), chart[name].values[inside], color=style.INK,
                      linestyle=(0, (4, 2)) if formula else "-", linewidth=0.9)
    patches = [Patch(facecolor=colour, edgecolor=style.FAINT, label=text) for colour, text in
               ((style.KINDS["inverted"], "inverted"), (style.KINDS["down"], "hanging"), (BOTH, "both"), ("white", "neither"))]
    lines = [plt.Line2D([], [], color=style.INK, linewidth=0.9, linestyle=kind, label=text)
             for kind, text in (("-", "exact"), ((0, (4, 2)), "Eqs. (5), (6)"))]
    axes.legend(handles=patches + lines, loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=8, title="stable at rest",
                title_fontsize=8)
    axes.set_xlim(omega[[0, -1]])
    axes.set_ylim(chart["m"].values[[0, -1]])
    axes.set_xlabel("drive frequency Ω (natural frequencies)")
    axes.set_ylabel("drive amplitude ε")
    return figure


def draw_errors(chart):
    """Relative error of m of every formula: a row of colours over k for each, and the curves themselves in these colours."""
    pairs = [(name, exact_of(name)) for name in curve_names(chart) if exact_of(name) in chart]
    if not pairs:
        raise BadFile("this view needs formulas beside their exact curves")
    k, norm = chart["k"].values, LogNorm(1e-8, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        errors = [np.maximum(np.abs(chart[name].values / chart[exact].values - 1), 1e-12) for name, exact in pairs]
    figure, (left, right) = plt.subplots(1, 2, figsize=(12.5, 5.4), layout="constrained", width_ratios=[3, 2])
    left.pcolormesh(k, np.arange(len(pairs)), errors, cmap=MAP, norm=norm, shading="nearest", rasterized=True)
    left.set_yticks(range(len(pairs)), [error_label(name, exact) for name, exact in pairs])
    left.set_yticks(np.arange(len(pairs) + 1) - 0.5, minor=True)
    left.grid(axis="y", which="minor", color="white", linewidth=3)
    left.tick_params(which="both", length=0, axis="y")
    left.invert_yaxis()
    left.set_xlabel("k")
    for (_, exact), error in sorted(zip(pairs, errors, strict=True), key=lambda row: -np.nanmax(row[1])):
        points = np.column_stack([k, chart[exact].values])
        known = np.isfinite(error[:-1] + error[1:])
        lines = LineCollection(np.stack([points[:-1], points[1:]], axis=1)[known], cmap=MAP, norm=norm, linewidth=2.6)
        lines.set_array(error[:-1][known])
        image = right.add_collection(lines)
    frame(right, chart)
    right.set_xlabel("k")
    figure.colorbar(image, ax=right, label="|m by formula / m exact − 1|", extend="both", pad=0.01)
    return figure


def error_label(name, exact):
    """Eq. (21), n = 6: which formula stands for which curve."""
    branch = ", upper branch" if exact.endswith("_upper") else ""
    number = label(name).split(", ")[-1] if "subharmonic" in name else label(name)
    number = LABELS.get(name.removesuffix("_upper"), number)
    return f"{number} for {label(exact)}{branch}"


DRAW = {"zones": draw_zones, "growth": draw_growth, "frequency": draw_frequency, "errors": draw_errors}


def damping_text(chart):
    if "quality_factor" in chart.attrs:
        return f"Q = {chart.attrs['quality_factor']:g}"
    return f"β = {chart.attrs['damping']:g}" if chart.attrs.get("damping", 0) > 0 else "no damping"


def main():
    arguments = parse_arguments()
    style.use()
    result = Result(arguments.file)
    chart = result.group("stability")
    if chart.sizes["k"] < 2 or chart.sizes["m"] < 2:
        raise BadFile(f"{result.path}: the chart has no area")
    figure = DRAW[arguments.view](chart)
    entitle(figure, result, f"{chart.sizes['k']} x {chart.sizes['m']} points", damping_text(chart))
    style.save(figure, arguments.output, arguments.dpi)


if __name__ == "__main__":
    run(main)
