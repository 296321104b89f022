"""A pendulum in this process: arrays in, arrays, pandas and xarray out."""

import copy
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas
import xarray
from numpy.typing import ArrayLike, NDArray

from kapitza import datasets, units
from kapitza.library import Library, load
from kapitza.scene import SYMBOLS, Scene, SceneLike, flow, put, texts
from kapitza.table import attractors_table
from kapitza.ways_out import WaysOut, scene_of

Reals = NDArray[np.float64]


class Image(NamedTuple):
    """States after drive periods: `theta` in [-pi, pi), `velocity`, net `turns`; `tangent` (..., 2, 2), if it was asked
    for."""

    theta: Reals
    velocity: Reals
    turns: NDArray[np.int64]
    tangent: Reals | None


class Pendulum:
    """A shaken pendulum, with its map, attractors, basins, cycles and manifolds.

    >>> pendulum = kapitza.Pendulum(quality_factor=5, drive_frequency=11, drive_amplitude=0.3)
    >>> pendulum.attractors()[["name", "period", "winding"]]
    >>> pendulum.basin(theta=300, velocity=(-2, 2, 300)).kapitza.plot(centre="inverted")

    Angles are in rad from down, or texts such as "175 deg"; velocities in rad per drive radian, or, of a pendulum in SI
    units, texts such as "3 rad/s". Threads may share a pendulum; calls on different pendulums run at the same time.
    Ctrl-C ends a call.

    :param scene: a scene (path, YAML text or mapping), of which the mappings pendulum, numerics and basin count; None =
        none
    :param keys: keys of the mapping `pendulum` (docs/reference/scene.md), such as `length="20 cm"`; the mappings
        `basin` (search for attractors, phase of release) and `numerics` by their names
    :raises SceneError: if a key is wrong
    """

    def __init__(self, scene: SceneLike | None = None, /, **keys: Any) -> None:
        tree = {} if scene is None else Scene(scene).tree()
        self._tree: dict[str, Any] = {name: tree[name] for name in ("pendulum", "numerics", "basin") if name in tree}
        self._change(keys)
        self._open()

    def _change(self, keys: Mapping[str, Any]) -> None:
        for name, value in keys.items():
            if name in ("basin", "numerics") and isinstance(value, Mapping):
                self._tree[name] = texts(value)
            else:
                put(self._tree, f"pendulum.{SYMBOLS.get(name, name)}", texts(value))

    def _open(self) -> None:
        self._library: Library = load()
        given = self._library.ffi.new("kapitza_pendulum **")
        self._library.call("kapitza_pendulum_create", flow(self._tree).encode(), given)
        self._own = self._library.ffi.gc(given[0], self._library.lib.kapitza_pendulum_free)
        numbers = self._library.ffi.new("kapitza_parameters *")
        self._call("kapitza_parameters_of", numbers)
        names = ("k", "beta", "m", "quality_factor", "drive_frequency", "drive_amplitude", "pivot_frequency")
        self._parameters = {name: float(getattr(numbers, name)) for name in names}

    def __reduce__(self) -> tuple[Any, ...]:
        return Pendulum, (self._tree,)

    def __repr__(self) -> str:
        written = (f"{name}={flow(value)}" for name, value in self._tree.get("pendulum", {}).items())
        return f"kapitza.Pendulum({', '.join(written)})"

    def _call(self, name: str, *arguments: Any) -> None:
        self._library.call(name, self._own, *arguments)

    @property
    def parameters(self) -> dict[str, float]:
        """k, beta, m, quality_factor, drive_frequency, drive_amplitude and pivot_frequency (rad/s); NaN = not defined.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).parameters["beta"]
        """
        return dict(self._parameters)

    def with_(self, **keys: Any) -> "Pendulum":
        """A pendulum with some keys changed; None takes a key away.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).with_(epsilon=0.31).attractors()
        """
        other = object.__new__(Pendulum)
        other._tree = copy.deepcopy(self._tree)
        other._change({name: value for name, value in keys.items() if value is not None})
        for name in (SYMBOLS.get(name, name) for name, value in keys.items() if value is None):
            other._tree.get("pendulum", {}).pop(name, None)
        other._open()
        return other

    def map(self, theta: ArrayLike, velocity: ArrayLike, periods: int = 1, *, tangent: bool = False) -> Image:
        """Moves states through drive periods, backwards if `periods` is negative: the strobe map, to some 1e-12 rad a
        period.

        >>> pendulum = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3)
        >>> theta, velocity, turns, _ = pendulum.map(np.linspace(-3, 3, 7), 0, periods=10)

        :param tangent: the matrices d(theta, velocity)/d(theta0, velocity0) too
        """
        angles, speeds = self._starts(theta, velocity)
        turns = np.zeros(angles.shape, np.int64)
        matrix = np.empty((*angles.shape, 2, 2)) if tangent else None
        view = self._library.view
        self._call("kapitza_map", angles.size, periods, view(angles), view(speeds), view(turns, "int64_t *"),
                   view(matrix))
        return Image(angles, speeds, turns, matrix)

    def orbit(self, theta: float | str, velocity: float | str, periods: int = 100, *, transient: int = 0,
              samples_per_period: int = 64) -> pandas.DataFrame:
        """One motion in continuous time: time (drive radians), theta (rad, not wrapped), velocity.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).orbit("170 deg", 0, periods=50).plot("time", "theta")
        """
        values = np.empty((2, periods * samples_per_period + 1))
        starts = (float(value) for value in self._starts(theta, velocity))
        self._call("kapitza_orbit", *starts, transient, periods, samples_per_period, *map(self._library.view, values))
        time = (transient * samples_per_period + np.arange(values.shape[1])) * (2 * np.pi / samples_per_period)
        return pandas.DataFrame({"time": time, "theta": values[0], "velocity": values[1]})

    def attractors(self) -> pandas.DataFrame:
        """The known attractors, a row each by id, with the columns of `Result.attractors`. The first call searches;
        starts may find more.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).attractors()["name"]
        """
        return attractors_table(self._listed("attractor", "kapitza_attractors"))

    def where(self, theta: ArrayLike, velocity: ArrayLike, *, start_error: float = 0) -> xarray.Dataset:
        """Where starts end: `attractor` (id; -1 = not settled), `evidence`, `settling_time` (drive periods), `turns`,
        `error` (rad) and `other_attractor` of the shape of the starts, labelled as `basin.method: exact` labels cells;
        and the attractors.

        >>> ends = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).where(np.linspace(2.9, 3.1, 5), 0.2)
        >>> ends.name[ends.attractor].values

        :param start_error: bound of the starts' own errors, rad; labels that they could change are undecided"""
        angles, speeds = self._starts(theta, velocity)
        kinds = dict(attractor="int16", other_attractor="int16", evidence="uint8", settling_time="int64", turns="int32",
                     error="float64")
        values = {name: np.empty(angles.shape, kind) for name, kind in kinds.items()}
        given, view = self._library.ffi.new("kapitza_cycles **"), self._library.view
        arrays = (view(values[name], "double *" if kind == "float64" else f"{kind}_t *") for name,
                  kind in kinds.items())
        self._call("kapitza_labels", angles.size, view(angles), view(speeds), start_error, *arrays, given)
        dims = next((value.dims for value in (theta, velocity) if isinstance(value, xarray.DataArray)), None)
        if dims is None or len(dims) != angles.ndim:
            dims = tuple(f"start_{axis}" for axis in range(angles.ndim)) if angles.ndim > 1 else ("start",
                                                                                                  )[:angles.ndim]
        labels = ({"theta": angles, "velocity": speeds} | values).items()
        return datasets.labelled({name: (dims, value) for name, value in labels}, self._library.cycles(given[0], "id"))

    def basin(self, theta: Any = 400, velocity: Any = 400) -> xarray.Dataset:
        """The label of every cell of a window, by all cores: variables over velocity and theta as in the group `basin`
        of a file, and the attractors. `.kapitza.plot(ax=...)` draws it, `.kapitza.attractors` is their table.

        >>> basin = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).basin(theta=200, velocity=(-2, 2, 200))
        >>> basin.attractor.plot()

        :param theta: number of cells; (min, max, count); or, at any depth, {"centre": "2.05", "width": 1e-20, "count":
            200}
        :param velocity: likewise
        """
        window = ", ".join(f"{name}: {flow(self._axis(name, value))}" for name,
                           value in (("theta", theta), ("velocity", velocity)))
        given = self._library.ffi.new("kapitza_basin **")
        self._call("kapitza_basin_of", window.encode(), given)
        try:
            return datasets.of_basin(self._library, given[0][0])
        finally:
            self._library.lib.kapitza_free(given[0])

    def _axis(self, name: str, value: Any) -> Any:
        if isinstance(value, Mapping):
            return value
        own = self._tree.get("basin", {}).get(name, {} if name == "theta" else {"min": -2, "max": 2})
        if isinstance(value, Sequence) and not isinstance(value, str):
            return dict(zip(("min", "max", "count"), value, strict=True))
        return dict(own) | {"count": int(value)}

    def cycles(self, max_period: int = 1, *, theta: tuple[float, float] = (-np.pi, np.pi),
               velocity: tuple[float, float] = (-2, 2)) -> xarray.Dataset:
        """All cycles of up to so many periods with a point in the window, attracting or not, as the group `saddles` of
        a file has them. The attribute `open_sums` is 0 if the sums of their indices show that none is missing.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).cycles(max_period=2)[["name", "period"]].to_dataframe()
        """
        ffi = self._library.ffi
        open_sums = ffi.new("int64_t *")
        cycles = self._listed("cycle", "kapitza_all_cycles", max_period, ffi.new("double [4]", [*theta, *velocity]),
                              after=(open_sums,))
        return cycles.assign_attrs(open_sums=int(open_sums[0]), max_period=max_period)

    def saddles(self, max_period: int = 1, **window: Any) -> xarray.Dataset:
        """The cycles that do not attract, of those that `cycles` finds.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).saddles().strobe_theta
        """
        cycles = self.cycles(max_period, **window)
        return cycles.isel(cycle=np.hypot(cycles.multiplier_re, cycles.multiplier_im).isel(pair=0).values > 1)

    def cycle(self, theta: float | str, velocity: float | str, period: int = 1, *,
              within: float = 0.5) -> xarray.Dataset:
        """The cycle that Newton's method finds near a state, attracting or not; its first strobe point is that near the
        state.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).cycle("179 deg", 0).multiplier_re.values

        :raises ValueError: if no cycle that closes after `period` periods lies within so many rad
        """
        starts = (float(value) for value in self._starts(theta, velocity))
        found = self._listed("cycle", "kapitza_cycle_near", period, *starts, within)
        if found.sizes["cycle"] == 0:
            raise ValueError(
                f"no cycle that closes after {period} periods lies within {within:g} rad of ({theta}, {velocity})")
        return found.isel(cycle=0)

    def manifold(self, cycle: xarray.Dataset, *, stable: bool = False, side: int = 1, phase: int = 0,
                 length: float = 20,
                 spacing: float = 0.02, max_speed: float = 2, most: int = 32768) -> pandas.DataFrame:
        """One branch of a manifold of a cycle: theta, velocity, arc_length and polyline (number of the unbroken part).

        >>> pendulum = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3)
        >>> pendulum.manifold(pendulum.saddles().isel(cycle=0), stable=True).plot.scatter("theta", "velocity", s=1)

        :param side: 1 or -1, along the eigenvector or against it
        :param phase: number of the strobe point from which the branch grows
        """
        points, count = np.empty((most, 4)), self._library.ffi.new("int64_t *")
        state = (float(cycle[name].values[phase]) for name in ("strobe_theta", "strobe_velocity"))
        self._call("kapitza_manifold", *state, int(cycle["period"]), int(stable), side, spacing, length, max_speed,
                   most, self._library.view(points), count)
        table = pandas.DataFrame(points[:count[0]], columns=["theta", "velocity", "arc_length", "polyline"])
        return table.astype({"polyline": int})

    def ways_out(self, *, max_period: int = 6, velocity: tuple[float, float] = (-2, 2), **keys: Any) -> WaysOut:
        """The least torque out of each basin, or into every one: paths, barriers, lives. Keys are those of the study
        `escape`.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).ways_out(starts=12).barriers
        """
        return WaysOut(self._library, scene_of(self._tree, max_period, velocity, keys))

    def _listed(self, dimension: str, name: str, *arguments: Any, after: tuple[Any, ...] = ()) -> xarray.Dataset:
        given = self._library.ffi.new("kapitza_cycles **")
        self._call(name, *arguments, given, *after)
        return self._library.cycles(given[0], dimension)

    def _starts(self, theta: ArrayLike, velocity: ArrayLike) -> list[Reals]:
        omega = self._parameters["pivot_frequency"]
        speeds = _numbers(velocity, lambda value: units.velocity(value, omega if np.isfinite(omega) else None))
        return [np.array(values, dtype=float, order="C")
                for values in np.broadcast_arrays(_numbers(theta, units.angle), speeds)]


def _numbers(values: ArrayLike, read: Any) -> Reals:
    """Numbers, or texts that `read` understands, as an array."""
    given = np.asarray(values)
    return given.astype(float) if given.dtype.kind in "iuf" else np.vectorize(read,
                                                                              otypes=[float])(given.astype(object))
