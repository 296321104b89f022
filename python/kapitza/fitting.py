"""A pendulum from a recorded track: natural frequency, damping and their errors, by least squares on the equation of motion."""

import argparse
import math
import os
import sys
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import yaml

from kapitza.least_squares import UNITS, Model, fitted
from kapitza.least_squares import simulated as simulated
from kapitza.units import HERTZ, TURN, angle, quantity

GRAVITY = 9.80665        # m/s^2
CERTAIN = 10.83          # of the F statistic of one more number: less happens to 1 in 1000 tracks by chance
ALIKE = 0.5              # correlation of neighbouring residuals, from which on the model does not describe the track

# Model -> the kinds of damping that it has.
MODELS = {"viscous": ("viscous",), "viscous + quadratic": ("viscous", "quadratic"),
          "viscous + quadratic + dry": ("viscous", "quadratic", "dry")}


class Fit:
    """What a track says of its pendulum. `models` are the fits with more and more kinds of damping; `best` is the simplest of them that no
    larger one improves beyond chance.

    :param time: times in s, ascending
    :param theta: angles in rad from any zero near the rest position
    :param omega: angular frequency of the drive in rad/s; None = a free decay
    """

    def __init__(self, time: Any, theta: Any, omega: float | None = None) -> None:
        self.time, self.theta = (np.asarray(values, dtype=float).ravel() for values in (time, theta))
        self.omega = omega
        self._check()
        self.models = {}
        guess = _guess(self.time, self.theta, omega)
        known = {key: value for key, value in guess.items() if key != "dry"}
        for name, kinds in MODELS.items():
            begins = [dict.fromkeys(kinds, 0.0) | known]
            if "dry" in kinds and omega is None:  # dry friction that stops a pendulum leaves little viscous friction
                begins.append(dict.fromkeys(kinds, 0.0) | guess | {"viscous": 1e-3 * guess["omega0"]})
            found = [fitted(name, self.time, self.theta, begin, omega) for begin in begins]
            self.models[name] = min(found, key=lambda model: model.residual)
            known = dict(self.models[name].values)

    def _check(self) -> None:
        if self.time.size != self.theta.size:
            raise ValueError(f"{self.time.size} times and {self.theta.size} angles; give one angle for each time")
        if self.time.size < 20:
            raise ValueError(f"the track has {self.time.size} samples; at least 20 are needed")
        if not (np.isfinite(self.time).all() and np.isfinite(self.theta).all()):
            raise ValueError("the track has values that are not finite numbers")
        if not (np.diff(self.time) > 0).all():
            raise ValueError("the times of the track do not ascend")
        if np.ptp(self.theta) < 1e-6:
            raise ValueError("the track does not move")

    @cached_property
    def best(self) -> Model:
        models = list(self.models.values())
        for place, model in enumerate(models):
            if not any(_improves(model, larger, self.time.size) for larger in models[place + 1:]):
                return model
        return models[-1]

    def quality_factor(self, amplitude: Any = None) -> float:
        """Q of the viscous damping that loses as much energy in a swing of this amplitude: rad, or a text such as "10 deg"; None = 10 deg,
        or the largest swing of the track if that is smaller."""
        values, swing = self.best.values, angle(f"{min(10.0, self.largest)} deg" if amplitude is None else amplitude)
        if not 0 < swing < math.pi:
            raise ValueError(f"the amplitude {amplitude!r} must be above 0 and below 180 deg")
        omega0 = values["omega0"]
        rate = (values["viscous"] + 8 / (3 * math.pi) * values.get("quadratic", 0.0) * omega0 * swing
                + 4 / math.pi * values.get("dry", 0.0) / (omega0 * swing))
        return omega0 / rate if rate > 0 else math.inf

    @property
    def largest(self) -> float:
        """Largest swing of the track in degrees; what it says of larger ones is no measurement."""
        return float(np.degrees(np.abs(self.theta - self.best.values["offset"]).max()))

    @property
    def length(self) -> float:
        """Length in m of the simple pendulum that swings as fast."""
        return float(GRAVITY / self.best.values["omega0"] ** 2)

    def scene(self, frequency: Any = None, amplitude: Any = None, swing: Any = None) -> dict[str, Any]:
        """A scene of this pendulum on a shaker.

        :param frequency: of the pivot, such as "50 Hz"; None = that of the track's drive
        :param amplitude: of the pivot, such as "8 mm"; None = that of the track's drive
        :param swing: amplitude of the swings whose equivalent quality factor is taken; None = as for quality_factor
        """
        if frequency is None and self.omega is not None:
            frequency = f"{self.omega / TURN:.12g} Hz"
        if amplitude is None and "drive" in self.best.values:
            amplitude = f"{abs(self.best.values['drive']) * self.length:.9g} m"
        if frequency is None or amplitude is None:
            raise ValueError("a free decay knows no shaker: give frequency and amplitude, such as frequency='50 Hz', amplitude='8 mm'")
        pendulum = {"length": f"{self.length:.9g} m", "quality_factor": self.quality_factor(swing),
                    "frequency": frequency, "amplitude": amplitude}
        return {"title": "A pendulum fitted to a track", "pendulum": pendulum,
                "basin": {"theta": {"count": 300}, "velocity": {"min": -0.05, "max": 0.05, "count": 200}}}

    def __repr__(self) -> str:
        lines = [f"{name:27s} leaves {1e3 * model.residual:.3g} mrad, neighbours correlated {model.correlation:.2f}"
                 for name, model in self.models.items()]
        best, viscous = self.best, self.models["viscous"]
        if best is not viscous:
            part = best.residual / viscous.residual
            lines.append(f"Viscous damping alone does not describe this track: {best.name} leaves {part:.2g} of what it leaves.")
        if best.correlation > ALIKE:
            lines.append(f"What {best.name} leaves is no noise: neighbouring residuals are alike, so that the errors below are too small.")
        lines += [f"  {name:10s} {value:12.6g} ± {best.errors[name]:.2g} {UNITS[name]}" for name, value in best.values.items()]
        lines.append(f"natural frequency {best.values['omega0'] / TURN:.6g} Hz, length of a simple pendulum {self.length:.5g} m")
        if min(best.values.get(kind, 0.0) for kind in ("viscous", "quadratic", "dry")) < 0:
            lines.append("A negative coefficient says that friction falls with speed, within the speeds of this track alone.")
        swings = [swing for swing in (2.0, 10.0, 40.0) if swing < 0.95 * self.largest] + [self.largest]
        lines.append("equivalent Q " + ", ".join(f"{self.quality_factor(f'{swing} deg'):.4g} at {swing:.3g} deg" for swing in swings))
        return "\n".join(lines)


