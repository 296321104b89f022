"""Branches of manifolds as smooth curves of one number, their place: where two of them cross, and how far apart they
are.

The point of place n + x is the image, after n returns, of the point at the distance `distance` * multiplier^x from the
cycle along the eigenvector (0 <= x < 1), and its tangent the image of the derivative there. Stable manifolds are those
of reversed time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, hypot, inf, isfinite, log, nan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from kapitza.pendulum import Pendulum

Reals = NDArray[np.float64]

# Rad: distance of a branch's beginning from its cycle; the branch leaves its tangent by the square of this
DISTANCE = 1e-7
TRACE_BEGINS = 1e-3  # rad from the cycle
SPACING = 0.05       # rad, and as a place: distance of neighbours in a trace
MOST_POINTS = 20000
PARALLEL = 1e-9      # last step of Newton's method, as a place


class BranchLost(ValueError):
    """A cycle ends, or is no saddle, at a value of the parameter."""


@dataclass(frozen=True)
class Branch:
    """One branch of a manifold of a cycle."""

    pendulum: "Pendulum"
    point: Reals       # strobe point of the cycle: rad, rad per drive radian
    direction: Reals   # unit eigenvector
    multiplier: float  # above 1, over `periods`, in the branch's own direction of time
    periods: int       # drive periods of a return, negative for a stable manifold
    distance: float    # rad: of the beginning from the cycle

    def points(self, places: Sequence[float]) -> tuple[Reals, Reals]:
        """Points (n, 2) and derivatives by the place (n, 2). Angles are wrapped."""
        place = np.asarray(places, dtype=float)
        returns = np.maximum(np.floor(place), 0).astype(int)
        far = self.distance * self.multiplier ** (place - np.floor(place))
        state = self.point + far[:, None] * self.direction
        tangent = (far * log(self.multiplier))[:, None] * self.direction
        for n in np.unique(returns[returns > 0]):
            own = returns == n
            image = self.pendulum.map(state[own, 0], state[own, 1], int(n) * self.periods, tangent=True)
            state[own] = np.stack([image.theta, image.velocity], axis=1)
            tangent[own] = np.einsum("nij,nj->ni", np.asarray(image.tangent), tangent[own])
        return state, tangent

    def trace(self, length: float) -> tuple[Reals, Reals, Reals]:
        """Places, points and tangents along the branch from TRACE_BEGINS beside the cycle on."""
        places: list[float] = []
        rows: list[tuple[Reals, Reals]] = []
        place, so_far = log(TRACE_BEGINS / self.distance) / log(self.multiplier), 0.0
        while so_far < length and len(places) < MOST_POINTS:
            point, tangent = (values[0] for values in self.points([place]))
            places.append(place)
            rows.append((point, tangent))
            speed = hypot(*tangent)
            step = min(SPACING, SPACING / speed) if isfinite(speed) and speed > 0 else 0.0
            if not place + step > place:
                break
            so_far += step * speed
            place += step
        return np.array(places), np.array([row[0] for row in rows]), np.array([row[1] for row in rows])


def branch_of(pendulum: "Pendulum", point: Reals, period: int, side: int, *, stable: bool,
              distance: float = DISTANCE) -> Branch:
    """The branch from a strobe point of a cycle to one side (1 or -1). BranchLost if the cycle is no saddle."""
    sign = -1 if stable else 1
    (a, b), (c, d) = np.asarray(pendulum.map(point[0], point[1], sign * period, tangent=True).tangent)
    half, root = (a + d) / 2, ((a + d) / 2) ** 2 - (a * d - b * c)
    if not root > 0:
        raise BranchLost("the cycle is no saddle")
    multiplier = half + copysign(root**0.5, half)
    direction = np.array([b, multiplier - a]) if hypot(b, multiplier
                                                       - a) >= abs(multiplier - d) else np.array([multiplier - d, c])
    if not abs(multiplier) > 1:
        raise BranchLost("the cycle is no saddle")
    twice = 2 if multiplier < 0 else 1
    direction *= side / hypot(*direction)
    return Branch(pendulum, np.array(point, dtype=float), direction, abs(multiplier) ** twice, sign * twice * period,
                  distance)


def _cross(a: Reals, b: Reals) -> Any:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _gap(a: Reals, b: Reals) -> Reals:
    """The vector from a to b, the angle on the circle."""
    gap = np.asarray(b - a)
    gap[..., 0] = np.remainder(gap[..., 0] + np.pi, 2 * np.pi) - np.pi
    return gap


def _sine(a: Reals, b: Reals) -> Any:
    return _cross(a, b) / (np.hypot(*np.moveaxis(a, -1, 0)) * np.hypot(*np.moveaxis(b, -1, 0)))


def crossing(first: tuple[Reals, Reals, Reals],
             second: tuple[Reals, Reals, Reals]) -> tuple[float, tuple[float, float]]:
    """The smallest sine of the angle at which two traces cross, and the places there; infinite if they do not cross."""
    (place, point, tangent), (place_2, point_2, tangent_2) = first, second
    if min(len(place), len(place_2)) < 2:
        return inf, (nan, nan)
    between = _gap(point[:-1, None], point_2[None, :-1])
    along, along_2 = _gap(point[:-1], point[1:])[:, None], _gap(point_2[:-1], point_2[1:])[None, :]
    with np.errstate(all="ignore"):
        area = _cross(along, along_2)
        share, share_2 = _cross(between, along_2) / area, _cross(between, along) / area
        crosses = (np.abs(between).sum(-1) <= 0.2) & (share >= 0) & (share < 1) & (share_2 >= 0) & (share_2 < 1)
        sine = np.where(crosses, np.abs(_sine(tangent[:-1, None], tangent_2[None, :-1])), inf)
    i, j = np.unravel_index(np.argmin(sine), sine.shape)
    if not isfinite(sine[i, j]):
        return inf, (nan, nan)
    return float(sine[i, j]), (float(place[i] + share[i, j] * (place[i + 1] - place[i])),
                               float(place_2[j] + share_2[i, j] * (place_2[j + 1] - place_2[j])))


def distance_between(first: Branch, second: Branch, places: Sequence[float]) -> tuple[float, tuple[float, float]]:
    """The distance, with a sign, between two branches where they are parallel, and the places there; NaN if Newton's
    method fails."""
    def conditions(x: Reals) -> tuple[Reals, float]:
        (point, tangent), (point_2, tangent_2) = ((rows[0] for rows in branch.points([float(place)]))
                                                  for branch, place in ((first, x[0]), (second, x[1])))
        gap, speed = _gap(point, point_2), hypot(*tangent)
        return np.array([gap @ tangent / speed, _sine(tangent, tangent_2)]), float(_cross(tangent, gap) / speed)

    x, step = np.array(places, dtype=float), 1e-5
    for _ in range(30):
        value, across = conditions(x)
        slope = np.stack([(conditions(x + one)[0] - conditions(x - one)[0]) / (2 * step) for one in step * np.eye(2)],
                         axis=1)
        try:
            change = -np.linalg.solve(slope, value)
        except np.linalg.LinAlgError:
            break
        most = float(np.abs(change).max())
        x = x + min(1.0, 0.1 / most if most > 0 else 1.0) * change
        if not np.abs(x - places).sum() < 2:
            break
        if most < PARALLEL:
            return across, (float(x[0]), float(x[1]))
    return nan, (nan, nan)
