"""Drives beyond the sine: harmonics, wave forms, a tilted or elliptic path of the pivot, torque, the phase of release."""

import json
import math
import subprocess

import h5py
import numpy as np
import pytest
from conftest import PROGRAM, ROOT

WINDOW = {"theta": {"count": 24}, "velocity": {"min": -2, "max": 2, "count": 24}}
PENDULUM = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
K, BETA, M = 1 / 121, 1 / 55, 0.3
CORNERED = [(j, 4 / (math.pi * j) * (-1) ** (j // 2)) for j in (1, 3, 5, 7)]
# Keys -> (a - k, b, torque) of theta'' + beta theta' + a sin theta - b cos theta = torque.
RIGS = {
    "sine": ({}, lambda t: (-M * math.cos(t), 0, 0)),
    "harmonics": ({"harmonics": [{"order": 2, "amplitude": 0.1, "phase": math.pi / 6}, {"order": 1, "amplitude": 0.02}]},
                  lambda t: (-0.32 * math.cos(t) - 0.1 * math.cos(2 * t + math.pi / 6), 0, 0)),
    "square": ({"waveform": "square"}, lambda t: (-M * sum(share * math.cos(j * t) for j, share in CORNERED), 0, 0)),
    "tilted": ({"tilt": math.pi / 36}, lambda t: (-M * math.cos(math.pi / 36) * math.cos(t), M * math.sin(math.pi / 36) * math.cos(t), 0)),
    "ellipse": ({"ellipse": 0.2}, lambda t: (-M * math.cos(t), 0.2 * M * math.sin(t), 0)),
    "torque": ({"torque": 0.004}, lambda t: (-M * math.cos(t), 0, 0.004)),
}


def period(force, state, phase=0.0, steps=500):
    """One drive period from the phase `phase`, by Runge and Kutta."""
    def slope(t, x):
        a, b, torque = force(t)
        return np.array([x[1], torque - BETA * x[1] - (K + a) * math.sin(x[0]) + b * math.cos(x[0])])
    x, h = np.array(state, dtype=float), 2 * math.pi / steps
    for i in range(steps):
        t = phase + i * h
        one = slope(t, x)
        two = slope(t + h / 2, x + h / 2 * one)
        three = slope(t + h / 2, x + h / 2 * two)
        x = x + h / 6 * (one + 2 * two + 2 * three + slope(t + h, x + h * three))
    return x


def run(kapitza, folder, scene, *options):
    (folder / "rig.yaml").write_text(json.dumps(scene))
    kapitza("run", "rig.yaml", *options, "--force", folder=folder)
    return h5py.File(folder / "rig.h5")


@pytest.fixture(scope="module", params=RIGS)
def rig(request, kapitza, tmp_path_factory):
    keys, force = RIGS[request.param]
    basin = {**WINDOW, "method": "exact", "attractors": {"starts": 256}}
    return force, request.param, run(kapitza, tmp_path_factory.mktemp("rig"), {"pendulum": {**PENDULUM, **keys}, "basin": basin})


def test_published_cycles_obey_the_equation(rig):
    """An integration written here carries each strobe point to the next."""
    force, _, file = rig
    found = file["attractors"]
    for i, n in enumerate(found["period"][:]):
        points = np.column_stack([found["strobe_theta"][i, :n], found["strobe_velocity"][i, :n]])
        for j in range(n):
            theta, velocity = period(force, points[j])
            expected = points[(j + 1) % n]
            assert abs(math.remainder(theta - expected[0], 2 * math.pi)) < 1e-7 and abs(velocity - expected[1]) < 1e-7


def test_attractors_have_mirror_images_where_the_pendulum_is_mirrored(rig):
    _, name, file = rig
    mirror = file["attractors/mirror"][:]
    if name in ("tilted", "ellipse", "torque"):
        assert (mirror == -1).all()
    else:
        assert (mirror >= 0).all() and (mirror[mirror] == np.arange(len(mirror))).all()
        labels = file["basin/attractor"][:]
        image = np.append(mirror, -1)[labels[::-1, ::-1]]
        assert (labels == image).mean() > 0.99  # flagged cells have two candidates


def test_labels_are_those_of_fine_steps(rig, kapitza, tmp_path):
    """Decided labels against integration with four times the steps, where that itself does not doubt."""
    _, name, file = rig
    scene = {"pendulum": {**PENDULUM, **RIGS[name][0]}, "numerics": {"scheme": "split6", "steps_per_period": 96},
             "basin": {**WINDOW, "attractors": {"starts": 256}}}
    fine = run(kapitza, tmp_path, scene)
    names = [np.append(f["attractors/name"].asstr()[:], "")[f["basin/attractor"][:]] for f in (file, fine)]
    decided = file["basin/evidence"][:] < 3
    assert decided.mean() > 0.5 and (names[0] == names[1])[decided].mean() > 0.995


def test_a_whole_turn_of_the_phase_changes_nothing(kapitza, tmp_path):
    scene = {"pendulum": PENDULUM, "numerics": {"scheme": "split6"}, "basin": {**WINDOW, "attractors": {"starts": 256}}}
    plain = run(kapitza, tmp_path, scene)["basin/attractor"][:]
    turned = run(kapitza, tmp_path, scene, "--set", "basin.start_phase=360 deg")["basin/attractor"][:]
    quarter = run(kapitza, tmp_path, scene, "--set", "basin.start_phase=90 deg")
    assert (plain == turned).mean() > 0.98 and (plain == quarter["basin/attractor"][:]).mean() < 0.98
    found = quarter["attractors"]
    for i in np.flatnonzero(found["period"][:] == 1):
        x = found["strobe_theta"][i, 0], found["strobe_velocity"][i, 0]
        theta, velocity = period(RIGS["sine"][1], x, math.pi / 2)
        assert abs(math.remainder(theta - x[0], 2 * math.pi)) < 1e-7 and abs(velocity - x[1]) < 1e-7


@pytest.mark.parametrize("keys, study, named", [
    ({"tilt": math.pi / 36}, {"basin": {**WINDOW, "method": "icm"}}, "pendulum.tilt: basin.method icm"),
    ({"tilt": 0.1}, {"basin": WINDOW, "numerics": {"scheme": "rk4"}}, "pendulum.tilt: numerics.scheme rk4"),
    ({"waveform": "square"}, {"basin": {**WINDOW, "method": "exact", "proof": True}}, "pendulum.waveform: basin.proof"),
    ({"torque": 0.1}, {"potential": {"drive_amplitudes": [0.3]}}, "pendulum.torque: study potential"),
    ({"harmonics": [{"order": 17, "amplitude": 1}]}, {"basin": WINDOW}, "pendulum.harmonics"),
    ({"harmonics": [{"order": 2, "height": 1}]}, {"basin": WINDOW}, "none of order, amplitude, phase"),
])
def test_what_a_drive_does_not_allow_is_refused_by_name(kapitza, tmp_path, keys, study, named):
    (tmp_path / "rig.yaml").write_text(json.dumps({"pendulum": {**PENDULUM, **keys}, **study}))
    done = kapitza("check", "rig.yaml", folder=tmp_path, status=2)
    assert named in done.stderr, done.stderr


def test_frames_and_centred_windows_of_other_drives_are_refused(kapitza, tmp_path):
    """Their reference orbits know the sine alone: labels would be silently wrong."""
    tilted = ["--set", "pendulum.tilt=5 deg"]
    centred = ["--set", 'basin.theta={centre: "1", width: 0.1, count: 4}']
    small = ROOT / "scenes" / "small.yaml"
    done = kapitza("check", small, *tilted, *centred, "--set", "basin.method=exact", folder=tmp_path, status=2)
    assert "give min and max" in done.stderr
    words = [PROGRAM, "serve", small, *tilted, "--set", "basin.method=exact"]
    with subprocess.Popen(list(map(str, words)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as engine:
        engine.stdin.write('{"sequence": 1, "request": "catalogue"}\n')
        engine.stdin.flush()
        answers = [engine.stdout.readline() for _ in range(2)]
        engine.stdin.close()
    assert "as a sine" in answers[1]
