"""The first fit of a track, with viscous damping: where it begins, and how the fitted part of the track grows."""

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import ellipk

from kapitza.motion_fit import Model, fitted
from kapitza.units import TURN

NAME = "viscous"
MOST_PERIODS = 10000  # longest track, in periods of the pendulum and of the drive
FIRST_SWINGS = 2.5  # slow swings of the first part of the track that is fitted
FIRST_SAMPLES = 30  # smallest number of samples in that part
# Values of drive omega / sqrt(2), in slow frequencies, with which the search begins; above 1 = inverted.
DEPTHS = (0.15, 0.5, 0.75, 0.9, 1.1, 1.5, 2.5)
TRIES, ALL_TRIES = 12, 50  # largest numbers of solutions for a fit to a part of the track and to all of it
NEAR = 3.0  # residuals of a minimum that is followed further, in those of the deepest
MINIMA = 3  # largest number of these


def first_fit(time: np.ndarray, theta: np.ndarray, omega: float | None) -> list[Model]:
    """Fits with viscous damping to the whole track, the best first; several only of a driven track.

    :raises ValueError: if the track has fewer than two whole swings
    """
    offset, slow = slow_swing(time, theta)
    if (periods := (time[-1] - time[0]) * max(slow, omega or 0.0) / TURN) > MOST_PERIODS:
        raise ValueError(f"the track has {periods:.0f} periods; give a part of it with at most {MOST_PERIODS}")
    ends = _parts(time, TURN / slow)
    begins = [_begin(time[: ends[0]], theta[: ends[0]], offset, slow)]
    if omega is not None:
        begins = _driven_begins(time[: ends[0]], theta[: ends[0]], begins[0], omega)
    models: list[Model] = []
    for end in ends:
        tries = TRIES if end < time.size else ALL_TRIES
        models = _different([fitted(NAME, time[:end], theta[:end], begin, omega, tries) for begin in begins])
        begins = [model.values for model in models]
    return models


def slow_swing(time: np.ndarray, theta: np.ndarray) -> tuple[float, float]:
    """The angle about which a track swings, and the angular frequency of its first swings (rad/s)."""
    offset = float(np.median(theta))
    swing = theta - offset
    side = np.sign(swing) * (np.abs(swing) > 0.1 * np.abs(swing).max())
    places = np.flatnonzero(side)
    turns = np.flatnonzero((side[places[:-1]] < 0) & (side[places[1:]] > 0))
    before, after = places[turns], places[turns + 1]
    if before.size < 2:
        raise ValueError("the track has fewer than two whole swings; record a longer one")
    crossings = time[before] - swing[before] * (time[after] - time[before]) / (swing[after] - swing[before])
    last = min(2, before.size - 1)
    return offset, TURN * last / float(crossings[last] - crossings[0])


def _parts(time: np.ndarray, swing: float) -> list[int]:
    """Numbers of samples of the parts of a track: its first swings, twice as many, and so on to the whole track."""
    ends = [max(int(np.searchsorted(time, time[0] + FIRST_SWINGS * swing)), FIRST_SAMPLES)]
    while ends[-1] < time.size:
        ends.append(2 * ends[-1])
    return [*ends[:-1], time.size]


def _begin(time: np.ndarray, theta: np.ndarray, offset: float, slow: float) -> dict[str, float]:
    """Numbers of a free decay: of the harmonic motion through the first swing, its frequency corrected for
    amplitude."""
    since = time - time[0]
    near = (since < TURN / slow) | (np.arange(time.size) < 8)
    columns = np.stack([np.cos(slow * since), np.sin(slow * since)], axis=1)[near]
    (along, across), *_ = np.linalg.lstsq(columns, (theta - offset)[near], rcond=None)
    omega0 = slow * 2 / math.pi * float(ellipk(math.sin(min(math.hypot(along, across), 3.0) / 2) ** 2))
    return {
        "omega0": omega0,
        "offset": offset,
        "theta": along + offset,
        "velocity": across * slow,
        "viscous": 1e-2 * slow,
    }


def _driven_begins(
    time: np.ndarray, theta: np.ndarray, begin: dict[str, float], omega: float
) -> list[dict[str, float]]:
    """Numbers of driven pendulums to begin with: minima of the averaged motion, which is tried with several drives
    whose slow frequency is that of the track: sqrt(omega0^2 + (drive omega)^2 / 2) down,
    sqrt((drive omega)^2 / 2 - omega0^2) inverted."""
    free = fitted(NAME, time, theta, begin, None, TRIES)
    slow, offset, turn = free.values["omega0"], free.values["offset"], omega * (time - time[0])
    fast = np.sin(theta + free.left - offset) * np.stack([-np.cos(turn), np.sin(turn)])
    (along, across), *_ = np.linalg.lstsq(fast.T, -free.left, rcond=None)
    begins = []
    for depth in DEPTHS:
        inverted = depth > 1
        begins.append(
            free.values
            | {
                "omega0": slow * math.sqrt(abs(1 - depth**2)),
                "offset": offset + (math.pi if inverted else 0.0),
                "drive": math.sqrt(2) * depth * slow / omega,
                "phase": math.atan2(across, along) + (math.pi if inverted else 0.0),
            }
        )
    minima = _different([fitted(NAME, time, theta, begin, omega, TRIES, averaged=True) for begin in begins])
    return [_with_fast_motion(model.values, omega) for model in minima]


def _with_fast_motion(values: dict[str, float], omega: float) -> dict[str, float]:
    """The numbers of the whole motion whose averaged motion has these."""
    angle, phase, drive = values["theta"] - values["offset"], values["phase"], values["drive"]
    change = values["velocity"] * math.cos(angle)
    theta = values["theta"] + drive * (2 / omega * change * math.sin(phase) - math.sin(angle) * math.cos(phase))
    velocity = values["velocity"] + drive * (change * math.cos(phase) + omega * math.sin(angle) * math.sin(phase))
    return values | {"theta": theta, "velocity": velocity}


def _different(models: Sequence[Model]) -> list[Model]:
    """The deepest of the minima, by their residuals, each once."""
    kept: list[Model] = []
    for model in sorted(models, key=lambda model: model.residual):
        if model.residual < NEAR * (kept or [model])[0].residual and not any(
            abs(model.values["omega0"] - other.values["omega0"]) < 1e-2 * other.values["omega0"] for other in kept
        ):
            kept.append(model)
    return kept[:MINIMA]
