"""Units in one place: which numbers of a result are in units of the drive, what they are in SI, and what people write behind a number."""

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray
import yaml

TURN = 2 * math.pi
# What a long_name says behind its last ", in " -> the unit in SI, and what one of it is there for a drive of 1 rad/s and of omega rad/s:
# factor * omega ** power.
SI: dict[str, tuple[str, float, int]] = {
    "rad per drive radian": ("rad s-1", 1, 1), "drive radians": ("s", 1, -1), "drive periods": ("s", TURN, -1),
    "1 per drive period": ("s-1", 1 / TURN, 1), "drive frequencies": ("Hz", 1 / TURN, 1),
}
COUNTED = re.compile(r"(.*_)?period")  # variables that name a motion by its period, which stays a whole number
HERTZ = {"Hz": 1.0, "kHz": 1e3, "rpm": 1 / 60, "1/min": 1 / 60, "1/s": 1.0, "rad/s": 1 / TURN}
LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
WRITTEN = {"m": LENGTHS | {"in": 0.0254}, "Hz": HERTZ, "s": {"ms": 1e-3, "min": 60.0}, "kg": {"g": 1e-3, "mg": 1e-6},
           "rad": {"deg": math.pi / 180, "°": math.pi / 180}}
OF_KEY = ("value", "branch_start", "branch_end")  # variables of a sweep that are values of its key


def in_units(dataset: xarray.Dataset, omega: float | None = None, degrees: bool = False) -> xarray.Dataset:
    """The dataset with numbers in other units, coordinates too. Their attribute `units` says which, and `drive_unit` what one unit of the
    drive (of an angle: one rad) is in them.

    :param omega: angular frequency of the drive, rad/s: velocities come in rad/s, times in s, frequencies in Hz; None = they stay
    :param degrees: angles in degrees
    """
    changed = {}
    for name, variable in dataset.variables.items():
        meaning, _, unit = str(variable.attrs.get("long_name", "")).rpartition(", in ")
        if unit in SI:
            if omega is None or COUNTED.fullmatch(str(name)):
                continue
            units, factor, power = SI[unit]
            factor *= omega**power
        elif degrees and variable.attrs.get("units") == "rad":
            units, factor, meaning = "degree", 180 / math.pi, str(variable.attrs.get("long_name", ""))
        else:
            continue
        attributes = variable.attrs | {"units": units, "long_name": meaning, "drive_unit": factor}
        changed[name] = (variable.dims, variable.values * factor, attributes)
    coordinates = {name: value for name, value in changed.items() if name in dataset.coords}
    return dataset.assign({name: value for name, value in changed.items() if name not in coordinates}).assign_coords(coordinates)


def written_units(sweep: xarray.Dataset, scene: str) -> xarray.Dataset:
    """A sweep with the values of its key in the unit in which the scene has them: mm rather than m."""
    try:
        plan = yaml.load(scene, yaml.BaseLoader)["sweep"]
        unit = re.sub(r"^[-+.\d]+([eE][-+]?\d+)?\s*", "", str(plan["min"]).strip())
    except (KeyError, TypeError, yaml.YAMLError):
        return sweep
    factor = WRITTEN.get(str(sweep["value"].attrs.get("units")), {}).get(unit)
    if factor is None:
        return sweep
    known = [sweep[name] for name in OF_KEY if name in sweep]
    changed = {variable.name: (variable.dims, variable.values / factor, variable.attrs | {"units": unit}) for variable in known}
    powers = {"critical_value": -1, "fit_slope": 1, "fit_slope_stderr": 1}
    attributes = {name: value * factor ** powers[str(name)] if name in powers else value for name, value in sweep.attrs.items()}
    value = changed.pop("value")
    return sweep.assign(changed).assign_coords(value=value).assign_attrs(attributes)


def drive_unit(variable: xarray.DataArray) -> float:
    """What one unit of the drive is in the unit of a variable: 1 unless in_units has changed it."""
    return float(variable.attrs.get("drive_unit", 1.0))


def in_degrees(variable: xarray.DataArray) -> np.ndarray:
    """The values of an angle in degrees, whatever its unit is."""
    return np.degrees(variable.values / drive_unit(variable))


def angle(value: Any) -> float:
    """An angle in rad: a number, or a text such as "175 deg", "175°", "pi/2" or "3 pi/4".

    :raises ValueError: if the text is none of these
    """
    if not isinstance(value, str):
        return float(value)
    text = value.strip()
    if found := re.fullmatch(r"(.+?)\s*(?:deg|°)", text):
        return math.radians(_number(found[1], value, "an angle such as 3.1, 175 deg or pi/2"))
    if found := re.fullmatch(r"([+-]?)(\d*\.?\d*)[ *]*(?:pi|π)(?: */ *(\d+))?", text):
        return float(f"{found[1]}1") * float(found[2] or 1) * math.pi / int(found[3] or 1)
    return _number(text, value, "an angle such as 3.1, 175 deg or pi/2")


def velocity(value: Any, omega: float | None) -> float:
    """A velocity in rad per drive radian: a number, or a text such as "3 rad/s" or "90 deg/s" if `omega` (rad/s) is known.

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
    number, _, unit = value.strip().partition(" ")
    if unit.strip() and unit.strip() not in known:
        raise ValueError(f"{value!r} is in no known unit; the units are {', '.join(known)}")
    return _number(number, value, "a number, maybe with its unit") * known.get(unit.strip(), 1.0)


def _number(text: str, value: str, wanted: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{value!r} is not {wanted}") from None


def written_frequency(pendulum: Mapping[str, Any]) -> float | None:
    """The angular frequency (rad/s) that the mapping `pendulum` of a scene gives by frequency or pivot_frequency; None = neither."""
    for name, factor in (("pivot_frequency", 1 / TURN), ("frequency", 1.0)):
        text = str(pendulum.get(name, "")).strip()
        try:
            return quantity(text, HERTZ) * TURN * (factor if " " not in text else 1.0)
        except ValueError:
            continue
    return None


def length_text(metres: float) -> str:
    """A length in the largest unit of which it is at least one: 20 cm."""
    unit = next((unit for unit, factor in LENGTHS.items() if abs(metres) >= factor * (1 - 1e-9)), "um")
    return f"{metres / LENGTHS[unit]:.6g} {unit}"


def si_parameters(pendulum: Mapping[str, Any]) -> dict[str, str]:
    """A pendulum in SI in a few words, by the keys of a scene: {"length": "length 20 cm", "frequency": "50 Hz", ...}."""
    words = {name: f"{name} {length_text(pendulum[name])}" for name in ("length", "radius") if name in pendulum}
    words["frequency"] = f"{pendulum['pivot_frequency'] / TURN:.6g} Hz"
    if "pivot_amplitude" in pendulum:
        words["amplitude"] = f"amplitude {1e3 * pendulum['pivot_amplitude']:.6g} mm"  # as the program's messages
    if math.isfinite(pendulum.get("quality_factor", math.nan)):
        words["quality_factor"] = f"Q = {pendulum['quality_factor']:.6g}"
    return words
