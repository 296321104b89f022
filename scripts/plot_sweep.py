#!/usr/bin/env python3
"""Draws a sweep of kapitza: quantities along one parameter of the pendulum.

    .venv/bin/python scripts/plot_sweep.py blackburn-walk.h5                       basins along the parameter, branches under them
    .venv/bin/python scripts/plot_sweep.py blackburn-fig10.h5                      amplitude of the flutter, and its square
    .venv/bin/python scripts/plot_sweep.py blackburn-fig06-omega11.h5              releases from rest that stay
    .venv/bin/python scripts/plot_sweep.py blackburn-fig04-dots.h5                 where flutter ends
    .venv/bin/python scripts/plot_sweep.py bifurcation.h5                          strobe points, up and down
    .venv/bin/python scripts/plot_sweep.py FILE --view branches                    one view of a file that holds several
"""

import kapitza_style as style
import matplotlib.pyplot as plt
import numpy as np
import xarray
from kapitza_file import BadFile, Result, run
from kapitza_plot import argument_parser, entitle, parsed
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

SYMBOLS = {"quality_factor": "Q", "drive_frequency": r"$\Omega$", "drive_amplitude": r"$\epsilon$", "damping": r"$\beta$"}
UP, DOWN = "#2f6db3", "#c2452f"
STAYS = "#f2d08a"
NAMED = 0.004  # branches whose share is smaller everywhere are drawn as one band


def parse_arguments():
    parser = argument_parser(__doc__, "a sweep")
    parser.add_argument("--view", choices=[name for name, _, _ in VIEWS], help="default: the first that the file has")
    return parsed(parser)


def parameter_text(sweep):
    """The axis label of the swept key."""
    name = sweep.attrs["parameter"]
    unit = sweep.attrs.get("parameter_units", "1")
    words = name.replace("_", " ")
    return f"{words} {SYMBOLS[name]}" if name in SYMBOLS else words if unit == "1" else f"{words} / {unit}"


def motions(sweep):
    """(period, winding, centre, whether the second of two mirror partners) of every branch."""
    columns = (sweep[f"branch_{name}"].values for name in ("period", "winding", "centre", "mirror"))
    return [(int(period), int(winding), int(centre), bool(mirror < branch)) for branch, (period, winding, centre, mirror)
            in enumerate(zip(*columns, strict=True))]


def branch_colours(sweep, named=None):
    """One colour per branch: branches of one motion share it, however far apart they live; those of `named` can be told apart."""
    kinds = motions(sweep)
    firsts = sorted({kind: kinds.index(kind) for kind in kinds}.values())
    dimension = sweep["branch_period"].dims
    table = xarray.Dataset({name: (dimension, [kinds[branch][column] for branch in firsts])
                            for column, name in enumerate(("period", "winding", "centre"))})
    table["mirror"] = dimension, [-1 if kinds[branch][3] else len(firsts) for branch in firsts]
    apart = None if named is None else [row for row, branch in enumerate(firsts) if kinds[branch] in {kinds[one] for one in named}]
    colour = dict(zip((kinds[branch] for branch in firsts), style.colours(table, apart), strict=True))
    return [colour[kind] for kind in kinds]


def draw_fractions(sweep):
    """Shares stacked over the parameter, with their intervals; under them the life of every branch."""
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8.6, 8.2), sharex=True, height_ratios=[3, 2], layout="constrained")
    value, share, order = sweep["value"].values, np.nan_to_num(sweep["fraction"].values), _stack_order(sweep)
    named = [branch for branch in order if share[:, branch].max() > NAMED]
    small = [branch for branch in order if share[:, branch].max() <= NAMED]
    colours = branch_colours(sweep, named)
    bands = np.column_stack([share[:, named], share[:, small].sum(axis=1)])
    top.stackplot(value, bands.T, colors=[*(colours[branch] for branch in named), style.FAINT], edgecolor="white", linewidth=0.25)
    bars = _draw_intervals(top, sweep, named, np.cumsum(bands, axis=1) - bands)
    top.set(ylim=(0, 1), ylabel="share of the starts")
    entries = [Patch(color=style.FAINT, label=_rest_text(small, bands))] if bands[:, -1].any() else []
    entries += [*_entries(sweep, colours, named[::-1]), *bars]
    if bands.sum(axis=1).min() < 1 - NAMED:
        entries.insert(0, Patch(facecolor="white", edgecolor=style.FAINT, lw=0.5, label="not settled"))
    top.legend(handles=entries, loc="upper left", bbox_to_anchor=(1, 1), borderaxespad=0.4, fontsize=8, labelspacing=0.35)
    _draw_lives(bottom, sweep, colours, order)
    return figure


