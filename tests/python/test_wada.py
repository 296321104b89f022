"""The study wada: the forced pendulum of Nusse and Yorke, boundaries of two basins, witnesses by scipy, symmetry, ranks."""

import numpy as np
import pytest
from conftest import datasets, flown, run_scene, stopped_and_resumed

FORCED = {"pendulum": {"k": 1, "damping": 0.2, "m": 0, "torque_amplitude": 1.66},
          "attractors": {"velocity": {"min": -2, "max": 4}, "starts": 512},
          "saddles": {"velocity": {"min": -3, "max": 3}}, "wada": {"length": 8, "spacing": 0.05}}
FIG11 = {"pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.2},
         "attractors": {"velocity": {"min": -1, "max": 1}, "starts": 512},
         "saddles": {"velocity": {"min": -1.5, "max": 1.5}}, "wada": {"length": 13, "spacing": 0.05}}
OPEN, NO, PARTLY, YES = range(4)


@pytest.fixture(scope="module")
def forced(kapitza, tmp_path_factory):
    return run_scene(kapitza, tmp_path_factory.mktemp("wada"), FORCED)


@pytest.fixture(scope="module")
def fig11(kapitza, tmp_path_factory):
    return run_scene(kapitza, tmp_path_factory.mktemp("wada"), FIG11)


def test_the_forced_pendulum_has_one_boundary(forced):
    """Nusse and Yorke's pendulum: the cycles on a boundary bound all three basins; the two flip cycles inside a basin bound nothing."""
    result, summary = forced
    wada, saddles = result.group("wada"), result.group("saddles")
    assert wada.sizes["attractor"] == 3 and np.all(wada["wada"].values == YES)
    inside = saddles["multiplier_re"].values[:, 0] < -1
    assert inside.sum() == 2 and np.all(wada["basins"].values == np.where(inside, 1, 3)) and np.all(wada["followed"].values[inside] == 1)
    shared = np.where(np.eye(3), 0, 3)
    assert np.array_equal(wada["pair_cycles"].values, shared) and np.array_equal(wada["pair_shared"].values, shared)
    assert "the unstable manifolds of 3 of 5 cycles meet all 3 basins" in summary


def test_witnesses_end_where_they_should(forced):
    """Each witness, followed by scipy in the original equation, comes to a strobe point of its attractor."""
    result, _ = forced
    wada, attractors = result.group("wada"), result.group("attractors")
    witness = np.stack([wada["theta"].values, wada["velocity"].values], axis=-1)
    known = np.argwhere(np.isfinite(witness[..., 0]))
    assert len(known) == 3 * 2 * 3 + 2 * 2
    start = witness[tuple(known.T)]
    periods = 40

    def field(t, y):
        theta, velocity = y.reshape(2, -1)
        return np.concatenate([velocity, -0.2 * velocity - np.sin(theta) + 1.66 * np.cos(t)])

    end = flown(field, 2 * np.pi * periods, start.T.ravel(), 1e-10).reshape(2, -1)
    for (_, _, attractor), theta, velocity in zip(known, *end, strict=True):
        gap = np.remainder(attractors["strobe_theta"].values[attractor] - theta + np.pi, 2 * np.pi) - np.pi
        assert np.nanmin(np.hypot(gap, attractors["strobe_velocity"].values[attractor] - velocity)) < 1e-3


def test_two_basins_can_share_a_boundary_without_the_third(fig11):
    """Fig. 11: the cycles at the rim of the inverted well have down on the other side; those of the rotations have down and inverted."""
    result, summary = fig11
    wada, names = result.group("wada"), list(result.group("attractors")["name"].values)
    down, inverted, one, other = (names.index(name) for name in ("down", "inverted", "rotation +1/1", "rotation -1/1"))
    assert [wada["wada"].values[i] for i in (down, inverted, one, other)] == [PARTLY, PARTLY, YES, YES]
    rim = wada["basins"].values == 2
    assert rim.sum() == 2 and np.all(wada["followed"].values[rim] == 1)
    met = np.isfinite(wada["theta"].values).any(axis=1)
    assert np.all(met[rim][:, [down, inverted]]) and not np.any(met[rim][:, [one, other]])
    assert wada["pair_cycles"].values[down, inverted] == 4 and wada["pair_shared"].values[down, inverted] == 2
    assert wada["pair_cycles"].values[one, other] == 0 and "partly" in summary


def test_witnesses_are_mirrored_and_the_same_on_three_ranks_after_a_stop(fig11, kapitza, tmp_path):
    result, _ = fig11
    wada, mirror, image = result.group("wada"), result.group("saddles")["mirror"].values, result.group("attractors")["mirror"].values
    for name in ("theta", "velocity"):
        values = wada[name].values
        assert np.array_equal(values[mirror][:, :, image], -values, equal_nan=True)
    assert datasets(stopped_and_resumed(kapitza, tmp_path, FIG11, ranks=3).path) == datasets(result.path)
