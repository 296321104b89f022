"""Least squares on the equation of motion of a pendulum, theta in rad from the rest position, time in s:

    theta'' + viscous theta' + quadratic |theta'| theta' + dry sign(theta') + (omega0^2 - drive omega^2 cos(omega t + phase)) sin theta = 0
"""

from dataclasses import dataclass

import numpy as np

from kapitza.chances import Z
from kapitza.units import TURN

STEPS = 24               # of the integrator in the shortest of the times of the motion
SHARPNESS = 2e-3         # share of the largest speed in which dry friction changes its sign
MOST_STEPS = 2_000_000   # of the integrator in a track
ITERATIONS = 60
UNITS = {"omega0": "rad/s", "offset": "rad", "theta": "rad", "velocity": "rad/s", "viscous": "1/s", "quadratic": "1/rad", "dry": "rad/s²",
         "drive": "", "phase": "rad"}


@dataclass(frozen=True)
class Model:
    """One least-squares fit: `values` and 95 % errors (`errors`) by name, the root mean square of what it leaves (`residual`, rad), the
    correlation of neighbouring residuals, and what it leaves at each time."""

    name: str
    values: dict[str, float]
    errors: dict[str, float]
    residual: float
    correlation: float
    left: np.ndarray


def simulated(time: np.ndarray, values: dict[str, np.ndarray], omega: float | None) -> np.ndarray:
    """Angles (columns, times) of the equation for numbers [columns] by name; Runge-Kutta of order 4 with steps that end at the times."""
    columns = len(values["omega0"])
    get = {name: values.get(name, np.zeros(columns)) for name in UNITS}
    fastest = max(float(np.max(np.abs(get["omega0"]))), omega or 0.0)
    steps = np.maximum(1, np.ceil(np.diff(time) * fastest * STEPS / TURN)).astype(int)
    if steps.sum() > MOST_STEPS:
        raise ValueError(f"the track takes {steps.sum()} steps to follow; give a shorter part of it (at most {MOST_STEPS} steps)")
    scale = SHARPNESS * max(float(np.max(np.abs(get["omega0"]))), 1e-12)
    square, viscous, quadratic, dry = get["omega0"] ** 2, get["viscous"], get["quadratic"], get["dry"]
    drive, phase, dried = get["drive"] * (omega or 0.0) ** 2, get["phase"], bool(np.any(dry))

    def force(t: float, theta: np.ndarray, speed: np.ndarray) -> np.ndarray:
        gravity = square - drive * np.cos(omega * t + phase) if omega else square
        drag = (viscous + quadratic * np.abs(speed)) * speed
        return -gravity * np.sin(theta) - (drag + dry * np.tanh(speed / scale) if dried else drag)

    theta, speed = get["theta"] - get["offset"], get["velocity"].copy()
    out = np.empty((time.size, columns))
    out[0] = theta
    for place, (start, end, count) in enumerate(zip(time[:-1] - time[0], time[1:] - time[0], steps, strict=True)):
        h = (end - start) / count
        for step in range(count):
            t = start + step * h
            a1 = force(t, theta, speed)
            v2 = speed + h / 2 * a1
            a2 = force(t + h / 2, theta + h / 2 * speed, v2)
            v3 = speed + h / 2 * a2
            a3 = force(t + h / 2, theta + h / 2 * v2, v3)
            v4 = speed + h * a3
            a4 = force(t + h, theta + h * v3, v4)
            theta, speed = theta + h / 6 * (speed + 2 * v2 + 2 * v3 + v4), speed + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        out[place + 1] = theta
    return (out + get["offset"]).T


def _residuals(time: np.ndarray, measured: np.ndarray, names: list[str], points: np.ndarray, omega: float | None) -> np.ndarray:
    """What each of points [columns][numbers] leaves of the measured angles; numbers that lead nowhere leave much."""
    with np.errstate(all="ignore"):
        found = simulated(time, dict(zip(names, points.T, strict=True)), omega)
    return np.nan_to_num(found - measured, nan=1e6, posinf=1e6, neginf=-1e6)


def half_width(spare: int) -> float:
    """Standard errors in half of a 95 % interval, from so many spare samples: Student's t by Cornish and Fisher's series."""
    return Z + (Z**3 + Z) / (4 * spare) + (5 * Z**5 + 16 * Z**3 + 3 * Z) / (96 * spare**2)


def fitted(name: str, time: np.ndarray, measured: np.ndarray, first: dict[str, float], omega: float | None) -> Model:
    """Levenberg and Marquardt's method, with a Jacobian of differences."""
    names, best = list(first), np.array(list(first.values()))
    sizes = {"omega0": abs(first["omega0"]), "velocity": abs(first["omega0"]) * 0.1, "viscous": abs(first["omega0"]) * 1e-2,
             "dry": abs(first["omega0"]) ** 2 * 1e-3, "quadratic": 1e-2, "drive": 1e-2}
    step = 1e-6 * np.array([sizes.get(key, 0.1) for key in names])
    damping, jacobian = 1e-3, np.empty(0)
    left = _residuals(time, measured, names, best[None], omega)[0]
    for _ in range(ITERATIONS):
        rows = _residuals(time, measured, names, best + np.diag(step), omega)
        jacobian = (rows - left).T / step
        normal, downhill = jacobian.T @ jacobian, jacobian.T @ left
        scale = np.maximum(np.diag(normal), 1e-300)
        trials = damping * 10.0 ** np.arange(-2, 4)
        points = np.array([best - np.linalg.lstsq(normal + np.diag(trial * scale), downhill, rcond=None)[0] for trial in trials])
        found = _residuals(time, measured, names, points, omega)
        costs = np.sum(found**2, axis=1)
        choice, before = int(np.argmin(costs)), float(left @ left)
        if not costs[choice] < before:
            break
        gain = 1 - costs[choice] / before
        best, left, damping = points[choice], found[choice], max(float(trials[choice]), 1e-12)
        if gain < 1e-10:
            break
    spare = max(time.size - len(names), 1)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * (left @ left) / spare
    errors = dict(zip(names, half_width(spare) * np.sqrt(np.maximum(np.diag(covariance), 0)), strict=True))
    correlation = float(left[1:] @ left[:-1] / max(float(left @ left), 1e-300))
    values = dict(zip(names, map(float, best), strict=True))
    return Model(name, values, {key: float(error) for key, error in errors.items()}, float(np.sqrt(np.mean(left**2))), correlation, left)
