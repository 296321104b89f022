"""Transition curves of a stability chart: their names, colours and ways, exact and by the papers' formulas."""

import re
from collections.abc import Mapping, Sequence

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from kapitza import style

COLOURS = ["#12806a", "#2f6db3", "#5b2a7a", "#c2452f", "#b08a1e", "#3b3f45"]

# Formula -> the exact curve that it approximates; subharmonics and upper branches by rule.
EXACT = {
    "blackburn_lower": "exact_1", "blackburn_upper": "exact_2", "blackburn_upper_note": "exact_2",
    "blackburn_tangent": "exact_2", "blackburn_down_upper": "exact_2",
    "butikov_4_refined": "exact_4", "butikov_5_refined": "exact_5", "butikov_5_refined_upper": "exact_5_upper",
    **{f"meissner_{number}": f"hill_{number}" for number in range(1, 6)},
}
LABELS = {
    "butikov_1": "Butikov Eq. 3", "butikov_2": "Butikov Eq. 4", "butikov_3": "Butikov Eq. 5",
    "butikov_4": "Butikov Eq. 6",
    "butikov_5": "Butikov Eq. 7", "butikov_4_refined": "Butikov Eq. 17", "butikov_5_refined": "Butikov Eq. 19",
    "butikov_damped_1": "Butikov Eq. 25", "butikov_damped_2": "Butikov Eq. 26",
    **{f"meissner_{number}": f"square wave, curve {number}" for number in range(1, 6)},
    "blackburn_lower": "Blackburn Eq. 5", "blackburn_upper": "Blackburn Eq. 6",
    "blackburn_upper_note": "Blackburn note 13", "blackburn_tangent": "tangent at k = 1/4",
    "blackburn_down_upper": "Blackburn Eq. 6, down",
}
# Meaning of each curve as a bound, with Butikov's numbers.
CURVES = {1: "curve 1: inverted stands above it", 2: "curve 2: first tongue, left edge",
          3: "curve 3: first tongue, right edge",
          4: "curve 4: second tongue, left edge", 5: "curve 5: second tongue, right edge"}
SUBHARMONICS = {2: 2, 3: 5, 4: 3, 6: 4}  # order -> colour, no two alike
K_LABEL, M_LABEL = "gravity k (negative about inverted)", "drive amplitude m"
A_LABEL, Q_LABEL = "a, static field (4 k)", "q, alternating field (2 m)"
KNOWN = re.compile(
    r"((butikov_)?(subharmonic|damped)|exact|hill|meissner|butikov)_\d+(_refined)?(_upper)?|blackburn_\w+")


def curve_names(chart: xarray.Dataset, *along: str) -> list[str]:
    """The curves over k, and those over m (`along`: over one of them alone)."""
    return [str(name) for name in chart.data_vars
            if chart[name].dims in [(axis,) for axis in along or "km"] and KNOWN.fullmatch(str(name))]


def axes_of(chart: xarray.Dataset) -> tuple[float, float, str, str]:
    """By what k and m are multiplied in a picture, and what its axes are: those of ion traps, where the scene has given
    them."""
    return (4, 2, A_LABEL, Q_LABEL) if "a" in chart else (1, 1, K_LABEL, M_LABEL)


def exact_of(name: str) -> str | None:
    """The exact curve behind a formula, None for a curve that is exact itself."""
    if name in EXACT:
        return EXACT[name]
    match = re.fullmatch(r"butikov_(subharmonic_\d+|damped_\d(_upper)?)", name)
    if match:
        return match[1]
    return name.replace("butikov", "exact") if name.startswith("butikov") else None


def label(name: str) -> str:
    """What people read instead of a variable's name."""
    if name in LABELS:
        return LABELS[name]
    match = re.fullmatch(r"(butikov_)?subharmonic_(\d+)", name)
    if match:
        return f"subharmonic of order {match[2]}" + (", Butikov Eq. 21" if match[1] else "")
    kind, number = name.split("_")[:2]
    if kind == "damped":
        return "damped: inverted stands above it" if number == "0" else f"tongue {number}, damped"
    return CURVES.get(int(number), f"curve {number}") if number.isdigit() else name.replace("_", " ")


