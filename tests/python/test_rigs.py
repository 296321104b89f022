"""Drives beyond the sine: harmonics, wave forms, a tilted or elliptic path of the pivot, torque, the phase of release."""

import json
import math
import subprocess

import h5py
import kapitza as kapitza_package
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


def step(slope, t, x, h):
    """By Runge and Kutta."""
    one = slope(t, x)
    two = slope(t + h / 2, x + h / 2 * one)
    three = slope(t + h / 2, x + h / 2 * two)
    return x + h / 6 * (one + 2 * two + 2 * three + slope(t + h, x + h * three))


def period(force, state, phase=0.0, steps=1500):
    """One drive period from the phase `phase`, by Runge and Kutta."""
    def slope(t, x):
        a, b, torque = force(t)
        return np.array([x[1], torque - BETA * x[1] - (K + a) * math.sin(x[0]) + b * math.cos(x[0])])
    x, h = np.array(state, dtype=float), 2 * math.pi / steps
    for i in range(steps):
        x = step(slope, phase + i * h, x, h)
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
            assert abs(math.remainder(theta - expected[0], 2 * math.pi)) < 1e-9 and abs(velocity - expected[1]) < 1e-9


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
    if name in ("sine", "square", "tilted", "torque"):
        pytest.skip("quad precision judges these: verification.drives, verification.certain")
    scene = {"pendulum": {**PENDULUM, **RIGS[name][0]}, "numerics": {"scheme": "split6", "steps_per_period": 96},
             "basin": {**WINDOW, "attractors": {"starts": 256}}}
    fine = run(kapitza, tmp_path, scene)
    names = [np.append(f["attractors/name"].asstr()[:], "")[f["basin/attractor"][:]] for f in (file, fine)]
    decided = (file["basin/evidence"][:] != 3) & (fine["basin/evidence"][:] != 9)
    assert decided.mean() > 0.8 and (names[0] == names[1])[decided].all()


def test_samples_are_the_harmonics_that_they_hold(kapitza, tmp_path):
    """Cosine of order 1 and sine of order 2, 8 samples; 64 samples of a square wave hold more, and what is left is told."""
    samples = [math.cos(math.pi * i / 4) + 0.25 * math.sin(math.pi * i / 2) for i in range(8)]
    basin = {"basin": {**WINDOW, "method": "direct", "attractors": {"starts": 256}}}
    labels = [run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **basin})["basin/attractor"][:]
              for keys in ({"waveform": "samples", "samples": samples},
                           {"harmonics": [{"order": 2, "amplitude": 0.25 * M, "phase": -math.pi / 2}]})]
    assert (labels[0] == labels[1]).all()
    square = {"pendulum": {**PENDULUM, "waveform": "samples", "samples": [1] * 16 + [-1] * 32 + [1] * 16}, **basin}
    (tmp_path / "rig.yaml").write_text(json.dumps(square))
    said = kapitza("check", "rig.yaml", folder=tmp_path).stdout.split("Drive: ")[1]
    times = 2 * math.pi * np.arange(64) / 64
    wave = np.array(square["pendulum"]["samples"], dtype=float)
    amplitude = np.fft.rfft(wave)[:17] / 32
    left = wave - sum((amplitude[j] * np.exp(1j * j * times)).real for j in range(1, 17))
    assert said.startswith("harmonics up to order 15 stand for 64 samples")
    assert abs(float(said.split("off by ")[1].split()[0]) - abs(left).max()) < 0.01


@pytest.mark.parametrize("keys, rest", [({}, "(for drive_amplitude"), ({"waveform": "square"}, "stable. Rest upside down: stable."),
                                        ({"waveform": "square", "drive_amplitude": 0.05}, "stable. Rest upside down: unstable."),
                                        ({"torque": 0.01}, "Rest: none")])
def test_rest_is_told_for_the_drive_that_is_there(kapitza, tmp_path, keys, rest):
    (tmp_path / "rig.yaml").write_text(json.dumps({"pendulum": {**PENDULUM, **keys}, "basin": WINDOW}))
    assert rest in kapitza("check", "rig.yaml", folder=tmp_path).stdout


def bessel(n, x):
    return sum((-1) ** i * (x / 2) ** (2 * i + n) / (math.factorial(i) * math.factorial(i + n)) for i in range(20))


