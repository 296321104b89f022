"""Units in one place: which numbers of a result are in units of the drive, what they are in SI, and what people write
behind a number."""

import math
import re
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray

TURN = 2 * math.pi
# Unit at the end of a long_name -> the unit in SI, factor and power: one of it is factor * omega ** power there, for a
# drive of omega rad/s.
SI: dict[str, tuple[str, float, int]] = {
    "rad per drive radian": ("rad s-1", 1, 1), "drive radians": ("s", 1, -1), "drive periods": ("s", TURN, -1),
    "1 per drive period": ("s-1", 1 / TURN, 1), "drive frequencies": ("Hz", 1 / TURN, 1),
}
COUNTED = re.compile(r"(.*_)?period")  # variables that name a motion by its period, which stays a whole number
HERTZ = {"Hz": 1.0, "kHz": 1e3, "rpm": 1 / 60, "1/min": 1 / 60, "1/s": 1.0, "rad/s": 1 / TURN}
LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
# Attributes of a group that are values of its swept key.
OF_KEY = {"tangency": ("value", "error")}
FREQUENCIES = {"frequency": TURN, "pivot_frequency": 1.0}  # keys of the drive's frequency -> rad/s of a value


def in_units(dataset: xarray.Dataset, omega: float | None = None, degrees: bool = False) -> xarray.Dataset:
    """The dataset with numbers in other units, coordinates too. Their attribute `units` says which, and `drive_unit`
    what one unit of the drive (of an angle: one rad) is in them, where it is the same for all values.

    :param omega: angular frequency of the drive, rad/s: velocities come in rad/s, times in s, frequencies in Hz; None =
        they stay. Where the group is along or over frequencies of the drive, each value is of its own
    :param degrees: angles in degrees
    """
    changed, own = {}, None if omega is None else _own_frequency(dataset)
    for name, variable in dataset.variables.items():
        meaning, _, unit = str(variable.attrs.get("long_name", "")).rpartition(", in ")
        if unit in SI:
            if omega is None or COUNTED.fullmatch(str(name)):
                continue
            if own is not None and own.dims[0] not in variable.dims:
                continue
            units, factor, power = SI[unit]
            scale = factor * (omega if own is None else own) ** power
        elif degrees and variable.attrs.get("units") == "rad":
            units, scale, meaning = "degree", 180 / math.pi, str(variable.attrs.get("long_name", ""))
        else:
            continue
        values = (variable.to_base_variable() * scale).transpose(*variable.dims).values
        one = {"drive_unit": scale} if isinstance(scale, float) else {}
        changed[name] = (variable.dims, values, variable.attrs | {"units": units, "long_name": meaning} | one)
    coordinates = {name: value for name, value in changed.items() if name in dataset.coords}
    return dataset.assign({name: value for name, value in changed.items()
                           if name not in coordinates}).assign_coords(coordinates)


def _own_frequency(dataset: xarray.Dataset) -> xarray.Variable | None:
    """The angular frequency of the drive, rad/s, at each value of a swept frequency; None if the drive has one
    frequency."""
    for key, axis in (("parameter", "value"), ("x_parameter", "x"), ("y_parameter", "y")):
        if dataset.attrs.get(key) in FREQUENCIES and axis in dataset.variables:
            return dataset.variables[axis].to_base_variable() * FREQUENCIES[dataset.attrs[key]]
    return None


def in_written_units(dataset: xarray.Dataset, group: str, axes: Mapping[Any, str]) -> xarray.Dataset:
    """A group with the values of swept keys in the unit that its scene writes: mm rather than m.

    :param axes: its variables that are values of a key -> which key, as its attributes begin: "parameter", "x" or "y"
    """
    attributes, changed = dict(dataset.attrs), {}
    for key in {"parameter", "x", "y"}:
        if f"{key}_written_units" not in attributes:
            continue
        unit, scale = str(attributes[f"{key}_written_units"]), float(attributes[f"{key}_written_scale"])
        attributes[f"{key}_units"] = unit
        for name, variable in dataset.variables.items():
            if axes.get(name) == key:
                changed[name] = (variable.dims, variable.values / scale, variable.attrs | {"units": unit})
        if key == "parameter":
            attributes |= {name: attributes[name] / scale for name in OF_KEY.get(group, ()) if name in attributes}
    coordinates = {name: value for name, value in changed.items() if name in dataset.coords}
    rest = {name: value for name, value in changed.items() if name not in coordinates}
    return dataset.assign(rest).assign_coords(coordinates).assign_attrs(attributes)


def drive_unit(variable: xarray.DataArray) -> float:
    """What one unit of the drive is in the unit of a variable: 1 unless in_units has changed it."""
    return float(variable.attrs.get("drive_unit", 1.0))


def unit_text(variable: xarray.DataArray) -> str:
    """The unit of a variable as people write it: that of its attribute, or of the drive, which stands in its long name;
    "" of a number."""
    units, long_name = str(variable.attrs.get("units", "1")), str(variable.attrs.get("long_name", ""))
    if units == "1":
        return long_name.rpartition(", in ")[2] if ", in " in long_name else ""
    return {"rad s-1": "rad/s", "s-1": "1/s", "degree": "deg"}.get(units, units)


