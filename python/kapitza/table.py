"""The attractors of a result as a table, and the labels of its basin as an array with its flags; the table of
measures."""

import re
from typing import Any

import numpy as np
import pandas
import xarray

from kapitza import units
from kapitza.units import TURN

CENTRES = ("down", "inverted", "rotating", "neither")  # codes of the variable centre
OPTIONS = {"starts", "cells", "shock_scale", "shock_tolerance"}  # attributes of the group measures that are no measures
PLAIN = ("amplitude", "mean_velocity", "lyapunov", "lyapunov_error", "fraction")  # columns that a file may lack


def attractors_table(attractors: xarray.Dataset) -> pandas.DataFrame:
    """A row each, by id: name, period (0: it never closes), winding, centre, symmetric, mirror (id), amplitude (rad),
    mean_velocity, lyapunov and its error (per drive period), fraction (share of the grid), multipliers (complex),
    strobe_theta (rad) and strobe_velocity (lists)."""
    count = attractors.sizes["attractor"]
    columns: dict[str, object] = {"name": [str(name) for name in attractors["name"].values],
                                  "period": attractors["period"].values, "winding": attractors["winding"].values,
                                  "centre": [CENTRES[int(code)] for code in attractors["centre"].values]}
    if "symmetric" in attractors:
        columns["symmetric"] = attractors["symmetric"].values.astype(bool)
    columns["mirror"] = attractors["mirror"].values
    columns |= {name: attractors[name].values for name in PLAIN if name in attractors}
    if "multiplier_re" in attractors:
        pairs = attractors["multiplier_re"].values + 1j * attractors["multiplier_im"].values
        columns["multipliers"] = [[complex(value) for value in row if np.isfinite(value)] for row in pairs]
    for name in ("strobe_theta", "strobe_velocity"):
        rows = attractors[name].values
        columns[name] = [[float(value) for value in rows[index] if np.isfinite(value)] for index in range(count)]
    return pandas.DataFrame(columns, index=pandas.RangeIndex(count, name="attractor"))


def measures_table(measures: xarray.Dataset) -> pandas.DataFrame:
    """A row each: name, period, winding, centre, and the measures; those over a second dimension as lists."""
    columns: dict[str, object] = {"name": [str(name) for name in measures["name"].values]}
    for name, values in measures.data_vars.items():
        if name not in columns and values.dims[:1] == ("attractor",):
            columns[str(name)] = values.values if values.ndim == 1 else values.values.tolist()
    columns["centre"] = [CENTRES[int(code)] for code in measures["centre"].values]
    columns |= {name: value for name, value in measures.attrs.items() if name not in OPTIONS}
    return pandas.DataFrame(columns, index=pandas.RangeIndex(measures.sizes["attractor"], name="attractor"))


def ids_of(name: int | str, plain: list[str], full: list[str]) -> list[int]:
    """The ids of all attractors of a name.

    :param plain: the name of each attractor
    :param full: the same, with the id where two attractors have the same name
    :raises KeyError: if there is none
    """
    found = [index for index, names in enumerate(zip(plain, full, strict=True)) if name in (*names, index)]
    if not found:
        raise KeyError(f"no attractor has the name {name!r}; the names are {', '.join(full)}")
    return found


def flag_words(names: list[str]) -> list[str]:
    """The names as words of a CF flag_meanings: rotation_+1_in_2, inverted_3-nodding_2 (with its id where two have one
    name)."""
    words = [re.sub(r"[^A-Za-z0-9_.+@-]", "_", name.replace("/", "_in_")) for name in names]
    return [f"{word}_{index}" if words.count(word) > 1 else word for index, word in enumerate(words)]


