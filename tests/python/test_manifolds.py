"""The study manifolds: invariance and separation by an independent integration, spacing, symmetry, ranks, refusals."""

import numpy as np
import pytest
from conftest import datasets, plot, refused_scene, run_scene, strobed

FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
SADDLES = {"velocity": {"min": -2, "max": 2}}
SPACING = 0.02


def scene(**manifolds):
    return {"pendulum": FIG12, "saddles": SADDLES, "manifolds": manifolds}


@pytest.fixture(scope="module")
def fig12(kapitza, tmp_path_factory):
    """All manifolds of the saddles of period 1 at Fig. 12: the result and the summary."""
    return run_scene(kapitza, tmp_path_factory.mktemp("manifolds"), scene(length=6, spacing=SPACING))


def branch_of(group, saddle, branch, kind):
    """Points (n, 2) and arc lengths of one branch."""
    rows = (group["saddle"].values == saddle) & (group["branch"].values == branch) & (group["kind"].values == kind)
    return np.stack([group["theta"].values[rows], group["velocity"].values[rows]], axis=1), group["arc_length"].values[rows]


def wrapped(angle):
    return angle - 2 * np.pi * np.rint(angle / (2 * np.pi))


def distance_to(points, line):
    """From each point to the nearest piece of the line; angles are compared on the circle."""
    piece = np.stack([wrapped(np.diff(line[:, 0])), np.diff(line[:, 1])], axis=1)
    gap = points[:, None, :] - line[None, :-1, :]
    gap[..., 0] = wrapped(gap[..., 0])
    share = np.clip((gap * piece).sum(axis=2) / np.maximum((piece**2).sum(axis=1), 1e-300), 0, 1)
    return np.linalg.norm(gap - share[..., None] * piece, axis=2).min(axis=1)


@pytest.mark.parametrize("kind", [0, 1])
def test_manifolds_are_carried_into_themselves(fig12, kind):
    """One period later every point is on the manifold again, as near as a line between its points can say."""
    result, _ = fig12
    for saddle in (0, 2):
        for branch in (0, 1):
            line, arc = branch_of(result.group("manifolds"), saddle, branch, kind)
            line, arc = line[arc < 3], arc[arc < 3]  # before parts beyond the largest speed break it
            chosen = line[arc < (3 if kind else 0.1)][::4]
            image = strobed(result.pendulum, chosen.T, tolerance=1e-10).T
            assert len(chosen) > 5
            assert distance_to(image, line).max() < 2e-3


@pytest.mark.extensive
def test_a_stable_manifold_divides_the_basins(fig12):
    """1e-8 to either side of the one of rotation +1/1 starts end on the attracting rotation and elsewhere, for 99 % of 400 points."""
    result, _ = fig12
    rng = np.random.default_rng(1)
    starts, sides = [], []
    for branch in (0, 1):
        line, arc = branch_of(result.group("manifolds"), 0, branch, 1)
        i = rng.integers(1, np.searchsorted(arc, 4), 200)
        along = np.stack([wrapped(line[i, 0] - line[i - 1, 0]), line[i, 1] - line[i - 1, 1]], axis=1)
        along /= np.linalg.norm(along, axis=1)[:, None]
        for side in (1e-8, -1e-8):
            starts.append(line[i] + side * np.stack([-along[:, 1], along[:, 0]], axis=1))
            sides.append((branch, side))
    states = strobed(result.pendulum, np.concatenate(starts).T, periods=50, tolerance=1e-12)
    end = strobed(result.pendulum, states, periods=10, tolerance=1e-12)
    rotates = (np.rint((end[0] - states[0]) / (2 * np.pi)) == 10).reshape(2, 2, 200)
    assert np.mean(rotates[:, 0] != rotates[:, 1]) >= 0.99


def test_points_are_as_near_as_asked(fig12):
    result, _ = fig12
    group = result.group("manifolds")
    joined = np.diff(group["polyline"].values) == 0
    step = np.hypot(wrapped(np.diff(group["theta"].values)), np.diff(group["velocity"].values))
    assert step[joined].max() <= SPACING * (1 + 1e-9)
    assert np.diff(group["arc_length"].values)[joined] == pytest.approx(step[joined], abs=1e-9)
    assert np.abs(group["velocity"].values).max() <= 2


def test_tails_that_are_stretched_far(kapitza, tmp_path):
    """A saddle of Fig. 13 with the multiplier -31.7: straight lines of up to 1 rad joined its manifold's ends 16 rad from it."""
    manifolds = {"saddles": [6], "kind": "stable", "length": 20, "spacing": SPACING}
    strong = {"pendulum": {**FIG12, "drive_amplitude": 0.46}, "manifolds": manifolds, "saddles": {**SADDLES, "max_period": 2}}
    group = run_scene(kapitza, tmp_path, strong)[0].group("manifolds")
    step = np.hypot(wrapped(np.diff(group["theta"].values)), np.diff(group["velocity"].values))
    assert step[np.diff(group["polyline"].values) == 0].max() <= SPACING * (1 + 1e-9)
    assert all(branch_of(group, 6, branch, 1)[1].max() >= 20 for branch in range(4))


def test_mirror_images_are_exact(fig12):
    group = fig12[0].group("manifolds")
    mine = [branch_of(group, 0, branch, 1)[0] for branch in (0, 1)]
    other = [-branch_of(group, 1, branch, 1)[0] for branch in (1, 0)]
    assert all(np.array_equal(a, b) for a, b in zip(mine, other, strict=True))


def test_one_rank_gives_the_same_bytes(kapitza, fig12, tmp_path):
    assert datasets(run_scene(kapitza, tmp_path, scene(length=6, spacing=SPACING))[0].path) == datasets(fig12[0].path)


def test_branches_that_end_early_are_told(kapitza, tmp_path):
    """The stable manifold of rotation +1/1 runs off to large speeds on one side; an unstable one ends in an attractor."""
    _, said = run_scene(kapitza, tmp_path, scene(saddles=[0], length=1000, spacing=0.1, max_speed=1, kind="unstable"))
    assert "manifolds: 2 branches" in said and "end before length = 1000" in said


def test_an_unknown_saddle_is_refused(kapitza, tmp_path):
    assert "manifolds.saddles: 99 is not among the 4 unstable cycles" in refused_scene(kapitza, tmp_path, scene(saddles=[99]))


@pytest.mark.extensive
def test_manifolds_are_drawn(kapitza, tmp_path):
    basin = {"theta": {"count": 40}, "velocity": {"min": -2, "max": 2, "count": 40}, "method": "direct"}
    run_scene(kapitza, tmp_path, scene(length=3, kind="stable") | {"basin": basin})
    assert plot("basin", tmp_path / "s.h5", "-o", tmp_path / "with.png", "--manifolds").returncode == 0
    assert plot("basin", tmp_path / "s.h5", "-o", tmp_path / "without.png").returncode == 0
    assert (tmp_path / "with.png").read_bytes() != (tmp_path / "without.png").read_bytes()
