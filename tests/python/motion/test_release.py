"""Releases at a phase of the drive, ramps of damping and drive, what ends alike at all phases."""

import math

import kapitza as kapitza_package
import numpy as np
import own_orbit
import pytest
from conftest import EXTENSIVE, datasets, flown
from drives import BETA, LINEAR, PENDULUM, SMOOTH, WINDOW, K, M, run


def released(theta, velocity, phase, ramp):
    """States at the strobe after which the drive has its final form, flown."""
    length = ramp["periods"] if ramp else 0

    def slope(t, x):
        s = min(1.0, t / (2 * math.pi * length)) if length else 1.0
        rest = 1 - (s * s * (3 - 2 * s) if ramp and ramp.get("shape") == "smooth" else s)
        beta = BETA + ((ramp["from"] - BETA) * rest if ramp and ramp["key"] == "damping" else 0)
        m = M + ((ramp["from"] - M) * rest if ramp and ramp["key"] == "drive_amplitude" else 0)
        angle, speed = x.reshape(2, -1)
        return np.concatenate([speed, -beta * speed - (K - m * np.cos(t)) * np.sin(angle)])
    # A ramp has a corner at its end
    ends = [phase, *sorted({2 * math.pi * max(1, math.ceil(length))} | ({2 * math.pi * length} - {0.0}))]
    x = np.concatenate([theta, velocity])
    for begin, end in zip(ends, ends[1:], strict=False):
        x = flown(lambda t, u, begin=begin: slope(begin + t, u), end - begin, x, 1e-11)
    return x.reshape(2, -1)


@pytest.mark.parametrize("phase, ramp", [(math.pi / 2, None), (0, LINEAR), (1.0, SMOOTH)])
def test_released_cells_end_where_an_integration_up_to_the_strobe_leads(kapitza, tmp_path, phase, ramp):
    pendulum = {**PENDULUM, **({"ramp": ramp} if ramp else {})}
    scene = {"pendulum": pendulum, "basin": {**WINDOW, "start_phase": phase, "attractors": {"starts": 256}}}
    file = run(kapitza, tmp_path, scene)
    theta, velocity = np.meshgrid(file["basin/theta"][::3], file["basin/velocity"][::3])
    x = released(theta.ravel(), velocity.ravel(), phase, ramp)
    there = kapitza_package.where({"pendulum": PENDULUM, "basin": {**WINDOW, "attractors": {"starts": 256}}}, x[0],
                                  x[1])
    names = np.append(file["attractors/name"].asstr()[:], "")[file["basin/attractor"][::3, ::3]].ravel()
    settling = file["basin/settling_time"][::3, ::3].ravel()
    assert (names == there["name"].to_numpy()).mean() > 0.98  # doubles of the integration above may cross a boundary
    late = settling - there["settling_time"].to_numpy(dtype=float)
    assert (late == (math.ceil(ramp["periods"]) if ramp else 1)).mean() > 0.9


PHASED = {"k": 0.0995439994018073, "damping": 0.08829602812899937, "m": 0.47545631300243496}


@pytest.mark.parametrize("phase, theta, velocity, end", [
    (7.5, -0.8639379797371931, -1.406431730302596, "inverted"),
    (1e5, 1.335176877775662, -1.8914081890276266, "rotation +1/1"),
    (-3.0, 0.8639379797371931, -0.24248822936251624, "inverted"),
])
def test_decided_labels_are_those_of_exactly_the_phase(phase, theta, velocity, end):
    """Whole turns that are taken out in doubles move the phase by 2e-16 to 1e-12, and these starts to another
    attractor."""
    basin = {"velocity": {"min": -2, "max": 2, "count": 8}, "theta": {"count": 8}, "start_phase": phase}
    found = kapitza_package.where({"pendulum": PHASED, "basin": basin}, theta, velocity).iloc[0]
    assert found["decided"] and found["name"] == end
    if EXTENSIVE:  # an integrator that shares nothing with the program
        points = [[(0.0, 0.0)], [*zip(found["strobe_theta"], found["strobe_velocity"], strict=True)]]
        assert own_orbit.end_of(tuple(PHASED.values()), (theta, velocity), points, 20, phase=phase) == 1


