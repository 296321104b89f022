"""Torques in the words of textbooks and of junctions; every number that scenes/textbooks and docs/howto/textbooks.md
say a book prints."""

import json
import math
import re
from decimal import Decimal, localcontext

import h5py
import numpy as np
import pytest
import yaml
from conftest import ROOT, run_scene
from kapitza import starts

SCENES = ROOT / "scenes" / "textbooks"
PAGE = (ROOT / "docs" / "howto" / "textbooks.md").read_text()
UNDECIDED = 3
WINDOW = {"velocity": {"min": -2, "max": 2}, "starts": 64}


def scene_of(name, **pendulum):
    scene = yaml.safe_load((SCENES / f"{name}.yaml").read_text())
    return scene | {"pendulum": scene["pendulum"] | pendulum}


def found(kapitza, folder, name, **pendulum):
    """(period, |winding|) of the attractors of a scene."""
    rows = run_scene(kapitza, folder, scene_of(name, **pendulum))[0].group("attractors")
    return set(zip(rows["period"].values.tolist(), np.abs(rows["winding"].values).tolist(), strict=True))


def limit_of_rest(kapitza, name, words):
    return float(re.search(words + r" ([\d.]+)", kapitza("check", "--all", SCENES / f"{name}.yaml").stdout).group(1))


def test_every_scene_stands_on_the_page():
    assert {path.stem for path in SCENES.glob("*.yaml")} == set(re.findall(r"textbooks/([\w-]+)\.yaml", PAGE))


OMEGA, MASS, LENGTH, GRAVITY = 3.0, 0.2, 0.5, 9.81
K = GRAVITY / LENGTH / OMEGA**2
MOMENT = MASS * GRAVITY * LENGTH  # M g r, N m
SI = {"length": LENGTH, "mass": MASS, "pivot_frequency": OMEGA, "amplitude": 0, "gravity": GRAVITY, "quality_factor": 4}
OWN = {"quality_factor": 4, "drive_frequency": 1 / math.sqrt(K), "drive_amplitude": 0}
WAYS = {
    "in units of I omega^2": OWN | {"torque": 0.2 * K, "torque_amplitude": 0.5 * K},
    "in units of M g r": OWN | {"constant_torque_ratio": 0.2, "gamma": 0.5},
    "N m": SI | {"constant_torque": f"{0.2 * MOMENT} N m", "oscillating_torque": f"{500 * MOMENT} mN m"},
    "a body": {name: value for name, value in SI.items() if name != "length"}
    | {"radius": LENGTH, "inertia": MASS * LENGTH**2, "constant_torque_ratio": 0.2, "oscillating_torque": 0.5 * MOMENT},
    "junction": {"beta_c": 16, "omega": 1 / math.sqrt(K), "i_dc": 0.2, "i_ac": 0.5},
}


@pytest.mark.parametrize("way", WAYS)
def test_all_words_give_one_pendulum(kapitza, tmp_path, way):
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": WAYS[way], "attractors": WINDOW})
    numbers = [result.pendulum[name] for name in ("k", "beta", "m", "torque", "torque_amplitude", "quality_factor")]
    assert np.allclose(numbers, [K, math.sqrt(K) / 4, 0, 0.2 * K, 0.5 * K, 4], rtol=1e-14, atol=0)


@pytest.mark.parametrize(
    ("parameter", "pendulum", "low", "high"),
    [("drive_frequency", OWN | {"gamma": 0.5}, 0.8, 1.4), ("pivot_frequency", SI | {"oscillating_torque": 0.5 * MOMENT},
                                                           3, 6)],
)
def test_a_torque_stays_the_same_in_a_sweep_of_the_frequency(kapitza, tmp_path, parameter, pendulum, low, high):
    """At both ends of the sweep the cycle is that of the torque 0.5 M g r; in units of I omega^2 it has become
    smaller."""
    sweep = {"parameter": parameter, "min": low, "max": high, "count": 2, "measure": ["attractors"], **WINDOW}
    swept, _ = run_scene(kapitza, tmp_path, {"pendulum": pendulum, "sweep": sweep}, name="swept")
    with h5py.File(swept.path) as file:
        cycles = np.stack([file["sweep/branch_theta"][:], file["sweep/branch_velocity"][:]], axis=-1)[
            :, file["sweep/branch_stable"][:] == 1
        ]
    for value, cycle in zip((low, high), cycles, strict=True):
        k = GRAVITY / LENGTH / value**2 if parameter == "pivot_frequency" else 1 / value**2
        alone = {"k": k, "damping": math.sqrt(k) / 4, "m": 0, "torque_amplitude": 0.5 * k}
        rows = run_scene(kapitza, tmp_path, {"pendulum": alone, "attractors": WINDOW},
                         name="alone")[0].group("attractors")
        strobe = np.array([rows["strobe_theta"].values[0, 0], rows["strobe_velocity"].values[0, 0]])
        assert np.nanmin(np.abs(cycle - strobe).sum(axis=-1)) < 1e-9


