"""Pendulums from tracks: the truth lies within the stated errors, and what a model cannot describe is said."""

import subprocess
from functools import partial

import kapitza
import numpy as np
import pytest
from conftest import EXTENSIVE, PROGRAM, run_script, with_extensive
from fit_coverage import DECAY, FRICTION, NOISE, counted, track
from kapitza import fitting
from kapitza.least_squares import half_width


def test_the_equation_is_that_of_the_program():
    """A driven track, in s, beside an orbit of the program with the same numbers."""
    omega, length = 2 * np.pi * 8, 0.2
    omega0 = np.sqrt(9.80665 / length)
    orbit = kapitza.orbit({"pendulum": {"length": "20 cm", "frequency": "8 Hz", "amplitude": "3 cm", "quality_factor": 9}}, 0.5, "2 rad/s",
                          periods=40, progress=False).group("orbit", si=True)
    time = orbit["time"].values[::4]
    truth = {"omega0": omega0, "offset": 0.0, "theta": 0.5, "velocity": 2.0, "viscous": omega0 / 9, "drive": 0.15, "phase": 0.0}
    found = fitting.simulated(time, {name: np.array([value]) for name, value in truth.items()}, omega)[0]
    assert found == pytest.approx(orbit["theta"].values[::4], abs=1e-3)


LENGTHS = {"decay": with_extensive([(9, 100, 0.25)], [(15, 200, 0.15)]), "all kinds": with_extensive([(16, 150)], [(20, 250)])}


@pytest.mark.parametrize(("seconds", "samples", "chance"), LENGTHS["decay"])
def test_a_decay_gives_frequency_and_damping(seconds, samples, chance):
    time = np.linspace(0, seconds, samples)
    found = kapitza.fit(time, np.degrees(track(DECAY, time)), degrees=True)
    assert found.best.name == "viscous" and found.best.residual == pytest.approx(NOISE, rel=chance) and abs(found.best.correlation) < 0.3
    assert all(abs(found.best.values[name] - value) < 2 * found.best.errors[name] for name, value in DECAY.items())
    assert found.quality_factor() == pytest.approx(7 / 0.15, rel=0.02) and found.length == pytest.approx(9.80665 / 49, rel=1e-3)
    scene = found.scene("50 Hz", "8 mm")
    assert kapitza.check(scene, set={"basin.theta.count": 20, "basin.velocity.count": 20}).studies == ["basin"]
    with pytest.raises(ValueError, match="knows no shaker"):
        found.scene()


@pytest.mark.parametrize(("pendulum", "tracks"), with_extensive([("viscous", 20)], [("viscous", 200), ("viscous + quadratic + dry", 100)]))
def test_the_truth_lies_within_the_stated_errors(pendulum, tracks):
    """Of 95 % intervals 95 of 100 hold the truth, up to the chance of so many tracks: one number in 5000 lies outside of these bounds."""
    from scipy.stats import binom  # which takes a second to load

    low, high = binom.ppf([1e-4, 1 - 1e-4], tracks, 0.95)
    for name, held in counted(pendulum, tracks).items():
        assert low <= held <= high, name


def test_few_samples_have_wider_intervals():
    """Student's t of 95 %, from tables."""
    assert [half_width(spare) for spare in (10, 14, 55, 1000)] == pytest.approx([2.228, 2.145, 2.004, 1.962], abs=4e-3)


@pytest.mark.parametrize(("seconds", "samples"), LENGTHS["all kinds"])
def test_drag_and_friction_are_told_from_viscous_damping(seconds, samples):
    time, truth = np.linspace(0, seconds, samples), FRICTION
    found = kapitza.fit(time, track(truth, time))
    viscous = found.models["viscous"]
    assert found.best.name == "viscous + quadratic + dry" and viscous.residual > 3 * found.best.residual and viscous.correlation > 0.5
    assert all(abs(found.best.values[name] - value) < 2.5 * found.best.errors[name] for name, value in truth.items())
    assert "Viscous damping alone does not describe this track" in repr(found)
    rate = 0.15 + 8 / (3 * np.pi) * 0.06 * 7 * np.radians(20) + 4 / np.pi * 0.05 / (7 * np.radians(20))
    assert found.quality_factor("20 deg") == pytest.approx(7 / rate, rel=0.03)