def _draw_intervals(axes, sweep, branches, base):
    """Where the upper edge of every band could lie: its own share's interval above its lower edge. Returns the legend's entries."""
    caps, drawn = 1.5 if sweep.sizes["value"] <= 40 else 0, []
    for row, branch in enumerate(branches):
        share, low, high = (sweep[name].values[:, branch] for name in ("fraction", "fraction_low", "fraction_high"))
        drawn.append(axes.errorbar(sweep["value"].values, base[:, row] + share, [share - low, high - share], fmt="none", ecolor=style.INK,
                                   elinewidth=0.7, capsize=caps, capthick=0.7, label="95 % interval of a share"))
    return drawn[:1]


def _rest_text(small, bands):
    return f"{len(small)} others, {style.share_text(bands[:, -1].max())} at most"


def _stack_order(sweep):
    """Inverted states at the bottom, rotations on top; within a kind by where branches begin."""
    place = {1: 0, 0: 1, 3: 2, 2: 3}
    keys = zip((place[int(centre)] for centre in sweep["branch_centre"].values), sweep["branch_start"].values,
               sweep["branch_period"].values, -sweep["branch_winding"].values, strict=True)
    return [branch for _, branch in sorted((key, branch) for branch, key in enumerate(keys))]


def _entries(sweep, colours, branches):
    """Legend entries, one per name and colour; two colours of one name are told apart by their branches."""
    groups = {}
    for branch in branches:
        groups.setdefault((str(sweep["branch_name"].values[branch]), colours[branch]), []).append(branch)
    names = [name for name, _ in groups]
    return [Patch(color=colour, label=style.name_text(name) + (f" ({', '.join(map(str, sorted(ids)))})" if names.count(name) > 1 else ""))
            for (name, colour), ids in groups.items()]


ENDS = {1: ("|", "fold"), 2: ("D", "period doubling"), 3: ("*", "Neimark-Sacker"), 4: ("s", "symmetry breaking"), 5: ("x", "not located")}


def _draw_lives(axes, sweep, colours, order):
    """A line from birth to death of each branch, with what happens there."""
    start, end = sweep["branch_start"].values, sweep["branch_end"].values
    for row, branch in enumerate(order):
        axes.plot([start[branch], end[branch]], [row, row], color=colours[branch], lw=2.2, solid_capstyle="butt")
        for place, kind in ((start, "branch_start_kind"), (end, "branch_end_kind")):
            code = int(sweep[kind].values[branch])
            if code in ENDS:
                axes.plot(place[branch], row, ENDS[code][0], color=style.INK, markersize=3.4, markeredgewidth=0.9, zorder=3)
    seen = {int(code) for kind in ("branch_start_kind", "branch_end_kind") for code in sweep[kind].values}
    axes.legend(handles=[Line2D([], [], ls="", marker=ENDS[code][0], color=style.INK, markersize=4, label=ENDS[code][1])
                         for code in sorted(seen & ENDS.keys())], loc="upper left", bbox_to_anchor=(1, 1), borderaxespad=0.4)
    axes.set(xlabel=parameter_text(sweep), ylabel="branches", yticks=[], ylim=(-1, len(order)))


