"""How likely a motion is: the share of a basin under a spread of starts, and shares along a sweep or over a plane, by
name."""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas
import xarray

from kapitza import units
from kapitza.bounded_reading import table_file
from kapitza.scene import tree_of
from kapitza.table import CENTRES, cells_of, edges_of

if TYPE_CHECKING:
    from kapitza.result import Result

Z = 1.959963984540054  # normal quantile of a 95 % interval
CYCLE, CHAOTIC = 0, 1  # codes of the variable `end` of a plane
Row = tuple[str, float, float, float]  # name, probability, low, high
OUTSIDE, NOT_SETTLED = "outside the window", "not settled"


def wilson(count: Any, n: int) -> tuple[Any, Any]:
    """The 95 % interval (Wilson) of a share that is `count` of n independent samples."""
    share, spread = np.asarray(count) / n, Z**2 / n
    middle, half = share + spread / 2, Z * np.sqrt(share * (1 - share) / n + spread / (4 * n))
    return np.maximum(0, (middle - half) / (1 + spread)), np.minimum(1, (middle + half) / (1 + spread))


def share_below(kind: str, edges: np.ndarray, middle: float, spread: float) -> np.ndarray:
    """The share of a distribution below each edge: "normal" with the standard deviation `spread`, "uniform" within
    +-spread."""
    if spread == 0:
        return (edges > middle).astype(float)
    if kind == "uniform":
        return np.clip((edges - middle + spread) / (2 * spread), 0, 1)
    return np.array([math.erfc(-(edge - middle) / spread / math.sqrt(2)) / 2 for edge in edges])


def probability(result: "Result", theta: Any, velocity: Any, spread: tuple[Any, Any], kind: str, starts: int,
                seed: int) -> pandas.DataFrame:
    """As Result.probability."""
    omega = result.pivot_frequency
    place = units.angle(theta), units.velocity(velocity, omega)
    widths = units.angle(spread[0]), units.velocity(spread[1], omega)
    if kind not in ("normal", "uniform"):
        raise ValueError(f"{kind!r} is not a kind of spread; give normal or uniform")
    if not all(math.isfinite(number) for number in (*place, *widths)) or min(widths) < 0:
        raise ValueError(f"the spread {spread!r} about ({theta!r}, {velocity!r}) must be finite and not below 0")
    if not 0 <= starts <= 100_000:
        raise ValueError(f"starts is {starts}; it must be from 0 (the basin of the file) to 100000")
    rows = _of_fresh_starts(result, place, widths, kind, starts,
                            seed) if starts else _of_basin(result, place, widths, kind)
    table = pandas.DataFrame(rows, columns=["name", "probability", "low", "high"])
    return table.sort_values("probability", ascending=False, kind="stable", ignore_index=True)


def _of_basin(result: "Result", place: tuple[float, float], widths: tuple[float, float], kind: str) -> list[Row]:
    """The weight of the cells of each attractor. Low counts the cells whose eight neighbours have the same label, high
    also every cell beside one of them: the boundary lies between."""
    basin, names = result.group("basin"), {-1: NOT_SETTLED, **dict(enumerate(result.names))}
    weights = {}
    for name, middle, width in zip(("theta", "velocity"), place, widths, strict=True):
        edges = np.linspace(*edges_of(basin, name), basin.sizes[name] + 1)
        turns = units.TURN * np.arange(-40, 41) if name == "theta" else np.zeros(1)
        reach = [turn for turn in turns if middle + turn + 9 * width >= edges[0] and middle + turn - 9 * width
                 <= edges[-1]]
        weights[name] = sum((np.diff(share_below(kind, edges, middle + turn, width)) for turn in reach),
                            np.zeros(basin.sizes[name]))
    weight, labels = np.outer(weights["velocity"], weights["theta"]), basin["attractor"].values
    around = edges_of(basin, "theta")
    wraps = abs(around[1] - around[0] - units.TURN) < 1e-6
    rows = []
    for label in np.unique(labels):
        mine = labels == label
        share, low, high = (float(weight[cells].sum()) for cells in (mine, ~_grown(~mine, wraps), _grown(mine, wraps)))
        if high > 0:
            rows.append((names[int(label)], share, low, min(high, 1.0)))
    outside = max(0.0, 1 - float(weight.sum()))
    return rows + [(OUTSIDE, outside, outside, outside)] * (outside > 1e-9)


