"""Near a bifurcation: the right attractors or none, never a wrong one (docs/validation/extremes.md)."""

import math

import pytest
from conftest import ROOT, run_scene, settings, with_extensive

# Bifurcations of Q = 5, Omega = 11: the epsilon where they happen, where in the plane, and what is not there below, and
# above.
# (name, whether it is its own mirror image)
CRITICAL = {
    "inverted flips": (0.46819030239029, (math.pi, 0), (0.1, 0.01), {("flutter", 1), ("flutter", 0)},
                       {("inverted", 1)}),
    "down flips": (0.44045457534337, (0, 0), (0.1, 0.1), {("down 2-nodding", 1), ("down 2-nodding", 0)}, {("down", 1)}),
    "inverted is born": (0.12904956189170, (math.pi, 0), (0.02, 0.002), {("inverted", 1)}, set()),
    "3-nodding is born": (0.46255521718229, (2.1837772, -0.0097489), (0.002, 0.002), {("inverted 3-nodding", 0)},
                          set()),
    "3-nodding flips": (0.47300943240971, (2.1407813, -0.0198527), (0.002, 0.002), {("inverted 6-nodding", 0)},
                        {("inverted 3-nodding", 0)}),
    "2-nodding loses its symmetry": (0.54148001976034, (-0.0161618, -0.3581809), (0.01, 0.01), {("down 2-nodding", 0)},
                                     {("down 2-nodding", 1)}),
    "flutter loses its symmetry": (0.56184564263138, (-2.0564952, -0.0136295), (0.02, 0.002), {("flutter", 0)},
                                   {("flutter", 1)}),
}


@pytest.mark.parametrize("distance", with_extensive([1e-9], [-1e-9]))
@pytest.mark.parametrize("name", CRITICAL)
def test_either_side_of_a_bifurcation(kapitza, tmp_path, name, distance):
    """No attractor of the other side, none twice, and slow is not chaotic."""
    epsilon, centre, half_widths, not_below, not_above = CRITICAL[name]
    axes = [f"basin.{axis}={{min: {middle - half!r}, max: {middle + half!r}, count: 4}}"
            for axis, middle, half in zip(("theta", "velocity"), centre, half_widths, strict=True)]
    words = settings(*axes, f"pendulum.drive_amplitude={epsilon + distance!r}", "basin.method=direct",
                     "basin.attractors.starts=64", "basin.max_periods=1000")
    found = run_scene(kapitza, tmp_path, ROOT / "scenes" / "small.yaml", *words)[0].group("attractors")
    kinds = list(zip(map(str, found["name"].values), found["symmetric"].values.tolist(), strict=True))
    assert not set(kinds) & (not_below if distance < 0 else not_above)
    assert "chaotic" not in dict(kinds)
    assert all(kinds.count(kind) <= (1 if kind[1] else 2) for kind in kinds if "rotation" not in kind[0])
