"""Labels of deep windows against orbits of the cells themselves, by another integrator, in as many digits as it
takes."""

import functools
import json
import random
import re
import sys
from decimal import Decimal, getcontext
from fractions import Fraction

import h5py
import pytest
from conftest import ROOT, with_extensive

sys.path.insert(0, str(ROOT / "tests" / "tools"))
import own_orbit

K01 = {"k": 0.1, "damping": 0.1, "m": 0.4}
FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
TILTED = FIG12 | {"tilt": "5 deg"}
SQUARE = FIG12 | {"waveform": "square", "harmonics": [{"order": 2, "amplitude": 0.02, "phase": "90 deg"}]}
PUSHED = FIG12 | {"torque": 0.001}
BETWEEN = {"k = 0.1": (K01, "-2.3672", "-2.3671", "17"), "Fig. 12": (FIG12, "-0.27", "-0.26", "1.42"),
           "tilted": (TILTED, "-0.27", "0.4", "1.42"), "square": (SQUARE, "-0.27", "0.4", "1.42"),
           "torque": (PUSHED, "0.08", "0.7", "1.42")}
SINES = ("k = 0.1", "Fig. 12")
WINDOWS = [*((name, depth, 50) for name in SINES for depth in (7, 20, 25, 50, 100)), ("k = 0.1", 300, 10),
           *((name, depth, 6) for name in BETWEEN if name not in SINES for depth in (20, 50, 100))]
COUNT = 101
ALONE = 2  # cells of a window whose orbits are followed without the common one too


@pytest.fixture(scope="module")
def boundary(kapitza, tmp_path_factory):
    """boundary(name, digits) -> a point of a boundary, as decimal texts."""
    folder = tmp_path_factory.mktemp("boundary")

    @functools.cache
    def find(name, digits):
        pendulum, one, other, velocity = BETWEEN[name]
        window = {"theta": {"count": 40}, "velocity": {"min": -2, "max": 2, "count": 40}}
        (folder / "s.yaml").write_text(json.dumps({"pendulum": pendulum, "basin": window}))
        said = kapitza("where", "s.yaml", one, velocity, other, velocity, "--boundary", digits, folder=folder).stdout
        return [re.search(rf"^{axis} +(\S+)", said, re.M)[1] for axis in ("theta", "velocity")]

    return find


def run_window(kapitza, folder, name, centre, depth):
    axes = {axis: {"centre": text, "width": f"1e-{depth}", "count": COUNT}
            for axis, text in zip(("theta", "velocity"), centre, strict=True)}
    (folder / "deep.yaml").write_text(json.dumps({"pendulum": BETWEEN[name][0], "basin": axes}))
    kapitza("run", "deep.yaml", folder=folder)
    return folder / "deep.h5"


def coefficients_of(group):
    """The pendulum of a result as own_orbit takes it."""
    harmonics = [[tuple(map(float, row)) for row in group[name][:]] if name in group else []
                 for name in ("vertical", "horizontal")]
    return (*(float(group.attrs[name]) for name in ("k", "beta", "m")), *harmonics, float(group.attrs.get("torque", 0)))


def referee(path, centre, depth, cells):
    """Of random cells: how many the program decided, those whose own orbit ends elsewhere, and how many attractors they
    show."""
    with h5py.File(path) as file:
        labels, evidence = file["basin/attractor"][:], file["basin/evidence"][:]
        pendulum = coefficients_of(file["pendulum"])
        group = file["attractors"]
        strobes = [list(zip(theta[:period], velocity[:period], strict=True)) for theta, velocity, period
                   in zip(group["strobe_theta"][:], group["strobe_velocity"][:], group["period"][:], strict=True)]
    chosen = random.Random(1).sample([(i, j) for i in range(COUNT) for j in range(COUNT)], cells)
    decided = [(row, column) for row, column in chosen if evidence[row, column] != 3]
    offsets = [[Fraction(2 * i + 1 - COUNT, 2 * COUNT * 10**depth) for i in (column, row)] for row, column in decided]
    middle = [Fraction(text) for text in centre]
    ends = own_orbit.ends_beside(pendulum, middle, offsets, strobes, depth + 3)
    for end, offset in zip(ends[:ALONE], offsets, strict=False):  # with all its digits
        assert end == own_orbit.end_of(pendulum, [a + b for a, b in zip(middle, offset, strict=True)], strobes,
                                       depth + 3)
    wrong = [(*cell, end, labels[cell]) for cell, end in zip(decided, ends, strict=True) if end != labels[cell]]
    return len(decided), wrong, len(set(ends))


def test_deep_windows_of_other_drives_are_decided(kapitza, tmp_path, boundary):
    path = run_window(kapitza, tmp_path, "tilted", boundary("tilted", 34), 30)
    with h5py.File(path) as file:
        assert len(set(file["basin/attractor"][:].ravel())) > 1 and (file["basin/evidence"][:] != 3).mean() > 0.9


RELEASES = {"phase": ({}, {"start_phase": 1}, ("-0.27", "1.42", "0.4", "1.42")),
            "ramp": ({"ramp": {"key": "drive_amplitude", "from": 0.1, "periods": 2.5, "shape": "smooth"}},
                     {"start_phase": "-40 deg"}, ("-0.27", "0.3", "0.4", "0.9"))}


@pytest.mark.parametrize("name", with_extensive(["ramp"], ["phase"]))
def test_deep_windows_are_released_as_single_starts_are(kapitza, tmp_path, name):
    """The window by orbits in many digits, 1e-20 wide; each start by itself in quad precision, whose release is another
    program's text."""
    keys, released, starts = RELEASES[name]
    scene = {"pendulum": TILTED | keys,
             "basin": {"theta": {"count": 40}, "velocity": {"min": -2, "max": 2, "count": 40}} | released}
    (tmp_path / "s.yaml").write_text(json.dumps(scene))
    said = kapitza("where", "s.yaml", *starts, "--boundary", 26, folder=tmp_path).stdout
    centre = [re.search(rf"^{axis} +(\S+)", said, re.M)[1] for axis in ("theta", "velocity")]
    axes = {axis: {"centre": text, "width": 1e-20, "count": 7} for axis,
            text in zip(("theta", "velocity"), centre, strict=True)}
    (tmp_path / "deep.yaml").write_text(json.dumps(scene | {"basin": axes | released}))
    kapitza("run", "deep.yaml", folder=tmp_path)
    with h5py.File(tmp_path / "deep.h5") as file:
        labels, evidence, names = file["basin/attractor"][:], file["basin/evidence"][:], file[
            "attractors/name"].asstr()[:]
    getcontext().prec = 60
    seen = set()
    for row, column in [(0, 0), (3, 3), (6, 6)]:
        start = [Decimal(text) + Decimal(f"{2 * i - 6}e-20") / 14 for text,
                 i in zip(centre, (column, row), strict=True)]
        end = json.loads(kapitza("where", "s.yaml", *map(str, start), "--json", folder=tmp_path).stdout)
        seen.add(end["name"])
        assert evidence[row, column] != 3 and end["name"] == names[labels[row, column]]
    assert len(seen) > 1


@pytest.mark.extensive
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("name, depth, cells", WINDOWS)
def test_own_orbits_contradict_no_label(kapitza, tmp_path, boundary, name, depth, cells):
    centre = boundary(name, depth + 4)
    decided, wrong, seen = referee(run_window(kapitza, tmp_path, name, centre, depth), centre, depth, cells)
    print(f"{name}, 1e-{depth}: {decided} of {cells} decided, wrong {wrong}, attractors {seen}")
    assert decided >= 0.9 * cells and not wrong and seen > 1
