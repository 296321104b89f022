"""A pendulum from a recorded track: natural frequency, damping and their errors, by least squares on the equation of
motion."""

import math
from functools import cached_property
from typing import Any

import numpy as np

from kapitza.initial_fit import first_fit
from kapitza.motion_fit import UNITS, Model, fitted
from kapitza.motion_fit import simulated as simulated
from kapitza.units import HERTZ, TURN, angle, quantity

GRAVITY = 9.80665        # m/s^2
CERTAIN = 10.83          # F statistic of one more number: less happens to 1 in 1000 tracks by chance
ALIKE = 0.5              # correlation of neighbouring residuals, from which on the model does not describe the track
# Strongest line in the spectrum of residuals, in means: noise has a stronger one in 1 of 10^6 tracks
LINE = 20.0
# Share of the swing in the residuals from which a track is refused: of a free decay, of a driven track
SHARES = 0.05, 0.01
DETERMINED = 0.1         # largest error of the natural frequency, in natural frequencies

# Model -> the kinds of damping that it has.
MODELS = {"viscous": ("viscous",), "viscous + quadratic": ("viscous", "quadratic"),
          "viscous + quadratic + dry": ("viscous", "quadratic", "dry")}


class Fit:
    """What a track says of its pendulum. `models` are the fits with more and more kinds of damping; `best` is the
    simplest of them that no larger one improves beyond chance.

    :param time: times in s, ascending
    :param theta: angles in rad from any zero near the rest position; jumps of a turn are removed (`jumps` counts them)
    :param omega: angular frequency of the drive in rad/s; None = a free decay
    :raises ValueError: if the track cannot be used, or if no model describes it or several do
    """

    def __init__(self, time: Any, theta: Any, omega: float | None = None) -> None:
        self.time, self.theta = (np.asarray(values, dtype=float).ravel() for values in (time, theta))
        self.omega, self.jumps = omega, 0
        self._check()
        self._unwrap()
        minima = first_fit(self.time, self.theta, omega)
        self.models = self._models(minima[0], omega, list(MODELS))
        self._check_fit(minima)
        if omega is not None:
            self._check_drive(omega)

    def _models(self, first: Model, omega: float | None, names: list[str]) -> dict[str, Model]:
        """The fits by name; each begins at the one before."""
        models = {names[0]: first}
        for name in names[1:]:
            kinds = MODELS[name]
            known = dict.fromkeys(kinds, 0.0) | list(models.values())[-1].values
            begins = [known]
            if "dry" in kinds and omega is None:  # dry friction that stops a pendulum leaves little viscous friction
                omega0 = known["omega0"]
                swing = [np.abs(half - known["offset"]).max() for half in np.array_split(self.theta, 2)]
                dry = omega0 * math.pi * max(swing[0] - swing[1], 0.0) / (self.time[-1] - self.time[0])
                begins.append(known | {"viscous": 1e-3 * omega0, "quadratic": 0.0, "dry": dry})
            found = [fitted(name, self.time, self.theta, begin, omega) for begin in begins]
            models[name] = min(found, key=lambda model: model.residual)
        return models

    def _check(self) -> None:
        if self.time.size != self.theta.size:
            raise ValueError(f"{self.time.size} times and {self.theta.size} angles; give one angle for each time")
        if self.time.size < 20:
            raise ValueError(f"the track has {self.time.size} samples; at least 20 are needed")
        if not (np.isfinite(self.time).all() and np.isfinite(self.theta).all()):
            raise ValueError("the track has values that are not finite numbers")
        if not (np.diff(self.time) > 0).all():
            raise ValueError("the times of the track do not ascend")
        if not 1e-3 <= (span := float(self.time[-1] / 2 - self.time[0] / 2) * 2) <= 1e7:
            raise ValueError(f"the track takes {span:.3g} s; it must be 1e-3 to 1e7 s, with times in s")
        if (largest := float(np.abs(self.theta).max())) > 1e4:
            raise ValueError(f"the angles reach {largest:.3g} rad; a track has at most 1e4 rad")
        if np.ptp(self.theta) < 1e-6:
            raise ValueError("the track does not move")

    def _unwrap(self) -> None:
        """Removes the jumps of an angle that is kept within a turn."""
        self.jumps = int(np.count_nonzero(np.abs(np.diff(self.theta)) > math.pi))
        if self.jumps and np.ptp(self.theta) > 1.001 * TURN:
            raise ValueError("neighbouring angles differ by more than half a turn; are they in degrees?")
        if self.jumps:
            self.theta = np.unwrap(self.theta)

    def _check_fit(self, minima: list[Model]) -> None:
        """Refuses residuals that are no noise, and numbers that the track does not determine."""
        best, omega0 = self.best, self.best.values["omega0"]
        spectrum = np.abs(np.fft.rfft(best.left))[1:] ** 2
        share = best.residual / float(np.std(self.theta))
        if spectrum.max() > LINE * spectrum.mean() and share > SHARES[self.omega is not None]:
            noise = float(np.sqrt(np.mean(np.diff(best.left) ** 2) / 2))
            raise ValueError(
                f"no model describes the track: {best.name} leaves {1e3 * best.residual:.3g} mrad of swings of "
                f"{1e3 * np.std(self.theta):.3g} mrad, neighbours differ by {1e3 * noise:.3g} mrad, and that is no "
                "noise; "
                f"{'check the frequency of the drive, ' if self.omega else ''}give a part of it or record more samples")
        for other in minima[1:]:
            apart = abs(other.values["omega0"] - minima[0].values["omega0"])
            if not _improves(other, minima[0], self.time.size, 1) and apart > minima[0].errors["omega0"]:
                raise ValueError(
                    f"the track does not tell natural frequencies of {omega0 / TURN:.4g} and "
                    f"{other.values['omega0'] / TURN:.4g} Hz apart; record a longer one, or more samples")
        if not best.errors["omega0"] < DETERMINED * omega0:
            raise ValueError(
                f"the track does not determine the natural frequency ({omega0 / TURN:.4g} ± "
                f"{best.errors['omega0'] / TURN:.2g} Hz); record a longer one, or more samples")

    def _check_drive(self, omega: float) -> None:
        """Refuses a frequency that the track does not show: a free decay with the same damping leaves as little."""
        names = list(MODELS)[:list(MODELS).index(self.best.name) + 1]
        free = self._models(first_fit(self.time, self.theta, None)[0], None, names)[self.best.name]
        if not _improves(free, self.best, self.time.size):
            raise ValueError(f"the track shows no drive of {omega / TURN:.6g} Hz: a free decay describes it as well; "
                             "leave the frequency out")

    @cached_property
    def best(self) -> Model:
        models = list(self.models.values())
        for place, model in enumerate(models):
            if not any(_improves(model, larger, self.time.size) for larger in models[place + 1:]):
                return model
        return models[-1]

    def quality_factor(self, amplitude: Any = None) -> float:
        """Q of the viscous damping that loses as much energy in a swing of this amplitude: rad, or a text such as "10
        deg"; None = 10 deg, or the largest swing of the track if that is smaller."""
        values, swing = self.best.values, angle(f"{min(10.0, self.largest)} deg" if amplitude is None else amplitude)
        if not 0 < swing < math.pi:
            raise ValueError(f"the amplitude {amplitude!r} must be above 0 and below 180 deg")
        omega0 = values["omega0"]
        rate = (values["viscous"] + 8 / (3 * math.pi) * values.get("quadratic", 0.0) * omega0 * swing
                + 4 / math.pi * values.get("dry", 0.0) / (omega0 * swing))
        return omega0 / rate if rate > 0 else math.inf

    @property
    def largest(self) -> float:
        """Largest swing, about down or inverted, in degrees; what a track says of larger ones is no measurement."""
        rest = self.best.values["offset"] + (math.pi if self.inverted else 0.0)
        return float(np.degrees(np.abs(np.remainder(self.theta - rest + math.pi, TURN) - math.pi).max()))

    @property
    def inverted(self) -> bool:
        """Whether the track swings about the inverted position."""
        return math.cos(float(np.median(self.theta)) - self.best.values["offset"]) < 0

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
            raise ValueError("a free decay knows no shaker: give frequency and amplitude, such as frequency='50 Hz', "
                             "amplitude='8 mm'")
        quality = self.quality_factor(swing)
        if math.isinf(quality):  # a scene cannot have it: the least that the track allows
            values, errors = self.best.values, self.best.errors
            quality = values["omega0"] / max(values["viscous"] + errors["viscous"], 1e-9 * values["omega0"])
        pendulum = {"length": f"{self.length:.9g} m", "quality_factor": float(f"{quality:.6g}"), "frequency": frequency,
                    "amplitude": amplitude}
        return {"title": "A pendulum fitted to a track", "pendulum": pendulum,
                "basin": {"theta": {"count": 300}, "velocity": {"min": -0.05, "max": 0.05, "count": 200}}}

    def __repr__(self) -> str:
        lines = [f"{name:27s} leaves {1e3 * model.residual:.3g} mrad, neighbours correlated {model.correlation:.2f}"
                 for name, model in self.models.items()]
        best, viscous = self.best, self.models["viscous"]
        if best is not viscous:
            part = best.residual / viscous.residual
            lines.append(
                f"Viscous damping alone does not describe this track: {best.name} leaves {part:.2g} of what it leaves.")
        if best.correlation > ALIKE:
            lines.append(f"What {best.name} leaves is no noise: neighbouring residuals are alike, so that the errors "
                         "below are too small.")
        lines += [f"  {name:10s} {value:12.6g} ± {best.errors[name]:.2g} {UNITS[name]}" for name,
                  value in best.values.items()]
        lines.append(
            f"natural frequency {best.values['omega0'] / TURN:.6g} Hz, length of a simple pendulum {self.length:.5g} m")
        if self.inverted:
            lines.append("The track swings about the inverted position.")
        if self.jumps:
            lines.append(f"{self.jumps} jumps of a turn between neighbouring angles were removed.")
        if min(best.values.get(kind, 0.0) for kind in ("viscous", "quadratic", "dry")) < 0:
            lines.append(
                "A negative coefficient says that friction falls with speed, within the speeds of this track alone.")
        swings = [swing for swing in (2.0, 10.0, 40.0) if swing < 0.95 * self.largest] + [self.largest]
        lines.append("equivalent Q " + ", ".join(f"{self.quality_factor(f'{swing} deg'):.4g} at {swing:.3g} deg"
                                                 for swing in swings))
        return "\n".join(lines)


