"""Branches of a sweep: their shares of the starts, and the life of each."""

from collections.abc import Iterable, Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from kapitza import style
from kapitza.plots.parameter_axes import key_text

NAMED = 0.02  # branches whose share is smaller everywhere are drawn as one band
SHORTEST = 1 / 400  # share of the range: shorter branches cannot be seen
INTERVALS = 12  # values, about, at which intervals of shares are drawn
# Code of what happens at an end of a branch -> its mark and name.
ENDS = {1: ("|", "fold"), 2: ("D", "period doubling"), 3: ("*", "Neimark-Sacker"), 4: ("s", "symmetry breaking"),
        5: ("x", "not located"), 6: ("o", "homoclinic")}
SYMBOLS = {"quality_factor": "Q", "drive_frequency": r"$\Omega$", "drive_amplitude": r"$\epsilon$",
           "damping": r"$\beta$"}


def parameter_text(sweep: xarray.Dataset) -> str:
    """The axis label of the swept key."""
    name = sweep.attrs["parameter"]
    return f"{name.replace('_', ' ')} {SYMBOLS[name]}" if name in SYMBOLS else key_text(sweep)


def motions(sweep: xarray.Dataset) -> list[tuple[int, int, int, bool]]:
    """(period, winding, centre, whether the second of two mirror partners) of every branch."""
    columns = (sweep[f"branch_{name}"].values for name in ("period", "winding", "centre", "mirror"))
    return [(int(period), int(winding), int(centre), bool(-1 < mirror < branch)) for branch,
            (period, winding, centre, mirror)
            in enumerate(zip(*columns, strict=True))]


def branch_colours(sweep: xarray.Dataset, named: Iterable[int] | None = None) -> list[str]:
    """One colour per branch: branches of one motion share it, however far apart they live; those of `named` can be
    distinguished."""
    kinds, attracting = motions(sweep), attracting_branches(sweep)
    firsts = sorted({kinds[branch]: branch for branch in reversed(attracting)}.values())
    dimension = sweep["branch_period"].dims
    table = xarray.Dataset({name: (dimension, [kinds[branch][column] for branch in firsts])
                            for column, name in enumerate(("period", "winding", "centre"))})
    # A second partner sorts before all
    table["mirror"] = dimension, [-2 if kinds[branch][3] else len(firsts) for branch in firsts]
    wanted = None if named is None else {kinds[one] for one in named}
    apart = None if wanted is None else [row for row, branch in enumerate(firsts) if kinds[branch] in wanted]
    colour = dict(zip((kinds[branch] for branch in firsts), style.colours(table, apart), strict=True))
    return [colour.get(kind, style.FAINT) for kind in kinds]


def attracting_branches(sweep: xarray.Dataset) -> list[int]:
    """The branches that attract, but those between two values that are too short to be seen in a picture."""
    if "branch_stable" not in sweep:
        return list(range(sweep.sizes["branch"]))
    seen = np.isfinite(sweep["branch_theta"].values).any(axis=0)
    length = sweep["branch_end"].values - sweep["branch_start"].values
    return list(np.flatnonzero((sweep["branch_stable"].values == 1)
                               & (seen | (length > SHORTEST * np.ptp(sweep["value"].values)))))


def repelling_beside(sweep: xarray.Dataset, order: Sequence[int]) -> list[tuple[int, int]]:
    """(row, branch) of the branches that repel: in the row of a branch of the same motion that turns into them."""
    if "branch_stable" not in sweep:
        return []
    kind, near = [one[:2] for one in motions(sweep)], 1e-9 * np.ptp(sweep["value"].values)
    ends = np.array([sweep["branch_start"].values, sweep["branch_end"].values])
    taken: list[tuple[int, int]] = []
    for branch in np.flatnonzero(sweep["branch_stable"].values == 0):
        rows = [row for row, other in enumerate(order) if kind[other] == kind[branch]
                and (abs(ends[:, other, None] - ends[None, :, branch]) < near).any()]
        if rows:
            taken.append((min(rows, key=lambda row: sum(row == one for one, _ in taken)), int(branch)))
    return taken


def named_branches(sweep: xarray.Dataset) -> list[int]:
    """The branches whose share is large somewhere, in the order of the stack."""
    share = np.nan_to_num(sweep["fraction"].values)
    return [branch for branch in stack_order(sweep) if share[:, branch].max() > NAMED]


