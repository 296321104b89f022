"""An engine: a pendulum that keeps its caches for many windows of starts, in this process."""

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from kapitza import units
from kapitza.live import LINE, Live, Part, change
from kapitza.program import SceneError, scene_error, source
from kapitza.scene import Scene, SceneLike, texts

UNSETTLED = 255  # label of a cell of a frame


class Engine:
    """Labels many windows of starts quickly, for the scene's pendulum or any other. Threads may share it; Ctrl-C ends a
    call.

    >>> engine = kapitza.Engine("scenes/blackburn-fig12.yaml")
    >>> labels = engine.frame((-3.1, 3.1, -2, 2), (250, 400))
    >>> engine.attractors.loc[labels[0, 0], "name"]
    """

    def __init__(self, scene: SceneLike, set: Mapping[str, Any] | None = None) -> None:
        asked = Scene(scene, set)
        try:
            self._live = Live(*source(asked))
        except SceneError as error:
            raise scene_error(str(error), asked) from None
        self._frequency: float = self._live.parameters["pivot_frequency"]
        self._attractors: list[dict[str, Any]] | None = None

    def __enter__(self) -> "Engine":
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing: the caches last as long as the engine."""

    def frame(self, window: tuple[Any, Any, Any, Any] | Mapping[str, Any] | None = None,
              shape: tuple[int, int] = (250, 400),
              pendulum: Mapping[str, Any] | None = None, quality: str = "exact") -> np.ndarray:
        """Labels every cell of a window: an integer array (rows, columns), the lowest velocity first; -1 = not settled.

        :param window: (theta_min, theta_max, velocity_min, velocity_max) in rad and rad per drive radian; or, for any
            depth, a mapping such as `{"theta": {"centre": "2.0512", "width": 1e-20}, "velocity": ...}`; None = the
            window of the scene's basin
        :param shape: (rows, columns)
        :param pendulum: another mapping `pendulum`, complete; None = that of the scene
        :param quality: "exact", or "moving", which is faster. With "moving" a few cells in a thousand of a whole circle
            have another label, and up to ten in a hundred of a deep window that is fractal throughout
        """
        if quality not in ("exact", "moving"):
            raise ValueError(f"quality is {quality!r}; it must be 'exact' or 'moving'")
        parts: list[Part] = []

        def keep(part: Part) -> bool:
            parts.append(part)
            return True

        changed = change(pendulum=pendulum, **_cells(window, shape))
        self._live.frame(keep, changed=changed, moving=quality == "moving")
        header, planes = parts[-1]
        self._attractors = header["catalogue"]["attractors"]
        return np.where(planes["labels"] == UNSETTLED, -1, planes["labels"].astype(np.int16))

    @property
    def attractors(self) -> pandas.DataFrame:
        """A table of the attractors that the labels of the last frame refer to. Before the first frame it has those of
        the scene."""
        if self._attractors is None:
            self._attractors = self._live.catalogue()["attractors"]
        return attractors_table(self._attractors)

    def where(self, theta: Any, velocity: Any, pendulum: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Returns where one start ends: a dict with the columns of `kapitza.where`."""
        units.note_bare([theta])
        return self._live.where([texts(theta)], [texts(velocity)], change(pendulum=pendulum))[0]

    def orbit(self, theta: Any, velocity: Any, periods: int = 100, pendulum: Mapping[str, Any] | None = None,
              samples_per_period: int = 64) -> pandas.DataFrame:
        """Models one motion: a table with the columns time (drive radians), theta (rad, not wrapped), velocity (rad per
        drive radian)."""
        omega = self._frequency if math.isfinite(self._frequency) else None
        values = self._live.with_pendulum(pendulum).orbit(units.angle(theta), units.velocity(velocity, omega), periods,
                                                          samples_per_period=samples_per_period)
        time = np.arange(values.shape[1]) * (2 * np.pi / samples_per_period)
        return pandas.DataFrame({"time": time, "theta": values[0], "velocity": values[1]})

    def motions(self, atlas: str | os.PathLike[str], x: float, y: float, *, states: bool = True) -> pandas.DataFrame:
        """The motions that attract at a point of an atlas: a table as `Result.motions` returns it. A point takes some
        milliseconds.

        :param atlas: name of a result file with the study atlas; the engine keeps the last one in memory
        """
        return motions_table(self._live.motions(str(Path(atlas).absolute()), x, y, states)["motions"])

    def line(self, atlas: str | os.PathLike[str], *, x: float | None = None, y: float
             | None = None) -> pandas.DataFrame:
        """The branches of all cycles along a line through an atlas: a table as `Result.line` returns it."""
        if (x is None) == (y is None):
            raise ValueError("a line has x or y, not both")
        branches, points = self._live.line(str(Path(atlas).absolute()), x, y)
        table, counts = pandas.DataFrame(points, columns=list(LINE)), [row["points"] for row in branches]
        for column, name in enumerate(("name", "period", "winding", "centre", "symmetric", "images")):
            table.insert(column, name, np.repeat([row[name] for row in branches], counts))
        table.insert(0, "branch", np.repeat(np.arange(len(counts)), counts))
        return table


def _cells(window: tuple[Any, ...] | Mapping[str, Any] | None, shape: tuple[int, int]) -> dict[str, Any]:
    """The mapping basin of a frame, by the keys that it changes."""
    rows, columns = shape
    if window is None:
        own: Mapping[str, Any] = {}
    elif isinstance(window, Mapping):
        own = window
    else:
        own = {"theta": {"min": window[0], "max": window[1]}, "velocity": {"min": window[2], "max": window[3]}}
    return {"basin": {axis: {**own.get(axis, {}), "count": count} for axis,
                      count in (("theta", columns), ("velocity", rows))}}


def attractors_table(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    """The attractors of a catalogue, a row each, by id; strobe points as lists."""
    table = pandas.DataFrame(rows).set_index("id")
    table["strobe_theta"] = [[point[0] for point in points] for points in table["strobe"]]
    table["strobe_velocity"] = [[point[1] for point in points] for points in table["strobe"]]
    return table.drop(columns="strobe")


def motions_table(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    """The motions of an answer, a row each; multipliers as complex numbers, points as lists."""
    columns = ["name", "period", "winding", "centre", "symmetric", "images", "curve", "multipliers", "strobe_theta",
               "strobe_velocity"]
    table = [{**row, "multipliers": [complex(*pair) for pair in row["multipliers"]],
              "strobe_theta": [point[0] for point in row["strobe"]],
              "strobe_velocity": [point[1] for point in row["strobe"]]}
             for row in rows]
    return pandas.DataFrame(table, columns=columns).astype({"curve": "Int64"})
