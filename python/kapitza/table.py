"""The attractors of a result as a table, and the labels of its basin as an array with its flags."""

import re

import numpy as np
import pandas
import xarray

CENTRES = ("down", "inverted", "rotating", "neither")  # codes of the variable centre
PLAIN = ("amplitude", "lyapunov", "lyapunov_error", "fraction")  # columns that a file may lack


def attractors_table(attractors: xarray.Dataset) -> pandas.DataFrame:
    """A row each, by id: name, period (0: chaotic), winding, centre, symmetric, mirror (id), amplitude (rad), lyapunov and its error (per
    drive period), fraction (share of the grid), multipliers (complex), strobe_theta (rad) and strobe_velocity (lists)."""
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


def flag_words(names: list[str]) -> list[str]:
    """The names as words of a CF flag_meanings: rotation_+1_in_2, inverted_3-nodding_2 (with its id where two have one name)."""
    words = [re.sub(r"[^A-Za-z0-9_.+@-]", "_", name.replace("/", "_in_")) for name in names]
    return [f"{word}_{index}" if words.count(word) > 1 else word for index, word in enumerate(words)]


def labels_array(basin: xarray.Dataset, attractors: xarray.Dataset) -> xarray.DataArray:
    """The labels over velocity and theta; attributes flag_values and flag_meanings say which number is which attractor."""
    labels = basin["attractor"].copy()
    names = [str(name) for name in attractors["name"].values]
    labels.attrs["flag_values"] = np.arange(-1, len(names), dtype=labels.dtype)
    labels.attrs["flag_meanings"] = " ".join(["not_settled", *flag_words(names)])
    return labels.rename("labels")
