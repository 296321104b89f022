"""What a group of a result file must hold before it is drawn, and what its values may be; all else is refused in
words."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray

# Every variable of the file, (group, name) -> what `kapitza keys --layout` prints of it.
VARIABLES: dict[tuple[str, str], dict[str, Any]] = {
    (row["group"], row["name"]): row for file in ("layout.jsonl", "boundaries/layout.jsonl")
    for row in map(json.loads, (Path(__file__).parent / file).read_text().splitlines())}

# Groups that Python adds to a file.
ADDED = {"manifolds", "tangency", "wada"}


class Part(NamedTuple):
    """Variables and attributes that are of use only together."""

    variables: tuple[str, ...]
    attributes: tuple[str, ...] = ()


def _part(names: str, attributes: str = "") -> Part:
    return Part(tuple(names.split()), tuple(attributes.split()))


# Without these a group is of no use to any picture; the study that writes a group adds its row here.
NEEDED = {
    "atlas": _part(
        "curve_kind curve_period curve_winding curve_centre curve_name curve_first curve_points x y supercritical "
                   "special_x special_y special_kind class_name class_period class_winding class_symmetric row column "
                   "attracting "
                   "count list region_x region_y region_share region_radius", "x_parameter y_parameter max_period"),
    "attractors": _part("period winding centre name mirror strobe_theta strobe_velocity"),
    "orbit": _part("time theta velocity pivot strobe_time strobe_theta strobe_velocity maximum_time maximum_angle "
                   "line_frequency line_amplitude line_phase", "closed centre period winding"),
    "stability": _part("k m log_multiplier angle stable"),
    "potential": _part("theta drive_amplitude rim_exact energy energy_blackburn energy_simple"),
    "escape": _part("from saddle barrier way_out path time theta velocity torque"),
    "tradeoff": _part(
        "label method scheme interpolation wrong wrong_low wrong_high seconds seconds_per_million_cells pareto",
                      "floor samples"),
    "basin": _part("theta velocity attractor settling_time evidence"),
    "line": _part("value name period winding centre", "parameter"),
    "plane": _part("x y", "x_parameter y_parameter"),
    "manifolds": _part("theta velocity arc_length saddle branch kind polyline"),
    "saddles": _part("period winding name index strobe_theta strobe_velocity multiplier_re multiplier_im"),
    "sweep": _part("value", "parameter"),
    "tangency": _part("strobe theta velocity", "value error parameter crossing"),
    "wada": _part("theta velocity arc_length periods followed basins wada pair_cycles pair_shared"),
}
_BRANCHES = ("branch_start branch_end branch_start_kind branch_end_kind branch_name branch_period branch_winding "
             "branch_centre branch_mirror")
# Parts that a group may hold, then whole: a part is there if its first variable is.
OPTIONAL = {
    "plane": [_part("end start_theta start_velocity end_period end_winding end_centre exponent settling_time"),
              _part("name period winding centre points")],
    "sweep": [
        _part(f"fraction fraction_low fraction_high {_BRANCHES}"),
        _part("alike alike_low alike_high", "phases"),
        _part(_BRANCHES),
        _part("release_stays release release_angle release_angle_largest release_angle_scan"),
        _part("strobe_theta sample_walk"),
    ],
}
# Never below 0; one of them is -1 where it is not known.
NOT_KNOWN = "list"
COUNTS = {"period", "settling_time", "branch_period", "class_period", "curve_period", "curve_first", "curve_points",
          "list", "end_period"}
GRIDS = {"theta", "velocity", "time", "k", "m", "value", "release", "x", "y", "row", "column"}  # axes that go up
# Attributes that are text; others are numbers
WORDS = {"parameter", "crossing", "parameter_units", "x_parameter", "y_parameter"}
WITH_PENDULUM = {"basin", "orbit", "potential", "tradeoff"}  # groups whose pictures name its parameters
# Where they are given
NUMBERS = {"quality_factor", "damping", *(f"tongue_{tongue}_lowest_{axis}" for tongue in (1, 2) for axis in "km")}


def axes_of(group: str) -> dict[str, str]:
    """The variables of a group that are values of a swept key -> which one, as its attributes begin: "parameter", "x"
    or "y"."""
    return {name: row["units"][1:].removesuffix("_units") for (of, name), row in VARIABLES.items()
            if of == group and row["units"].startswith("@")}


def attributes(group: str, variable: str) -> dict[str, Any]:
    """Those that a variable has in a file (CF)."""
    row = VARIABLES[group, variable]
    if not row["flags"]:
        return {"units": row["units"], "long_name": row["long_name"]}
    return {"long_name": row["long_name"], "flag_values": np.arange(len(row["flags"]), dtype=row["type"]),
            "flag_meanings": " ".join(flag.replace(" ", "_") for flag in row["flags"])}


def described(group: str, dataset: xarray.Dataset) -> xarray.Dataset:
    """A dataset made in Python with the dimensions' numbers, and the types and attributes that its group has in a
    file."""
    dataset = dataset.assign_coords({name: np.arange(size) for name, size in dataset.sizes.items()
                                     if name not in dataset.coords})
    for name in map(str, dataset.variables):
        dataset[name] = dataset[name].astype(VARIABLES[group, name]["type"]).assign_attrs(attributes(group, name))
    return dataset


def wrong_shape(dataset: xarray.Dataset, group: str) -> str | None:
    """What the group lacks, or has in another shape or type; None = nothing."""
    optional = [part for part in OPTIONAL.get(group, []) if next(iter(part.variables)) in dataset]
    for part in [*([NEEDED[group]] if group in NEEDED else []), *optional]:
        lacking = [variable for variable in part.variables if variable not in dataset]
        lacking += [attribute for attribute in part.attributes if attribute not in dataset.attrs]
        if lacking:
            return f"incomplete, the group {group} lacks {', '.join(lacking)}"
        for variable in part.variables:
            dimensions = VARIABLES[group, variable]["dimensions"]
            if dataset[variable].dims != tuple(dimensions):
                return f"{group}/{variable} is not over {' and '.join(dimensions)}"
        for attribute in {*part.attributes, *NUMBERS & dataset.attrs.keys()}:
            if not isinstance(dataset.attrs[attribute], str if attribute in WORDS else int | float | np.number):
                return f"the attribute {attribute} of {group} is of another type"
    return None


def wrong_values(dataset: xarray.Dataset, group: str) -> str | None:
    """What is wrong with the values of the first variable at fault; None = nothing that is known."""
    return next(filter(None, (_fault(dataset, group, str(variable)) for variable in dataset.variables)), None)


def _fault(dataset: xarray.Dataset, group: str, name: str) -> str | None:
    values, row = dataset[name].values, VARIABLES.get((group, name), {"type": "", "flags": []})
    code = bool(row["flags"]) or name in COUNTS
    if (values.dtype.kind not in "OSU") if row["type"] == "text" else values.dtype.kind not in ("iu"
                                                                                                if code else "iuf"):
        return f"{name} is of another type"
    least = -1 if name == NOT_KNOWN else 0
    if code and values.size and not least <= values.min() <= values.max() <= (len(row["flags"]) - 1 if row["flags"]
                                                                              else np.inf):
        return f"{name} has values that mean nothing"
    if name in dataset.dims and values.dtype.kind == "f" and not np.isfinite(values).all():
        return f"{name} is an axis with values that are not finite"
    if name in dataset.dims and name in GRIDS:
        # Offsets tell cells apart where doubles near their centres do not
        values = dataset.get(f"{name}_offset", dataset[name]).values
    if name in dataset.dims and name in GRIDS and not (np.diff(values) > 0).all():
        return f"{name} is an axis that does not go up"
    return None