def draw_branches(sweep):
    """The life of every branch, named."""
    colours, order = branch_colours(sweep), _stack_order(sweep)
    figure, axes = plt.subplots(figsize=(8.6, 1.6 + 0.16 * len(order)), layout="constrained")
    _draw_lives(axes, sweep, colours, order)
    ids = style.names_with_ids(sweep["branch_name"].values)
    names = [style.name_text(ids[branch]) for branch in order]
    axes.set_yticks(range(len(order)), names, fontsize=6.5)
    axes.set_ylabel("")
    return figure


def draw_flutter(sweep):
    """Amplitude, and amplitude^2 with the fitted line, over the parameter."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.9), layout="constrained")
    value, amplitude = sweep["value"].values, sweep["flutter_amplitude"].values
    critical, slope = sweep.attrs["critical_value"], sweep.attrs["fit_slope"]
    colour, width = style.KINDS["flutter"], 1.6
    left.plot(value, np.degrees(amplitude), color=colour, lw=width)
    left.set(xlabel=parameter_text(sweep), ylabel="amplitude / degrees", ylim=(0, None))
    left.axvline(critical, color=style.FAINT, lw=0.8, ls="--")
    left.annotate(f"multiplier −1 at {critical:.9g}", (critical, left.get_ylim()[1]), (4, -12), textcoords="offset points",
                  fontsize=8, color=style.FAINT)
    there = np.isfinite(amplitude)
    distance = value[there] - critical
    right.plot(distance, amplitude[there] ** 2, color=colour, lw=width, label="amplitude²")
    near = amplitude[there][np.argmin(np.abs(distance))] ** 2 / np.abs(distance).min() if there.any() else np.nan
    right.plot(distance, near * distance, color=style.FAINT, lw=0.8, ls="--", label=f"tangent, {np.sqrt(near):.3f}² rad² per unit")
    right.plot([], [], " ", label=f"fitted slope {slope:.3f} ± {sweep.attrs['fit_slope_stderr']:.3f}")
    right.plot([], [], " ", label=f"exponent {sweep.attrs['fit_exponent']:.4f} ± {sweep.attrs['fit_exponent_error']:.4f}")
    right.set(xlabel=f"{parameter_text(sweep)} − critical value", ylabel="amplitude² / rad²", ylim=(0, None))
    right.legend(loc="upper left")
    return figure


def draw_zone(sweep):
    """Where flutter begins and ends in the drive amplitude."""
    figure, axes = plt.subplots(figsize=(7.2, 5), layout="constrained")
    value = sweep["value"].values
    onset, asymmetry, end, release = (sweep[f"flutter_{name}"].values for name in ("onset", "asymmetry", "end", "release_end"))
    colour = style.KINDS["flutter"]
    axes.fill_between(value, onset, end, color=style.shade(colour, 0.8), lw=0)
    axes.plot(value, end, color=colour, lw=1, ls=":", label="the asymmetric cycles double their period")
    axes.plot(value, asymmetry, color=colour, lw=1.4, label="flutter loses its mirror symmetry")
    axes.plot(value, release, "o", color=style.INK, markersize=4, label="a release of 1° from rest fails (the dots)")
    axes.plot(value, onset, color=style.KINDS["inverted"], lw=1.8, label="inverted gives way to flutter")
    axes.set(xlabel=parameter_text(sweep), ylabel=r"drive amplitude $\epsilon$ = m", xlim=(value[0], value[-1]))
    axes.legend(loc="upper right")
    return figure


def draw_releases(sweep):
    """The set of releases that stay, its first gap, and its last edge."""
    figure, axes = plt.subplots(figsize=(8, 4.8), layout="constrained")
    value, angle = sweep["value"].values, np.degrees(sweep["release"].values)
    edges = np.concatenate([[1.5 * value[0] - 0.5 * value[1]], (value[1:] + value[:-1]) / 2, [1.5 * value[-1] - 0.5 * value[-2]]])
    stays = np.where(sweep["release_stays"].values.T == 1, 1.0, np.nan)
    axes.pcolormesh(edges, np.concatenate([[angle[0] / 2], angle + angle[0] / 2]), stays, cmap=_plain(STAYS), rasterized=True)
    axes.plot(value, np.degrees(sweep["release_angle_largest"].values), color=style.FAINT, lw=0.9, label="last angle that stays")
    axes.plot(value, np.degrees(sweep["release_angle_scan"].values), ".", color=DOWN, markersize=4,
              label="first failure of a scan in whole degrees")
    axes.plot(value, np.degrees(sweep["release_angle"].values), color=style.INK, lw=1.1, label="first gap")
    handles = [*axes.get_legend_handles_labels()[0], Patch(color=STAYS, label="releases that stay")]
    axes.legend(handles=handles, loc="upper right")
    top = np.nanmax(np.degrees(sweep["release_angle_largest"].values))
    axes.set(xlabel=parameter_text(sweep), ylabel="release angle from inverted / degrees", ylim=(0, min(180, 1.35 * top)))
    return figure


def _plain(colour):
    """A colour map of one colour."""
    return plt.matplotlib.colors.ListedColormap([colour])


def draw_strobe(sweep):
    """Strobe points over the parameter, the walk up above the walk down; inverted in the middle."""
    figure, panels = plt.subplots(2, 1, figsize=(8.6, 7), sharex=True, sharey=True, layout="constrained")
    value, walk = sweep["value"].values, sweep["sample_walk"].values
    turned = np.mod(sweep["strobe_theta"].values, 2 * np.pi) / np.pi
    for axes, code, colour, words in zip(panels, (0, 1), (UP, DOWN), ("going up", "going down"), strict=True):
        points = turned[:, walk == code]
        axes.plot(np.repeat(value, points.shape[1]), points.ravel(), ".", markersize=1.6, markeredgewidth=0, color=colour, rasterized=True)
        axes.set_title(words, fontsize=9, fontweight="normal")
        axes.set(ylabel="θ at the strobe", xlim=(value[0], value[-1]))
        axes.set_yticks([0, 0.5, 1, 1.5, 2], [style.pi_text(tick) for tick in (0, 0.5, 1, 1.5, 2)])
    panels[1].set_xlabel(parameter_text(sweep))
    return figure


# name, a variable that it needs, what draws it
VIEWS = [
    ("fractions", "fraction", draw_fractions),
    ("branches", "branch_start", draw_branches),
    ("flutter", "flutter_amplitude", draw_flutter),
    ("zone", "flutter_onset", draw_zone),
    ("releases", "release_stays", draw_releases),
    ("strobe", "strobe_theta", draw_strobe),
]


def chosen_view(result, sweep, wanted):
    """The function that draws the view asked for, or the first one that the file has."""
    there = {name: draw for name, variable, draw in VIEWS if variable in sweep}
    if not there:
        raise BadFile(f"{result.path}: the sweep has measured nothing")
    if wanted and wanted not in there:
        raise BadFile(f"{result.path}: has no {wanted}; it has {', '.join(there)}")
    return there[wanted or next(iter(there))]


def fixed_text(result, sweep):
    """The parameters that were not swept, where the papers' symbols are defined."""
    names = {"quality_factor": "Q", "drive_frequency": r"$\Omega$", "drive_amplitude": r"$\epsilon$"}
    swept = sweep.attrs["parameter"]
    kept = [f"{symbol} = {result.pendulum[name]:.6g}" for name, symbol in names.items()
            if name != swept and np.isfinite(result.pendulum.get(name, np.nan))]
    if "flutter_onset" in sweep:
        kept = [text for text in kept if r"\epsilon" not in text]
    return ",  ".join(kept)


def main():
    arguments = parse_arguments()
    style.use()
    result = Result(arguments.file)
    sweep = result.group("sweep")
    figure = chosen_view(result, sweep, arguments.view)(sweep)
    entitle(figure, result, f"{sweep.sizes['value']} values", fixed_text(result, sweep))
    style.save(figure, arguments.output, arguments.dpi)


if __name__ == "__main__":
    run(main)
