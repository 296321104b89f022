"""What lies over the basins: saddles and manifolds, of a result or of a pendulum that the page asks for."""

import numpy as np

from kapitza.boundaries.manifolds import manifolds
from kapitza.pendulum import Pendulum

from .requests import BadRequest

OVERLAYS = ("saddles", "manifolds")
LENGTH = 14  # length of each branch: rad and rad per drive radian together


def overlays(result):
    """{group: {"points": [[theta, velocity], ...]} or {"lines": [[[theta, velocity], ...], ...]}}."""
    found = {}
    for group in OVERLAYS:
        if result is None or group not in result.groups:
            continue
        table = result.group(group)
        found[group] = {"points": _points(table)} if group == "saddles" else {"lines": _lines(table)}
    return found


def skeleton(kept, request):
    """(header, payload) of each answer: `progress`, then `skeleton` with the overlays of a pendulum: its saddles of one
    period and their stable manifolds, which are the boundaries, inside of velocities up to `fastest`."""
    pendulum, fastest = request.get("pendulum"), request.get("fastest")
    if not isinstance(pendulum, dict) or isinstance(fastest, bool) or not isinstance(
        fastest, int | float) or not 0 < fastest <= 1000:
        raise BadRequest("a skeleton needs the mapping pendulum, and fastest: a velocity above 0 and up to 1000")
    scene = {"pendulum": pendulum, "saddles": {"velocity": {"min": -fastest, "max": fastest}, "max_period": 1}}

    def boundaries(result):
        curves = manifolds(Pendulum({"pendulum": pendulum}), result.group("saddles"), kind="stable", length=LENGTH,
                           max_speed=fastest)
        return {"overlays": overlays(result) | {"manifolds": {"lines": _lines(curves)}}}, b""

    return kept.answers(scene, boundaries, answer="skeleton", final=True)


def _points(table):
    """The strobe points of all rows."""
    theta, velocity = table["strobe_theta"].values, table["strobe_velocity"].values
    known = np.isfinite(theta)
    return np.column_stack([theta[known], velocity[known]]).tolist()


def _lines(table):
    """Polylines: rows of a matrix, or runs of one (saddle, branch, kind) in a list of points; cut where the angle
    wraps."""
    theta, velocity = table["theta"].values, table["velocity"].values
    ends = np.zeros(theta.shape, dtype=bool)
    for name in ("saddle", "branch", "kind"):
        if name in table and table[name].shape == theta.shape:
            ends[1:] |= table[name].values[1:] != table[name].values[:-1]
    rows = theta.reshape(-1, theta.shape[-1]), velocity.reshape(-1, theta.shape[-1]), ends.reshape(-1, theta.shape[-1])
    lines = []
    for angles, speeds, cuts in zip(*rows, strict=True):
        known = np.isfinite(angles)
        angles, speeds, cuts = angles[known], speeds[known], cuts[known]
        breaks = np.flatnonzero(cuts[1:] | (np.abs(np.diff(angles)) > np.pi)) + 1
        for part in np.split(np.arange(len(angles)), breaks):
            if len(part) > 1:
                lines.append(np.column_stack([angles[part], speeds[part]]).tolist())
    return lines