@pytest.mark.parametrize("n", [0, 1])
def test_shapiro_steps_are_as_wide_as_bessel_functions(kapitza, tmp_path, n):
    """Kautz, Rep. Prog. Phys. 59 (1996) 935: under a fast drive step n reaches to beta n + k |J_n(a)|, a the swing's amplitude."""
    k, beta, amplitude = 0.02, 0.3, 1.5
    half = k * abs(bessel(n, amplitude / math.hypot(1, beta)))
    sweep = {"parameter": "torque", "min": beta * n, "max": beta * n + 1.2 * half, "count": 2, "measure": ["attractors"],
             "starts": 16, "velocity": {"min": n - 0.5, "max": n + 0.5}, "theta": {"min": -math.pi, "max": math.pi}}
    file = run(kapitza, tmp_path, {"pendulum": {"k": k, "damping": beta, "m": 0, "torque": 0, "torque_amplitude": amplitude},
                                   "numerics": {"scheme": "split6", "steps_per_period": 24}, "sweep": sweep})
    names = list(file["sweep/branch_name"].asstr()[:])
    step = names.index("rotation +1/1" if n else "down")
    assert abs((file["sweep/branch_end"][step] - beta * n) / half - 1) < 2e-3


@pytest.mark.parametrize("torque", [0, 0.13])
def test_an_oscillating_torque_is_that_of_the_equation(kapitza, tmp_path, torque):
    """Cycles in the frame of the swing g obey theta'' + beta theta' + k sin theta = torque + T cos t with theta + g."""
    k, beta, amplitude = 0.3, 0.5, 1.2
    scene = {"pendulum": {"k": k, "damping": beta, "m": 0, "torque": torque, "torque_amplitude": amplitude},
             "attractors": {"velocity": {"min": -1, "max": 1}, "starts": 64}}
    found = run(kapitza, tmp_path, scene)["attractors"]
    t0 = (-amplitude / (1 + beta**2), amplitude * beta / (1 + beta**2))  # g = a cos t + b sin t and its slope at t = 0
    x = np.array([found["strobe_theta"][0, 0] + t0[0], found["strobe_velocity"][0, 0] + t0[1]])
    start, steps = x.copy(), 1500 * int(found["period"][0])
    h = 2 * math.pi * int(found["period"][0]) / steps

    def slope(t, y):
        return np.array([y[1], torque + amplitude * math.cos(t) - beta * y[1] - k * math.sin(y[0])])
    for i in range(steps):
        x = step(slope, i * h, x, h)
    assert abs(math.remainder(x[0] - start[0], 2 * math.pi)) < 1e-9 and abs(x[1] - start[1]) < 1e-9


LINEAR = {"key": "damping", "from": 0.06, "periods": 2.5}
SMOOTH = {"key": "drive_amplitude", "from": 0.1, "periods": 3, "shape": "smooth"}


def released(theta, velocity, phase, ramp, steps=1000):
    """States at the strobe after which the drive has its final form, by Runge and Kutta."""
    length = ramp["periods"] if ramp else 0

    def slope(t, x):
        s = min(1.0, t / (2 * math.pi * length)) if length else 1.0
        rest = 1 - (s * s * (3 - 2 * s) if ramp and ramp.get("shape") == "smooth" else s)
        beta = BETA + ((ramp["from"] - BETA) * rest if ramp and ramp["key"] == "damping" else 0)
        m = M + ((ramp["from"] - M) * rest if ramp and ramp["key"] == "drive_amplitude" else 0)
        return np.array([x[1], -beta * x[1] - (K - m * np.cos(t)) * np.sin(x[0])])
    ends = sorted({2 * math.pi * n for n in range(1, max(1, math.ceil(length)) + 1)} | ({2 * math.pi * length} - {0.0}))
    t, x = phase, np.array([theta, velocity])
    for end in ends:
        h = (end - t) / steps
        for i in range(steps):
            x = step(slope, t + i * h, x, h)
        t = end
    return x


@pytest.mark.parametrize("phase, ramp", [(math.pi / 2, None), (0, LINEAR), (1.0, SMOOTH)])
def test_released_cells_end_where_an_integration_up_to_the_strobe_leads(kapitza, tmp_path, phase, ramp):
    pendulum = {**PENDULUM, **({"ramp": ramp} if ramp else {})}
    scene = {"pendulum": pendulum, "basin": {**WINDOW, "start_phase": phase, "attractors": {"starts": 256}}}
    file = run(kapitza, tmp_path, scene)
    theta, velocity = np.meshgrid(file["basin/theta"][::3], file["basin/velocity"][::3])
    x = released(theta.ravel(), velocity.ravel(), phase, ramp)
    there = kapitza_package.where({"pendulum": PENDULUM, "basin": {**WINDOW, "attractors": {"starts": 256}}}, x[0], x[1])
    names = np.append(file["attractors/name"].asstr()[:], "")[file["basin/attractor"][::3, ::3]].ravel()
    settling = file["basin/settling_time"][::3, ::3].ravel()
    assert (names == there["name"].to_numpy()).mean() > 0.98  # doubles of the integration above may cross a boundary
    late = settling - there["settling_time"].to_numpy(dtype=float)
    assert (late == (math.ceil(ramp["periods"]) if ramp else 1)).mean() > 0.9


