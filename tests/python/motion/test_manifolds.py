"""Manifolds, shared boundaries and tangencies in Python: against scipy, formulas, symmetry, and the compiled studies
that they replace."""

import math
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, flown, run_scene, strobed
from kapitza import Pendulum, manifolds, tangency, wada
from kapitza.boundaries.wada import PARTLY, YES
from kapitza.plots import measure_lines

FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
SPACING = 0.02
TOOL = ROOT / "benchmarks" / "tangency_scipy.py"
SCIPY = 0.058589688430988      # value of that tool for k = 1, beta = 0.02
COMPILED = 0.0585896884310148  # value of the study in C of 0.4.0; its error was 4e-15


@pytest.fixture(scope="module")
def fig12():
    pendulum = Pendulum(**FIG12)
    return pendulum, manifolds(pendulum, pendulum.saddles(), length=6, spacing=SPACING)


def branch_of(group, saddle, branch, kind):
    """Points (n, 2) and arc lengths of one branch."""
    rows = (group["saddle"].values == saddle) & (group["branch"].values == branch) & (group["kind"].values == kind)
    return np.stack([group["theta"].values[rows], group["velocity"].values[rows]],
                    axis=1), group["arc_length"].values[rows]


def wrapped(angle):
    return angle - 2 * np.pi * np.rint(angle / (2 * np.pi))


def distance_to(points, line):
    """From each point to the nearest piece of the line; angles are compared on the circle."""
    piece = np.stack([wrapped(np.diff(line[:, 0])), np.diff(line[:, 1])], axis=1)
    gap = points[:, None, :] - line[None, :-1, :]
    gap[..., 0] = wrapped(gap[..., 0])
    share = np.clip((gap * piece).sum(axis=2) / np.maximum((piece**2).sum(axis=1), 1e-300), 0, 1)
    return np.linalg.norm(gap - share[..., None] * piece, axis=2).min(axis=1)


# ---- manifolds ----


@pytest.mark.parametrize("kind", [0, 1])
def test_manifolds_are_carried_into_themselves(fig12, kind):
    """One period later every point is on the manifold again, as near as a line between its points can say."""
    pendulum, curves = fig12
    for saddle in (0, 2):
        for branch in (0, 1):
            line, arc = branch_of(curves, saddle, branch, kind)
            line, arc = line[arc < 3], arc[arc < 3]  # before parts beyond the largest speed break it
            chosen = line[arc < (3 if kind else 0.1)][::4]
            image = strobed(pendulum.parameters, chosen.T, tolerance=1e-10).T
            assert len(chosen) > 5
            assert distance_to(image, line).max() < 2e-3


def test_points_are_as_near_as_asked(fig12):
    _, curves = fig12
    joined = np.diff(curves["polyline"].values) == 0
    step = np.hypot(wrapped(np.diff(curves["theta"].values)), np.diff(curves["velocity"].values))
    assert step[joined].max() <= SPACING * (1 + 1e-9)
    assert np.diff(curves["arc_length"].values)[joined] == pytest.approx(step[joined], abs=1e-9)
    assert np.abs(curves["velocity"].values).max() <= 2


def test_tails_that_are_stretched_far():
    """A saddle of Fig. 13 with the multiplier -31.7: straight lines of up to 1 rad joined its manifold's ends 16 rad
    from it."""
    strong = Pendulum(**FIG12 | {"drive_amplitude": 0.46})
    saddle = strong.saddles(max_period=2).isel(cycle=[6])
    curves = manifolds(strong, saddle, kind="stable", spacing=SPACING)
    step = np.hypot(wrapped(np.diff(curves["theta"].values)), np.diff(curves["velocity"].values))
    assert step[np.diff(curves["polyline"].values) == 0].max() <= SPACING * (1 + 1e-9)
    assert all(branch_of(curves, 0, branch, 1)[1].max() >= 20 for branch in range(4))


def test_mirror_images_are_exact(fig12):
    _, curves = fig12
    mine = [branch_of(curves, 0, branch, 1)[0] for branch in (0, 1)]
    other = [-branch_of(curves, 1, branch, 1)[0] for branch in (1, 0)]
    assert all(np.array_equal(a, b) for a, b in zip(mine, other, strict=True))


