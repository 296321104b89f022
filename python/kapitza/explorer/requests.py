"""What a page asks of an engine, answered by the library: each answer is a header and planes of numbers."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from kapitza.live import PLANES, Live, change

MOST_CELLS = 1 << 24  # cells of a frame, or samples of an orbit
Answer = tuple[dict[str, Any], Sequence[np.ndarray]]
Show = Callable[[dict[str, Any], Sequence[np.ndarray]], None]


class BadRequest(Exception):
    """A request of the page that cannot be meant; the text says why."""


class Engine:
    """A pendulum of the library for a view. `ends`: the starts of a chart, as the scene's `sweep.ends` has them."""

    def __init__(self, text: str, name: str, sets: Sequence[str], ends: Mapping[str, Any] | None) -> None:
        self._live, self._ends = Live(text, name, sets), ends or {"theta": ["3.0"]}

    def answers(self, request: Mapping[str, Any], show: Show, between: Callable[[], bool]) -> bool:
        """Shows each answer; False if `between`, asked every few milliseconds of a frame or chart, has ended it."""
        kind = request.get("request")
        if kind == "frame":
            return self._frame(request, show, between)
        if kind == "chart":
            return self._chart(request, show, between)
        make = {"where": self._where, "orbit": self._orbit, "catalogue": self._catalogue}.get(str(kind))
        if make is None:
            raise BadRequest(
                f"request: {str(kind)[:60]!r} is unknown; it must be frame, where, orbit, catalogue, chart or cancel")
        show(*make(request))
        return True

    def _frame(self, request: Mapping[str, Any], show: Show, between: Callable[[], bool]) -> bool:
        rows, columns = (_integer(request, name, 1, 8192) for name in ("rows", "columns"))
        if rows * columns > MOST_CELLS:
            raise BadRequest(f"rows: {rows} times {columns} columns are more than {MOST_CELLS} cells")
        planes, quality, shown = _planes(request), request.get("quality", "exact"), 0
        if quality not in ("exact", "moving"):
            raise BadRequest(f"quality: {str(quality)[:60]!r} is unknown; it must be exact or moving")
        window, point = _mapping(request, "window") or {}, (0.0, 0.0)
        if request.get("atlas") is not None:
            point = _number(request, "x"), _number(request, "y")
        elif "x" in request or "y" in request:
            raise BadRequest("x: is a point of an atlas; give the name of its file as atlas")
        cells = {"theta": columns, "velocity": rows}
        basin = {axis: {**(_mapping(window, axis) or {}), "count": count} for axis, count in cells.items()}

        def part(found: tuple[dict[str, Any], dict[str, np.ndarray]]) -> bool:
            nonlocal shown
            header, values = found
            catalogue = header["catalogue"]
            if catalogue["version"] != shown:
                shown = catalogue["version"]
                show({"answer": "catalogue", **catalogue, "final": False}, ())
            show({"answer": "frame", **header, "catalogue": shown, "quality": quality, "planes": planes},
                 [values[name] for name in planes])
            return True

        return self._live.frame(part, between, changed=change(pendulum=_mapping(request, "pendulum"), basin=basin),
                                planes=planes,
                                moving=quality == "moving", coarseness=_levels(request), atlas=request.get("atlas"),
                                point=point)

    def _chart(self, request: Mapping[str, Any], show: Show, between: Callable[[], bool]) -> bool:
        axes = {axis: _mapping(request, axis) for axis in ("x", "y")}
        if None in axes.values():
            raise BadRequest("a chart needs the mappings x and y")
        plane = change(pendulum=_mapping(request, "pendulum"), sweep={"measure": ["ends"], "ends": self._ends, **axes})

        def part(found: tuple[dict[str, Any], dict[str, np.ndarray]]) -> bool:
            show({"answer": "chart", **found[0], "planes": list(found[1])}, list(found[1].values()))
            return True

        return self._live.chart(part, between, changed=plane, coarseness=_levels(request))

    def _where(self, request: Mapping[str, Any]) -> Answer:
        theta, velocity = (_digits(request, name) for name in ("theta", "velocity"))
        ending = self._live.where([theta], [velocity], change(pendulum=_mapping(request, "pendulum")))[0]
        return {"answer": "where", "final": True, **ending}, ()

    def _orbit(self, request: Mapping[str, Any]) -> Answer:
        periods = _integer(request, "periods", 1, 100_000, 100)
        transient = _integer(request, "transient", 0, 10_000_000, 0)
        samples = _integer(request, "samples_per_period", 1, 4096, 64)
        if periods * samples > MOST_CELLS:
            raise BadRequest(
                f"periods: {periods} times {samples} samples_per_period are more than {MOST_CELLS} samples")
        live = self._live.with_pendulum(_mapping(request, "pendulum"))
        values = live.orbit(_number(request, "theta"), _number(request, "velocity"), periods, transient, samples)
        numbers = live.parameters
        return {"answer": "orbit", "final": True, "samples": values.shape[1], "samples_per_period": samples,
                "transient": transient,
                "k": numbers["k"], "damping": numbers["beta"], "m": numbers["m"],
                "pivot": live.pivot(samples)}, [values]

    def _catalogue(self, request: Mapping[str, Any]) -> Answer:
        found = self._live.catalogue(change(pendulum=_mapping(request, "pendulum")))
        return {"answer": "catalogue", **found, "final": True}, ()


def _mapping(request: Mapping[str, Any], name: str) -> Mapping[str, Any] | None:
    value = request.get(name)
    if value is not None and not isinstance(value, dict):
        raise BadRequest(f"{name}: must be a mapping")
    return value


def _integer(request: Mapping[str, Any], name: str, low: int, high: int, default: int | None = None) -> int:
    value = request.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        wrong = "is missing" if value is None else f"{str(value)[:60]!r} is out of range"
        raise BadRequest(f"{name}: {wrong}; it must be an integer from {low} to {high}")
    return value


def _digits(request: Mapping[str, Any], name: str) -> str:
    """A number as text, with all its digits."""
    value = request.get(name)
    if value is None:
        raise BadRequest(f"{name}: is missing; it must be a number")
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise BadRequest(f"{name}: must be a number, or text with its digits")
    return repr(value) if isinstance(value, float) else str(value)


def _number(request: Mapping[str, Any], name: str) -> float:
    text = _digits(request, name)
    try:
        value = float(text)
    except (ValueError, OverflowError):
        value = math.nan
    if not math.isfinite(value):
        raise BadRequest(f"{name}: {text[:60]!r} is not a finite decimal number")
    return value


def _levels(request: Mapping[str, Any]) -> list[int]:
    levels = request.get("levels", [1])
    known = isinstance(levels, list) and levels and all(level in (1, 2, 4, 8) for level in levels)
    if not known or any(later >= level for level, later in zip(levels, levels[1:], strict=False)):
        raise BadRequest("levels: must be a list from 8, 4, 2, 1 in falling order")
    return list(levels)


def _planes(request: Mapping[str, Any]) -> list[str]:
    planes = request.get("planes", ["labels"])
    if not isinstance(planes, list) or not planes or any(plane not in PLANES for plane in planes):
        raise BadRequest(f"planes: must be a list from {', '.join(PLANES)}")
    return list(planes)


def packed(planes: Sequence[np.ndarray]) -> Iterator[memoryview]:
    """The bytes of planes, little-endian."""
    for plane in planes:
        yield np.ascontiguousarray(plane, plane.dtype.newbyteorder("<")).data.cast("B")