def with_unit(words: str, variable: xarray.DataArray) -> str:
    """Words with the unit of a variable behind them, for an axis or a bar: "settling time (s)"."""
    unit = unit_text(variable).removeprefix("1 ")
    return f"{words} ({unit})" if unit else words


def in_degrees(variable: xarray.DataArray) -> np.ndarray:
    """The values of an angle in degrees, whatever its unit is."""
    return np.degrees(variable.values / drive_unit(variable))


def note_bare(angles: Iterable[Any]) -> None:
    """Warns of the first angle without a unit that is large and round, so that degrees may be meant."""
    for value in angles:
        try:
            number = float(value)
        except (TypeError, ValueError):
            continue
        if abs(number) > 2 * TURN and (10 * number).is_integer():
            warnings.warn(f'an angle without a unit is in rad; write "{number:g} deg" for degrees', stacklevel=3)
            return


def angle(value: Any) -> float:
    """An angle in rad: a number, or a text such as "175 deg", "175°", "pi/2" or "3 pi/4". Large numbers are noted.

    :raises ValueError: if the text is none of these
    """
    note_bare([value])
    if not isinstance(value, str):
        return float(value)
    text = value.strip()
    if found := re.fullmatch(r"(.+?)\s*(?:deg|°)", text):
        return math.radians(_number(found[1], value, "an angle such as 3.1, 175 deg or pi/2"))
    if found := re.fullmatch(r"([+-]?)(\d*\.?\d*)[ *]*(?:pi|π)(?: */ *(\d+))?", text):
        return float(f"{found[1]}1") * float(found[2] or 1) * math.pi / int(found[3] or 1)
    return _number(text, value, "an angle such as 3.1, 175 deg or pi/2")


def velocity(value: Any, omega: float | None) -> float:
    """A velocity in rad per drive radian: a number, or a text such as "3 rad/s" or "90 deg/s" if `omega` (rad/s) is
    known.

    :raises ValueError: if the text is none of these
    """
    if not isinstance(value, str):
        return float(value)
    found = re.fullmatch(r"(.+?)\s*(rad|deg)/s", value.strip())
    if not found:
        return _number(value, value, "a velocity such as 0.2 (rad per drive radian) or 3 rad/s")
    if omega is None:
        raise ValueError(f"{value!r} is per second, but the scene is not in SI units")
    number = _number(found[1], value, "a velocity such as 3 rad/s")
    return (number if found[2] == "rad" else math.radians(number)) / omega


def quantity(value: Any, known: Mapping[str, float]) -> float:
    """A number, or a text with one of the known units behind it, in their common unit.

    :raises ValueError: if the text is neither
    """
    if not isinstance(value, str):
        return float(value)
    number, unit = parts_of(value) or (value, "")
    if unit and unit not in known:
        raise ValueError(f"{value!r} is in no known unit; the units are {', '.join(known)}")
    return _number(number, value, "a number, maybe with its unit") * known.get(unit, 1.0)


def parts_of(text: str) -> tuple[str, str] | None:
    """A number and the unit behind it, "" without one, of a text such as "20 cm" or "50Hz"; None if the text is no
    number."""
    found = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
    return (found[1], found[2]) if found else None


def _number(text: str, value: str, wanted: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{value!r} is not {wanted}") from None


def written_frequency(pendulum: Mapping[str, Any]) -> float | None:
    """The angular frequency (rad/s) that the mapping `pendulum` of a scene gives by frequency or pivot_frequency; None
    = neither."""
    for name, factor in (("pivot_frequency", 1 / TURN), ("frequency", 1.0)):
        text = str(pendulum.get(name, "")).strip()
        try:
            return quantity(text, HERTZ) * TURN * (1.0 if (parts_of(text) or ("", ""))[1] else factor)
        except ValueError:
            continue
    return None


def energy_unit(pendulum: Mapping[str, Any]) -> float | None:
    """I omega^2 in J, the unit of actions and torques, of a pendulum with a mass in SI units; None of others."""
    arm = pendulum.get("radius", pendulum.get("length", math.nan))
    inertia = pendulum.get("inertia", pendulum.get("mass", math.nan) * arm**2)
    unit = float(inertia) * float(pendulum.get("pivot_frequency", math.nan)) ** 2
    return unit if math.isfinite(unit) else None


def length_text(metres: float) -> str:
    """A length in the largest unit of which it is at least one: 20 cm."""
    unit = next((unit for unit, factor in LENGTHS.items() if abs(metres) >= factor * (1 - 1e-9)), "um")
    return f"{metres / LENGTHS[unit]:.6g} {unit}"


def si_parameters(pendulum: Mapping[str, Any]) -> dict[str, str]:
    """A pendulum in SI in a few words, by the keys of a scene: {"length": "length 20 cm", "frequency": "50 Hz",
    ...}."""
    words = {name: f"{name} {length_text(pendulum[name])}" for name in ("length", "radius") if name in pendulum}
    words["frequency"] = f"{pendulum['pivot_frequency'] / TURN:.6g} Hz"
    if "pivot_amplitude" in pendulum:
        words["amplitude"] = f"amplitude {1e3 * pendulum['pivot_amplitude']:.6g} mm"  # as the program's messages
    if math.isfinite(pendulum.get("quality_factor", math.nan)):
        words["quality_factor"] = f"Q = {pendulum['quality_factor']:.6g}"
    return words