@pytest.mark.extensive
def test_a_bearing_that_stops_the_pendulum():
    """Swings of 4 degrees that shrink evenly, as dry friction makes them."""
    time, truth = np.linspace(0, 4.5, 120), DECAY | {"theta": 0.085, "velocity": 0.0, "viscous": 0.02, "dry": 0.13}
    found = kapitza.fit(time, track(truth, time))
    full = found.models["viscous + quadratic + dry"]
    assert full.residual == pytest.approx(NOISE, rel=0.25) and full.values["dry"] == pytest.approx(0.13, rel=0.3)
    assert found.largest < 5 and " at 10 deg" not in repr(found) and found.quality_factor() == found.quality_factor(f"{found.largest} deg")


@pytest.mark.extensive
def test_a_driven_track_gives_drive_and_phase():
    """Shaken eight times as fast as it swings; the amplitude of the pivot comes with its length."""
    time, omega, truth = np.linspace(0, 8, 300), 56.0, DECAY | {"drive": 0.05, "phase": 0.7}
    found = kapitza.fit(time, track(truth, time, omega=omega), frequency=f"{omega / (2 * np.pi):.15g} Hz")
    values = found.models["viscous"].values
    assert values["omega0"] == pytest.approx(7, rel=5e-3) and abs(values["drive"]) == pytest.approx(0.05, rel=0.1)
    turn = values["phase"] + (np.pi if values["drive"] < 0 else 0)
    assert np.cos(turn - 0.7) > 0.98
    pendulum = found.scene()["pendulum"]
    assert float(pendulum["amplitude"].split()[0]) == pytest.approx(0.05 * 9.80665 / 49, rel=0.1)


@pytest.mark.parametrize(("time", "theta", "words"), [
    (np.arange(30), np.arange(29), "30 times and 29 angles"),
    (np.arange(5), np.arange(5), "at least 20"),
    (np.arange(30)[::-1], np.sin(np.arange(30)), "do not ascend"),
    (np.arange(30), np.full(30, np.nan), "not finite"),
    (np.arange(30), np.zeros(30), "does not move"),
    (np.linspace(0, 1, 30), np.linspace(0, 1, 30), "fewer than two whole swings"),
])
def test_tracks_that_cannot_be_used(time, theta, words):
    with pytest.raises(ValueError, match=words):
        kapitza.fit(time, theta)


def test_the_command(tmp_path):
    """A file with names, one without, and what is refused."""
    time = np.linspace(0, 9, 60)
    angles = np.degrees(track(DECAY, time))
    np.savetxt(tmp_path / "track.csv", np.column_stack([time, angles]), delimiter=",", header="time,theta_deg", comments="")
    np.savetxt(tmp_path / "bare.csv", np.column_stack([time, angles]), delimiter=",")
    done = subprocess.run([PROGRAM, "fit", "bare.csv", "--degrees"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "natural frequency 1.11" in done.stdout, done.stderr
    assert "pendulum: {length: 0.2" in done.stdout and "quality_factor: 46" in done.stdout
    (named, bare) = (fitting.read_track(tmp_path / f"{name}.csv") for name in ("track", "bare"))
    assert np.array_equal(named[:2], bare[:2]) and (named[2], bare[2]) == (True, False)
    if EXTENSIVE:
        again = subprocess.run([PROGRAM, "fit", "track.csv"], cwd=tmp_path, capture_output=True, text=True)
        assert again.returncode == 0 and again.stdout == done.stdout, again.stderr
    (tmp_path / "wrong.csv").write_text("time,speed\n0,1\n")
    for words, said in ((["absent.csv"], "absent.csv: No such file"), (["wrong.csv"], "it needs time (s) and theta"),
                        (["track.csv", "--frequency", "fast"], "'fast' is not a number")):
        done = run_script(partial(fitting.main, [str(tmp_path / words[0]), *words[1:]]))
        assert done.returncode == 2 and said in done.stderr