def test_what_ends_alike_at_all_phases(kapitza, tmp_path):
    """Phase 0 is the basin itself, pi/2 that of start_phase; a common end is that of every phase. Same bytes for two
    ranks."""
    scene = {"pendulum": PENDULUM, "basin": {**WINDOW, "method": "exact", "phases": 4, "attractors": {"starts": 256}},
             "sweep": {"parameter": "drive_amplitude", "min": 0.3, "max": 0.3001, "count": 2, "starts": 256,
                       "measure": ["phases"], "phases": 4}}

    def shares(names, fractions):
        return dict(zip(names.asstr()[:], fractions, strict=True))
    other = run(kapitza, tmp_path, scene, "--set", "basin.start_phase=90 deg", "--set", "basin.phases=2")["attractors"]
    turned = shares(other["name"], other["fraction"][:])
    file = run(kapitza, tmp_path, scene)
    group, labels, swept = file["phases"], file["basin/attractor"][:], file["sweep"]
    assert np.allclose(group["phase"][:], [0, math.pi / 2, math.pi, 3 * math.pi / 2])
    assert (group["fraction"][0] == file["attractors/fraction"][:]).all()
    quarter = shares(file["attractors/name"], group["fraction"][1])
    # Flagged cells have two candidates
    assert all(abs(quarter.get(name, 0) - share) < 0.005 for name, share in turned.items())
    common, ends = group["common"][:], group["ends"][:]
    assert ((common >= 0) == (ends == 1)).all() and (common == labels)[common >= 0].all()
    assert group.attrs["share"] == (common >= 0).mean() and 0.02 < group.attrs["share"] < 0.3
    low, alike, high = (swept[name][:] for name in ("alike_low", "alike", "alike_high"))
    # The sweep follows in doubles
    assert abs(alike[0] - group.attrs["share"]) < 0.01 and (low < alike).all() and (alike < high).all()
    kapitza("run", "rig.yaml", "-o", "two.h5", folder=tmp_path, ranks=2)
    assert datasets(tmp_path / "two.h5") == datasets(file.filename)
    del scene["basin"]
    by_starts = run(kapitza, tmp_path, scene)["sweep"]
    assert (by_starts["alike_low"][:]
            < high).all() and (low < by_starts["alike_high"][:]).all() and by_starts.attrs["phases"] == 4
    scene["sweep"].update(theta={"min": math.pi - 0.01, "max": math.pi + 0.01}, velocity={"min": -0.01, "max": 0.01})
    # About upside down, which attracts at every phase
    assert (run(kapitza, tmp_path, scene)["sweep/alike"][:] == 1).all()


def test_releases_are_the_same_for_any_number_of_ranks_and_mirrored(kapitza, tmp_path):
    scene = {"pendulum": {**PENDULUM, "ramp": SMOOTH},
             "basin": {**WINDOW, "start_phase": 1, "attractors": {"starts": 256}}}
    alone = run(kapitza, tmp_path, scene)
    labels, mirror = alone["basin/attractor"][:], alone["attractors/mirror"][:]
    assert (labels == np.append(mirror, -1)[labels[::-1, ::-1]]).mean() > 0.99
    kapitza("run", "rig.yaml", "-o", "two.h5", folder=tmp_path, ranks=2)
    assert datasets(tmp_path / "two.h5") == datasets(alone.filename)


def test_a_whole_turn_of_the_phase_and_a_ramp_of_no_length_change_nothing(kapitza, tmp_path):
    scene = {"pendulum": PENDULUM, "basin": {**WINDOW, "attractors": {"starts": 256}}}
    plain = run(kapitza, tmp_path, scene)["basin/attractor"][:]
    for option in ("basin.start_phase=360 deg", "pendulum.ramp={key: damping, from: 0, periods: 0}"):
        assert (plain == run(kapitza, tmp_path, scene, "--set", option)["basin/attractor"][:]).all()


def test_a_sweep_goes_along_a_ramp(kapitza, tmp_path):
    """Its first value is the basin without a ramp; a damping that comes down from four times its value leaves fewer
    rotations."""
    ramp = {"key": "damping", "from": 4 * BETA, "periods": 0}
    sweep = {"parameter": "ramp.periods", "min": 0, "max": 20, "count": 2, "measure": ["basin_fractions"],
             "starts": 256}
    basin = {**WINDOW, "method": "direct", "attractors": {"starts": 256}}
    file = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, "ramp": ramp}, "basin": basin, "sweep": sweep})
    share, names = file["sweep/fraction"][:], file["sweep/branch_name"].asstr()[:]
    share = share if share.shape[0] == len(names) else share.T
    whole = dict(zip(file["attractors/name"].asstr()[:], file["attractors/fraction"][:], strict=True))
    assert all(abs(whole[name] - share[i, 0]) < 1e-12 for i, name in enumerate(names))
    rotating = [name.startswith("rotation") for name in names]
    assert np.nansum(share[rotating, 1]) < 0.8 * np.nansum(share[rotating, 0])
