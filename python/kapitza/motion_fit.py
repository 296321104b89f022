"""The equation of motion of a pendulum, theta in rad from the rest position, time in s, and its fit to a track:

theta'' + viscous theta' + quadratic |theta'| theta' + dry sign(theta')
    + (omega0^2 - drive omega^2 cos(omega t + phase)) sin theta = 0
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares
from scipy.special import stdtrit

SHARPNESS = 2e-3  # share of the largest speed in which dry friction changes its sign
FASTEST = 100.0  # largest speed of a solution, in units of the speeds of its numbers
UNITS = {
    "omega0": "rad/s",
    "offset": "rad",
    "theta": "rad",
    "velocity": "rad/s",
    "viscous": "1/s",
    "quadratic": "1/rad",
    "dry": "rad/s²",
    "drive": "",
    "phase": "rad",
}


@dataclass(frozen=True)
class Model:
    """One least-squares fit: `values` and 95 % errors (`errors`) by name, the root mean square of the residuals
    (`residual`, rad), the correlation of neighbouring residuals, and the residuals (`left`, rad)."""

    name: str
    values: dict[str, float]
    errors: dict[str, float]
    residual: float
    correlation: float
    left: np.ndarray


def simulated(time: np.ndarray, values: Mapping[str, Any], omega: float | None, averaged: bool = False) -> np.ndarray:
    """Angles (columns, times) of the equation for numbers [columns] by name; infinite from where a solution runs away.

    :param averaged: whether the slow motion is solved, in the effective potential of a fast drive, and the fast one
        added to it; `theta` and `velocity` are of the slow motion then
    """
    columns = len(values["omega0"])
    get = {name: np.broadcast_to(np.asarray(values.get(name, 0.0), dtype=float), columns) for name in UNITS}
    square, viscous, quadratic, dry = get["omega0"] ** 2, get["viscous"], get["quadratic"], get["dry"]
    rate, phase = omega or 0.0, get["phase"]
    drive, dried = get["drive"] * rate**2, bool(np.any(dry))
    scale = SHARPNESS * max(float(np.max(np.abs(get["omega0"]))), 1e-12)
    limit = FASTEST * float(np.max(np.abs(get["omega0"]) + np.abs(get["drive"]) * rate + np.abs(get["velocity"])))

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        theta, speed = state[:columns], state[columns:]
        size = np.abs(speed)
        if size.max() > limit:
            return np.full(2 * columns, np.nan)
        if averaged:
            gravity = square + get["drive"] * drive / 2 * np.cos(theta)
        else:
            gravity = square - drive * np.cos(rate * t + phase) if omega else square
        drag = (viscous + quadratic * size) * speed
        return np.concatenate(
            [speed, -gravity * np.sin(theta) - (drag + dry * np.tanh(speed / scale) if dried else drag)]
        )

    since = time - time[0]
    with np.errstate(all="ignore"):
        solution = solve_ivp(
            slope,
            (0.0, since[-1]),
            np.concatenate([get["theta"] - get["offset"], get["velocity"]]),
            method="DOP853",
            t_eval=since,
            rtol=1e-7,
            atol=1e-9,
        )
        found, speed = np.split(solution.y, 2)
        if averaged:
            turn = rate * solution.t + phase[:, None]
            found = found + get["drive"][:, None] * (
                2 / rate * speed * np.cos(found) * np.sin(turn) - np.sin(found) * np.cos(turn)
            )
    angles = np.full((columns, time.size), np.inf)
    angles[:, : solution.t.size] = found + get["offset"][:, None]
    return angles


def fitted(
    name: str,
    time: np.ndarray,
    measured: np.ndarray,
    first: Mapping[str, float],
    omega: float | None,
    tries: int = 50,
    averaged: bool = False,
) -> Model:
    """The fit that begins at the numbers `first` and takes at most `tries` solutions; `averaged` as for simulated()."""
    names, begin = list(first), np.array(list(first.values()))
    pace = abs(first["omega0"])
    sizes = {
        "omega0": pace,
        "velocity": 0.1 * pace,
        "viscous": 1e-2 * pace,
        "dry": 1e-3 * pace**2,
        "quadratic": 1e-2,
        "drive": 1e-2,
    }
    step = 1e-6 * np.array([sizes.get(key, 0.1) for key in names])

    def solved(point: np.ndarray) -> np.ndarray:
        """Residuals, and those with each number a step larger: all columns of a solution cost little more than one."""
        if not abs(point[names.index("omega0")]) < 20 * pace:
            return np.full((len(names) + 1, time.size), np.inf)
        columns = np.column_stack([point, point[:, None] + np.diag(step)])
        return np.asarray(simulated(time, dict(zip(names, columns, strict=True)), omega, averaged) - measured)

    latest: dict[bytes, np.ndarray] = {}

    def left(point: np.ndarray) -> np.ndarray:
        latest[point.tobytes()] = rows = solved(point)
        return np.asarray(rows[0])

    def jacobian(point: np.ndarray) -> np.ndarray:
        rows = latest.pop(point.tobytes())
        latest.clear()
        return np.asarray((rows[1:] - rows[0]).T / step)

    found = least_squares(left, begin, jacobian, x_scale="jac", max_nfev=tries, ftol=1e-6, xtol=1e-6, gtol=1e-12)
    spare = max(time.size - len(names), 1)
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * 2 * found.cost / spare
    errors = stdtrit(spare, 0.975) * np.sqrt(np.maximum(np.diag(covariance), 0))
    correlation = float(found.fun[1:] @ found.fun[:-1] / max(2 * found.cost, 1e-300))
    values = _normal(dict(zip(names, map(float, found.x), strict=True)), float(np.median(measured)))
    return Model(
        name,
        values,
        dict(zip(names, map(float, errors), strict=True)),
        math.sqrt(2 * found.cost / time.size),
        correlation,
        found.fun,
    )


def _normal(values: dict[str, float], middle: float) -> dict[str, float]:
    """The same motion with omega0 and drive above 0, the phase within half a turn of 0, the offset of the middle."""
    drive, phase = values.get("drive", 0.0), values.get("phase", 0.0)
    if "drive" in values:
        values |= {"drive": abs(drive), "phase": math.remainder(phase + (math.pi if drive < 0 else 0.0), 2 * math.pi)}
    return values | {
        "omega0": abs(values["omega0"]),
        "offset": middle + math.remainder(values["offset"] - middle, 2 * math.pi),
    }
