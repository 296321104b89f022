"""The studies orbit and attractors: what must hold for every orbit, models, chaos, refusals."""

import json
import re
from math import cos, pi, sqrt

import numpy as np
import pytest
from conftest import ROOT, datasets, refused_scene, run_scene, with_extensive
from orbit_scenes import BLACKBURN, FIGURES, NODDING, WINDOW, closed, parameters


def test_open_record_tells_the_period(model):
    """The settled motion, not closed by Newton: its windowed lines tell n and the winding of the cycle that attracts
    it."""
    cycle = NODDING["n4_bottom_k0.02_m0.307_Q8"]
    theta, velocity = map(float, cycle["strobe_theta_v_at_t0"][0])
    start = {"theta": theta + 0.01, "velocity": velocity}
    orbit = model(parameters(cycle), orbit={"start": start, "transient": 800, "periods": 200}).group("orbit")
    assert (orbit.attrs["closed"], orbit.attrs["period"], orbit.attrs["winding"]) == (0, 4, 0)
    spin = FIGURES["0.300"]["attractors"][4]
    start = dict(zip(("theta", "velocity"), map(float, spin["strobe_points"][0]), strict=True))
    orbit = model({**BLACKBURN, "drive_amplitude": 0.3}, orbit={"start": start, "periods": 300}).group("orbit")
    assert (orbit.attrs["closed"], orbit.attrs["period"], orbit.attrs["winding"]) == (0, 6, 2)


@pytest.mark.parametrize(("scene", "period", "name"), [
    ("butikov-fig07", 4, "down 4-nodding"), ("butikov-fig08", 6, "down 6-nodding")])
def test_butikovs_figures_are_his_noddings(kapitza, tmp_path, scene, period, name):
    orbit = run_scene(kapitza, tmp_path, (ROOT / "scenes" / f"{scene}.yaml").read_text())[0].group("orbit")
    phases = orbit["line_phase"].values[[1, period - 1, period + 1]]
    assert (orbit.attrs["period"], orbit.attrs["name"], orbit.attrs["dominant_line"]) == (period, name, 1)
    assert scene == "butikov-fig07" or np.all(np.abs(np.sin(2 * phases)) > 0.1)  # neither sines nor cosines