def lowest_point(chart: xarray.Dataset, name: str) -> tuple[float, float] | None:
    """(k, m) of the lowest point of a damped tongue, where the chart has found it."""
    found = re.fullmatch(r"damped_(\d)", name)
    if not found or name not in chart:
        return None
    k, m = (float(chart.attrs.get(f"tongue_{found[1]}_lowest_{axis}", np.nan)) for axis in "km")
    return (k, m) if np.isfinite(k) else None


def _entry(chart: xarray.Dataset, name: str) -> str:
    """What the legend says of a curve."""
    lowest = lowest_point(chart, name)
    return label(name) + (f", lowest at k = {lowest[0]:.5f}, m = {lowest[1]:.5f}" if lowest else "")


def family(name: str) -> str:
    """Formula and exact curve share a colour."""
    number = int((re.findall(r"\d+", exact_of(name) or name) or ["1"])[0])
    if "subharmonic" in name:
        return COLOURS[SUBHARMONICS.get(number, number % len(COLOURS))]
    return COLOURS[(0, 1, 3)[number % 3]] if "damped" in name else COLOURS[(number - 1) % len(COLOURS)]


def whole_curve(chart: xarray.Dataset, name: str) -> tuple[np.ndarray, np.ndarray]:
    """(k, m) of a curve from the axis over its turn to its upper branch, where it has one."""
    if chart[name].dims == ("m",):
        return chart[name].values, chart["m"].values
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


def is_branch(chart: xarray.Dataset, name: str) -> bool:
    """An upper branch, drawn with the rest of its curve."""
    return name.endswith("_upper") and name.removesuffix("_upper") in chart and not name.startswith("blackburn")


def draw_curves(axes: Axes, chart: xarray.Dataset, *, colours: Mapping[str, str] | None = None, legend: bool = True,
                zones: Sequence[Artist] = ()) -> Axes:
    """Exact curves solid, formulas dashed, undamped ones faint where damped ones stand beside them. `colours`: by name
    of the curve (default: family); `zones`: further entries of the legend."""
    names = [name for name in curve_names(chart) if not is_branch(chart, name)]
    damped = any(name.startswith("damped") for name in names)
    across, up, *_ = axes_of(chart)
    for name in names:
        formula, faint = exact_of(name) is not None, damped and name.startswith("exact")
        k, m = whole_curve(chart, name)
        axes.plot(across * k, up * m, color=(colours or {}).get(name, style.FAINT if faint else family(name)),
                  linestyle=(0, (1, 1.2)) if "refined" in name else (0, (4, 2)) if formula else "-",
                  linewidth=0.7 if faint else 1.3 if formula else 1.6,
                  label=_entry(chart, name) + (", undamped" if faint else ""))
    if names and legend:
        axes.legend(handles=[*_entries(axes, names, damped), *zones], loc="upper left", bbox_to_anchor=(1.01, 1),
                    fontsize="small")
    return axes


def _entries(axes: Axes, names: list[str], damped: bool) -> list[Artist]:
    """Every exact curve by its name; formulas, which share the colours of their curves, by how they are drawn."""
    handles = dict(zip(names, axes.lines[-len(names):], strict=True))
    exact = [handles[name] for name in names if exact_of(name) is None and not (damped and name.startswith("exact"))]
    dashed = [name for name in names if exact_of(name) and "refined" not in name]
    square = [name for name in dashed if name.startswith("meissner")]
    kinds = [(dashes, text) for dashes, text, some in (
        ((0, (4, 2)), "of the true square wave, colour of its curve", square),
        ((0, (4, 2)), "formula of a paper, colour of its curve", len(dashed) > len(square)),
        ((0, (1, 1.2)), "refined formula", any("refined" in name for name in names))) if some]
    lines = [Line2D([], [], color=style.INK, linewidth=1.3, linestyle=dashes, label=text) for dashes, text in kinds]
    if damped and any(name.startswith("exact") for name in names):
        lines.append(Line2D([], [], color=style.FAINT, linewidth=0.7, label="without damping"))
    return [*exact, *lines]
