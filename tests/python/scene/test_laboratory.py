"""A pendulum in a laboratory: units in scenes, starts and sweeps, and what the first line of a summary says of its rest
positions."""

import re

import kapitza
import numpy as np
import pytest
import yaml
from conftest import ROOT, plot
from kapitza.plots import compare

SCENE = ROOT / "scenes" / "laboratory.yaml"
OMEGA = 2 * np.pi * 50
FEW = {"basin.theta.count": 8, "basin.velocity.count": 8, "basin.attractors.starts": 64}


def rest(text):
    return next(line for line in text.splitlines() if line.startswith("Rest down: "))


def test_it_is_the_pendulum_that_it_says():
    """k = g/(l omega^2), m = A/l, beta = omega0/(omega Q)."""
    page = kapitza.check(SCENE, set=FEW).text
    k, beta, m = (float(value) for value in re.search(r"k = (\S+), beta = (\S+), m = (\S+)", page).groups())
    assert (k, m) == pytest.approx((9.80665 / (0.2 * OMEGA**2), 0.008 / 0.2), rel=1e-9)
    assert beta == pytest.approx(np.sqrt(9.80665 / 0.2) / (OMEGA * 20), rel=1e-9)
    again = kapitza.check(kapitza.check(SCENE, set=FEW).scene).text
    assert f"k = {k:.10g}, beta = {beta:.10g}, m = {m:.10g}" in again


ROD = {"length": "20 cm", "frequency": "50 Hz", "amplitude": "8 mm", "quality_factor": 20}
PAPER = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}


def still(**pendulum):
    """A scene that follows no motion."""
    return {"pendulum": pendulum, "potential": {"drive_amplitudes": [0.1], "theta": {"count": 9}}}


@pytest.mark.parametrize(("amplitude", "words"), [
    ("8 mm", "inverted: stable (for amplitude from 6.306 mm to 90.9"),
    ("3 mm", "inverted: unstable (stable for amplitude from 6.306 mm to 90.9"),
    ("120 mm", "down: unstable (stable for amplitude"),
])
def test_the_first_line_says_what_stands(amplitude, words):
    """6.306 mm: near A = l sqrt(2 k), the classical threshold A omega > sqrt(2 g l), which Q raises a little."""
    page = kapitza.check(still(**ROD | {"amplitude": amplitude})).text
    assert words in rest(page)
    assert 6.306e-3 == pytest.approx(np.sqrt(2 * 9.80665 * 0.2) / OMEGA, rel=2e-3)


@pytest.mark.parametrize("pendulum, key, unit", [
    (ROD, "amplitude", " mm"), (PAPER, "drive_amplitude", ""), (PAPER | {"drive_amplitude": -0.3}, "drive_amplitude",
                                                                "")])
def test_the_rod_stands_at_the_limits_that_are_printed(pendulum, key, unit):
    """0.129 was printed for 0.12905, below which it falls; and positive limits for a negative amplitude."""
    said = rest(kapitza.check(still(**pendulum)).text)
    limits = re.search(r"inverted: .*? from ([-\d.]+)(?: mm)? to ([-\d.]+)", said).groups()
    assert [limit.startswith("-") for limit in limits] == [str(pendulum[key]).startswith("-")] * 2
    for limit in limits:
        assert "inverted: stable" in rest(kapitza.check(still(**pendulum | {key: limit + unit})).text)


@pytest.mark.parametrize("m, limits", [(0.3, "above 0, up to 0.4638"), (-0.3, "below 0, down to -0.4638"),
                                       (1e-13, "above 0, up to 0.4638")])
def test_without_gravity_both_rests_are_stable_from_no_drive_on(m, limits):
    """Rounding was printed as a limit, 1.906e-11. The drive acts as gravity of m^2/(2 (1 + beta^2)) does."""
    said = rest(kapitza.check(still(k=0, damping=0.1, m=m)).text)
    assert said.count(f": stable (for m {limits})") == 2
    assert "unstable (stable for m above 0, up to" in rest(kapitza.check(still(k=0, damping=0.1, m=0)).text)
    assert "to 0)" not in rest(kapitza.check(still(k=0, damping=0.1, m=2000)).text)


def test_numbers_without_a_unit_are_noted():
    bare = kapitza.check(still(**ROD | {"length": 0.2, "amplitude": 0.008, "frequency": 50})).text
    assert ("note: pendulum: numbers without a unit are taken so: length 0.2 m, frequency 50 Hz, amplitude 0.008 m"
            in bare)
    assert "note:" not in kapitza.check(still(**ROD)).text


@pytest.mark.parametrize("key, value", [("length", "200"), ("amplitude", "5"), ("amplitude", "-8.5")])
def test_lengths_in_millimetres_without_a_unit_are_refused(key, value):
    """With its unit even 200 m pass, and so does the resolved scene of them."""
    with pytest.raises(kapitza.SceneError,
                       match=f"{value} is taken for {value} m, more than a laboratory has; give its unit, such as"):
        kapitza.check(still(**ROD | {key: value}))
    resolved = kapitza.check(still(**ROD | {key: f"{value} m"})).scene
    assert f"{key}: {value} m" in resolved and kapitza.check(resolved).scene == resolved


def test_a_velocity_without_a_unit_is_noted(kapitza):
    said = kapitza("where", SCENE, "150 deg", "3").stdout
    assert 'is in rad per drive radian: 3 is 942.478 rad/s; for rad/s write "3 rad/s"' in said
    assert "is in rad per drive radian" not in kapitza("where", SCENE, "150 deg", "3 rad/s").stdout


