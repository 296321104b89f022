"""Basins that share one boundary (lakes of Wada): which basins the unstable manifold of each saddle enters.

Let the unstable manifold of a saddle P meet the basins B1 ... Bn. An arc across the stable manifold of P comes near P
and is stretched along the unstable one (the inclination lemma: J. Palis, Topology 8 (1969) 385); basins are open, so
its images enter each of these basins, and so does the arc. Every point of the stable manifold is a boundary point of
all n basins. If both branches lie in two basins in all, no third basin comes near the stable manifold; that is checked
at points `spacing` apart, so a basin that cuts a branch between two points is missed. (H. E. Nusse, J. A. Yorke,
Science 271 (1996) 1376; J. Kennedy, J. A. Yorke, Physica D 51 (1991) 213.)

A point counts for a basin if its motion is decided to end there with the error of the point itself, OFF; it is the
witness.
"""

from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray
from numpy.typing import NDArray

from kapitza import layout
from kapitza.boundaries.manifolds import MOST_POINTS

if TYPE_CHECKING:
    from kapitza.pendulum import Pendulum

Reals = NDArray[np.float64]

OFF = 1e-11    # rad: bound of the distance of a computed point from the manifold, which shrinks along it
# Rad: nearer to the cycle points are not labelled, because OFF counts there; the others contain their images
BESIDE = 1e-6
OPEN, NO, PARTLY, YES = range(4)
WITNESS = ("theta", "velocity", "arc_length", "periods")


def wada(pendulum: "Pendulum", cycles: xarray.Dataset, *, length: float = 10, spacing: float = 0.02,
         max_speed: float = 10) -> xarray.Dataset:
    """Which basins the unstable manifold of each saddle enters, and which boundaries more than two basins share.

    >>> forced = kapitza.Pendulum(k=1, damping=0.2, m=0, torque_amplitude=1.66)
    >>> kapitza.wada(forced, forced.saddles(max_period=2, velocity=(-4, 4))).wada.values      # 3: yes

    :param cycles: saddles of this pendulum, as `Pendulum.saddles` or the group `saddles` of a file has them
    :param length: of each branch, rad and rad per drive radian together; parts faster than max_speed are left out
    :param spacing: largest distance of neighbouring points, rad
    :return: by saddle, side and attractor a witness (theta, velocity, arc_length, periods); `basins` that share the
        stable manifold of a saddle; `wada` of an attractor: 3 yes (each known cycle bounds three basins or more), 2
        partly, 1 no, 0 open
    """
    dimension = cycles["period"].dims[0]
    tasks = [(cycles.isel({dimension: row}), side) for row in range(cycles.sizes[dimension]) for side in (1, -1)]

    def grow(task: tuple[xarray.Dataset, int]) -> pandas.DataFrame:
        own = pendulum.with_()  # calls on one pendulum wait for each other
        branch = own.manifold(task[0], side=task[1], length=length, spacing=spacing, max_speed=max_speed,
                              most=MOST_POINTS)
        return branch[branch["arc_length"] >= BESIDE]

    with ThreadPoolExecutor(cpu_count()) as pool:
        branches = list(pool.map(grow, tasks))
    points = pandas.concat(branches, ignore_index=True) if branches else pandas.DataFrame({"theta": [], "velocity": [],
                                                                                           "arc_length": []})
    ends = pendulum.where(points["theta"].to_numpy(), points["velocity"].to_numpy(), start_error=OFF)
    decided = (ends["attractor"].values >= 0) & (ends["other_attractor"].values < 0)
    label, periods = np.where(decided, ends["attractor"].values, -1), ends["settling_time"].values
    witness = np.full((len(tasks), ends.sizes["id"], len(WITNESS)), np.nan)
    followed, at = np.zeros(len(tasks), np.int8), 0
    for number, branch in enumerate(branches):
        own, at = slice(at, at + len(branch)), at + len(branch)
        for attractor in np.unique(label[own][label[own] >= 0]):
            inside = np.flatnonzero(label[own] == attractor)
            first = inside[np.argmin(periods[own][inside])]
            witness[number, attractor] = [*branch[["theta", "velocity", "arc_length"]].to_numpy()[first],
                                          periods[own][first]]
        followed[number] = len(branch) and label[own][-1] >= 0 and (label[own]
                                                                    == label[own][-1]).all() and periods[own][-1] == 0
    sides = (cycles.sizes[dimension], 2)
    return _proved(witness.reshape(*sides, *witness.shape[1:]), followed.reshape(sides), ends)


def _proved(witness: Reals, followed: NDArray[np.int8], ends: xarray.Dataset) -> xarray.Dataset:
    """The group `wada`: what the witnesses say of saddles, attractors and pairs of attractors."""
    meets = np.asarray(~np.isnan(witness[..., 0]).all(axis=1))          # saddle, attractor
    basins = meets.sum(axis=1)
    complete = followed.all(axis=1)                         # no longer branch would meet another basin
    bounds = (basins >= 2) | ~complete
    both = meets[:, :, None] & meets[:, None, :] & bounds[:, None, None]
    every, three = both.sum(axis=0), (both & (basins > 2)[:, None, None]).sum(axis=0)
    two = (both & ((basins == 2) & complete)[:, None, None]).sum(axis=0).diagonal()
    all_own, three_own = every.diagonal(), three.diagonal()
    words = np.where((three_own > 0) & (two > 0), PARTLY,
                     np.where((all_own == 0) | (three_own + two < all_own), OPEN, np.where(three_own > 0, YES, NO)))
    apart = 1 - np.eye(len(words), dtype=int)
    variables: dict[str, Any] = {name: (("saddle", "side", "attractor"), witness[..., place]) for place,
                                 name in enumerate(WITNESS)}
    variables |= {"followed": (("saddle", "side"), followed), "basins": ("saddle", basins),
                  "wada": ("attractor", words),
                  "pair_cycles": (("attractor", "other"), every * apart),
                  "pair_shared": (("attractor", "other"), three * apart)}
    return layout.described("wada",
                            xarray.Dataset(variables)).assign_attrs(names=[str(name) for name in ends["name"].values])
