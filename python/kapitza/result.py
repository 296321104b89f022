"""The one reader of kapitza's result files (HDF5, netCDF-4 readable)."""

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray

from kapitza.reading import BadFile as BadFile
from kapitza.reading import File
from kapitza.table import attractors_table, ids_of, labels_array, measures_table, starts_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from kapitza.compare import Comparison
    from kapitza.engine import Engine
    from kapitza.probability import Agreement, Largest


class Result(File):
    """A complete result file of kapitza.

    `attributes` has the attributes of the file, `groups` the names of its groups, and `pendulum` the numbers of the
    pendulum. `summary` is what the run has printed; it is "" for a file that was opened by its name.

    :param path: name of the file
    :raises BadFile: if the file is not a complete result, or is damaged
    """

    def __repr__(self) -> str:
        from kapitza.representation import as_text
        return f"<kapitza.Result {self.path}>\n{as_text(self)}"

    def _repr_html_(self) -> str:
        from kapitza.representation import as_html
        return as_html(self)

    @cached_property
    def attractors(self) -> pandas.DataFrame:
        """A table with a row for each attractor, in the order of ids: name, period, winding, centre, mirror, fraction,
        multipliers, strobe points (lists) and so on."""
        return attractors_table(self.group("attractors"))

    @cached_property
    def measures(self) -> pandas.DataFrame:
        """The table of the study `measures`: a row for each attractor, with its name and a column for each measure.
        What belongs to the whole pendulum is the same in all rows; what has several numbers for an attractor is a
        list."""
        return measures_table(self.group("measures"))

    @property
    def names(self) -> list[str]:
        """The names of the attractors, in the order of ids. If two attractors have the same name, the id is added to
        each of them."""
        from kapitza.style import names_with_ids
        return names_with_ids(self.attractors["name"])

    def labels(self, *, si: bool = False, degrees: bool = False) -> xarray.DataArray:
        """The label of every start, with the dimensions velocity and theta: the id of its attractor, -1 = not settled.

        Attractors.jl calls this array `basins_of_attraction`.

        :param si: velocities in rad/s, of a scene in SI units
        :param degrees: angles in degrees
        """
        return labels_array(self.group("basin", si=si, degrees=degrees), self.group("attractors"))

    def at(self, theta: Any, velocity: Any) -> pandas.Series | pandas.DataFrame:
        """What the basin says of starts: for each the cell in which it lies. `kapitza.where` follows the start itself
        instead.

        :param theta: angles in rad from down, or texts such as "175 deg" and "pi/2"; whole turns are taken off
        :param velocity: velocities in rad per drive radian, or, for a scene in SI units, texts such as "3 rad/s"
        :return: for numbers a Series with theta and velocity (of the start; theta within the window), attractor (id; -1
            = not settled), name, settling_time (drive periods), evidence and, where the file has them, turns; for
            arrays, which are broadcast, a DataFrame with a row each
        :raises ValueError: if a start lies outside the window
        """
        return starts_table(self.group("basin"), self.names, theta, velocity, self.pivot_frequency)

    def basin(self, name: int | str) -> xarray.DataArray:
        """True for every start that ends on this attractor, with the dimensions velocity and theta.

        :param name: id or name of the attractor; a name may stand for several
        """
        labels = self.labels()
        return labels.isin(self.ids(name)).rename(f"basin of {name}")

    def ids(self, name: int | str) -> list[int]:
        """The ids of all attractors of a name. A name with its id, such as "inverted 3-nodding (2)", or an id gives
        this one attractor.

        :raises KeyError: if there is none
        """
        return ids_of(name, self.attractors["name"].tolist(), self.names)

    def basins_fractions(self) -> dict[int, float]:
        """A dict from the id of each attractor to its share of the starts; -1 = not settled."""
        values, counts = np.unique(self.labels().values, return_counts=True)
        return {int(value): float(count / counts.sum()) for value, count in zip(values, counts, strict=True)}

    def basin_entropy(self) -> tuple[float, float]:
        """The basin entropy, and the boundary basin entropy: the same for boxes with more than one label."""
        attributes = self.group("basin").attrs
        return float(attributes["basin_entropy"]), float(attributes["boundary_basin_entropy"])

    def uncertainty_exponent(self) -> tuple[float, float]:
        """The uncertainty exponent of the boundaries, and the standard error of the fitted line."""
        attributes = self.group("basin").attrs
        return float(attributes["uncertainty_exponent"]), float(attributes["uncertainty_exponent_stderr"])

    def convergence_times(self, *, si: bool = False, degrees: bool = False) -> xarray.DataArray:
        """The number of drive periods (with `si` the time in s) until a trapping region holds each start, with the
        dimensions velocity and theta."""
        return self.group("basin", si=si, degrees=degrees)["settling_time"]

    def probability(self, theta: Any, velocity: Any, spread: tuple[Any, Any], *, kind: str = "normal", starts: int = 0,
                    seed: int = 1) -> pandas.DataFrame:
        """How likely each end of a start is that is known up to a spread: a table with name, probability, low and high,
        likeliest first.

        From the basin of the file, low and high say how much the cells beside boundaries matter; what the window lacks
        is a row "outside the window". From fresh starts, each followed to its end, they are a 95 % interval.

        :param theta: angle in rad, or a text such as "175 deg"
        :param velocity: velocity in rad per drive radian, or, for a scene in SI units, a text such as "3 rad/s"
        :param spread: of the angle and of the velocity, in the same units
        :param kind: "normal": the spreads are standard deviations; "uniform": the starts lie evenly within them, to
            both sides
        :param starts: number of fresh random starts, at most 100,000; 0 = take the basin of the file
        :param seed: of the random starts
        """
        from kapitza.probability import probability
        return probability(self, theta, velocity, spread, kind, starts, seed)

    def share(self, name: str) -> xarray.DataArray:
        """The share of the starts that end on attractors of a name along a sweep, or in motions about a centre over a
        plane.

        Along a sweep it has the coordinates `low` and `high`, its 95 % interval (Wilson): `share.low`.

        :param name: name of branches, or a centre: "down", "inverted", "rotating", "neither"; a plane knows centres
            only
        :raises KeyError: if there is none
        """
        from kapitza.probability import share
        return share(self, name)

    def largest(self, name: str, share: float) -> "Largest":
        """The largest swept value at which at least this share of the starts ends on attractors of a name; NaN if there
        is none.

        :return: a named tuple `value, low, high`: `low` and `high` are the same of the lower and the upper ends of the
            shares' 95 % intervals
        """
        from kapitza.probability import largest
        return largest(self, name, share)

    @cached_property
    def _engine(self) -> "Engine":
        from kapitza.engine import Engine
        return Engine(self.scene, {"basin.theta.count": 2, "basin.velocity": {"min": -1, "max": 1, "count": 2}})

    @cached_property
    def _certainty(self) -> dict[str, float]:
        """Of the lists of an atlas; files of 0.4 do not say."""
        import h5py
        with h5py.File(self.path) as file:
            return {name: float(value) for name, value in file["atlas"].attrs.items() if name == "lacking_high"}

    def flutter(self) -> xarray.Dataset:
        """The flutter of a sweep with branches: `amplitude`, the largest angle from inverted over `value`, up to where
        it loses its mirror symmetry; NaN = not there.

        Attributes in the unit of the swept key: `onset`, the value of the period doubling from which it grows,
        `asymmetry`, where it loses its mirror symmetry, `end`, where the pair that follows doubles its period; NaN =
        not within the range. `slope` and `slope_stderr` are those of the line through amplitude^2 over the distance
        from the onset, `exponent` that of the amplitude at the onset, and `exponent_error` its change if all values are
        used instead of the nearer half.

        :raises KeyError: if the sweep has no branches
        """
        from kapitza.flutter import flutter
        return flutter(self.group("sweep", written=True))

    def motions(self, x: float, y: float, *, states: bool = True) -> pandas.DataFrame:
        """The motions that attract at any point of an atlas, of up to its `max_period` periods, in some milliseconds.

        Each cycle is carried to the point from the curve on which it is born, and solved for there: no start is
        followed.

        :param x: value of the key along the horizontal axis
        :param y: value of the key along the vertical axis
        :param states: with strobe points and multipliers; without them a point takes less than a millisecond
        :return: a row for each motion: name, period, winding, centre, symmetric, images (2: its mirror image attracts
            too), curve (number of the curve from which it was carried), multipliers (over its period), strobe_theta,
            strobe_velocity (lists; empty without `states`) The attribute `lacking_high` of the table is the
            probability, at most, that the list lacks a motion.
        :raises SceneError: outside of the plane, and where the list is not known: the curves contradict each other, so
            that one is missing
        """
        table = self._engine.motions(self.path, x, y, states=states)
        table.attrs |= self._certainty
        return table

    def line(self, *, x: float | None = None, y: float | None = None) -> pandas.DataFrame:
        """The branches of all cycles along a line through an atlas, attracting or not, of up to its `max_period`
        periods.

        :param x: value of the key along the horizontal axis, of a vertical line
        :param y: value of the key along the vertical axis, of a horizontal line, in place of x
        :return: a row for each point, in the order of the branch: branch (number), name, period, winding, centre,
            symmetric, images, value (of the key that varies), height (mean of the bob at the strobe points, -1 to 1),
            theta and velocity (of a strobe point), multiplier (the largest modulus over the period: below 1 the cycle
            attracts)
        :raises SceneError: outside of the plane
        """
        return self._engine.line(self.path, x=x, y=y)

    def agree(self, table: Any) -> "Agreement":
        """Compares measured releases with the basin.

        :param table: a pandas table, or the name of a CSV file, with the columns theta (or theta_deg), velocity (or
            velocity_rad_per_s) and end: the name of an attractor, or a centre such as "inverted"
        :raises ValueError: if the table lacks a column, names an unknown end, or has a start outside the window
        """
        from kapitza.probability import agreement
        return agreement(self, table)

    def plot(self, kind: str | None = None, *, ax: "Axes | None" = None, **options: Any) -> "Figure":
        """Draws a group of the file and returns the matplotlib Figure.

        :param kind: a kind of picture, such as "basin" or "orbit"; None = that of the main study of the file
        :param ax: axes of a figure of yours that take the picture, of one panel, without title; None = a page of its
            own
        :param options: options of `kapitza plot KIND`, such as `centre="inverted"`, `si=True` or `width="86mm"`;
            `colours` is the name of a file or a mapping such as `{"inverted": "gold"}`, `points` of a basin a table as
            `agree` takes it
        :raises ValueError: if the kind does not take an option or its value; the text lists what it takes
        """
        from kapitza.plots.picture import picture
        from kapitza.representation import main_kind
        return picture(self, kind or main_kind(self), ax, **options)

    def report(self, output: str | os.PathLike[str] | None = None) -> Path:
        """Writes a self-contained HTML page on the result and returns its path.

        :param output: name of the page; None = the name of the result with .html
        """
        from kapitza.report.page import report
        path = Path(output) if output is not None else self.path.with_suffix(".html")
        path.write_bytes(report(self).encode("utf-8", "replace"))
        return path

    def compare(self, other: "Result | str | os.PathLike[str]") -> "Comparison":
        """Compares the basins of this result with those of another one, whose attractors are matched by their strobe
        points."""
        from kapitza.compare import Comparison
        return Comparison(self, other if isinstance(other, Result) else Result(other))