def test_the_slow_motion_has_its_fast_part(model):
    """Theta + xi is a quarter as far from the angle as Theta alone: Blackburn (1992), Eq. (9)."""
    pendulum, start = {"k": 1 / 121, "damping": 1 / 55, "m": 0.15}, {"theta": pi + 0.17, "velocity": 0}
    slow = model(pendulum, orbit={"model": "effective", "start": start, "periods": 5}).group("orbit")
    xi, theta = slow["xi"].values, slow["theta"].values
    assert np.abs(xi + 0.15 * np.sin(theta) * np.cos(slow["time"].values)).max() < 1e-14
    whole = model(pendulum, orbit={"start": {"theta": theta[0] + xi[0], "velocity": 0},
                                   "periods": 5}).group("orbit")["theta"].values
    whole = whole[::(len(whole) - 1) // (len(theta) - 1)]
    assert np.abs(theta + xi - whole).max() < 0.3 * np.abs(theta - whole).max()


def test_chaos_of_the_papers_ends_on_a_rotation(kapitza, tmp_path):
    orbit = run_scene(kapitza, tmp_path, (ROOT / "scenes" / "blackburn-chaos.yaml").read_text())[0].group("orbit")
    turns = np.diff(orbit["strobe_theta"].values) / (2 * pi)
    assert np.ptp(turns[:40]) > 1  # how long it lasts depends on the last digits of a machine, what is left does not
    assert re.fullmatch(r"rotation [+-](1/1|2/2)", orbit.attrs["settles_on"])


def test_chaos_is_never_a_long_period(model):
    pendulum = {"k": 0.25, "damping": 0.05, "m": 0.5}
    listed = model(pendulum, attractors={"velocity": {"min": -2, "max": 2}}).group("attractors")
    assert [str(name) for name in listed["name"].values] == ["chaotic"]
    assert listed["lyapunov"].values[0] > 5 * listed["lyapunov_error"].values[0] > 0
    orbit = model(pendulum, orbit={"start": {"theta": 1, "velocity": 0.2}, "transient": 1000,
                                   "periods": 400}).group("orbit")
    assert (orbit.attrs["period"], orbit.attrs["name"]) == (0, "chaotic")
    assert orbit.attrs["lyapunov"] > 5 * orbit.attrs["lyapunov_error"] > 0
    assert abs(orbit.attrs["lyapunov"] - listed["lyapunov"].values[0]) < 6 * orbit.attrs["lyapunov_error"]


@pytest.mark.parametrize(("keys", "unit", "omega"), [
    ({"k": 0.25, "damping": 0.05, "m": 0.5}, "drive radian", 1),
    ({"drive_frequency": 2, "quality_factor": 10, "drive_amplitude": 0.5}, "1/omega0", 2),
    ({"length": "9.80665 m", "frequency": f"{1 / pi} Hz", "amplitude": "4.903325 m", "quality_factor": 10}, "s", 2)])
def test_exponents_are_told_in_time_of_the_scene(kapitza, tmp_path, keys, unit, omega):
    """One pendulum in drive radians, in natural frequencies, and of 9.80665 m with a drive of 2 rad/s."""
    scene = {"pendulum": keys, "attractors": {"velocity": {"min": -2, "max": 2}, "starts": 64},
             "orbit": {"start": {"theta": 1, "velocity": 0.2}, "transient": 1000, "periods": 400}}
    result, said = run_scene(kapitza, tmp_path, scene)
    listed, orbit = result.group("attractors"), result.group("orbit").attrs
    told = re.findall(r"exponent(?: of 0:)? (\S+) \+- (\S+) per drive period, (\S+) \+- (\S+) per (.*)", said)
    for line, (mean, error) in zip(told, [(listed["lyapunov"].values[0], listed["lyapunov_error"].values[0]),
                                          (orbit["lyapunov"], orbit["lyapunov_error"])], strict=True):
        numbers = [mean, error, mean * omega / (2 * pi), error * omega / (2 * pi)]
        assert line[4] == unit and [float(text) for text in line[:4]] == pytest.approx(numbers, rel=0.05)


def test_lines_of_chaos_are_those_of_the_velocity(model):
    """Its angle drifts by many turns, whose spectrum hides everything else; against numpy's transform through the same
    window."""
    orbit = model({"k": 0.25, "damping": 0.05, "m": 0.5},
                  orbit={"start": {"theta": 1, "velocity": 0.2}, "transient": 1000, "periods": 100}).group("orbit")
    assert (orbit.attrs["line_quantity"], orbit["line_amplitude"].attrs["units"]) == ("velocity", "1")
    samples = round(2 * pi / orbit["time"].values[1])
    # As in 0.2.0
    assert [0.5 * cos(orbit["time"].values[i]) for i in range(samples)] == list(orbit["pivot"].values[:samples])
    velocity = orbit["velocity"].values[:-1]
    from scipy import signal  # loaded here: it takes a second

    window = signal.get_window("blackmanharris", len(velocity))
    mean = np.average(velocity, weights=window)
    lines = 2 * np.abs(np.fft.rfft((velocity - mean) * window)) / window.sum()
    ours = orbit["line_amplitude"].values
    assert np.ptp(orbit["theta"].values) > 6 * pi
    assert abs(ours[0] - abs(mean)) < 1e-9 and np.abs(ours[1:] - lines[1:len(ours)]).max() < 1e-9
    assert orbit.attrs["dominant_line"] == 1 + ours[1:].argmax()


SETTLING = {
    "inverted": ({**BLACKBURN, "drive_amplitude": 0.3}, {"theta": 3, "velocity": 0.1}),
    "rotation +1/1": ({**BLACKBURN, "drive_amplitude": 0.3}, {"theta": 3, "velocity": 1}),
    "flutter": ({**BLACKBURN, "drive_amplitude": 0.5}, {"theta": 3.316, "velocity": 0}),
    "down": ({"k": 0.01, "damping": 0.02, "m": 0}, {"theta": 3, "velocity": 0.1}),
    None: ({"k": 0.01, "damping": 0, "m": 0}, {"theta": 3, "velocity": 0.1}),
}


@pytest.mark.parametrize("end", SETTLING)
def test_a_decay_is_named_with_what_it_decays_to(kapitza, tmp_path, end):
    pendulum, start = SETTLING[end]
    result, line = run_scene(kapitza, tmp_path, {"pendulum": pendulum, "orbit": {"start": start, "periods": 40}})
    attributes = result.group("orbit").attrs
    assert (attributes["period"], attributes.get("settles_on")) == (0, end)
    assert (f"; it settles on {end}; " in line) == (end is not None) and "chaotic" not in line


def test_leaving_an_unstable_position_is_no_chaos(model):
    """From 6e-10 rad beside the unstable top neighbours part all through the record, which still is a fall to the
    bottom."""
    orbit = model({**BLACKBURN, "drive_amplitude": 0.1},
                  orbit={"start": {"theta": 3.141592653, "velocity": 0}, "periods": 60}).group("orbit")
    assert orbit.attrs["period"] == 0 and orbit.attrs["lyapunov"] > 5 * orbit.attrs["lyapunov_error"]
    assert (orbit.attrs["name"], orbit.attrs["settles_on"], orbit.attrs["line_quantity"]) == ("", "down", "angle")


def test_effective_model_follows_the_mean(model):
    """The slow equation near the top of the well: close to the mean of the full motion, to the order of the fast
    swing."""
    pendulum = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.2}
    start = {"theta": pi - 0.1, "velocity": 0}
    full, slow = (model(pendulum, orbit={"start": start, "periods": 40, "model": name}).group("orbit")
                  for name in ("pendulum", "effective"))
    assert np.abs(full["strobe_theta"].values - slow["strobe_theta"].values).max() < 0.2 * 0.2
    assert slow.attrs["centre"] == 1