def test_manifolds_are_kept_in_a_file_and_drawn(fig12, kapitza, tmp_path):
    """Result.add replaces the file; its own groups are refused."""
    pendulum, curves = fig12
    window = {"theta": {"count": 20}, "velocity": {"min": -2, "max": 2, "count": 20}, "method": "direct"}
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": FIG12, "basin": window})
    labels, mode = result.labels().values, result.path.stat().st_mode
    kept = result.add("manifolds", curves).add("manifolds", curves)
    assert kept.group("manifolds").equals(curves) and np.array_equal(kept.labels().values, labels)
    assert [path.name for path in tmp_path.glob("*.h5*")] == [result.path.name] and result.path.stat().st_mode == mode
    lines = [len(axes.lines) for axes in kept.plot(manifolds=True).axes]
    assert sum(lines) > sum(len(axes.lines) for axes in kept.plot().axes) + 10
    with pytest.raises(ValueError, match="own groups"):
        kept.add("basin", curves)


# ---- shared boundaries ----


@pytest.fixture(scope="module")
def forced():
    pendulum = Pendulum(k=1, damping=0.2, m=0, torque_amplitude=1.66, basin={"velocity": {"min": -2, "max": 4}})
    cycles = pendulum.cycles(velocity=(-3, 3))
    cycles = cycles.isel(cycle=np.hypot(cycles.multiplier_re, cycles.multiplier_im).isel(pair=0).values > 1)
    return pendulum, cycles, wada(pendulum, cycles, length=8, spacing=0.05)


def test_the_forced_pendulum_has_one_boundary(forced):
    """Nusse and Yorke's pendulum: the cycles on a boundary bound all three basins; the two flip cycles inside a basin
    bound nothing."""
    _, cycles, found = forced
    assert found.sizes["attractor"] == 3 and np.all(found["wada"].values == YES)
    inside = cycles["multiplier_re"].values[:, 0] < -1
    assert inside.sum() == 2 and np.all(found["basins"].values
                                        == np.where(inside, 1, 3)) and np.all(found["followed"].values[inside] == 1)
    shared = np.where(np.eye(3), 0, 3)
    assert np.array_equal(found["pair_cycles"].values, shared) and np.array_equal(found["pair_shared"].values, shared)


def test_witnesses_end_where_they_should(forced):
    """Each witness, followed by scipy in the original equation, comes to a strobe point of its attractor."""
    pendulum, _, found = forced
    attractors = pendulum.attractors()
    assert list(attractors["name"]) == found.attrs["names"]
    witness = np.stack([found["theta"].values, found["velocity"].values], axis=-1)
    known = np.argwhere(np.isfinite(witness[..., 0]))
    assert len(known) == 3 * 2 * 3 + 2 * 2

    def field(t, y):
        theta, velocity = y.reshape(2, -1)
        return np.concatenate([velocity, -0.2 * velocity - np.sin(theta) + 1.66 * np.cos(t)])

    end = flown(field, 2 * np.pi * 40, witness[tuple(known.T)].T.ravel(), 1e-10).reshape(2, -1)
    for (_, _, attractor), theta, velocity in zip(known, *end, strict=True):
        row = attractors.iloc[attractor]
        gap = wrapped(np.array(row["strobe_theta"]) - theta)
        assert np.nanmin(np.hypot(gap, np.array(row["strobe_velocity"]) - velocity)) < 1e-3


