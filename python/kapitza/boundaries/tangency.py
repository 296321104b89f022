"""The value of a parameter at which an unstable and a stable manifold touch and begin to cross.

Below the value the two curves lie apart, above it (or the other way round) they cross infinitely often: the erosion of
the basins begins. For weak damping and a weak drive Melnikov's method gives m = (4/pi) beta k^(3/2) sinh(pi/(2
sqrt(k))) for the inverted state.

The range is halved by whether traces of the branches (kapitza.boundaries.branch) cross; then Newton's method moves a
place on each branch to where the two are parallel, the nearest points opposite, and Brent's method finds the value at
which their distance is 0.
"""

from dataclasses import dataclass
from math import ceil, inf, isnan, log, nan
from typing import TYPE_CHECKING

import numpy as np
import xarray
from scipy.optimize import brentq

from kapitza import layout
from kapitza.boundaries.branch import DISTANCE, Branch, BranchLost, Reals, branch_of, crossing, distance_between
from kapitza.scene import SYMBOLS

if TYPE_CHECKING:
    from kapitza.pendulum import Pendulum

FARTHER = 5    # factor by which branches begin farther away when the error is measured
# Factor from the change that this makes to the error: the change is one sample of it, which may be larger
MARGIN = 4
HALVINGS = 10  # halvings of the range before Newton's method
STEPS = 16     # steps of a cycle along the whole range


@dataclass
class Search:
    """Two cycles that are carried along the parameter, and the pair of branches that touch."""

    pendulum: "Pendulum"
    parameter: str
    range: tuple[float, float]
    length: float
    value: float          # at which the cycles are known
    cycles: list[Reals]   # strobe points (period, 2) of the cycles of the unstable and of the stable manifold
    distance: float = DISTANCE
    pair: tuple[int, int, int] = (1, 0, 1)  # side of the unstable branch; strobe point and side of the stable one
    places: tuple[float, float] = (nan, nan)

    def at(self, value: float) -> "Pendulum":
        """The pendulum at a value, with both cycles carried there in steps."""
        steps = max(1, ceil(abs(value - self.value) * STEPS / (self.range[1] - self.range[0])))
        for part in np.linspace(self.value, value, steps + 1)[1:] if value != self.value else ():
            moved = self.pendulum.with_(**{self.parameter: float(part)})
            for number, points in enumerate(self.cycles):
                try:
                    cycle = moved.cycle(float(points[0, 0]), float(points[0, 1]), len(points), within=0.5)
                except ValueError as error:
                    raise BranchLost("a cycle ends") from error
                if int(cycle.period) != len(points):
                    raise BranchLost("a cycle ends")
                self.cycles[number] = np.stack([cycle.strobe_theta.values, cycle.strobe_velocity.values],
                                               axis=1)[:len(points)]
        self.value = value
        return self.pendulum.with_(**{self.parameter: float(value)})

    def branches(self, value: float, pair: tuple[int, int, int] | None = None) -> tuple[Branch, Branch]:
        side, phase, side_2 = pair or self.pair
        pendulum = self.at(value)
        return (branch_of(pendulum, self.cycles[0][0], len(self.cycles[0]), side, stable=False, distance=self.distance),
                branch_of(pendulum, self.cycles[1][phase], len(self.cycles[1]), side_2, stable=True,
                          distance=self.distance))

    def crosses(self, value: float) -> bool:
        """Whether any two branches cross at a value; the pair that does so at the smallest angle is kept."""
        smallest, best = inf, None
        unstable = [self.branches(value, (side, 0, 1))[0].trace(self.length) for side in (-1, 1)]
        for phase, side_2 in ((phase, side) for phase in range(len(self.cycles[1])) for side in (-1, 1)):
            stable = self.branches(value, (1, phase, side_2))[1].trace(self.length)
            for side, trace in zip((-1, 1), unstable, strict=True):
                sine, places = crossing(trace, stable)
                if sine < smallest:
                    smallest, best = sine, ((side, phase, side_2), places)
        if best:
            self.pair, self.places = best
        return best is not None

    def gap(self, value: float) -> float:
        """Distance of the kept pair where its branches are parallel."""
        gap, places = distance_between(*self.branches(value), self.places)
        if not isnan(gap):
            self.places = places
        return gap

    def root(self, apart: float, crossed: float) -> float:
        """The value at which the distance is 0, between two values or a little beyond them; NaN if there is none."""
        seed, beyond = self.places, crossed - apart
        for _ in range(8):
            self.places = seed
            ends = (crossed + beyond, apart - beyond)
            gaps = [self.gap(end) for end in ends]
            if gaps[0] * gaps[1] <= 0:
                return float(brentq(self.gap, *ends, xtol=1e-300, rtol=4 * np.finfo(float).eps))
            beyond *= 2
        return nan

    def error(self, value: float, width: float) -> float:
        """MARGIN times the change of the value where branches begin FARTHER times as far from the cycles."""
        pair, kept = self.branches(value), (self.places, self.distance)
        first, second = (place - log(FARTHER) / log(branch.multiplier) for place,
                         branch in zip(self.places, pair, strict=True))
        self.places, self.distance = (first, second), FARTHER * self.distance
        again = self.root(value - width, value + width)
        self.places, self.distance = kept
        return MARGIN * abs(value - again)