def test_what_ends_alike_at_all_phases(kapitza, tmp_path):
    """Phase 0 is the basin itself, pi/2 that of start_phase; a common end is that of every phase. Same bytes for two ranks."""
    scene = {"pendulum": PENDULUM, "basin": {**WINDOW, "method": "exact", "phases": 4, "attractors": {"starts": 256}}}
    def shares(names, fractions):
        return dict(zip(names.asstr()[:], fractions, strict=True))
    other = run(kapitza, tmp_path, scene, "--set", "basin.start_phase=90 deg", "--set", "basin.phases=2")["attractors"]
    turned = shares(other["name"], other["fraction"][:])
    file = run(kapitza, tmp_path, scene)
    group, labels = file["phases"], file["basin/attractor"][:]
    assert np.allclose(group["phase"][:], [0, math.pi / 2, math.pi, 3 * math.pi / 2])
    assert (group["fraction"][0] == file["attractors/fraction"][:]).all()
    quarter = shares(file["attractors/name"], group["fraction"][1])
    assert all(abs(quarter.get(name, 0) - share) < 0.005 for name, share in turned.items())  # flagged cells have two candidates
    common, ends = group["common"][:], group["ends"][:]
    assert ((common >= 0) == (ends == 1)).all() and (common == labels)[common >= 0].all()
    assert group.attrs["share"] == (common >= 0).mean() and 0.02 < group.attrs["share"] < 0.3
    kapitza("run", "rig.yaml", "-o", "two.h5", folder=tmp_path, ranks=2)
    with h5py.File(tmp_path / "two.h5") as two:
        assert all((two["phases"][name][:] == group[name][:]).all() for name in ("common", "ends", "fraction"))


@pytest.mark.parametrize("name", ["tilted", "square"])
def test_saddles_manifolds_and_orbits_are_of_the_drive(kapitza, tmp_path, name):
    """Unstable cycles obey the equation, manifolds begin at them, an orbit settles on an attractor."""
    keys, force = RIGS[name]
    studies = {"saddles": {"max_period": 1, "velocity": {"min": -2, "max": 2}}, "manifolds": {"length": 5},
               "orbit": {"start": {"theta": 0.1, "velocity": 0}, "periods": 20}}
    file = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **studies})
    points = np.column_stack([file["saddles/strobe_theta"][:, 0], file["saddles/strobe_velocity"][:, 0]])
    assert len(points) > 0
    for point in points:
        theta, velocity = period(force, point)
        assert abs(math.remainder(theta - point[0], 2 * math.pi)) < 1e-9 and abs(velocity - point[1]) < 1e-9
    where = np.column_stack([file["manifolds/theta"][:], file["manifolds/velocity"][:]])
    assert len(where) > 100 and np.isfinite(where).all()
    assert file["orbit"].attrs["settles_on"] == "down"


def test_folding_changes_no_byte(kapitza, tmp_path):
    """A window that is its own mirror image is computed by half; with a row more nothing is folded."""
    basin = {"method": "exact", "theta": {"count": 24}, "attractors": {"starts": 256}}
    scene = {"pendulum": {**PENDULUM, "waveform": "triangle"}}
    folded = run(kapitza, tmp_path, {**scene, "basin": {**basin, "velocity": {"min": -2, "max": 2, "count": 16}}})["basin"]
    folded = {name: folded[name][:] for name in ("attractor", "settling_time", "velocity")}
    whole = run(kapitza, tmp_path, {**scene, "basin": {**basin, "velocity": {"min": -2, "max": 2.25, "count": 17}}})["basin"]
    assert (whole["velocity"][:16] == folded["velocity"]).all()
    assert (whole["attractor"][:16] == folded["attractor"]).all()


def test_releases_are_the_same_for_any_number_of_ranks_and_mirrored(kapitza, tmp_path):
    scene = {"pendulum": {**PENDULUM, "ramp": SMOOTH}, "basin": {**WINDOW, "start_phase": 1, "attractors": {"starts": 256}}}
    alone = run(kapitza, tmp_path, scene)
    labels, mirror = alone["basin/attractor"][:], alone["attractors/mirror"][:]
    assert (labels == np.append(mirror, -1)[labels[::-1, ::-1]]).mean() > 0.99
    (tmp_path / "rig.yaml").write_text(json.dumps(scene))
    kapitza("run", "rig.yaml", "-o", "two.h5", folder=tmp_path, ranks=2)
    with h5py.File(tmp_path / "two.h5") as two:
        for name in ("attractor", "settling_time", "evidence"):
            assert (two["basin"][name][:] == alone["basin"][name][:]).all()


