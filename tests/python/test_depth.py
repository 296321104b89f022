"""Labels of deep windows against orbits of the cells themselves, by another integrator, in as many digits as it takes."""

import json
import os
import random
import re
import sys
from fractions import Fraction

import h5py
import numpy as np
import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests" / "tools"))
import own_orbit

K01 = {"k": 0.1, "damping": 0.1, "m": 0.4}
FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
BETWEEN = {"k = 0.1": (K01, "-2.3672", "-2.3671", "17"), "Fig. 12": (FIG12, "-0.27", "-0.26", "1.42")}
COUNT = 101


def boundary(kapitza, folder, name, digits):
    """A point of a boundary, as decimal texts."""
    pendulum, one, other, velocity = BETWEEN[name]
    window = {"theta": {"count": 40}, "velocity": {"min": -2, "max": 2, "count": 40}}
    (folder / "s.yaml").write_text(json.dumps({"pendulum": pendulum, "basin": window}))
    said = kapitza("where", "s.yaml", one, velocity, other, velocity, "--boundary", digits, folder=folder).stdout
    return [re.search(rf"^{axis} +(\S+)", said, re.M)[1] for axis in ("theta", "velocity")]


def run_window(kapitza, folder, name, depth):
    theta, velocity = boundary(kapitza, folder, name, max(depth + 4, 12))
    width = f"1e-{depth}"
    axes = {axis: {"centre": centre, "width": width, "count": COUNT} for axis, centre in (("theta", theta), ("velocity", velocity))}
    (folder / "deep.yaml").write_text(json.dumps({"pendulum": BETWEEN[name][0], "basin": axes}))
    kapitza("run", "deep.yaml", folder=folder)
    return [Fraction(theta), Fraction(velocity)], Fraction(1, 10**depth)


def referee(path, centre, width, cells):
    """Of random cells: how many the program decided, those whose own orbit ends elsewhere, and how many attractors they show."""
    with h5py.File(path) as file:
        labels, evidence = file["basin/attractor"][:], file["basin/evidence"][:]
        pendulum = [float(file["pendulum"].attrs[name]) for name in ("k", "beta", "m")]
        group = file["attractors"]
        strobes = [list(zip(theta[:period], velocity[:period], strict=True)) for theta, velocity, period
                   in zip(group["strobe_theta"][:], group["strobe_velocity"][:], group["period"][:], strict=True)]
    digits, seen, wrong, decided = -np.log10(float(width)) if width > 1e-300 else 300, set(), [], 0
    for row, column in random.Random(1).sample([(i, j) for i in range(COUNT) for j in range(COUNT)], cells):
        if evidence[row, column] == 3:
            continue
        start = [middle + width * Fraction(2 * i + 1 - COUNT, 2 * COUNT) for middle, i in zip(centre, (column, row), strict=True)]
        end = own_orbit.end_of(pendulum, start, strobes, digits + 3)
        decided += 1
        seen.add(end)
        if end != labels[row, column]:
            wrong.append((row, column, end, labels[row, column]))
    return decided, wrong, len(seen)


@pytest.mark.skipif(not os.environ.get("KAPITZA_EXTENSIVE"), reason="takes minutes: KAPITZA_EXTENSIVE=1")
@pytest.mark.parametrize("name, depth, cells", [
    ("k = 0.1", 7, 50), ("k = 0.1", 20, 50), ("k = 0.1", 25, 50), ("k = 0.1", 50, 50), ("k = 0.1", 100, 50), ("k = 0.1", 300, 5),
    ("Fig. 12", 7, 50), ("Fig. 12", 20, 50), ("Fig. 12", 50, 50), ("Fig. 12", 100, 5)])
def test_own_orbits_contradict_no_label(kapitza, tmp_path, name, depth, cells):
    centre, width = run_window(kapitza, tmp_path, name, depth)
    decided, wrong, seen = referee(tmp_path / "deep.h5", centre, width, cells)
    print(f"{name}, 1e-{depth}: {decided} of {cells} decided, wrong {wrong}, attractors {seen}")
    assert decided >= 0.9 * cells and not wrong and seen > 1
