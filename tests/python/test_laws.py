"""Simple laws of the two papers' text (docs/explanation/theory.md, "Simple laws"): the program's numbers obey them."""

from math import acos, degrees, sqrt

import numpy as np
import pytest

BLACKBURN = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}


@pytest.mark.parametrize("beta", [0, 0.02, 0.5])
def test_the_effective_potential_has_a_well_from_the_boundary_on(model, beta):
    """BSG (10): epsilon^2 = 2 k ((1 + k)^2 + beta^2) / (1 + k); damping raises it."""
    k = 1 / 121
    boundary = sqrt(2 * k * ((1 + k) ** 2 + beta**2) / (1 + k))
    amplitudes = [boundary * (1 - 1e-9), boundary * (1 + 1e-9)]
    group = model({"k": k, "damping": beta, "m": 0.3}, potential={"drive_amplitudes": amplitudes, "theta": {"count": 3}}).group("potential")
    assert group["stable_inverted"].values.tolist() == [0, 1]


def test_releases_follow_the_slow_angle(model):
    """The rim of (12) and the slow angle at t = 0, phi - epsilon sin phi: arccos r + epsilon sqrt(1 - r^2), r = 2 / (epsilon Omega)^2."""
    sweep = {"parameter": "drive_amplitude", "min": 0.15, "max": 0.25, "count": 3, "measure": ["release_angle"]}
    group = model({**BLACKBURN, "quality_factor": 20}, sweep=sweep).group("sweep")
    for epsilon, angle in zip(group["value"].values, group["release_angle"].values, strict=True):
        r = 2 / (11 * epsilon) ** 2
        assert degrees(angle) == pytest.approx(degrees(acos(r) + epsilon * sqrt(1 - r * r)), abs=1.5)


def test_no_motion_stays_faster_than_damping_allows(model):
    """limsup |v| <= (k + m) / beta, on a chaotic motion that began beyond it."""
    orbit = {"start": {"theta": 0.3, "velocity": 4}, "transient": 5, "periods": 200}
    speed = np.abs(model({"k": 0.1, "damping": 0.6, "m": 1.2}, orbit=orbit).group("orbit")["velocity"].values)
    assert 1 < speed.max() < (0.1 + 1.2) / 0.6


def test_flutter_without_gravity_grows_as_the_root(model):
    """S1 = 3.434 sqrt(m - 0.4540231669) at k = 0, beta = 0."""
    orbit = {"start": {"theta": 0, "velocity": 0.0545}, "closed": True, "period": 2}
    group = model({"k": 0, "damping": 0, "m": 0.456}, orbit=orbit).group("orbit")
    assert group["line_amplitude"].values[1] == pytest.approx(3.434 * sqrt(0.456 - 0.4540231669), rel=1e-3)


def test_the_rotation_begins_at_twice_the_damping(model):
    """epsilon = 2 beta, nearly: the fold of rotation +1/1."""
    sweep = {"parameter": "drive_amplitude", "min": 0.03, "max": 0.05, "count": 3, "measure": ["attractors"], "starts": 512}
    group = model(BLACKBURN, sweep=sweep).group("sweep")
    names = list(group["branch_name"].values)
    assert group["branch_start"].values[names.index("rotation +1/1")] == pytest.approx(2 / 55, rel=1e-3)
