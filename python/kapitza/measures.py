"""The group measures as words and values that people read."""

from typing import Any

import numpy as np
import xarray

from kapitza.table import OPTIONS
from kapitza.units import unit_text


def measures_of(measures: xarray.Dataset) -> list[str]:
    """The measures of each attractor with one number; the ends of intervals are left out."""
    known = {"name", "period", "winding", "centre", "theta", "velocity"}
    return [str(name) for name, values in measures.data_vars.items()
            if values.dims[:1] == ("attractor",) and name not in known and not str(name).endswith(("_low", "_high"))]


def value_text(measures: xarray.Dataset, name: str, row: int) -> str:
    """A value, with its interval and unit; of several sizes or other attractors one after another; a dash where it has
    none."""
    values = np.atleast_1d(measures[name].values[row])
    text = ", ".join(_number(value) for value in values)
    if f"{name}_low" in measures and np.isfinite(values).all():
        text += f" ({_number(measures[f'{name}_low'].values[row])} to {_number(measures[f'{name}_high'].values[row])})"
    units = unit_text(measures[name])
    return text + (f" {units}" if units and np.isfinite(values).any() else "")


def _number(value: Any) -> str:
    return f"{float(value):.4g}".replace("-", "−") if np.isfinite(value) else "–"


def of_pendulum(measures: xarray.Dataset) -> dict[str, str]:
    """The measures of the whole pendulum."""
    return {str(name): _number(value) for name, value in measures.attrs.items() if name not in OPTIONS}


def rows_of(measures: xarray.Dataset, row: int) -> list[tuple[str, str]]:
    """All measures of an attractor, then those of the pendulum: words and values. Pairs with other attractors are left
    out."""
    names = [name for name in measures_of(measures) if "other" not in measures[name].dims]
    rows = [(name.replace("_", " "), value_text(measures, name, row)) for name in names]
    return rows + [(name.replace("_", " "), text) for name, text in of_pendulum(measures).items()]