def draw_shares(axes: Axes, sweep: xarray.Dataset, *, colours: Sequence[str] | None = None,
                legend: bool = True) -> Axes:
    """Shares stacked over the parameter, with their intervals; `colours`: one per branch (default: branch_colours)."""
    value, share, named = sweep["value"].values, np.nan_to_num(sweep["fraction"].values), named_branches(sweep)
    small = [branch for branch in attracting_branches(sweep) if branch not in named]
    colours = colours or branch_colours(sweep, named)
    bands = np.column_stack([share[:, named], share[:, small].sum(axis=1)])
    axes.stackplot(value, bands.T, colors=[*(colours[branch] for branch in named), style.FAINT], edgecolor="white",
                   linewidth=0.25)
    bars = _draw_intervals(axes, sweep, named, np.cumsum(bands, axis=1) - bands)
    axes.set(ylim=(0, 1), xlabel=parameter_text(sweep), ylabel="share of the starts")
    if legend:
        entries: list[Patch | ErrorbarContainer] = []
        if bands.sum(axis=1).min() < 1 - NAMED:
            entries.append(Patch(facecolor="white", edgecolor=style.FAINT, lw=0.5, label="not settled"))
        if bands[:, -1].any():
            entries.append(Patch(color=style.FAINT,
                                 label=f"{len(small)} smaller ones (≤ {style.share_text(bands[:, -1].max())})"))
        entries += [*_entries(sweep, colours, named[::-1]), *bars]
        axes.legend(handles=entries, loc="upper left", bbox_to_anchor=(1, 1), borderaxespad=0.4, labelspacing=0.35)
    return axes


def _draw_intervals(axes: Axes, sweep: xarray.Dataset, branches: Sequence[int],
                    base: np.ndarray) -> list[ErrorbarContainer]:
    """Where the upper edge of every band could lie: its own share's interval above its lower edge. Returns the legend's
    entries."""
    drawn, some = [], slice(None, None, max(1, sweep.sizes["value"] // INTERVALS))
    for row, branch in enumerate(branches):
        share, low, high = (sweep[name].values[some, branch] for name in ("fraction", "fraction_low", "fraction_high"))
        drawn.append(axes.errorbar(sweep["value"].values[some], base[some, row] + share, [share - low, high - share],
                                   fmt="none",
                                   ecolor=style.INK, elinewidth=0.7, capsize=1.5, capthick=0.7,
                                   label="95 % interval of a share"))
    return drawn[:1]


def stack_order(sweep: xarray.Dataset) -> list[int]:
    """Inverted states at the bottom, rotations on top; within a kind by where branches begin."""
    place = {1: 0, 0: 1, 3: 2, 2: 3}
    keys = zip((place[int(centre)] for centre in sweep["branch_centre"].values), sweep["branch_start"].values,
               sweep["branch_period"].values, -sweep["branch_winding"].values, strict=True)
    attracting = set(attracting_branches(sweep))
    return [branch for _, branch in sorted((key, branch) for branch, key in enumerate(keys)) if branch in attracting]


def _entries(sweep: xarray.Dataset, colours: Sequence[str], branches: Iterable[int]) -> list[Patch]:
    """Legend entries, one per name and colour; two colours of one name are distinguished by their branches."""
    groups: dict[tuple[str, str], list[int]] = {}
    for branch in branches:
        groups.setdefault((str(sweep["branch_name"].values[branch]), colours[branch]), []).append(branch)
    names = [name for name, _ in groups]
    return [Patch(color=colour, label=style.name_text(name) + (f" ({', '.join(map(str, sorted(ids)))})"
                                                               if names.count(name) > 1 else ""))
            for (name, colour), ids in groups.items()]


def draw_lives(axes: Axes, sweep: xarray.Dataset, *, colours: Sequence[str] | None = None, legend: bool = True,
               names: bool = False, only: Sequence[int] | None = None) -> Axes:
    """A line from birth to death of each branch that attracts, with what happens there; dashed, what it turns into
    where it repels.

    `names`: each branch's name beside it; `only`: of these branches, in this order."""
    colours, order = colours or branch_colours(sweep), stack_order(sweep) if only is None else list(only)
    start, end = sweep["branch_start"].values, sweep["branch_end"].values
    for row, branch in enumerate(order):
        axes.plot([start[branch], end[branch]], [row, row], color=colours[branch], lw=2.2, solid_capstyle="butt")
        for place, kind in ((start, "branch_start_kind"), (end, "branch_end_kind")):
            code = int(sweep[kind].values[branch])
            if code in ENDS:
                axes.plot(place[branch], row, ENDS[code][0], color=style.INK, markersize=3.4, markeredgewidth=0.9,
                          zorder=3)
    repelling = repelling_beside(sweep, order)
    for row, branch in repelling:
        axes.plot([start[branch], end[branch]], [row, row], color=colours[order[row]], lw=0.9, ls=(0, (3, 2)), zorder=1)
    seen = {int(code) for kind in ("branch_start_kind", "branch_end_kind") for code in sweep[kind].values[order]}
    if legend:
        marks = [Line2D([], [], ls="", marker=ENDS[code][0], color=style.INK, markersize=4, label=ENDS[code][1])
                 for code in sorted(seen & ENDS.keys())]
        marks += [Line2D([], [], color=style.INK, lw=0.9, ls=(0, (3, 2)), label="repels")] * bool(repelling)
        axes.legend(handles=marks, loc="upper left", bbox_to_anchor=(1, 1), borderaxespad=0.4)
    axes.set(xlabel=parameter_text(sweep), ylabel="branches", yticks=[], ylim=(-1, len(order)))
    if names:
        ids = style.names_with_ids(sweep["branch_name"].values) if only is None else sweep["branch_name"].values
        axes.set_yticks(range(len(order)), [style.name_text(ids[branch]) for branch in order])
        axes.set_ylabel("")
    return axes
