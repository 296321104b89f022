"""Ends of the branches of sweeps along lines through several planes, against the curves of an atlas of a narrow plane
about each line."""

import json

import numpy as np
import pytest
from kapitza import Result

BLACKBURN = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.5}
BUTIKOV = {"k": 0.1, "damping": 0.1, "m": 0.5}
# The pendulum, the swept key, its range and number of values, the key that is the same along the line
LINES = {"m": (BUTIKOV, "m", 0.42, 0.9, 9, "k"),
         "k": (BUTIKOV, "k", -0.3, 0.4, 15, "m"),
         "damping": ({"k": 0.00826, "damping": 0.02, "m": 0.3}, "damping", 0.005, 0.1, 13, "m"),
         "frequency": (BLACKBURN, "drive_frequency", 5, 12, 13, "drive_amplitude"),
         "amplitude": (BLACKBURN, "drive_amplitude", 0.4, 0.58, 13, "drive_frequency"),
         "tilt": (BLACKBURN | {"tilt": 0.05}, "tilt", 0.01, 0.3, 9, "drive_amplitude"),
         "torque": (BUTIKOV | {"torque": 0.05}, "torque", 0.0, 0.2, 11, "m"),
         "quality": (BLACKBURN, "quality_factor", 2, 11, 10, "drive_amplitude"),
         "square wave": (BLACKBURN | {"waveform": "square"}, "drive_amplitude", 0.2, 0.45, 11, "drive_frequency"),
         "laboratory": ({"length": "20 cm", "frequency": "16 Hz", "amplitude": "6 cm", "quality_factor": 5},
                        "amplitude", 0.05, 0.12, 11, "frequency")}
LEFT, NOT_LOCATED = 0, 5
UNITS = {"laboratory": 16}  # the key that is the same, in the unit of the file


def crossings(group, value):
    """Where curves pass x = value, by polynomials through up to six points; the plane is narrow, so that they are
    nearly straight."""
    found = []
    for first, n in zip(group["curve_first"].values, group["curve_points"].values, strict=True):
        xs, ys = group["x"].values[first:first + n], group["y"].values[first:first + n]
        for at in np.flatnonzero((xs[:-1] < value) != (xs[1:] < value)):
            near = slice(max(0, at - 2), at + 4)
            scaled = (xs[near] - value) / (xs.max() - xs.min())
            found.append(np.polyval(np.polyfit(scaled, ys[near], len(scaled) - 1), 0))
    return np.array(found)


@pytest.mark.extensive
@pytest.mark.parametrize("name", LINES)
def test_ends_of_branches_lie_on_curves_of_the_atlas(kapitza, tmp_path, name):
    pendulum, key, low, high, count, other = LINES[name]
    value = UNITS.get(name, pendulum[other])
    studies = {"sweep": {"parameter": key, "min": low, "max": high, "count": count, "measure": ["attractors"],
                         "starts": 1024, "max_period": 4},
               "atlas": {"x": {"parameter": other, "min": 0.9999 * value, "max": 1.0001 * value},
                         "y": {"parameter": key, "min": low, "max": high}, "max_period": 4, "checks": 0, "points": 16}}
    for study, keys in studies.items():
        (tmp_path / f"{study}.yaml").write_text(json.dumps({"pendulum": pendulum, study: keys}))
        kapitza("run", f"{study}.yaml", folder=tmp_path)
    curves = crossings(Result(tmp_path / "atlas.h5").group("atlas"), value)
    branches, compared = Result(tmp_path / "sweep.h5").group("sweep"), 0
    for end in ("start", "end"):
        columns = (branches[column].values for column in (f"branch_{end}", f"branch_{end}_kind", "branch_period"))
        for at, kind, period in zip(*columns, strict=True):
            if kind == LEFT or period == 0:
                continue
            assert kind != NOT_LOCATED and abs(curves - at).min() < 1e-11 * (high - low), (end, at, kind, period)
            compared += 1
    assert compared >= 5
