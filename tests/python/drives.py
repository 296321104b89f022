"""Pendulums with other drives and releases for the tests, and an integration of them."""

import json
import math

import h5py
from conftest import flown

WINDOW = {"theta": {"count": 24}, "velocity": {"min": -2, "max": 2, "count": 24}}
PENDULUM = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
K, BETA, M = 1 / 121, 1 / 55, 0.3
CORNERED = [(j, 4 / (math.pi * j) * (-1) ** (j // 2)) for j in (1, 3, 5, 7)]
# Keys -> (a - k, b, torque) of theta'' + beta theta' + a sin theta - b cos theta = torque.
RIGS = {
    "sine": ({}, lambda t: (-M * math.cos(t), 0, 0)),
    "harmonics": ({"harmonics": [{"order": 2, "amplitude": 1 / 3, "phase": math.pi / 6},
                                 {"order": 1, "amplitude": 0.2}]},
                  lambda t: (-1.2 * M * math.cos(t) - M / 3 * math.cos(2 * t + math.pi / 6), 0, 0)),
    "square": ({"waveform": "square"}, lambda t: (-M * sum(share * math.cos(j * t) for j, share in CORNERED), 0, 0)),
    "tilted": ({"tilt": math.pi / 36}, lambda t: (-M * math.cos(math.pi / 36) * math.cos(t),
                                                  M * math.sin(math.pi / 36) * math.cos(t), 0)),
    "ellipse": ({"ellipse": 0.2}, lambda t: (-M * math.cos(t), 0.2 * M * math.sin(t), 0)),
    "torque": ({"torque": 0.004}, lambda t: (-M * math.cos(t), 0, 0.004)),
}


def period(force, state):
    """One drive period, flown."""
    def slope(t, x):
        a, b, torque = force(t)
        return [x[1], torque - BETA * x[1] - (K + a) * math.sin(x[0]) + b * math.cos(x[0])]
    return flown(slope, 2 * math.pi, state, 1e-12)


def run(kapitza, folder, scene, *options):
    (folder / "rig.yaml").write_text(json.dumps(scene))
    kapitza("run", "rig.yaml", *options, "--force", folder=folder)
    return h5py.File(folder / "rig.h5")


LINEAR = {"key": "damping", "from": 0.06, "periods": 2.5}
SMOOTH = {"key": "drive_amplitude", "from": 0.1, "periods": 3, "shape": "smooth"}
