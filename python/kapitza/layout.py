"""What a group of a result file must hold before it is drawn, and what its values may be; all else is refused in words."""

from typing import NamedTuple

import numpy as np
import xarray


class Part(NamedTuple):
    """Variables with their dimensions, and attributes, that are of use only together."""

    variables: dict[str, str]
    attributes: tuple[str, ...] = ()


def _over(dimensions: str, *names: str) -> dict[str, str]:
    return dict.fromkeys(names, dimensions)


# Without these a group is of no use to any picture; the study that writes a group adds its row here.
NEEDED = {
    "atlas": Part(_over("curve", "curve_kind", "curve_period", "curve_winding", "curve_centre", "curve_name", "curve_first", "curve_points")
                  | _over("point", "x", "y", "supercritical") | _over("special", "special_x", "special_y", "special_kind")
                  | _over("class", "class_name", "class_period", "class_winding", "class_symmetric")
                  | {"row": "row", "column": "column", "attracting": "class row column"} | _over("row column", "count", "list")
                  | _over("region", "region_x", "region_y", "region_share", "region_radius"),
                  ("x_parameter", "y_parameter", "max_period")),
    "attractors": Part(_over("attractor", "period", "winding", "centre", "name", "mirror")
                       | _over("attractor phase", "strobe_theta", "strobe_velocity")),
    "orbit": Part(_over("time", "time", "theta", "velocity", "pivot")
                  | _over("strobe_time", "strobe_time", "strobe_theta", "strobe_velocity")
                  | _over("maximum_time", "maximum_time", "maximum_angle")
                  | _over("line_frequency", "line_frequency", "line_amplitude", "line_phase"), ("closed", "centre", "period", "winding")),
    "stability": Part({"k": "k", "m": "m"} | _over("m k", "log_multiplier", "angle", "stable")),
    "potential": Part({"theta": "theta"} | _over("drive_amplitude", "drive_amplitude", "rim_exact")
                      | _over("drive_amplitude theta", "energy", "energy_blackburn", "energy_simple")),
    "tradeoff": Part(_over("setting", "label", "method", "scheme", "interpolation", "wrong", "wrong_low", "wrong_high",
                           "seconds", "seconds_per_million_cells", "pareto"), ("floor", "samples")),
    "basin": Part({"theta": "theta", "velocity": "velocity"} | _over("velocity theta", "attractor", "settling_time", "evidence")),
    "chart": Part({"x": "x", "y": "y"} | _over("start", "start_theta", "start_velocity")
                  | _over("start y x", "period", "winding", "centre", "end", "exponent", "settling_time"), ("x_parameter", "y_parameter")),
    "manifolds": Part(_over("point", "theta", "velocity", "arc_length", "saddle", "branch", "kind", "polyline")),
    "saddles": Part(_over("saddle", "period", "winding", "name", "index") | _over("saddle phase", "strobe_theta", "strobe_velocity")
                    | _over("saddle pair", "multiplier_re", "multiplier_im")),
    "sweep": Part({"value": "value"}, ("parameter",)),
}
_BRANCHES = _over("branch", "branch_start", "branch_end", "branch_start_kind", "branch_end_kind", "branch_name", "branch_period",
                  "branch_winding", "branch_centre", "branch_mirror")
# What a group may hold, and then whole: a part is there if its first variable is.
OPTIONAL = {
    "sweep": [
        Part(_over("value branch", "fraction", "fraction_low", "fraction_high") | _BRANCHES),
        Part(_over("value", "alike", "alike_low", "alike_high"), ("phases",)),
        Part(_BRANCHES),
        Part({"flutter_amplitude": "value"},
             ("critical_value", "fit_slope", "fit_slope_stderr", "fit_exponent", "fit_exponent_error")),
        Part(_over("value", "flutter_onset", "flutter_asymmetry", "flutter_end", "flutter_release_end")),
        Part({"release_stays": "value release", "release": "release"}
             | _over("value", "release_angle", "release_angle_largest", "release_angle_scan")),
        Part({"strobe_theta": "value sample", "sample_walk": "sample"}),
    ],
}
# What is not a number, and what counts or is a code (with the largest code, where there is one).
TEXT = {"name", "label", "scheme", "branch_name", "curve_name", "class_name"}
CODES = {"curve_kind": 4, "curve_period": None, "curve_centre": 3, "curve_first": None, "curve_points": None, "class_period": None,
         "special_kind": 2, "list": None, "period": None, "centre": 3, "evidence": 12, "settling_time": None, "method": 2,
         "interpolation": 1,
         "branch_period": None, "branch_centre": 3, "kind": 1, "end": 3}
GRIDS = {"theta", "velocity", "time", "k", "m", "value", "release", "x", "y", "row", "column"}  # axes that go up
WORDS = {"parameter", "parameter_units", "x_parameter", "y_parameter"}  # attributes that are text; all others that a part names are numbers
WITH_PENDULUM = {"basin", "orbit", "potential", "tradeoff"}  # groups whose pictures name its parameters
NUMBERS = {"quality_factor", "damping", *(f"tongue_{tongue}_lowest_{axis}" for tongue in (1, 2) for axis in "km")}  # where they are given


def wrong_shape(dataset: xarray.Dataset, group: str) -> str | None:
    """What the group lacks, or has in another shape or type; None = nothing."""
    optional = [part for part in OPTIONAL.get(group, []) if next(iter(part.variables)) in dataset]
    for part in [*([NEEDED[group]] if group in NEEDED else []), *optional]:
        lacking = [variable for variable in part.variables if variable not in dataset]
        lacking += [attribute for attribute in part.attributes if attribute not in dataset.attrs]
        if lacking:
            return f"incomplete, the group {group} lacks {', '.join(lacking)}"
        for variable, dimensions in part.variables.items():
            if dataset[variable].dims != tuple(dimensions.split()):
                return f"{group}/{variable} is not over {dimensions.replace(' ', ' and ')}"
        for attribute in {*part.attributes, *NUMBERS & dataset.attrs.keys()}:
            if not isinstance(dataset.attrs[attribute], str if attribute in WORDS else int | float | np.number):
                return f"the attribute {attribute} of {group} is of another type"
    return None


def wrong_values(dataset: xarray.Dataset) -> str | None:
    """What is wrong with the values of the first variable at fault; None = nothing that is known."""
    return next(filter(None, (_fault(dataset, str(variable)) for variable in dataset.variables)), None)


def _fault(dataset: xarray.Dataset, name: str) -> str | None:
    values, code = dataset[name].values, name in CODES
    if (values.dtype.kind not in "OSU") if name in TEXT else values.dtype.kind not in ("iu" if code else "iuf"):
        return f"{name} is of another type"
    if code and values.size and not 0 <= values.min() <= values.max() <= (CODES[name] or np.inf):
        return f"{name} has values that mean nothing"
    if name in dataset.dims and values.dtype.kind == "f" and not np.isfinite(values).all():
        return f"{name} is an axis with values that are not finite"
    if name in dataset.dims and name in GRIDS:
        values = dataset.get(f"{name}_offset", dataset[name]).values  # what tells cells apart where doubles near their centres do not
    if name in dataset.dims and name in GRIDS and not (np.diff(values) > 0).all():
        return f"{name} is an axis that does not go up"
    return None