START = {"start": {"theta": 0, "velocity": 0}}
RESOLVED = {
    "listed": {"attractors": {**WINDOW, "starts": 512}, "orbit": {"attractor": 0}},
    "linear": {"orbit": {**START, "model": "mathieu", "transient": 2, "periods": 3, "samples_per_period": 7}},
    "closed": {"orbit": {"start": {"theta": 3, "velocity": 1.07}, "closed": True}},
}


@pytest.mark.parametrize("name", RESOLVED)
def test_resolved_scene_gives_the_same(kapitza, tmp_path, name):
    scene = {"pendulum": {**BLACKBURN, "drive_amplitude": 0.3}, **RESOLVED[name]}
    runs = []
    for _ in range(2):
        result, _ = run_scene(kapitza, tmp_path, scene)
        scene = result.attributes["scene_resolved"]
        runs.append([result.group(group) for group in RESOLVED[name]])
    assert all(one.identical(other) for one, other in zip(*runs, strict=True))


REFUSED = {
    "no start": ({}, "orbit.start: is missing"),
    "start and attractor": ({**START, "attractor": 0}, "orbit.start: contradicts attractor"),
    "open attractor": ({"attractor": 0, "closed": False}, "orbit.closed: contradicts attractor",
                       {"attractors": WINDOW}),
    "no catalogue": ({"attractor": 0}, "orbit.attractor: needs a list of attractors"),
    "about the pendulum": ({**START, "about": "down"}, "orbit.about"),
    "closed slow motion": ({**START, "model": "effective", "closed": True}, "orbit.closed"),
    "period of an open orbit": ({**START, "period": 3}, "orbit.period"),
    "closed linear motion of any period": ({**START, "model": "mathieu", "closed": True}, "orbit.period"),
    "half a start": ({"start": {"theta": 0}}, "orbit.start.velocity: is missing"),
    "no samples": ({**START, "samples_per_period": 0}, "orbit.samples_per_period"),
    "too fast": ({"start": {"theta": 0, "velocity": 1e6}}, "orbit: needs"),
    "no fast drive": ({**START, "model": "effective"}, "orbit.model: effective",
                      {"pendulum": {"k": 2, "damping": 0, "m": 0.3}}),
}