@pytest.mark.parametrize("count", [7, 13])
def test_miles_loses_symmetry_where_he_says(kapitza, tmp_path, count):
    """delta = 1/8, epsilon = 1/2: at the frequency .595017791, in one sweep with values close to it. Both twins go
    there in one piece."""
    sweep = {"parameter": "drive_frequency", "min": 0.58, "max": 0.61, "count": count, "measure": ["attractors"],
             **WINDOW}
    result, _ = run_scene(kapitza, tmp_path,
                          {"pendulum": OWN | {"quality_factor": 4, "drive_frequency": 1, "gamma": 0.5}, "sweep": sweep})
    with h5py.File(result.path) as file:
        names = ("stable", "symmetric", "mirror", "start", "end")
        rows = [row for row in zip(*(file[f"sweep/branch_{name}"][:].tolist() for name in names), strict=True)
                if row[0]]
    breaking = pytest.approx(0.595017791, abs=5e-10)
    assert rows == [(1, 1, 0, 0.58, 0.61), (1, 0, 2, 0.58, breaking), (1, 0, 1, 0.58, breaking),
                    (1, 1, 3, breaking, 0.61)]


@pytest.mark.parametrize(("word", "meant"),
                         [("F_D", "torque_ratio"), ("current", "i_dc"), ("omega_D", "drive_frequency")])
def test_words_of_books_are_answered_by_the_key(kapitza, tmp_path, word, meant):
    (tmp_path / "s.yaml").write_text(json.dumps({"pendulum": OWN | {word: 1}, "attractors": WINDOW}))
    assert f"pendulum.{word}: unknown key; the program calls it {meant}" in kapitza("run", "s.yaml", folder=tmp_path,
                                                                                    status=2).stderr


@pytest.mark.parametrize(
    ("pendulum", "named"),
    [
        (OWN | {"torque": 1, "constant_torque_ratio": 1}, "pendulum.constant_torque_ratio: contradicts torque"),
        (WAYS["junction"] | {"torque_ratio": 1}, "pendulum.i_ac: contradicts torque_ratio"),
        (WAYS["junction"] | {"k": 1}, "pendulum.k: contradicts pendulum.beta_c"),
        ({name: value for name, value in WAYS["N m"].items() if name != "mass"},
         "lacks: mass (beside friction or a torque)"),
    ],
)
def test_two_words_for_one_torque_are_refused(kapitza, tmp_path, pendulum, named):
    (tmp_path / "s.yaml").write_text(json.dumps({"pendulum": pendulum, "attractors": WINDOW}))
    assert named in kapitza("run", "s.yaml", folder=tmp_path, status=2).stderr


def test_period_doublings_are_those_of_taylor(kapitza, tmp_path):
    """Table 12.1."""
    result, _ = run_scene(kapitza, tmp_path, scene_of("taylor"))
    with h5py.File(result.path) as file:
        branch = {name: file[f"sweep/branch_{name}"][:] for name in ("period", "end", "stable")}
        ends = file["sweep/branch_name"].asstr()[:]
    doublings = [branch["end"][(branch["period"] == n) & (branch["stable"] == 1)] for n in (1, 2, 4, 8)]
    assert len(ends) and [round(float(values.max()), 4) for values in doublings] == [1.0664, 1.0793, 1.0821, 1.0827]
    assert np.allclose([values.max() for values in doublings], [1.0663729, 1.0793139, 1.0820844, 1.0826783], rtol=0,
                       atol=6e-8)


@pytest.mark.parametrize(
    ("name", "amplitude", "motion"),
    [
        ("baker-gollub", 1.07, {(2, 0)}),
        ("baker-gollub", 1.15, {(0, 0)}),
        ("baker-gollub", 1.35, {(1, 1)}),
        ("baker-gollub", 1.45, {(2, 2)}),
        ("baker-gollub", 1.47, {(4, 4)}),
        ("baker-gollub", 1.5, {(0, 0)}),
        ("giordano", 1.35, {(1, 1)}),
        ("giordano", 1.44, {(2, 2)}),
        ("giordano", 1.465, {(4, 4)}),
    ],
)
def test_baker_and_gollub_and_giordano(kapitza, tmp_path, name, amplitude, motion):
    assert found(kapitza, tmp_path, name, torque_ratio=amplitude) == motion


