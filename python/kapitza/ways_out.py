"""Ways out of basins, and into others: the torques of least action that the study `escape` finds."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray

from kapitza import style, units
from kapitza.result import Result
from kapitza.scene import flow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from kapitza.library import Library

_COLUMNS = ("from", "into", "saddle", "barrier", "largest_torque", "barrier_by_k", "barrier_by_m", "barrier_by_beta",
            "is_gate", "agrees", "starts")


class WaysOut:
    """Paths of least action of a pendulum. Actions and torques are in units of I omega^2; of a pendulum in SI units
    with a mass also in J and N m.

    :ivar result: the result with the groups attractors, saddles and escape
    """

    def __init__(self, library: "Library", scene: Mapping[str, Any]) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="kapitza-ways-out-")  # for as long as this object lives
        path = Path(self._folder.name) / "ways-out.h5"
        library.call("kapitza_run", flow(scene).encode(), str(path).encode(), 0, library.ffi.NULL)
        self.result = Result(path)
        self.names = style.names_with_ids(self.result.group("attractors")["name"].values)

    def _with_si(self, rows: pandas.DataFrame) -> pandas.DataFrame:
        unit = units.energy_unit(self.result.pendulum)
        if unit is not None:
            rows["barrier_J"] = rows["barrier"] * unit
            rows["largest_torque_Nm"] = rows["largest_torque"] * unit
        return rows

    @property
    def table(self) -> pandas.DataFrame:
        """A row for each path: names of the motions that it leaves and reaches, id of the saddle, `barrier`, slopes of
        the barrier ..."""
        escape, saddles = self.result.group("escape"), self.result.group("saddles")["name"].values
        rows = pandas.DataFrame({name: escape[name].values for name in _COLUMNS},
                                index=pandas.Index(escape["route"].values, name="route"))
        for column in ("from", "into"):
            rows[column] = [self.names[number] if number >= 0 else "none" for number in rows[column]]
        rows.insert(3, "saddle_name", [style.name_text(saddles[number]) for number in rows["saddle"]])
        return self._with_si(rows.astype({"is_gate": bool, "agrees": bool}).sort_values("barrier"))

    @property
    def barriers(self) -> pandas.DataFrame:
        """For each motion that is left: `barrier` out of its basin, `largest_torque`, `life_exponent`, the `island` on
        the way, the `route`."""
        escape = self.result.group("escape")
        torque = np.append(escape["largest_torque"].values, np.nan)  # the last for those without a route, -1
        rows = pandas.DataFrame({"barrier": escape["barrier_out"].values,
                                 "largest_torque": torque[escape["way_out"].values],
                                 "life_exponent": escape["life_exponent"].values,
                                 "island": [self.names[number] if number >= 0 else ""
                                            for number in escape["island"].values],
                                 "route": escape["way_out"].values}, index=pandas.Index(self.names, name="attractor"))
        return self._with_si(rows[rows["route"] >= 0].copy())

    @property
    def matrix(self) -> pandas.DataFrame:
        """Barriers from each motion (rows) into each basin (columns); on the diagonal out of the own one.

        :raises ValueError: if paths into every basin were not sought
        """
        escape = self.result.group("escape")
        if "barrier_into" not in escape:
            raise ValueError("paths out of basins only were sought; give into_every_basin=True")
        return pandas.DataFrame(escape["barrier_into"].values, index=self.names, columns=self.names)

    @property
    def chains(self) -> pandas.DataFrame:
        """The matrix with detours over other attractors, where that costs less: the sum of the barriers on the way."""
        costs = self.matrix.fillna(np.inf)
        for middle in self.names:
            costs = np.minimum(costs, costs[[middle]].to_numpy() + costs.loc[[middle]].to_numpy())
        own = np.eye(len(costs), dtype=bool)
        return costs.mask(own, self.matrix).replace(np.inf, np.nan)

    @property
    def lives(self) -> pandas.DataFrame:
        """Mean lives that were counted, in drive periods, with their 95 % intervals.

        :raises ValueError: if none were counted
        """
        escape = self.result.group("escape")
        if "life" not in escape:
            raise ValueError("no lives were counted; give temperatures=[...]")
        rows = escape[["life", "life_low", "life_high", "life_ended"]].to_dataframe().reset_index()
        rows["attractor"] = [self.names[number] for number in rows["attractor"]]
        return rows[rows["life_ended"] > 0].reset_index(drop=True)

    def path(self, route: int) -> xarray.Dataset:
        """theta (rad, not wrapped), velocity and torque over time (drive periods) of a path; in SI units torque_Nm too.

        :raises ValueError: if the path is not among those of least action
        """
        escape = self.result.group("escape")
        points = escape[["theta", "velocity", "torque",
                         "time"]].isel(point=np.flatnonzero(escape["path"].values == route))
        if points.sizes["point"] == 0:
            raise ValueError(f"path {route} is not the least into any basin; those are "
                             f"{sorted(set(escape['path'].values.tolist()))}")
        unit = units.energy_unit(self.result.pendulum)
        if unit is not None:
            points = points.assign(torque_Nm=points["torque"] * unit)
        return points.swap_dims(point="time").reset_coords("point", drop=True).assign_attrs(
            action=float(escape["barrier"].values[route]))

    def plot(self, attractor: str | int | None = None, into: str | int | None = None, **options: Any) -> "Figure":
        """The path in the plane and its torque below, as `kapitza plot escape` draws them."""
        given = {"attractor": attractor, "into": into}
        options |= {name: str(value) for name, value in given.items() if value is not None}
        return self.result.plot("escape", **options)


def scene_of(tree: Mapping[str, Any], max_period: int, velocity: Sequence[float],
             escape: Mapping[str, Any]) -> dict[str, Any]:
    """The scene of ways out of a pendulum: `tree` has its mappings."""
    low, high = (float(edge) for edge in velocity)
    scene = {name: tree[name] for name in ("pendulum", "numerics") if name in tree}
    window = {"min": low, "max": high}
    return scene | {"attractors": {"velocity": window}, "saddles": {"velocity": window, "max_period": max_period},
                    "escape": dict(escape)}