def test_a_whole_turn_of_the_phase_and_a_ramp_of_no_length_change_nothing(kapitza, tmp_path):
    scene = {"pendulum": PENDULUM, "basin": {**WINDOW, "attractors": {"starts": 256}}}
    plain = run(kapitza, tmp_path, scene)["basin/attractor"][:]
    for option in ("basin.start_phase=360 deg", "pendulum.ramp={key: damping, from: 0, periods: 0}"):
        assert (plain == run(kapitza, tmp_path, scene, "--set", option)["basin/attractor"][:]).all()


def test_a_sweep_goes_along_a_ramp(kapitza, tmp_path):
    """Its first value is the basin without a ramp; a damping that comes down from four times its value leaves fewer rotations."""
    ramp = {"key": "damping", "from": 4 * BETA, "periods": 0}
    sweep = {"parameter": "ramp.periods", "min": 0, "max": 20, "count": 2, "measure": ["basin_fractions"], "starts": 256}
    basin = {**WINDOW, "method": "direct", "attractors": {"starts": 256}}
    file = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, "ramp": ramp}, "basin": basin, "sweep": sweep})
    share, names = file["sweep/fraction"][:], file["sweep/branch_name"].asstr()[:]
    share = share if share.shape[0] == len(names) else share.T
    whole = dict(zip(file["attractors/name"].asstr()[:], file["attractors/fraction"][:], strict=True))
    assert all(abs(whole[name] - share[i, 0]) < 1e-12 for i, name in enumerate(names))
    rotating = [name.startswith("rotation") for name in names]
    assert np.nansum(share[rotating, 1]) < 0.8 * np.nansum(share[rotating, 0])


@pytest.mark.parametrize("keys, study, named", [
    ({"tilt": math.pi / 36}, {"basin": {**WINDOW, "method": "icm"}}, "pendulum.tilt: basin.method icm"),
    ({"tilt": 0.1}, {"basin": WINDOW, "numerics": {"scheme": "rk4"}}, "pendulum.tilt: numerics.scheme rk4"),
    ({"waveform": "square"}, {"basin": {**WINDOW, "method": "exact", "proof": True}}, "pendulum.waveform: basin.proof"),
    ({"tilt": 0.1}, {"stability": {"k": {"min": 0, "max": 0.1, "count": 3}, "m": {"min": 0, "max": 1, "count": 3}}},
     "pendulum.tilt: study stability"),
    ({"torque": 0.1}, {"potential": {"drive_amplitudes": [0.3]}}, "pendulum.torque: study potential"),
    ({"ramp": LINEAR}, {"basin": {**WINDOW, "method": "icm"}}, "pendulum.ramp: basin.method icm"),
    ({"ramp": LINEAR}, {"basin": {**WINDOW, "proof": True}}, "pendulum.ramp: basin.proof"),
    ({"ramp": LINEAR}, {"attractors": {"velocity": {"min": -1, "max": 1}}}, "pendulum.ramp: needs the study basin"),
    ({"ramp": LINEAR}, {"basin": WINDOW, "orbit": {"start": {"theta": 1, "velocity": 0}}}, "pendulum.ramp: study orbit"),
    ({"ramp": {**LINEAR, "from": -1}}, {"basin": WINDOW}, "pendulum.ramp.from"),
    ({"drive_amplitude": 0.3, "torque_amplitude": 1}, {"basin": WINDOW}, "torque_amplitude is for a pivot at rest"),
    ({"drive_amplitude": 0, "torque_amplitude": 9}, {"basin": WINDOW}, "at most about 4"),
    ({"waveform": "samples"}, {"basin": WINDOW}, "pendulum.samples"),
    ({"samples": [1, 0, -1, 0]}, {"basin": WINDOW}, "pendulum.waveform: samples"),
    ({"ramp": {**LINEAR, "key": "k"}}, {"basin": WINDOW}, "pendulum.ramp.key"),
    ({}, {"basin": {**WINDOW, "method": "direct", "phases": 4}}, "basin.phases: needs basin.method exact"),
    ({}, {"basin": {**WINDOW, "start_phase": 1, "boundary": {}}}, "basin.start_phase: basin.boundary"),
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
