"""The group orbit in the units of the pictures, and which of its periods are shown."""

import numpy as np
import xarray

from kapitza.result import BadFile, Result
from kapitza.units import TURN, drive_unit

LONG, LAST = 200, 100  # open records of more periods than LONG show their last ones
ROUNDING = 1e-9  # deg, and whatever else an axis counts in: what spans less is rounding noise, not motion


def cut(data: xarray.Dataset, start: float, end: float) -> xarray.Dataset:
    """The orbit's data between two times (drive periods)."""
    for time in ("time", "strobe_time", "maximum_time"):
        inside = (data[time].values >= TURN * start - 1e-6) & (data[time].values <= TURN * end + 1e-6)
        data = data.isel({data[time].dims[0]: np.flatnonzero(inside)})
    return data


def shown(data: xarray.Dataset, last: float | None) -> tuple[xarray.Dataset, float | None]:
    """(data, last periods that they are or None): of a long open record its last periods, of a long closed orbit one
    round."""
    length = float(data["time"].values[-1]) / TURN
    if data.attrs["closed"]:
        return (cut(data, 0, int(data.attrs["period"])) if length > LONG else data), None
    last = last or (LAST if length > LONG else length)
    return (cut(data, length - last, length), last) if last < length else (data, None)


class Orbit:
    """The group orbit in the units of the pictures: degrees from the centre, drive periods; on axes also s, rad/s and
    Hz.

    `clock` and `speed` are what a drive period and one rad per drive radian are on an axis: 1, or in SI.
    """

    def __init__(self, result: Result, last: float | None = None, *, si: bool = False) -> None:
        whole, drawn = result.group("orbit"), result.group("orbit", si=si)
        self.si, self.speed = si, drive_unit(drawn["velocity"])
        self.clock = TURN * drive_unit(drawn["time"]) if si else 1.0
        if whole.sizes["time"] < 2 or whole.sizes["line_frequency"] < 2:
            raise BadFile(f"{result.path}: the orbit has fewer than two samples")
        self.data, self.last = shown(whole, last)
        self.attributes = self.data.attrs
        self.closed = bool(self.attributes["closed"])
        self.rotating = int(self.attributes["centre"]) == 2
        self.period = int(self.attributes["period"])
        self.centre = self._centre()
        self.time = self.data["time"].values / TURN
        self.theta = self.data["theta"].values
        self.velocity = self.data["velocity"].values

    def _centre(self) -> float:
        """The copy of down or inverted that the orbit moves about; rad."""
        if int(self.attributes["centre"]) > 1:
            return 0.0
        offset = np.pi * int(self.attributes["centre"])
        mean = float(self.data["theta"].mean())
        return float(offset + TURN * np.rint((mean - offset) / TURN))

    @property
    def resting(self) -> bool:
        """Whether nothing moves but the last digits."""
        return bool(np.ptp(self.deflection()) < ROUNDING)

    @property
    def place(self) -> str:
        """What angles are counted from."""
        return {0: "down", 1: "inverted"}.get(int(self.attributes["centre"]), "down")

    def rotation(self) -> float:
        """Turns per drive period that the lines leave out."""
        return int(self.attributes["winding"]) / max(self.period, 1) if self.rotating and self.period else 0.0

    def deflection(self, theta: np.ndarray | None = None, time: np.ndarray | None = None) -> np.ndarray:
        """Degrees from the centre; of a rotation, from the steady turn."""
        theta, time = (self.theta, self.data["time"].values) if theta is None or time is None else (theta, time)
        return np.degrees(theta - self.centre - self.rotation() * time - self._mean())

    def _mean(self) -> float:
        """Mean angle of a rotation beside its steady turn; rad."""
        if not self.rotation():
            return 0.0
        return float(np.mean((self.theta - self.rotation() * self.data["time"].values)[:-1]))

    def wrapped(self, theta: np.ndarray) -> np.ndarray:
        """Degrees from the centre within half a turn."""
        return np.degrees(theta - self.centre - TURN * np.rint((theta - self.centre) / TURN))

    def strongest(self, count: int) -> list[int]:
        """Numbers j >= 1 of the strongest lines."""
        amplitude = self.data["line_amplitude"].values[1:]
        order = 1 + np.argsort(-amplitude)[:count]
        return [int(j) for j in order if amplitude[j - 1] > 0.01 * amplitude.max()]

    def line_text(self, j: int) -> str:
        """j/n of the drive."""
        whole = round(1 / float(self.data["line_frequency"].values[1]))
        return f"{j}/{whole}" if j % whole else str(j // whole)
