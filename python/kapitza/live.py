"""Frames, ends of starts and motions on request, from a pendulum of the library that keeps what it finds."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from kapitza.library import NO_TURNS, Library, load
from kapitza.motion_kinds import kind
from kapitza.scene import flow

PLANES = {"labels": np.uint8, "settling_time": np.float32, "smooth_time": np.float32, "doubt": np.uint8,
          "other": np.uint8,
          "turns": np.float32, "evidence": np.uint8}  # in the order of kapitza.h
CENTRES = ("down", "inverted", "rotating", "neither")
LINE = ("value", "height", "theta", "velocity", "multiplier")  # numbers of a point of a branch
Part = tuple[dict[str, Any], dict[str, np.ndarray]]  # a header, and planes by name


def finite(value: float) -> float | None:
    """A number as JSON has it: None if there is none."""
    return value if math.isfinite(value) else None


def change(**mappings: Any) -> str:
    """Mappings of a scene as the library takes them; those that are None are left out."""
    return ", ".join(f"{name}: {flow(value)}" for name, value in mappings.items() if value is not None)


class Live:
    """One pendulum of the library with its caches. Threads wait for each other.

    :param text: of its scene; `name`: of the file in messages; `sets`: changes KEY=VALUE
    """

    def __init__(self, text: str | bytes, name: str = "scene", sets: Sequence[str] = ()) -> None:
        self._library: Library = load()
        self._scene = text, name, tuple(sets)
        given = self._library.ffi.new("kapitza_pendulum **")
        scene, _kept = self._library.scene(*self._scene)
        self._library.call("kapitza_pendulum_open", scene, given)
        self._own = self._library.ffi.gc(given[0], self._library.lib.kapitza_pendulum_free)
        self._known: dict[str, Any] = {}  # the last catalogue

    def with_pendulum(self, pendulum: Mapping[str, Any] | None) -> "Live":
        """One of another pendulum, without caches; None: this one."""
        text, name, sets = self._scene
        return self if pendulum is None else Live(text, name, (*sets, f"pendulum={flow(pendulum)}"))

    @property
    def parameters(self) -> dict[str, float]:
        """The numbers of the pendulum, by the names of kapitza_parameters."""
        numbers = self._library.ffi.new("kapitza_parameters *")
        self._library.call("kapitza_parameters_of", self._own, numbers)
        names = ("k", "beta", "m", "quality_factor", "drive_frequency", "drive_amplitude", "pivot_frequency")
        return {name: float(getattr(numbers, name)) for name in names}

    def needs(self) -> list[float]:
        """Least and largest drive m at which it stands upside down, and at which it flutters; NaN = none."""
        amplitude = self._library.ffi.new("double[4]")
        self._library.call("kapitza_needs", self._own, amplitude)
        return list(amplitude)

    def _given(self, kind: str, name: str, *arguments: Any) -> Iterator[Any]:
        """What a function makes as its last argument; it is freed behind the loop."""
        place = self._library.ffi.new(f"{kind} **")
        self._library.call(name, self._own, *arguments, place)
        try:
            yield place[0][0]
        finally:
            self._library.lib.kapitza_free(place[0])

    def _shown(self, name: str, arguments: Sequence[Any], kind: str, show: Callable[[Any], bool],
               between: Callable[[], bool]) -> bool:
        """Calls a function that shows parts and asks between them; False if one of these callbacks has ended it."""

        faults: list[BaseException | None] = []

        def keep(_kind: type, fault: BaseException, _traceback: object) -> int:
            faults.append(fault)
            return 1

        def asked(goes_on: bool) -> int:
            if not goes_on:
                faults.append(None)
            return not goes_on

        callback = self._library.ffi.callback
        functions = (callback(kind, lambda _, part: asked(show(part)), error=1, onerror=keep),
                     callback("kapitza_pause", lambda _: asked(between()), error=1, onerror=keep))
        try:
            self._library.call(name, self._own, *arguments, *functions, self._library.ffi.NULL)
        except KeyboardInterrupt:
            if not faults:
                raise
            if faults[0] is not None:
                raise faults[0] from None
            return False
        return True

    def frame(self, show: Callable[[Part], bool], between: Callable[[], bool] = lambda: True, *,
              changed: str | None = None, planes: Sequence[str] = ("labels",), moving: bool = False,
              coarseness: Sequence[int] = (1,), atlas: str | None = None, point: Sequence[float] = (0, 0)) -> bool:
        """Makes a frame part by part, for `show`; False if `show` or `between` ends it by False."""
        ffi, texts = self._library.ffi, [self._library.text(changed), self._library.text(atlas)]
        request = ffi.new("kapitza_frame_request *", {
            "change": texts[0], "moving": moving, "planes": sum(1 << list(PLANES).index(name) for name in planes),
            "n_parts": len(coarseness), "coarseness": list(coarseness)[:4], "atlas": texts[1], "x": point[0],
            "y": point[1]})

        def shown(part: Any) -> bool:
            header = {"catalogue": self._catalogue(part.catalogue[0]), "milliseconds": round(1e3 * part.seconds, 3)}
            return show((self._raster(part) | header, {name: self._plane(part, part.plane[place], PLANES[name])
                                                       for place, name in enumerate(PLANES) if name in planes}))

        return self._shown("kapitza_frame", [request], "kapitza_show", shown, between)

    @staticmethod
    def _raster(part: Any) -> dict[str, Any]:
        return {"level": part.coarseness, "rows": part.rows, "columns": part.columns, "final": bool(part.last)}

    def _plane(self, part: Any, pointer: Any, kind: Any) -> np.ndarray:
        return self._library.array(pointer, part.rows * part.columns, kind).reshape(part.rows, part.columns)

    def chart(self, show: Callable[[Part], bool], between: Callable[[], bool] = lambda: True, *, changed: str,
              coarseness: Sequence[int] = (1,)) -> bool:
        """Draws where one start ends over a plane of two keys, as `frame` does."""
        def shown(part: Any) -> bool:
            return show((self._raster(part), {name: self._plane(part, getattr(part, name), np.uint8)
                                              for name in ("period", "centre")}))

        steps = self._library.ffi.new("int32_t[]", list(coarseness))
        arguments = [self._library.text(changed), len(coarseness), steps]
        return self._shown("kapitza_chart", arguments, "kapitza_show_chart", shown, between)

    def catalogue(self, changed: str | None = None) -> dict[str, Any]:
        """The known attractors of a pendulum, with numbers that stay with them while it changes."""
        for found in self._given("kapitza_catalogue", "kapitza_catalogue_of", self._library.text(changed)):
            return self._catalogue(found)
        raise AssertionError

    def _catalogue(self, found: Any) -> dict[str, Any]:
        if self._known.get("version") != found.version:
            self._known = self._catalogue_of(found)
        return self._known

    def _catalogue_of(self, found: Any) -> dict[str, Any]:
        numbers = {"k": "k", "damping": "beta", "m": "m", "quality_factor": "quality_factor",
                   "drive_frequency": "drive_frequency",
                   "drive_amplitude": "drive_amplitude"}
        return {"version": found.version, "pendulum": {name: finite(getattr(found.parameters, field)) for name,
                                                       field in numbers.items()},
                "attractors": [self._attractor(index, found.track[index], found.attractors.cycle[index])
                               for index in range(found.attractors.count)]}

    def _attractor(self, number: int, track: int, row: Any) -> dict[str, Any]:
        return {"id": number, "track": track, "name": self._word(row.name),
                "kind": kind(row.period, row.winding, row.centre),
                "period": row.period, "winding": row.winding, "centre": CENTRES[row.centre],
                "symmetric": bool(row.symmetric),
                "mirror": row.mirror, "mean_velocity": finite(row.mean_velocity),
                "multiplier": finite(math.hypot(row.multiplier_re[0], row.multiplier_im[0])) if row.period else None,
                "strobe": self._points(row.theta, row.velocity, row.period)}

    def _word(self, text: Any) -> str:
        return str(self._library.ffi.string(text).decode())

    @staticmethod
    def _points(theta: Any, velocity: Any, count: int) -> list[list[float]]:
        return [[theta[index], velocity[index]] for index in range(count)]

    def where(self, theta: Sequence[str], velocity: Sequence[str], changed: str | None = None) -> list[dict[str, Any]]:
        """Where starts end, whose numbers are texts of any digits: a row each, with the columns of `kapitza.where`."""
        (angles, _), (speeds, _) = kept = [self._library.texts(numbers) for numbers in (theta, velocity)]
        for found in self._given("kapitza_endings", "kapitza_where", self._library.text(changed), len(theta), angles,
                                 speeds):
            del kept
            return endings_of(self._library, found)
        raise AssertionError

    def orbit(self, theta: float, velocity: float, periods: int, transient: int = 0,
              samples_per_period: int = 64) -> np.ndarray:
        """One motion in continuous time, behind `transient` periods: theta (not wrapped) and velocity."""
        values = np.empty((2, periods * samples_per_period + 1))
        self._library.call("kapitza_orbit", self._own, theta, velocity, transient, periods, samples_per_period,
                           *map(self._library.view, values))
        return values

    def pivot(self, samples: int) -> list[list[float]]:
        """Where the pivot is at the samples of a drive period: [aside, height]."""
        time, place = 2 * np.pi * np.arange(samples) / samples, np.empty((samples, 2))
        self._library.call("kapitza_pivot", self._own, samples, self._library.view(time), self._library.view(place))
        return place.tolist()

    def motions(self, atlas: str, x: float, y: float, states: bool = True) -> dict[str, Any]:
        """What attracts at a point of the atlas in a result file."""
        for found in self._given("kapitza_motions", "kapitza_motions_at", self._library.text(atlas), x, y, int(states)):
            return {"x": found.x, "y": found.y, "k": found.k, "damping": found.beta, "m": found.m,
                    "motions": [self._motion(found.motion[index]) for index in range(found.count)]}
        raise AssertionError

    def _kind(self, row: Any) -> dict[str, Any]:
        return {"name": self._word(row.name), "period": row.period, "winding": row.winding,
                "centre": CENTRES[row.centre],
                "symmetric": bool(row.symmetric), "images": row.images}

    def _motion(self, row: Any) -> dict[str, Any]:
        pairs = [[row.multiplier_re[place], row.multiplier_im[place]] for place in range(2)]
        return self._kind(row) | {"curve": row.curve if row.curve >= 0 else None, "multipliers": pairs if row.strobes
                                  else [],
                                  "strobe": self._points(row.theta, row.velocity, row.strobes)}

    def line(self, atlas: str, x: float | None, y: float | None) -> tuple[list[dict[str, Any]], np.ndarray]:
        """The branches of cycles along a line through the atlas in a result file, and their points."""
        along = (0, x) if y is None else (1, y)
        for found in self._given("kapitza_line", "kapitza_line_through", self._library.text(atlas), *along):
            rows = (found.branch[index] for index in range(found.count))
            return ([self._kind(row) | {"first": row.first, "points": row.points} for row in rows],
                    self._library.array(found.point, found.points * len(LINE), float).reshape(-1, len(LINE)))
        raise AssertionError


def endings_of(library: Library, found: Any) -> list[dict[str, Any]]:
    """A kapitza_endings as rows, each a member of what `kapitza where --json` prints; in SI units too where the
    pendulum has them."""
    omega = found.parameters.pivot_frequency
    return [_ending(library, found.ending[index], omega if math.isfinite(omega) else None)
            for index in range(found.count)]


def _ending(library: Library, row: Any, omega: float | None) -> dict[str, Any]:
    settled = row.attractor >= 0
    name, other, precision = (library.ffi.string(text).decode() or None
                              for text in (row.name, row.other_name, row.precision))
    strobe = [[points[index] for index in range(row.period)] for points in (row.strobe_theta, row.strobe_velocity)]
    near = row.near_time if row.near_time >= 0 else None
    ending: dict[str, Any] = {
        "theta": row.theta, "velocity": row.velocity, "attractor": row.attractor, "name": name,
        "period": row.period if settled else None, "winding": row.winding if settled else None,
        "settling_time": row.settling_time if settled else None, "decided": precision is not None,
        "strobe_theta": strobe[0],
        "strobe_velocity": strobe[1], "precision": precision, "error": finite(row.error), "other_attractor": row.other,
        "other_name": other, "near_time": near, "turns": row.turns if settled and row.turns != NO_TURNS else None,
        "mean_velocity": finite(row.mean_velocity) if settled else None}
    if omega is None:
        return ending
    seconds = {name: None if time is None else time * 2 * math.pi / omega for name, time in
               (("settling_seconds", ending["settling_time"]), ("near_seconds", near))}
    return ending | {"velocity_rad_per_s": row.velocity * omega} | seconds | {
        "strobe_velocity_rad_per_s": [value * omega for value in strobe[1]]}
