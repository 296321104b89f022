"""Labels and basins of a pendulum as datasets, and their accessor `.kapitza`."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
import xarray

from kapitza import layout
from kapitza.library import NO_TURNS, Library
from kapitza.table import attractors_table, flag_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ABOUT = {"theta": ("rad", "angle from down"), "velocity": ("1", "angular velocity, rad per drive radian"),
          "settling_time": ("6.283185307179586", "time after which it is certain where the start ends"),
          "error": ("rad", "bound of the orbit's error when it was trapped")}


def labelled(variables: Mapping[str, Any], attractors: xarray.Dataset) -> xarray.Dataset:
    """Labels with the attractors to which they refer; their attributes say what the numbers mean (CF)."""
    found = xarray.Dataset(dict(variables)).merge(attractors.assign_coords(id=np.arange(attractors.sizes["id"])))
    for name in ("attractor", "other_attractor"):
        found[name].attrs = {"flag_values": np.arange(-1, attractors.sizes["id"], dtype=np.int16),
                             "flag_meanings": " ".join([
                                 "not_settled", *flag_words([str(name) for name in attractors["name"].values])])}
    found["evidence"].attrs = layout.attributes("basin", "evidence")
    for name, (unit, words) in _ABOUT.items():
        if name in found.variables:
            found[name].attrs |= {"units": unit, "long_name": words}
    if found["turns"].dtype.kind == "i":
        found["turns"].attrs["missing_value"] = np.int32(NO_TURNS)
    return found


def of_basin(library: Library, basin: Any) -> xarray.Dataset:
    """A kapitza_basin."""
    shape = (basin.rows, basin.columns)
    kinds = {"attractor": ("attractor", np.int16), "settling_time": ("settling_time", np.float32),
             "evidence": ("evidence", np.uint8), "other_attractor": ("other", np.int16), "turns": ("turns", np.float32)}
    planes = {name: library.array(getattr(basin, field), shape[0] * shape[1], kind).reshape(shape)
              for name, (field, kind) in kinds.items()}
    axes = {"velocity": library.array(basin.velocity, shape[0], float),
            "theta": library.array(basin.theta, shape[1], float)}
    variables = {name: (("velocity", "theta"), plane) for name, plane in planes.items()}
    attractors = library._cycles(basin.attractors[0], "id")
    return labelled({name: (name, values) for name, values in axes.items()} | variables, attractors)


@xarray.register_dataset_accessor("kapitza")
class Accessor:
    """What a dataset of `Pendulum.basin` or `Pendulum.where` can do: `.plot()`, `.attractors`, `.fractions()`."""

    def __init__(self, dataset: xarray.Dataset) -> None:
        self._dataset = dataset

    def _attractors(self) -> xarray.Dataset:
        own = self._dataset
        return own[[name for name in own.data_vars if "id" in own[name].dims]].drop_vars("id").rename(id="attractor")

    @property
    def attractors(self) -> pandas.DataFrame:
        """The attractors to which the labels refer, a row each by id."""
        return attractors_table(self._attractors())

    def fractions(self) -> pandas.Series:
        """The share of the starts that end on each attractor, by name; "not settled" last."""
        labels = self._dataset["attractor"].values
        names = [*self._attractors()["name"].values, "not settled"]
        counts = np.bincount(np.where(labels < 0, len(names) - 1, labels).ravel(), minlength=len(names))
        return pandas.Series(counts / labels.size, index=names, name="fraction")

    def plot(self, ax: "Axes | None" = None, *, quantity: str = "attractor", colours: Sequence[str] | Mapping[str, str]
             | None = None, centre: str = "down", legend: bool = True, **options: Any) -> "Axes":
        """Draws a basin.

        >>> kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).basin().kapitza.plot(colours={"inverted": "gold"})

        :param ax: the Axes; None = a new one
        :param quantity: "attractor", "settling_time" or "evidence"
        :param colours: one for each attractor, or some by their names
        :param centre: the state in the middle of a whole circle, "down" or "inverted"
        :param options: of kapitza.plots.basin.draw_basins, such as `dots=False`
        """
        from matplotlib import pyplot

        from kapitza import style
        from kapitza.plots import basin
        axes = ax if ax is not None else pyplot.subplots(layout="constrained")[1]
        own, attractors = self._dataset.drop_vars("id"), self._attractors()
        if quantity == "settling_time":
            return basin.draw_settling_time(axes, own, centre=centre, legend=legend, **options)
        if quantity == "evidence":
            return basin.draw_evidence(axes, own, centre=centre, legend=legend, **options)
        if isinstance(colours, Mapping):
            names = attractors["name"].values
            colours = [colours.get(name, plain) for name, plain in zip(names, style.colours(attractors), strict=True)]
        return basin.draw_basins(axes, own, attractors, colours=colours, centre=centre, legend=legend, **options)