def labels_array(basin: xarray.Dataset, attractors: xarray.Dataset) -> xarray.DataArray:
    """The labels over velocity and theta; attributes flag_values and flag_meanings say which number is which
    attractor."""
    labels = basin["attractor"].copy()
    names = [str(name) for name in attractors["name"].values]
    labels.attrs["flag_values"] = np.arange(-1, len(names), dtype=labels.dtype)
    labels.attrs["flag_meanings"] = " ".join(["not_settled", *flag_words(names)])
    return labels.rename("labels")


def flag_word(variable: xarray.DataArray, code: int) -> str:
    """What a code of a variable means, by its flag_values and flag_meanings."""
    values, words = np.ravel(variable.attrs["flag_values"]).tolist(), str(variable.attrs["flag_meanings"]).split()
    return str(words[values.index(code)]).replace("_", " ")


def edges_of(basin: xarray.Dataset, name: str) -> tuple[float, float]:
    """The edges of the window along theta or velocity, in the units of its cells' centres.

    :raises ValueError: if the window is too narrow for doubles, or has a single cell there
    """
    centres = basin[name].values
    if f"{name}_offset" in basin:
        raise ValueError("the window is given by a centre of many digits, which numbers cannot find; kapitza.where "
                         "follows such starts")
    if len(centres) < 2:
        raise ValueError(f"the basin has a single {name}, whose cell has no width in the file")
    half = (centres[-1] - centres[0]) / (len(centres) - 1) / 2
    return float(centres[0] - half), float(centres[-1] + half)


def cells_of(basin: xarray.Dataset, theta: np.ndarray,
             velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Starts (rad, rad per drive radian; of one shape) as (theta within the window, row and column of their cells).

    :raises ValueError: if one lies outside the window
    """
    (left, right), (low, high) = edges_of(basin, "theta"), edges_of(basin, "velocity")
    slack = 1e-9 * (right - left)  # edges are computed from centres
    theta = theta - TURN * np.floor((theta - left + slack) / TURN)
    outside = ~((theta <= right + slack) & (np.abs(velocity - (low + high) / 2) <= (high - low) / 2 * (1 + 1e-9)))
    if outside.any():
        first = int(np.argmax(outside.ravel()))
        start = f"theta = {theta.ravel()[first]:.9g} rad, velocity = {velocity.ravel()[first]:.9g}"
        raise ValueError(f"the start {start} lies outside the window: "
                         f"theta from {left:.9g} to {right:.9g}, velocity from {low:.9g} to {high:.9g} rad per drive "
                         "radian")
    rows, columns = (np.clip(((place - first) / (last - first) * basin.sizes[name]).astype(int), 0,
                             basin.sizes[name] - 1)
                     for place, first, last, name in ((velocity, low, high, "velocity"), (theta, left, right, "theta")))
    return theta, rows, columns


def starts_table(basin: xarray.Dataset, names: list[str], theta: Any, velocity: Any,
                 frequency: float | None) -> pandas.DataFrame | pandas.Series:
    """What the cells of starts say, as `Result.at` returns it. `frequency`: of the pivot, rad/s, for velocities with a
    unit."""
    named = {-1: "not settled", **dict(enumerate(names))}
    pairs = np.broadcast(np.asarray(theta, dtype=object), np.asarray(velocity, dtype=object))
    starts = [(units.angle(one), units.velocity(other, frequency)) for one, other in pairs]
    angles, speeds = np.array(starts).reshape(-1, 2).T
    angles, rows, columns = cells_of(basin, angles, speeds)
    labels = basin["attractor"].values[rows, columns]
    table = pandas.DataFrame({"theta": angles, "velocity": speeds, "attractor": labels,
                              "name": [named[int(label)] for label in labels],
                              "settling_time": basin["settling_time"].values[rows, columns],
                              "evidence": [flag_word(basin["evidence"], code)
                                           for code in basin["evidence"].values[rows, columns]]})
    if "turns" in basin:
        table["turns"] = pandas.array(basin["turns"].values[rows, columns], dtype="Int64")
    return table if pairs.shape else table.iloc[0]
