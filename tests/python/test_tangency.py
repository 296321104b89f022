"""The study tangency: against scipy, Melnikov's formula, quadratic opening of the crossing, ranks, refusals."""

import math
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, datasets, refused_scene, run_scene
from kapitza.plots import measure_lines as line

TOOL = ROOT / "benchmarks" / "tangency_scipy.py"
SCIPY = 0.058589688430988  # of that tool, for k = 1, beta = 0.02


def scene(damping=0.02, **words):
    return {"pendulum": {"k": 1, "damping": damping, "m": 0.05}, "saddles": {"velocity": {"min": -1, "max": 1}},
            "tangency": {"parameter": "m", "min": 2 * damping, "max": 4 * damping, **words}}


# And shares along a sweep of the same key.
WEAK = scene() | {"sweep": {"parameter": "m", "min": 0.04, "max": 0.08, "count": 3, "measure": ["share"], "starts": 64,
                            "velocity": {"min": -1, "max": 1}}}


@pytest.fixture(scope="module")
def weak(kapitza, tmp_path_factory):
    return run_scene(kapitza, tmp_path_factory.mktemp("tangency"), WEAK)


def test_the_value_is_that_of_scipy(weak):
    result, summary = weak
    group = result.group("tangency")
    assert abs(group.attrs["value"] - SCIPY) < 1e-12 and group.attrs["error"] < 1e-11 and group.attrs["crossing"] == "above"
    assert group.attrs["saddle"] == group.attrs["into"] == 0 and "touches the stable one of cycle 0 at m = 0.0585896884310" in summary


def test_melnikov_is_the_limit(weak, kapitza, tmp_path):
    """The value divided by Melnikov's nears 1 as the square of the damping, because the first order is Melnikov's."""
    strong = run_scene(kapitza, tmp_path, scene(0.04))[0].group("tangency").attrs["value"]
    melnikov = 4 * math.sinh(math.pi / 2) / math.pi
    off = [value / (melnikov * beta) - 1 for value, beta in ((weak[0].group("tangency").attrs["value"], 0.02), (strong, 0.04))]
    assert abs(off[0]) < 3e-4 and off[1] / off[0] == pytest.approx(4, rel=0.05)


def test_the_orbit_leads_from_the_saddle_to_the_saddle(weak):
    """One state a return: the first and the last lie beside the inverted state, and the motion goes around."""
    group = weak[0].group("tangency")
    gap = np.hypot(np.remainder(group["theta"].values, 2 * np.pi) - np.pi, group["velocity"].values)
    assert gap[[0, -1]].max() < 1e-4 and gap.max() > 1 and np.all(np.diff(group["strobe"].values) == 1)


def test_values_are_the_same_on_three_ranks(weak, kapitza, tmp_path):
    assert datasets(run_scene(kapitza, tmp_path, WEAK, ranks=3)[0].path) == datasets(weak[0].path)


@pytest.mark.parametrize(("words", "named"), [
    ({"min": 0.02, "max": 0.03}, "tangency.max: the manifolds cross at neither end"),
    ({"saddle": 3}, "tangency.saddle: 3 is not among the 1 unstable cycles"),
    ({"parameter": "damping", "min": 0.008, "max": 0.012}, "tangency.max: the manifolds cross at both ends")],
    ids=["neither", "id", "both"])
def test_a_range_without_a_tangency_is_refused(kapitza, tmp_path, words, named):
    assert named in refused_scene(kapitza, tmp_path, scene(**words))


def test_a_picture_of_measures_marks_the_value(weak):
    """Shares of a sweep of the same key, with their band, and the dashed line at the value."""
    result, _ = weak
    figure = line.draw(result)
    axes, = figure.axes
    lines = [list(drawn.get_xdata()) for drawn in axes.lines]
    shares = [list(drawn.get_ydata()) for drawn in axes.lines if len(drawn.get_xdata()) == 3]
    assert [SCIPY, SCIPY] in [pytest.approx(x) for x in lines] and axes.collections
    assert np.array_equal(shares[0], result.group("line")["share"].values[0], equal_nan=True)


@pytest.mark.extensive
def test_the_tool_finds_its_number_again():
    done = subprocess.run([sys.executable, TOOL, "1", "0.02", "0.04", "0.1"], check=True, capture_output=True, text=True)
    assert float(re.search(r"m = (\S+)", done.stdout)[1]) == pytest.approx(SCIPY, abs=1e-12)
