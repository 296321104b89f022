"""Simple laws of the two papers' text (docs/explanation/theory.md, "Simple laws"): the program's numbers obey them.
Those of releases and of rotations: test_sweep.py."""

from math import sqrt

import numpy as np
import pytest


@pytest.mark.parametrize("beta", [0, 0.02, 0.5])
def test_the_effective_potential_has_a_well_from_the_boundary_on(model, beta):
    """BSG (10): epsilon^2 = 2 k ((1 + k)^2 + beta^2) / (1 + k); damping raises it."""
    k = 1 / 121
    boundary = sqrt(2 * k * ((1 + k) ** 2 + beta**2) / (1 + k))
    amplitudes = [boundary * (1 - 1e-9), boundary * (1 + 1e-9)]
    group = model({"k": k, "damping": beta, "m": 0.3},
                  potential={"drive_amplitudes": amplitudes, "theta": {"count": 3}}).group("potential")
    assert group["stable_inverted"].values.tolist() == [0, 1]


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