def test_a_run_begins_with_that_line(tmp_path):
    result = kapitza.run(SCENE, set=FEW, progress=False)
    assert result.summary.startswith("Rest down: stable (for amplitude up to")
    assert result.pendulum["length"] == 0.2 and result.pendulum["pivot_amplitude"] == 0.008
    assert result.pendulum["pivot_frequency"] == pytest.approx(OMEGA) and result.pendulum["quality_factor"] == 20


def test_starts_in_laboratory_units(kapitza):
    said = kapitza("where", SCENE, "175 deg", "3 rad/s").stdout
    assert "theta = 3.054326191 (175 deg), velocity = 0.009549296586 (3 rad/s)" in said and "deg and rad/s" in said
    assert re.search(r"certain         after (\d+) drive periods \(([\d.]+) s\)", said)
    own = kapitza("where", ROOT / "scenes" / "small.yaml", "3 pi/4", "1 rad/s", status=2).stderr
    assert "the scene is not in SI units" in own


def test_tables_of_starts_are_in_si_too():
    table = kapitza.where(SCENE, ["175 deg", 0.1], "3 rad/s")
    assert table["velocity_rad_per_s"].values == pytest.approx(3, rel=1e-12)
    assert np.allclose(table["settling_seconds"], table["settling_time"].astype(float) / 50)
    assert np.allclose(table["near_seconds"],
                       table["near_time"].astype(float) / 50) and (table["near_time"] > 100).all()
    assert table["strobe_velocity_rad_per_s"][0] == pytest.approx(OMEGA * np.array(table["strobe_velocity"][0]))


@pytest.mark.extensive
def test_reports_and_comparisons_are_in_si(tmp_path):
    for name, amplitude in (("one", "8 mm"), ("other", "9 mm")):
        kapitza.run(SCENE, tmp_path / f"{name}.h5", set=FEW | {"pendulum.amplitude": amplitude}, progress=False)
    assert plot("report", tmp_path / "one.h5", "-o", tmp_path / "one.html").returncode == 0
    assert "period (s)" in (tmp_path / "one.html").read_text()
    panels = compare.draw(kapitza.Result(tmp_path / "one.h5"), other=tmp_path / "other.h5", si=True).axes
    assert panels[0].get_ylabel() == "velocity dθ/dt (rad/s)"


IN_SI = """\
pendulum: {length: 20 cm, frequency: 50 Hz, amplitude: 2.5 cm, quality_factor: 10}
basin: {theta: {count: 2}, velocity: {min: -16 rad/s, max: 900 deg/s, count: 2}, attractors: {starts: 8}}
saddles: {velocity: {min: -1, max: 3rad/s}}
orbit: {start: {theta: 150°, velocity: "170 deg/s"}}
sweep: {x: {parameter: amplitude, min: 1 mm, max: 1 cm, count: 2}, y: {parameter: length, min: 0.1, max: 0.2, count: 2},
        measure: [ends], ends: {theta: [1, 90°], velocity: [0, 3 rad/s]}}
"""


@pytest.mark.extensive
def test_scales_of_shocks_take_units():
    resolved = yaml.safe_load(kapitza.check(IN_SI, set={"basin.shocks.scale": "10 °/s"}).scene)
    assert resolved["basin"]["shocks"]["scale"] == np.radians(10) / OMEGA


def test_velocities_take_units_wherever_they_are_keys():
    """The resolved scene has them in units of the drive, to the bit of velocity / omega, and reads as the same scene
    again."""
    resolved = kapitza.check(IN_SI).scene
    numbers = yaml.safe_load(resolved)
    assert numbers["basin"]["velocity"]["min"] == -16 / OMEGA
    assert numbers["basin"]["velocity"]["max"] == np.radians(900) / OMEGA
    assert numbers["saddles"]["velocity"] == {"min": -1, "max": 3 / OMEGA}
    assert numbers["orbit"]["start"] == {"theta": np.radians(150), "velocity": np.radians(170) / OMEGA}
    assert {name: numbers["sweep"]["ends"][name] for name in ("theta", "velocity")} == {"theta": [1, np.pi / 2],
                                                                                        "velocity": [0, 3 / OMEGA]}
    assert kapitza.check(resolved).scene == resolved
    window = {"basin.velocity": {"centre": "10 rad/s", "width": "1 deg/s", "count": 8},
              "basin.theta": {"centre": "170°", "width": "pi/8", "count": 8}}
    deep = yaml.safe_load(kapitza.check(IN_SI, set=window).scene)["basin"]
    assert float(deep["velocity"]["centre"]) == 10 / OMEGA
    assert float(deep["theta"]["centre"]) == pytest.approx(np.radians(170), rel=1e-15)
    assert float(deep["theta"]["width"]) == np.pi / 8


@pytest.mark.parametrize(("change", "words"), [
    ({"orbit.start.velocity": "3 m/s"},
     "is not a finite decimal number; it must be a number from -1000000000 to 1000000000 in "
                                        "rad per drive radian, or with its unit: rad/s, deg/s"),
    ({"orbit.start.velocity": "3 Hz"}, "is in a unit of another quantity"),
    ({"sweep.y": {"parameter": "frequency", "min": 10, "max": 20, "count": 2}},
     "but the scene changes the frequency of the pivot"),
    ({"pendulum.frequency": "50 mm"}, 'pendulum.frequency: "50 mm" is in a unit of another quantity'),
])
def test_velocities_with_a_wrong_unit_are_refused(change, words):
    with pytest.raises(kapitza.SceneError, match=re.escape(words)):
        kapitza.check(IN_SI, set=change)


def test_a_velocity_per_second_needs_a_pendulum_in_si():
    scene = yaml.safe_load(IN_SI) | {"pendulum": {"k": 0.1, "damping": 0.1, "m": 0.1}}
    with pytest.raises(kapitza.SceneError,
                       match='"-16 rad/s" is per second, but the scene is not in SI units; it must be a number'):
        kapitza.check(scene)