@pytest.mark.parametrize("name", REFUSED)
def test_contradictions_are_refused(kapitza, tmp_path, name):
    orbit, named, *others = REFUSED[name]
    scene = {"pendulum": {"k": 0, "damping": 0, "m": 0.3}, "orbit": orbit} | dict(*others)
    assert named in refused_scene(kapitza, tmp_path, scene)


@pytest.mark.parametrize(("transient", "limit"), with_extensive([(8000, "0.001")], [(500000, "0.05")]))
def test_a_long_transient_stops_and_goes_on(kapitza, tmp_path, transient, limit):
    """Stopped by the clock before its transient, or after the first stretch of it; resumed on two ranks: the same
    motion."""
    orbit = {"start": {"theta": 1, "velocity": 0.2}, "transient": transient, "periods": 5}
    (tmp_path / "s.yaml").write_text(json.dumps({"pendulum": {"k": 0.25, "damping": 0, "m": 0.5}, "orbit": orbit}))
    kapitza("run", "s.yaml", "-o", "whole.h5", folder=tmp_path)
    stopped = kapitza("run", "s.yaml", "-o", "parts.h5", "--time-limit", limit, folder=tmp_path, status=None)
    assert stopped.returncode == 75, stopped.stderr
    kapitza("run", "s.yaml", "-o", "parts.h5", "--resume", folder=tmp_path, ranks=2)
    assert datasets(tmp_path / "whole.h5") == datasets(tmp_path / "parts.h5")


@pytest.mark.parametrize("k, m, velocity",
                         with_extensive([(0.01, 0.3, 20)], [(0.01, 0.3, 100), (0, 100, 1), (100, 0.3, 1)]))
def test_fast_motion_gets_the_steps_it_needs(model, k, m, velocity):
    """One period against thirty steps a radian."""
    pendulum = {"k": k, "damping": 0, "m": m}  # nothing to settle on
    orbit = {"start": {"theta": 0.3, "velocity": velocity}, "periods": 1}
    fine = {"scheme": "split6", "steps_per_period": int(30 * (2 + velocity + 2 * sqrt(k + m)))}
    ours, reference = model(pendulum, orbit=orbit).group("orbit"), model(pendulum, orbit=orbit,
                                                                         numerics=fine).group("orbit")
    assert abs(ours["strobe_theta"].values[1] - reference["strobe_theta"].values[1]) < 2e-9
    assert abs(ours["strobe_velocity"].values[1] - reference["strobe_velocity"].values[1]) < 2e-9


FAILING = {
    "another period": (closed(0.0767, 0.2707, period=8), "closes after 4"),
    "no such cycle": (closed(1.5, 1.5, period=3), "no cycle of 3 periods"),
    "overflow": ({"start": {"theta": 0.1, "velocity": 0}, "model": "mathieu", "about": "inverted", "periods": 10000},
                 "too large for double precision"),
}


@pytest.mark.parametrize("name", FAILING)
def test_a_scene_that_cannot_be_modelled_is_refused(kapitza, tmp_path, name):
    orbit, named = FAILING[name]
    drive = 0.05 if name == "overflow" else 0.307
    pendulum = {"quality_factor": 8, "drive_frequency": 7.0710678118654755, "drive_amplitude": drive}
    line = refused_scene(kapitza, tmp_path, {"pendulum": pendulum, "orbit": orbit})
    assert named in line and re.match(r"kapitza: error: s\.yaml:1:\d+: orbit", line)


@pytest.mark.parametrize("ranks", [None, 2])
def test_an_attractor_that_is_not_there_is_refused(kapitza, tmp_path, ranks):
    scene = {"pendulum": {"k": 0.1, "damping": 0.3, "m": 0}, "attractors": {**WINDOW, "starts": 16},
             "orbit": {"attractor": 7}}
    (tmp_path / "s.yaml").write_text(json.dumps(scene))
    line = kapitza("run", "s.yaml", folder=tmp_path, ranks=ranks, status=2).stderr
    place = f"s.yaml:1:{json.dumps(scene).index('7}') + 1}"
    said = "7 is not the id of an attractor; the search found 1, so choose an id below that"
    assert line == f"kapitza: error: {place}: orbit.attractor: {said}\n"
    assert [path.name for path in tmp_path.iterdir()] == ["s.yaml"]