def test_turns_are_those_of_hubbard(kapitza, tmp_path):
    scene = scene_of("hubbard")
    scene["basin"] |= {"theta": {"count": 32}, "velocity": {"min": -3, "max": 5, "count": 32}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    assert result.group("attractors")["period"].values.tolist() == [1]
    assert np.all(result.group("basin")["attractor"].values == 0)


def turns_of(scene, theta, velocity, **keys):
    return starts.where(scene, theta, velocity, keys)["turns"].to_numpy(dtype=float, na_value=np.nan)


def turned(theta, velocity, phase=0.0, periods=60, steps=400):
    """The same by Runge-Kutta steps, as the angle at the end is that of a well."""

    def rates(time, state):
        return np.array([state[1], -0.1 * state[1] - np.sin(state[0]) + np.cos(time)])

    state, step, angles = np.array([theta, velocity], dtype=float), 2 * np.pi / steps, []
    for i in range(periods * steps):
        time = phase + i * step
        a = rates(time, state)
        b = rates(time + step / 2, state + step / 2 * a)
        c = rates(time + step / 2, state + step / 2 * b)
        d = rates(time + step, state + step * c)
        state = state + step / 6 * (a + 2 * b + 2 * c + d)
        angles.append(state[0])
    return round((np.mean(angles[-steps:]) - theta) / (2 * np.pi))


def test_the_lakes_of_hubbard(kapitza, tmp_path):
    """Net turns of the article's starts; of a start of many digits, of one given a turn farther; of cells of any depth
    as of starts."""
    scene = scene_of("hubbard")
    assert turns_of(scene, 0, [1.85, 1.9, 2, -2, 0]).tolist() == [0, 1, 3, -2, 0]
    assert turns_of(scene, ["6.283185307179586476925286766559", "2 pi"], [2, 2]).tolist() == [3, 3]
    released = turns_of(scene, 0, [1.85, -1.2], **{"basin.start_phase": 1.0})
    assert released.tolist() == [turned(0, 1.85, phase=1), turned(0, -1.2, phase=1)]
    for centre, width, count in (("0.3", "4", 12), ("2.8", "1e-16", 4)):
        window = {"centre": centre, "width": width, "count": count}, {"centre": "3.21", "width": width, "count": count}
        scene["basin"] = {"theta": window[0], "velocity": window[1], "turns": True}
        basin = run_scene(kapitza, tmp_path, scene)[0].group("basin")
        with localcontext(prec=60):
            shares = [basin[name].values.tolist() for name in ("theta_offset", "velocity_offset")]
            starts = [
                [f"{Decimal(axis['centre']) + Decimal(share) * Decimal(width):.50f}" for share in along]
                for axis, along in zip(window, shares, strict=True)
            ]
        angles, speeds = (values.ravel() for values in np.meshgrid(*starts))
        decided = basin["evidence"].values.ravel() != UNDECIDED
        assert np.array_equal(turns_of(scene_of("hubbard"), angles, speeds)[decided],
                              basin["turns"].values.ravel()[decided])
        assert np.mean(decided) > 0.9


@pytest.mark.parametrize("method", ["icm", "direct"])
def test_every_method_counts_turns(kapitza, tmp_path, method):
    """Mirrored starts turn the other way; ends that rotate have no number."""
    scene = yaml.safe_load((ROOT / "scenes" / "blackburn-fig12.yaml").read_text())
    scene["basin"] |= {"theta": {"count": 60}, "velocity": {"min": -2, "max": 2, "count": 60}, "turns": True}
    exact, other = (run_scene(kapitza, tmp_path, scene, "--set", f"basin.method={word}", name=word)[0]
                    for word in ("exact", method))
    basin, same = exact.group("basin"), other.group("basin")
    turns = basin["turns"].values
    agree = same["attractor"].values == basin["attractor"].values
    assert np.mean(agree) > 0.97 and np.mean((same["turns"].values == turns)[agree & ~np.isnan(turns)]) > 0.97
    assert np.array_equal(turns, -turns[::-1, ::-1], equal_nan=True) and np.nanmax(turns) > 5
    told = exact.at(np.repeat(basin["theta"].values[::20], 3), np.tile(basin["velocity"].values[::20], 3))["turns"]
    assert np.array_equal(told.to_numpy(dtype=float, na_value=np.nan), turns[::20, ::20].T.ravel(), equal_nan=True)
    assert np.array_equal(np.isnan(turns), exact.group("attractors")["winding"].values[basin["attractor"].values] != 0)


@pytest.mark.parametrize(("ratio", "all_rest"), [(0.126, True), (0.1285, False)])
def test_running_begins_where_strogatz_says(kapitza, tmp_path, ratio, all_rest):
    """Running begins at the homoclinic, 4 alpha/pi = .12732 for small alpha, .127008860 at alpha = .1."""
    scene = scene_of("strogatz", constant_torque_ratio=ratio)
    scene["basin"] |= {"theta": {"count": 16}, "velocity": {"min": 0, "max": 4, "count": 8}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    rows = result.group("attractors")
    rest = int(np.flatnonzero((rows["period"] == 1) & (rows["winding"] == 0))[0])
    assert bool(np.all(result.group("basin")["attractor"].values == rest)) == all_rest


def test_basin_stability_of_the_running_state(kapitza, tmp_path):
    """bSTAB and pyBasin: .848 +- .0036 from 10,000 random starts; 1600 cells differ by three times as much at most."""
    result, _ = run_scene(kapitza, tmp_path, scene_of("running-state"))
    rows = result.group("attractors")
    assert rows["name"].values.tolist() == ["down", "running +"] and (result.group("basin")["evidence"].values
                                                                      < 3).all()
    assert rows["fraction"].values == pytest.approx([0.152, 0.848], abs=0.0108)
    assert rows["mean_velocity"].values == pytest.approx([0, 4.99599559], abs=1e-7)
    assert np.abs(rows["lyapunov"].values[1]) <= rows["lyapunov_error"].values[1] < 1e-6


def test_the_running_state_is_born_on_the_homoclinic_orbit(kapitza, tmp_path):
    sweep = {"parameter": "torque", "min": 0.1, "max": 0.2, "count": 3, "measure": ["attractors"], "starts": 64}
    pendulum = scene_of("running-state")["pendulum"]
    result, said = run_scene(kapitza, tmp_path,
                             {"pendulum": pendulum, "sweep": sweep | {"velocity": {"min": 0, "max": 4}}})
    with h5py.File(result.path) as file:
        row = file["sweep/branch_name"].asstr()[:].tolist().index("running +")
        assert abs(file["sweep/branch_start"][row] - 0.127008860) < 1e-9 and file["sweep/branch_start_kind"][row] == 6
        assert (file["sweep/fraction_unsettled"][:] == 0).all()
    assert "homoclinic" in said and "nothing known" not in said


def test_a_sweep_says_what_ends_on_nothing_known(kapitza, tmp_path):
    """The rotations of two periods are longer than the search looks for."""
    sweep = {"parameter": "torque_ratio", "min": 1.449, "max": 1.45, "count": 2, "measure": ["attractors"],
             "starts": 32, "max_period": 1}
    result, said = run_scene(kapitza, tmp_path, {"pendulum": scene_of("baker-gollub")["pendulum"], "sweep": sweep})
    with h5py.File(result.path) as file:
        assert (file["sweep/fraction_unsettled"][:] == 1).all()
    assert "at 2 values 100.00 to 100.00 % of the starts or cells end on nothing known" in said


def test_landau_and_lifshitz(kapitza):
    assert math.isclose(
        limit_of_rest(kapitza, "landau-lifshitz", "inverted: stable .for drive_amplitude from"), math.sqrt(2) / 100,
        rel_tol=1e-3
    )


def test_inverted_stands_where_kapitza_says(kapitza):
    """A omega = sqrt(2 g l)."""
    limit = limit_of_rest(kapitza, "kapitza", "inverted: stable .for amplitude from")
    assert math.isclose(limit * 1e-3 * 2 * math.pi * 50, math.sqrt(2 * 9.80665 * 0.2), rel_tol=1e-3)


def test_resonance_begins_where_butikov_says(kapitza):
    assert limit_of_rest(kapitza, "butikov", "down: unstable .stable for drive_amplitude up to") == 0.1002


def test_mccumber_and_stewart(kapitza, tmp_path):
    """On a step the mean velocity is whole, and the currents of step 1 lie about the Ohmic line i = omega /
    sqrt(beta_c)."""
    result, _ = run_scene(kapitza, tmp_path, scene_of("mccumber-stewart"))
    with h5py.File(result.path) as file:
        group = file["line"]
        velocity, current = group["mean_velocity"][:], group["value"][:]
    velocity = velocity.reshape(len(current),
                                -1) if velocity.shape[0] == len(current) else velocity.reshape(-1, len(current)).T
    steps = {n: current[np.any(velocity == n, axis=1)] for n in (0, 1)}
    assert steps[0].min() == 0 and steps[1].size >= 2 and abs(steps[1].mean() - 1.5) <= 0.25