def _grown(cells: np.ndarray, wraps: bool) -> np.ndarray:
    """The cells and all that touch one of them; `wraps`: the first and the last column touch."""
    wide = np.pad(cells, ((0, 0), (1, 1)), mode="wrap" if wraps else "edge")
    row = wide[:, :-2] | wide[:, 1:-1] | wide[:, 2:]
    high = np.pad(row, ((1, 1), (0, 0)), mode="edge")
    return np.asarray(high[:-2] | high[1:-1] | high[2:])


def _of_fresh_starts(result: "Result", place: tuple[float, float], widths: tuple[float, float], kind: str, starts: int,
                     seed: int) -> list[Row]:
    """Random starts, each followed to its end, with the 95 % interval (Wilson) of each share."""
    from kapitza.starts import where
    random = np.random.default_rng(seed)

    def draw() -> np.ndarray:
        return np.asarray(random.normal(size=starts) if kind == "normal" else random.uniform(-1, 1, starts))

    theta, velocity = (middle + width * draw() for middle, width in zip(place, widths, strict=True))
    ends = where(result.scene, theta, velocity)
    counts = ends["name"].fillna(NOT_SETTLED).value_counts()
    intervals = ((name, count, *wilson(count, starts)) for name, count in counts.items())
    return [(str(name), count / starts, float(low), float(high)) for name, count, low, high in intervals]


def share(result: "Result", name: str) -> xarray.DataArray:
    """As Result.share."""
    if "sweep" in result.groups:
        sweep = result.group("sweep")
        if "fraction" not in sweep:
            raise KeyError("the sweep has no shares; add basin_fractions to its measure")
        names = [str(one) for one in sweep["branch_name"].values]
        kinds = [CENTRES[int(code)] for code in sweep["branch_centre"].values]
        chosen = _chosen(name, names, kinds)
        along = sweep["fraction"].fillna(0).isel(branch=chosen).sum("branch").rename(f"share of {name}").assign_attrs(
            long_name=f"share of the starts that end on {name}", units="1")
        n, known = _followed(result), sweep["fraction"].notnull().any("branch").values
        low, high = wilson(np.rint(along.values * n), n)
        return along.assign_coords(low=("value", np.where(known, low, 0.0)), high=("value", np.where(known, high, 1.0)))
    chart = result.group("plane")
    ends = chart["end"].isin([CYCLE, CHAOTIC])
    kinds = [CENTRES[code] if code < len(CENTRES) else "neither" for code in range(4)]
    if name not in kinds:
        raise KeyError(f"a plane knows no {name!r}; give {', '.join(kinds)}")
    return (ends & (chart["end_centre"] == kinds.index(name))).mean("start").rename(f"share of {name}").assign_attrs(
        long_name=f"share of the starts that end {name}", units="1")


def _followed(result: "Result") -> int:
    """The number of cells or starts whose ends a sweep counts at each value."""
    scene = tree_of(result.scene)
    axes = [scene.get("basin", {}).get(name, {}) for name in ("theta", "velocity")]
    return math.prod(int(axis["count"]) for axis in axes) if all(axes) else int(scene["sweep"]["starts"])


def _chosen(name: str, names: list[str], kinds: list[str]) -> list[int]:
    """The branches of a name, or of a centre where no branch has the name."""
    chosen = [place for place, one in enumerate(names) if one == name] or [place for place, kind in enumerate(kinds)
                                                                           if kind == name]
    if not chosen and name not in CENTRES:
        raise KeyError(f"no branch has the name {name!r}; the names are {', '.join(dict.fromkeys(names))}")
    return chosen


class Largest(NamedTuple):
    """The largest value of a key with a share; for `low` the lower ends of the shares' 95 % intervals count, for `high`
    the upper."""

    value: float
    low: float
    high: float