def _improves(model: Model, larger: Model, samples: int) -> bool:
    """Whether a larger model leaves so much less that chance does not do it."""
    more = len(larger.values) - len(model.values)
    before, after = model.residual**2 * samples, larger.residual**2 * samples
    return (before - after) / more > CERTAIN * after / (samples - len(larger.values))


def _guess(time: np.ndarray, theta: np.ndarray, omega: float | None) -> dict[str, float]:
    """Numbers to begin with: from the crossings of the mean, and from how the swing shrinks between the halves of the track."""
    offset = float(np.median(theta))
    swing = theta - offset
    if omega is not None:  # the slow motion
        width = max(1, round(TURN / omega / float(np.median(np.diff(time)))))
        swing = np.convolve(np.pad(swing, width, mode="edge"), np.ones(width) / width, "same")[width:-width]
    step = swing[1:] - swing[:-1]
    up = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    if up.size < 2:
        raise ValueError("the track has fewer than two whole swings; record a longer one")
    crossings = time[up] - swing[up] * (time[up + 1] - time[up]) / step[up]
    size = [float(np.abs(half).max()) for half in np.array_split(np.abs(swing), 2)]
    span = (time[-1] - time[0]) / 2
    first = np.polynomial.Polynomial.fit(time[:5] - time[0], theta[:5], 1).convert().coef
    omega0 = TURN * (up.size - 1) / float(crossings[-1] - crossings[0]) * (1 + size[0] ** 2 / 16 * (size[0] < 2))
    guess = {"omega0": omega0, "offset": offset, "theta": float(first[0]), "velocity": float(first[1] if len(first) > 1 else 0),
             "viscous": max(2 * math.log(max(size[0] / max(size[1], 1e-9), 1.0001)) / span, 1e-4),
             "dry": omega0 * math.pi / 2 * max(size[0] - size[1], 0.0) / span}
    return guess | ({"drive": 0.0, "phase": 0.0} if omega is not None else {})


