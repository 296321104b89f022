"""An engine: a process of `kapitza serve` that answers many requests."""

import itertools
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from kapitza import units
from kapitza.client import Client, Ended
from kapitza.program import ERROR, RunError, SceneError, check_end, command, scene_error
from kapitza.scene import Scene, SceneLike, texts

UNSETTLED = 255  # label in an answer


class Engine:
    """A process that stays in memory and labels many windows of starts quickly, for the scene's pendulum or any other.

    >>> with kapitza.Engine("scenes/blackburn-fig12.yaml") as engine:
    ...     labels = engine.frame((-3.1, 3.1, -2, 2), (250, 400))
    ...     engine.attractors.loc[labels[0, 0], "name"]
    """

    def __init__(self, scene: SceneLike, set: Mapping[str, Any] | None = None, *, timeout: float | None = None) -> None:
        """:param timeout: seconds after which a request ends with TimeoutError; None = it may take as long as it takes"""
        self._scene, self._timeout = Scene(scene, set), timeout
        self._views = itertools.count(1)
        self._attractors: list[dict[str, Any]] | None = None
        try:
            self._client = Client(command(["serve", self._scene.path, *self._scene.sets]))
        except Ended as end:
            raise self._why(end) from None
        self.ready = self._client.ready

    def __enter__(self) -> "Engine":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self._client.ended else "ready"
        return f"<kapitza.Engine of {self.ready.get('title') or 'a scene'}: {state}>"

    def close(self) -> None:
        """Ends the process of the engine."""
        if hasattr(self, "_client"):
            self._client.close()

    def frame(self, window: tuple[Any, Any, Any, Any] | Mapping[str, Any] | None = None, shape: tuple[int, int] = (250, 400),
              pendulum: Mapping[str, Any] | None = None, quality: str = "exact") -> np.ndarray:
        """Labels every cell of a window: an integer array (rows, columns), the lowest velocity first; -1 = not settled.

        :param window: (theta_min, theta_max, velocity_min, velocity_max) in rad and rad per drive radian; or, for any depth, a mapping
            such as `{"theta": {"centre": "2.0512", "width": 1e-20}, "velocity": ...}`; None = the window of the scene's basin
        :param shape: (rows, columns)
        :param pendulum: another mapping `pendulum`, complete; None = that of the scene
        :param quality: "exact", or "moving", which is faster. With "moving" a few cells in a thousand of a whole circle have another
            label, and up to ten in a hundred of a deep window that is fractal throughout
        """
        request: dict[str, Any] = {"request": "frame", "rows": shape[0], "columns": shape[1], "quality": quality}
        if window is not None:
            request["window"] = window if isinstance(window, Mapping) else {
                "theta": {"min": window[0], "max": window[1]}, "velocity": {"min": window[2], "max": window[3]}}
        header, payload = self._ask(request, pendulum)
        if header["catalogue"] in self._client.catalogues:
            self._attractors = self._client.catalogues[header["catalogue"]]["attractors"]
        labels = np.frombuffer(payload, np.uint8, header["rows"] * header["columns"]).reshape(header["rows"], header["columns"])
        return np.where(labels == UNSETTLED, -1, labels.astype(np.int16))

    @property
    def attractors(self) -> pandas.DataFrame:
        """A table of the attractors that the labels of the last frame refer to. Before the first frame it has those of the scene."""
        if self._attractors is None:
            self._attractors = self._ask({"request": "catalogue"}, None)[0]["attractors"]
        return attractors_table(self._attractors)

    def where(self, theta: Any, velocity: Any, pendulum: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Returns where one start ends: a dict with the columns of `kapitza.where`."""
        units.note_bare([theta])
        header, _ = self._ask({"request": "where", "theta": theta, "velocity": velocity}, pendulum)
        return {key: value for key, value in header.items() if key not in ("answer", "sequence", "final", "bytes")}

    def orbit(self, theta: Any, velocity: Any, periods: int = 100, pendulum: Mapping[str, Any] | None = None,
              samples_per_period: int = 64) -> pandas.DataFrame:
        """Models one motion: a table with the columns time (drive radians), theta (rad, not wrapped), velocity (rad per drive radian)."""
        units.note_bare([theta])
        header, payload = self._ask({"request": "orbit", "theta": theta, "velocity": velocity, "periods": periods,
                                     "samples_per_period": samples_per_period}, pendulum)
        values = np.frombuffer(payload, "<f8").reshape(2, header["samples"])
        time = np.arange(header["samples"]) * (2 * np.pi / samples_per_period)
        return pandas.DataFrame({"time": time, "theta": values[0], "velocity": values[1]})

    def motions(self, atlas: str | os.PathLike[str], x: float, y: float, *, states: bool = True) -> pandas.DataFrame:
        """The motions that attract at a point of an atlas: a table as `Result.motions` returns it. A point takes some milliseconds.

        :param atlas: name of a result file with the study atlas; the engine keeps the last one in memory
        """
        header, _ = self._ask({"request": "motions", "atlas": str(Path(atlas).absolute()), "x": x, "y": y, "states": states}, None)
        return motions_table(header["motions"])

    def line(self, atlas: str | os.PathLike[str], *, x: float | None = None, y: float | None = None) -> pandas.DataFrame:
        """The branches of all cycles along a line through an atlas: a table as `Result.line` returns it."""
        given = {key: value for key, value in (("x", x), ("y", y)) if value is not None}
        header, payload = self._ask({"request": "line", "atlas": str(Path(atlas).absolute()), **given}, None)
        table = pandas.DataFrame(np.frombuffer(payload, "<f8").reshape(-1, len(header["columns"])), columns=header["columns"])
        counts = [row["points"] for row in header["branches"]]
        for column, name in enumerate(("name", "period", "winding", "centre", "symmetric", "images")):
            table.insert(column, name, np.repeat([row[name] for row in header["branches"]], counts))
        table.insert(0, "branch", np.repeat(np.arange(len(counts)), counts))
        return table

    def _ask(self, request: dict[str, Any], pendulum: Mapping[str, Any] | None) -> tuple[dict[str, Any], bytes]:
        """The last answer to a request. Ctrl-C cancels it. Each request has a view of its own, so that none of another thread ends it."""
        request["view"] = str(next(self._views))
        if pendulum is not None:
            request["pendulum"] = pendulum
        try:
            pending = self._client.send(_plain(request))
            try:
                while True:
                    header, payload = pending.next(self._timeout)
                    if header["answer"] == "error":
                        raise scene_error(header["message"].removeprefix(ERROR), self._scene)
                    if header["answer"] == "ended":
                        raise RuntimeError("the engine is closed")
                    if header["final"]:
                        return header, payload
            except (KeyboardInterrupt, TimeoutError):
                self._client.send({"request": "cancel", "view": request["view"]})
                raise
        except Ended as end:
            raise self._why(end) from None

    def _why(self, end: Ended) -> Exception:
        """The exception that the end of the process becomes."""
        try:
            check_end(end.status, end.errors, self._scene)
        except (RunError, SceneError) as error:
            return error
        return RuntimeError("the engine is closed")


def attractors_table(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    """The attractors of a catalogue, a row each, by id; strobe points as lists."""
    table = pandas.DataFrame(rows).set_index("id")
    table["strobe_theta"] = [[point[0] for point in points] for points in table["strobe"]]
    table["strobe_velocity"] = [[point[1] for point in points] for points in table["strobe"]]
    return table.drop(columns="strobe")


def motions_table(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    """The motions of an answer, a row each; multipliers as complex numbers, points as lists."""
    columns = ["name", "period", "winding", "centre", "symmetric", "images", "curve", "multipliers", "strobe_theta", "strobe_velocity"]
    table = [{**row, "multipliers": [complex(*pair) for pair in row["multipliers"]],
              "strobe_theta": [point[0] for point in row["strobe"]], "strobe_velocity": [point[1] for point in row["strobe"]]}
             for row in rows]
    return pandas.DataFrame(table, columns=columns).astype({"curve": "Int64"})


def _plain(value: Any) -> Any:
    """The value as JSON holds it."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return value if isinstance(value, bool | int | float | str) else texts(value)
