"""Two results beside each other: which attractor is which, how their shares differ, and which cells end elsewhere."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from kapitza.result import Result

FARTHEST = 0.5  # strobe points of one attractor under two pendulums are nearer than this on average (rad, rad per drive radian)


def match_attractors(mine: pandas.DataFrame, others: pandas.DataFrame) -> dict[int, int]:
    """My id -> id of the same attractor among the others, by the distance of their strobe points; the nearest pairs first, each once.

    Attractors.jl calls it match_statespacesets. Only motions of the same winding per period are compared.
    """
    pairs = []
    for one in range(len(mine)):
        for other in range(len(others)):
            row, their = mine.iloc[one], others.iloc[other]
            same_turns = row["winding"] * max(their["period"], 1) == their["winding"] * max(row["period"], 1)
            if same_turns and (distance := _distance(row, their)) < FARTHEST:
                pairs.append((row["period"] != their["period"], distance, one, other))
    matched: dict[int, int] = {}
    for _, _, one, other in sorted(pairs):
        if one not in matched and other not in matched.values():
            matched[one] = other
    return matched


def _distance(one: pandas.Series, other: pandas.Series) -> float:
    """Mean distance of the points of one set from the nearest of the other, the larger way round; chaotic sets by where they are listed."""
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
        """A table with a row for each attractor: its name, its ids in both results (missing if it has none), its fractions in both, and
        their difference."""
        mine, others = self.first.attractors, self.second.attractors
        shares = self.first.basins_fractions(), self.second.basins_fractions()
        rows = [(mine["name"][one], one, self.matched.get(one)) for one in mine.index]
        rows += [(others["name"][other], None, other) for other in others.index if other not in self.matched.values()]
        table = pandas.DataFrame(rows, columns=["name", "first", "second"]).astype({"first": "Int64", "second": "Int64"})
        for side, share in zip(("first", "second"), shares, strict=True):
            table[f"fraction_{side}"] = [0.0 if pandas.isna(index) else float(share.get(index, 0.0)) for index in table[side]]
        table["difference"] = table["fraction_second"] - table["fraction_first"]
        return table

    @cached_property
    def differing(self) -> xarray.DataArray:
        """True for every cell that ends on another attractor in the second result.

        :raises ValueError: if the two grids are not the same
        """
        labels, others = self.first.labels(), self.second.labels()
        if labels.shape != others.shape or any(not np.array_equal(labels[axis], others[axis]) for axis in labels.dims):
            raise ValueError("the two results have other windows or counts; their cells cannot be compared one by one")
        return xarray.DataArray(self._renamed(labels.values) != others.values, labels.coords, labels.dims, name="differing")

    def _renamed(self, labels: np.ndarray) -> np.ndarray:
        """Labels of the first by the ids of the second; -2 = an attractor that the second lacks."""
        count = len(self.first.attractors)
        return np.array([*(self.matched.get(one, -2) for one in range(count)), -1])[labels]  # -1 takes the last

    @property
    def differing_share(self) -> float:
        """The share of the cells that end on another attractor."""
        return float(self.differing.mean())

    def tipping_probabilities(self) -> pandas.DataFrame:
        """P[i, j]: of the basin of attractor i in the first, the share that lies in the basin of j in the second (as of Attractors.jl)."""
        _ = self.differing  # the same grid
        table = pandas.crosstab(self.first.labels().values.ravel(), self.second.labels().values.ravel(), normalize="index")
        names = [{-1: "not settled", **dict(enumerate(result.names))} for result in (self.first, self.second)]
        return table.rename(index=names[0], columns=names[1]).rename_axis(index="first", columns="second")

    def plot(self, **options: Any) -> "Figure":
        """Both basins, and where they differ: a figure. Options: width ("178mm", or inches), centre ("down" or "inverted")."""
        from kapitza.plots.compare import comparison_figure
        return comparison_figure(self, **options)

    def __repr__(self) -> str:
        table = self.table.to_string(index=False, formatters={name: "{:.2%}".format for name in
                                                              ("fraction_first", "fraction_second", "difference")})
        try:
            words = f"{self.differing_share:.2%} of the cells end elsewhere"
        except ValueError as error:
            words = str(error)
        return f"{self.first.title} | {self.second.title}\n{table}\n{words}"