def largest(result: "Result", name: str, least: float) -> Largest:
    """As Result.largest."""
    along = share(result, name)
    if along.ndim != 1:
        raise ValueError("a plane has no single value; take .share(name) of it")
    value, low, high = (float(along["value"].where(of >= least).max()) for of in (along, along["low"], along["high"]))
    return Largest(value, low, high)


def agreement(result: "Result", table: Any) -> "Agreement":
    """As Result.agree."""
    if not isinstance(table, pandas.DataFrame):
        table = pandas.read_csv(table_file(table))
    measured = table.reset_index(drop=True)
    theta, velocity = measured_starts(measured)
    if "end" not in measured or not len(measured):
        raise ValueError(
            "the table of releases needs a column end, such as inverted or down, and a row for each release")
    found = result.at(theta, velocity)
    assert isinstance(found, pandas.DataFrame)  # as lists give
    centres = {-1: "", **dict(enumerate(result.attractors["centre"]))}
    plain = {-1: NOT_SETTLED, **dict(enumerate(result.attractors["name"]))}
    known = {*result.names, *plain.values(), *CENTRES}
    if unknown := sorted(set(measured["end"]) - known):
        names = ", ".join([*result.names, *CENTRES])
        raise ValueError(f"no attractor is called {unknown[0]!r}; give a name or a centre: {names}")
    found["measured"] = measured["end"]
    found["agrees"] = [end in (row["name"], plain[int(row["attractor"])], centres[int(row["attractor"])])
                       for end, (_, row) in zip(measured["end"], found.iterrows(), strict=True)]
    found["near_boundary"] = _near_boundary(result, found)
    return Agreement(found[["theta", "velocity", "measured", "name", "agrees", "near_boundary"]])


def measured_starts(table: pandas.DataFrame) -> tuple[list[Any], list[Any]]:
    """The starts of a table with the columns theta or theta_deg, and velocity or velocity_rad_per_s."""
    for name in ("theta", "velocity"):
        if name not in table and {"theta": "theta_deg", "velocity": "velocity_rad_per_s"}[name] not in table:
            raise ValueError(
                f"the table of releases needs a column {name}, or {name}_{'deg' if name == 'theta' else 'rad_per_s'}")
    theta = table["theta"] if "theta" in table else [f"{value!r} deg" for value in table["theta_deg"].astype(float)]
    velocity = table["velocity"] if "velocity" in table else [f"{value!r} rad/s"
                                                              for value in table["velocity_rad_per_s"].astype(float)]
    return list(theta), list(velocity)


def _near_boundary(result: "Result", found: pandas.DataFrame) -> list[bool]:
    """Whether one of the eight cells around a start has another label."""
    basin = result.group("basin")
    labels = basin["attractor"].values
    _, rows, columns = cells_of(basin, found["theta"].to_numpy(), found["velocity"].to_numpy())
    pieces = (labels[max(0, row - 1):row + 2, max(0, column - 1):column + 2] for row,
              column in zip(rows, columns, strict=True))
    return [bool((piece != piece.flat[0]).any()) for piece in pieces]


class Agreement:
    """Measured releases beside a basin.

    `table` has a row each: theta and velocity, `measured` (the end that was seen), `name` (where the map has it end),
    `agrees`, and `near_boundary` (whether a cell beside its own ends elsewhere). `share` is the share that agrees,
    `interval` its 95 % interval (Wilson).
    """

    def __init__(self, table: pandas.DataFrame) -> None:
        self.table = table
        self.share = float(table["agrees"].mean())
        self.interval = tuple(map(float, wilson(table["agrees"].sum(), len(table))))

    def __repr__(self) -> str:
        wrong, low, high = self.table[~self.table["agrees"]], *(100 * edge for edge in self.interval)
        lines = [f"{int(self.table['agrees'].sum())} of {len(self.table)} releases agree ({100 * self.share:.1f} %, "
                 "95 % interval "
                 f"{low:.1f} to {high:.1f} %)"]
        if len(wrong):
            lines.append(
                f"{int(wrong['near_boundary'].sum())} of the {len(wrong)} others lie beside a boundary of the basins")
            lines.append(wrong.to_string())
        return "\n".join(lines)
