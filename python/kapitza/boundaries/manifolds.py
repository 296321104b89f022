"""Stable and unstable manifolds of cycles as polylines.

The stable manifold of a saddle is the set of starts that end on it; where it is a boundary, starts on its two sides end
on different attractors. The unstable manifold is the curve along which motions leave the saddle. The first arc of a
branch lies on the eigenvector of the cycle's multiplier, 1e-8 rad from it, and is mapped again and again; an arc is
halved where neighbouring points are farther apart than `spacing`, or where the curve bends by more than 0.3 rad. Every
point is computed from the first arc, so errors do not add up. A branch ends where it is `length` long, after
MOST_POINTS points, or where neighbouring starts differ in their last digits only.
"""

from concurrent.futures import ThreadPoolExecutor
from itertools import product
from os import cpu_count
from typing import TYPE_CHECKING

import numpy as np
import pandas
import xarray

from kapitza import layout

if TYPE_CHECKING:
    from kapitza.pendulum import Pendulum

MOST_POINTS = 32768
KINDS = {"unstable": (0,), "stable": (1,), "both": (0, 1)}
COLUMNS = ["theta", "velocity", "arc_length", "saddle", "branch", "kind", "polyline"]


def manifolds(pendulum: "Pendulum", cycles: xarray.Dataset, *, kind: str = "both", length: float = 20,
              spacing: float = 0.02, max_speed: float = 2) -> xarray.Dataset:
    """All branches of the manifolds of saddles, as the group `manifolds` of a file had them.

    >>> pendulum = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3)
    >>> curves = kapitza.manifolds(pendulum, pendulum.saddles(), kind="stable", length=14)

    :param cycles: saddles of this pendulum, as `Pendulum.saddles` or the group `saddles` of a file has them; `saddle`
        counts its rows, or has its ids
    :param kind: "stable", "unstable" or "both"
    :param length: of each branch, rad and rad per drive radian together; parts faster than max_speed are left out
    :param spacing: largest distance of neighbouring points, rad; up to 32 times smaller where a manifold bends by over
        0.3 rad
    """
    if kind not in KINDS:
        raise ValueError(f'kind is "{kind}"; it must be "stable", "unstable" or "both"')
    dimension = cycles["period"].dims[0]
    ids = cycles[dimension].values if dimension in cycles.coords else range(cycles.sizes[dimension])
    tasks = [(int(number), cycles.isel({dimension: row}), phase, stable, side) for row, number in enumerate(ids)
             for phase, stable, side in product(range(int(cycles["period"].values[row])), KINDS[kind], (1, -1))]

    def grow(task: tuple[int, xarray.Dataset, int, int, int]) -> pandas.DataFrame:
        number, cycle, phase, stable, side = task
        own = pendulum.with_()  # calls on one pendulum wait for each other
        points = own.manifold(cycle, stable=bool(stable), side=side, phase=phase, length=length, spacing=spacing,
                              max_speed=max_speed, most=MOST_POINTS)
        return points.assign(saddle=number, branch=2 * phase + (side < 0), kind=stable)

    with ThreadPoolExecutor(cpu_count()) as pool:
        branches = list(pool.map(grow, tasks))
    table = pandas.concat(branches, ignore_index=True) if branches else pandas.DataFrame(columns=COLUMNS)
    starts = np.concatenate([np.arange(len(branch)) == 0 for branch in branches]) if branches else np.zeros(0, bool)
    breaks = starts | (np.diff(table["polyline"].to_numpy(), prepend=-1) != 0)
    table["polyline"] = np.cumsum(breaks) - 1
    return layout.described("manifolds", xarray.Dataset({name: ("point", table[name].to_numpy()) for name in COLUMNS}))
