"""Two results beside each other: which attractor is which, how their shares differ, and which cells end elsewhere."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray

from kapitza.table import cells_of, edges_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from kapitza.result import Result

# Strobe points of one attractor under two pendulums are nearer than this on average (rad, rad per drive radian)
FARTHEST = 0.5


def match_attractors(mine: pandas.DataFrame, others: pandas.DataFrame) -> dict[int, int]:
    """My id -> id of the same attractor among the others, by the distance of their strobe points; the nearest pairs
    first, each once.

    Attractors.jl calls it match_statespacesets. Only motions of the same period, winding and centre are joined.
    """
    pairs = []
    for one in range(len(mine)):
        for other in range(len(others)):
            row, their = mine.iloc[one], others.iloc[other]
            alike = all(row[name] == their[name] for name in ("period", "winding", "centre"))
            if alike and (distance := _distance(row, their)) < FARTHEST:
                pairs.append((distance, one, other))
    matched: dict[int, int] = {}
    for _, one, other in sorted(pairs):
        if one not in matched and other not in matched.values():
            matched[one] = other
    return matched


def _distance(one: pandas.Series, other: pandas.Series) -> float:
    """Mean distance of the points of one set from the nearest of the other, the larger way round; chaotic sets by where
    they are listed."""
    a, b = (np.column_stack([row["strobe_theta"], row["strobe_velocity"]]) for row in (one, other))
    if not len(a) or not len(b):
        return 0.0 if len(a) == len(b) else np.inf
    gap = a[:, None, :] - b[None, :, :]
    gap[..., 0] -= 2 * np.pi * np.rint(gap[..., 0] / (2 * np.pi))
    apart = np.hypot(gap[..., 0], gap[..., 1])
    return float(max(apart.min(axis=1).mean(), apart.min(axis=0).mean()))


@dataclass
class Comparison:
    """The differences between the basins of two results, `first` and `second`."""

    first: "Result"
    second: "Result"

    @cached_property
    def matched(self) -> dict[int, int]:
        """A dict from the id in the first result to the id in the second one, for the attractors that both have."""
        return match_attractors(self.first.attractors, self.second.attractors)

    @cached_property
    def table(self) -> pandas.DataFrame:
        """A table with a row for each attractor: its name (both names, if they differ), its ids in both results
        (missing if it has none), its fractions in both, and their difference."""
        mine, others = self.first.attractors, self.second.attractors
        shares = self.first.basins_fractions(), self.second.basins_fractions()
        names = {one: " → ".join(dict.fromkeys([mine["name"][one], others["name"][other]])) for one,
                 other in self.matched.items()}
        rows = [(names.get(one, mine["name"][one]), one, self.matched.get(one)) for one in mine.index]
        rows += [(others["name"][other], None, other) for other in others.index if other not in self.matched.values()]
        table = pandas.DataFrame(rows,
                                 columns=["name", "first", "second"]).astype({"first": "Int64", "second": "Int64"})
        for side, share in zip(("first", "second"), shares, strict=True):
            table[f"fraction_{side}"] = [0.0 if pandas.isna(index) else float(share.get(index, 0.0))
                                         for index in table[side]]
        table["difference"] = table["fraction_second"] - table["fraction_first"]
        return table

    @cached_property
    def _labels(self) -> tuple[xarray.DataArray, xarray.DataArray]:
        """The labels of both on one grid: along each axis that of the result with fewer cells, whose centres are looked
        up in the other."""
        pair = self.first.labels(), self.second.labels()
        if all(np.array_equal(pair[0][name], pair[1][name]) for name in pair[0].dims):
            return pair
        basins = self.first.group("basin"), self.second.group("basin")
        for name in pair[0].dims:
            mine, others = (edges_of(basin, str(name)) for basin in basins)
            if not np.allclose(mine, others, rtol=0, atol=1e-6 * np.ptp(mine)):
                raise ValueError("the two results have different windows; their cells cannot be compared")
        grid = {name: min((labels[name] for labels in pair), key=len) for name in pair[0].dims}
        places = np.meshgrid(grid["theta"].values, grid["velocity"].values)
        both = (labels.values[cells_of(basin, *places)[1:]] for labels, basin in zip(pair, basins, strict=True))
        first, second = (xarray.DataArray(values, grid, ("velocity", "theta")) for values in both)
        return first, second

    @cached_property
    def differing(self) -> xarray.DataArray:
        """True for every cell that ends on another attractor in the second result. Of two grids over one window the
        coarser one counts: the other result says where the centres of its cells end.

        :raises ValueError: if the two windows are not the same
        """
        labels, others = self._labels
        return xarray.DataArray(self._renamed(labels.values) != others.values, labels.coords, labels.dims,
                                name="differing")

    @property
    def cells(self) -> xarray.Dataset:
        """`differing` with what a picture needs to know of the window."""
        basin = self.first.group("basin")
        return (basin.assign(differing=self.differing)
                if self.differing.shape == basin["attractor"].shape else self.differing.to_dataset())

    def _renamed(self, labels: np.ndarray) -> np.ndarray:
        """Labels of the first by the ids of the second; -2 = an attractor that the second lacks."""
        count = len(self.first.attractors)
        return np.asarray(np.array([*(self.matched.get(one, -2) for one in range(count)), -1])[labels])  # -1: the last

    @property
    def differing_share(self) -> float:
        """The share of the cells that end on another attractor."""
        return float(self.differing.mean())

    def tipping_probabilities(self) -> pandas.DataFrame:
        """P[i, j]: of the basin of attractor i in the first, the share that lies in the basin of j in the second (as of
        Attractors.jl)."""
        first, second = (labels.values.ravel() for labels in self._labels)
        table = pandas.crosstab(first, second, normalize="index")
        names = [{-1: "not settled", **dict(enumerate(result.names))} for result in (self.first, self.second)]
        return table.rename(index=names[0], columns=names[1]).rename_axis(index="first", columns="second")

    def plot(self, **options: Any) -> "Figure":
        """Both basins, and where they differ: a figure. Options as of `kapitza plot compare`, such as width ("178mm",
        or inches) and centre ("down" or "inverted")."""
        from kapitza.plots.picture import picture
        return picture(self.first, "compare", other=self.second, **options)

    def __repr__(self) -> str:
        table = self.table.to_string(index=False, formatters={name: "{:.2%}".format for name in
                                                              ("fraction_first", "fraction_second", "difference")})
        try:
            words = f"{self.differing_share:.2%} of the cells end elsewhere"
        except ValueError as error:
            words = str(error)
        return f"{self.first.title} | {self.second.title}\n{table}\n{words}"