def _number(pendulum: "Pendulum", parameter: str) -> float:
    keys = pendulum._tree["pendulum"]
    try:
        return float(keys[SYMBOLS.get(parameter, parameter)])
    except (KeyError, ValueError) as error:
        raise ValueError(f"{parameter} must be a number among the keys of the pendulum, {list(keys)}") from error


def _points(cycle: xarray.Dataset) -> Reals:
    period = int(cycle["period"])
    return np.stack([cycle["strobe_theta"].values[:period], cycle["strobe_velocity"].values[:period]], axis=1)


def tangency(pendulum: "Pendulum", parameter: str, low: float, high: float, *, saddle: xarray.Dataset | None = None,
             into: xarray.Dataset | None = None, length: float = 8) -> xarray.Dataset:
    """The value of a parameter, between low and high, at which an unstable and a stable manifold touch and begin to
    cross.

    >>> pendulum = kapitza.Pendulum(k=1, damping=0.02, m=0.05)
    >>> kapitza.tangency(pendulum, "m", 0.02, 0.1).attrs["value"]      # 0.0585896884310

    :param saddle: the cycle of the unstable manifold, at the pendulum's own value; None = the inverted state
    :param into: the cycle of the stable manifold; None = the same (a homoclinic tangency)
    :param length: of each branch that is looked at, rad and rad per drive radian together
    :return: the orbit through the point of contact (theta, velocity by strobe); attributes are `value`, its `error`,
        and `crossing`: whether the manifolds cross "above" or "below" the value
    :raises ValueError: if the manifolds cross at both ends or at neither, or a cycle ends or is no saddle on the way
    """
    first = pendulum.cycle(np.pi, 0) if saddle is None else saddle
    cycles = [_points(first), _points(first if into is None else into)]
    search = Search(pendulum, parameter, (low, high), length, _number(pendulum, parameter), cycles)
    above = search.crosses(high)
    kept = search.pair, search.places
    below = search.crosses(low)
    if above == below:
        raise ValueError(f"the manifolds cross at {'both ends' if above else 'neither end'} of {low:g} to {high:g}; "
                         "they must cross at one")
    if above:
        search.pair, search.places = kept
    crossed, apart = (high, low) if above else (low, high)
    for _ in range(HALVINGS):
        middle = crossed + (apart - crossed) / 2
        crossed, apart = (middle, apart) if search.crosses(middle) else (crossed, middle)
    value = search.root(apart, crossed)
    error = nan if isnan(value) else search.error(value, abs(crossed - apart))
    if isnan(error):
        raise ValueError(f"length {length:g} leads to manifolds that do not touch smoothly where they begin to cross; "
                         "choose another one")
    search.gap(value)
    return _described(search, parameter, value, error, above)


def _described(search: Search, parameter: str, value: float, error: float, above: bool) -> xarray.Dataset:
    """The group `tangency`: the orbit has a state for each return to either cycle, `strobe` drive periods from the
    contact."""
    unstable, stable = search.branches(value)
    before, after = (int(place) for place in search.places)
    states = np.concatenate([unstable.points([search.places[0] - n for n in range(before, -1, -1)])[0],
                             stable.points([search.places[1] - n for n in range(1, after + 1)])[0]])
    strobe = [*(-n * unstable.periods for n in range(before, -1, -1)),
              *(n * -stable.periods for n in range(1, after + 1))]
    theta = (states[:, 0] + np.pi) % (2 * np.pi) - np.pi
    orbit = xarray.Dataset({"theta": ("strobe", theta), "velocity": ("strobe", states[:, 1])}, {"strobe": strobe})
    return layout.described("tangency", orbit).assign_attrs(value=value, error=error, parameter=parameter,
                                                            crossing="above" if above else "below")