def test_two_basins_can_share_a_boundary_without_the_third():
    """Fig. 11: the cycles at the rim of the inverted well have down on the other side; those of the rotations have down
    and inverted."""
    pendulum = Pendulum(**FIG12 | {"drive_amplitude": 0.2})
    found = wada(pendulum, pendulum.saddles(velocity=(-1.5, 1.5)), length=13, spacing=0.05)
    down, inverted, one, other = (found.attrs["names"].index(name)
                                  for name in ("down", "inverted", "rotation +1/1", "rotation -1/1"))
    assert [found["wada"].values[i] for i in (down, inverted, one, other)] == [PARTLY, PARTLY, YES, YES]
    rim = found["basins"].values == 2
    assert rim.sum() == 2 and np.all(found["followed"].values[rim] == 1)
    met = np.isfinite(found["theta"].values).any(axis=1)
    assert np.all(met[rim][:, [down, inverted]]) and not np.any(met[rim][:, [one, other]])
    assert found["pair_cycles"].values[down, inverted] == 4 and found["pair_shared"].values[down, inverted] == 2
    assert found["pair_cycles"].values[one, other] == 0


# ---- tangencies ----


@pytest.fixture(scope="module")
def weak():
    return tangency(Pendulum(k=1, damping=0.02, m=0.05), "m", 0.04, 0.08)


def test_the_value_is_that_of_scipy_and_of_the_compiled_study(weak):
    assert abs(weak.attrs["value"] - SCIPY) < 1e-12 and abs(weak.attrs["value"] - COMPILED) < 1e-14
    assert weak.attrs["error"] < 1e-11 and weak.attrs["crossing"] == "above"


def test_melnikov_is_the_limit(weak):
    """The value divided by Melnikov's nears 1 as the square of the damping, because the first order is Melnikov's."""
    strong = tangency(Pendulum(k=1, damping=0.04, m=0.05), "m", 0.08, 0.16).attrs["value"]
    melnikov = 4 * math.sinh(math.pi / 2) / math.pi
    off = [value / (melnikov * beta) - 1 for value, beta in ((weak.attrs["value"], 0.02), (strong, 0.04))]
    assert abs(off[0]) < 3e-4 and off[1] / off[0] == pytest.approx(4, rel=0.05)


def test_the_orbit_leads_from_the_saddle_to_the_saddle(weak):
    """One state a return: the first and the last lie beside the inverted state, and the motion goes around."""
    gap = np.hypot(np.remainder(weak["theta"].values, 2 * np.pi) - np.pi, weak["velocity"].values)
    assert gap[[0, -1]].max() < 1e-4 and gap.max() > 1 and np.all(np.diff(weak["strobe"].values) == 1)


@pytest.mark.parametrize(("parameter", "low", "high", "words"), [
    ("m", 0.02, 0.03, "cross at neither end"), ("beta", 0.008, 0.012, "cross at both ends"),
    ("damping", 0.008, 0.012, "cross at both ends"),
    ("tilt", 0, 1, "tilt must be a number")],
    ids=["neither", "symbol", "both", "key"])
def test_a_range_without_a_tangency_is_refused(parameter, low, high, words):
    with pytest.raises(ValueError, match=words):
        tangency(Pendulum(k=1, damping=0.02, m=0.05), parameter, low, high)


def test_a_picture_of_measures_marks_the_value(weak, kapitza, tmp_path):
    """Shares of a sweep of the same key, with their band, and the dashed line at the value."""
    sweep = {"parameter": "m", "min": 0.04, "max": 0.08, "count": 3, "measure": ["share"], "starts": 64,
             "velocity": {"min": -1, "max": 1}}
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": {"k": 1, "damping": 0.02, "m": 0.05}, "sweep": sweep})
    result = result.add("tangency", weak)
    axes, = measure_lines.draw(result).axes
    lines = [list(drawn.get_xdata()) for drawn in axes.lines]
    shares = [list(drawn.get_ydata()) for drawn in axes.lines if len(drawn.get_xdata()) == 3]
    assert [SCIPY, SCIPY] in [pytest.approx(x) for x in lines] and axes.collections
    assert np.array_equal(shares[0], result.group("line")["share"].values[0], equal_nan=True)


@pytest.mark.extensive
def test_the_tool_finds_its_number_again():
    done = subprocess.run([sys.executable, TOOL, "1", "0.02", "0.04", "0.1"], check=True, capture_output=True,
                          text=True)
    assert float(re.search(r"m = (\S+)", done.stdout)[1]) == pytest.approx(SCIPY, abs=1e-12)