def _improves(model: Model, larger: Model, samples: int, more: int | None = None) -> bool:
    """Whether a larger model, with so many more numbers, leaves so much less that chance does not do it."""
    more = more or len(larger.values) - len(model.values)
    before, after = model.residual**2 * samples, larger.residual**2 * samples
    return (before - after) / more > CERTAIN * after / (samples - len(larger.values))


def fit(time: Any, theta: Any, *, degrees: bool = False, frequency: Any = None) -> Fit:
    """Fits a pendulum to a recorded track: a free decay, or, with the frequency of its drive, a driven one.

    Three models are fitted, with viscous damping, with quadratic drag too, and with dry friction too; `print` of the
    answer says what each leaves, which is the simplest that describes the track, its numbers with 95 % errors, and the
    equivalent quality factor at three amplitudes.

    :param time: times in s, ascending
    :param theta: angles in rad from any zero near the rest position
    :param degrees: whether the angles are in degrees
    :param frequency: of the pivot's drive: Hz, or a text such as "50 Hz"; None = a free decay
    :raises ValueError: if the track cannot be used, or if no model describes it or several do
    """
    angles = np.radians(np.asarray(theta, dtype=float)) if degrees else theta
    return Fit(time, angles, None if frequency is None else TURN * quantity(frequency, HERTZ))