def fit(time: Any, theta: Any, *, degrees: bool = False, frequency: Any = None) -> Fit:
    """Fits a pendulum to a recorded track: a free decay, or, with the frequency of its drive, a driven one.

    Three models are fitted, with viscous damping, with quadratic drag too, and with dry friction too; `print` of the answer says what each
    leaves, which is the simplest that describes the track, its numbers with 95 % errors, and the equivalent quality factor at three
    amplitudes.

    :param time: times in s, ascending
    :param theta: angles in rad from any zero near the rest position
    :param degrees: whether the angles are in degrees
    :param frequency: of the pivot's drive: Hz, or a text such as "50 Hz"; None = a free decay
    :raises ValueError: if the track cannot be used
    """
    angles = np.radians(np.asarray(theta, dtype=float)) if degrees else theta
    return Fit(time, angles, None if frequency is None else TURN * quantity(frequency, HERTZ))


TIMES, ANGLES = ("time", "t", "time_s"), ("theta", "angle", "theta_rad", "angle_rad", "theta_deg", "angle_deg")


def read_track(path: str | os.PathLike[str]) -> tuple[np.ndarray, np.ndarray, bool]:
    """Times, angles and whether these are in degrees: of a CSV file whose first line names its columns (time, and theta or theta_deg), or
    of two columns of numbers without names."""
    table = pandas.read_csv(path, comment="#", skipinitialspace=True)
    names = {str(name).strip().lower(): name for name in table.columns}
    time, theta = (next((name for name in known if name in names), None) for known in (TIMES, ANGLES))
    if time is None and theta is None and len(names) >= 2 and all(_is_number(name) for name in list(names)[:2]):
        table = pandas.read_csv(path, comment="#", skipinitialspace=True, header=None)
        names, time, theta = {"time": table.columns[0], "theta": table.columns[1]}, "time", "theta"
    if time is None or theta is None:
        raise ValueError(f"has the columns {', '.join(map(str, names))}; it needs time (s) and theta (rad) or theta_deg")
    columns = [pandas.to_numeric(table[names[name]], errors="coerce").to_numpy(dtype=float) for name in (time, theta)]
    if wrong := np.flatnonzero(~np.isfinite(columns[0] * columns[1])).tolist():
        raise ValueError(f"row {wrong[0] + 1} holds no two finite numbers")
    return columns[0], columns[1], theta.endswith("_deg")


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def main(words: Sequence[str] | None = None) -> None:
    """The command `kapitza fit`."""
    parser = argparse.ArgumentParser(prog="kapitza fit", description="natural frequency and damping of a pendulum from a recorded track")
    parser.add_argument("track", type=Path, help="CSV file with the columns time (s) and theta (rad) or theta_deg")
    parser.add_argument("--frequency", help="of the drive of a driven track: Hz, or with a unit such as 3000 rpm")
    parser.add_argument("--degrees", action="store_true", help="angles are in degrees")
    arguments = parser.parse_args(words)
    try:
        time, theta, degrees = read_track(arguments.track)
        found = fit(time, theta, degrees=degrees or arguments.degrees, frequency=arguments.frequency)
    except (OSError, UnicodeDecodeError, ValueError, pandas.errors.ParserError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        print(f"kapitza: error: {arguments.track}: {reason}", file=sys.stderr)
        sys.exit(2)
    print(found)
    known = {"length": f"{found.length:.6g} m", "quality_factor": round(found.quality_factor(), 4)}
    pendulum = found.scene()["pendulum"] if found.omega else known
    print("pendulum: " + yaml.safe_dump(pendulum, default_flow_style=True, sort_keys=False, width=200).strip()
          + ("" if found.omega else "   # and frequency and amplitude of the shaker"))
