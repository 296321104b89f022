"""Pendulums from tracks: the truth lies within the stated errors, and what a model cannot describe is said."""

import subprocess
from functools import partial

import kapitza
import numpy as np
import pytest
from conftest import EXTENSIVE, PROGRAM, run_script, with_extensive
from fit_coverage import DECAY, FRICTION, NOISE, counted, track
from kapitza import fitting
from kapitza.track import main, read_track


def test_the_equation_is_that_of_the_program():
    """A driven track, in s, beside an orbit of the program with the same numbers."""
    omega, length = 2 * np.pi * 8, 0.2
    omega0 = np.sqrt(9.80665 / length)
    orbit = kapitza.orbit({"pendulum": {"length": "20 cm", "frequency": "8 Hz", "amplitude": "3 cm",
                                        "quality_factor": 9}}, 0.5, "2 rad/s",
                          periods=40, progress=False).group("orbit", si=True)
    time = orbit["time"].values[::4]
    truth = {"omega0": omega0, "offset": 0.0, "theta": 0.5, "velocity": 2.0, "viscous": omega0 / 9, "drive": 0.15,
             "phase": 0.0}
    found = fitting.simulated(time, {name: np.array([value]) for name, value in truth.items()}, omega)[0]
    assert found == pytest.approx(orbit["theta"].values[::4], abs=1e-3)


LENGTHS = {"decay": with_extensive([(9, 100, 0.25)], [(15, 200, 0.15)]),
           "all kinds": with_extensive([(16, 150)], [(20, 250)])}


@pytest.mark.parametrize(("seconds", "samples", "chance"), LENGTHS["decay"])
def test_a_decay_gives_frequency_and_damping(seconds, samples, chance):
    time = np.linspace(0, seconds, samples)
    found = kapitza.fit(time, np.degrees(track(DECAY, time)), degrees=True)
    assert found.best.name == "viscous" and found.best.residual == pytest.approx(NOISE, rel=chance)
    assert abs(found.best.correlation) < 0.3
    assert all(abs(found.best.values[name] - value) < 2 * found.best.errors[name] for name, value in DECAY.items())
    assert found.quality_factor() == pytest.approx(7 / 0.15,
                                                   rel=0.02) and found.length == pytest.approx(9.80665 / 49, rel=1e-3)
    scene = found.scene("50 Hz", "8 mm")
    assert kapitza.check(scene, set={"basin.theta.count": 20, "basin.velocity.count": 20}).studies == ["basin"]
    with pytest.raises(ValueError, match="knows no shaker"):
        found.scene()


@pytest.mark.parametrize(("pendulum", "tracks"),
                         with_extensive([("viscous", 20)], [("viscous", 200), ("viscous + quadratic + dry", 100)]))
def test_the_truth_lies_within_the_stated_errors(pendulum, tracks):
    """Of 95 % intervals 95 of 100 hold the truth, up to the chance of so many tracks: one number in 5000 lies outside
    of these bounds."""
    from scipy.stats import binom  # loaded here: it takes a second

    low, high = binom.ppf([1e-4, 1 - 1e-4], tracks, 0.95)
    for name, held in counted(pendulum, tracks).items():
        assert low <= held <= high, name


@pytest.mark.parametrize(("seconds", "samples"), LENGTHS["all kinds"])
def test_drag_and_friction_are_told_from_viscous_damping(seconds, samples):
    time, truth = np.linspace(0, seconds, samples), FRICTION
    found = kapitza.fit(time, track(truth, time))
    viscous = found.models["viscous"]
    assert found.best.name == "viscous + quadratic + dry" and viscous.residual > 3 * found.best.residual
    assert viscous.correlation > 0.5
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
    assert found.largest < 5 and " at 10 deg" not in repr(found)
    assert found.quality_factor() == found.quality_factor(f"{found.largest} deg")


@pytest.mark.parametrize(("hertz", "samples", "drive"), [(15, 60, 0.09), (6, 14, 0.15)])
def test_a_driven_track_gives_drive_and_phase(hertz, samples, drive):
    """Few samples in a drive period, and less than three; the first ended at 8.80 ± 0.06 rad/s without a drive."""
    time, truth = np.arange(0, 4, 1 / samples), DECAY | {"drive": drive, "phase": 0.7}
    found = kapitza.fit(time, track(truth, time, omega=2 * np.pi * hertz), frequency=f"{hertz} Hz")
    assert all(abs(found.best.values[name] - value) < 2 * found.best.errors[name] for name, value in truth.items())
    amplitude = found.scene()["pendulum"]["amplitude"]
    assert float(amplitude.split()[0]) == pytest.approx(drive * 9.80665 / 49, rel=0.1)


def test_a_pendulum_that_the_drive_holds_inverted():
    time, omega = np.arange(0, 3, 1 / 40), 2 * np.pi * 8
    truth = DECAY | {"theta": np.pi + 0.3, "drive": 0.35, "phase": 0.7}
    found = kapitza.fit(time, track(truth, time, omega=omega), frequency="8 Hz")
    assert found.inverted and found.largest < 60
    assert found.best.values["omega0"] == pytest.approx(7, abs=2 * found.best.errors["omega0"])


def test_a_frequency_that_the_track_does_not_show_is_refused():
    time = np.linspace(0, 5, 60)
    with pytest.raises(ValueError, match="shows no drive of 6 Hz: a free decay describes it as well"):
        kapitza.fit(time, track(DECAY, time), frequency="6 Hz")


@pytest.mark.parametrize("frequency", [None, "5 Hz"])
def test_a_model_that_does_not_describe_the_track_is_refused(frequency):
    """A track with a drive of 8 Hz, as a free decay and with a wrong frequency."""
    time = np.arange(0, 2.6, 1 / 30)
    theta = track(DECAY | {"drive": 0.2, "phase": 0.7}, time, omega=2 * np.pi * 8)
    with pytest.raises(ValueError, match="no model describes the track: .* mrad"):
        kapitza.fit(time, theta, frequency=frequency)


def test_an_angle_that_jumps_at_pi_is_unwrapped():
    time = np.linspace(0, 9, 100)
    plain = track(DECAY, time)
    shifted = np.remainder(plain + 3.0 + np.pi, 2 * np.pi) - np.pi
    assert np.abs(np.diff(shifted)).max() > 5
    found, expected = kapitza.fit(time, shifted), kapitza.fit(time, plain)
    assert found.best.values["omega0"] == pytest.approx(expected.best.values["omega0"], rel=1e-6)
    assert f"{found.jumps} jumps of a turn" in repr(found) and expected.jumps == 0 and "jumps" not in repr(expected)


@pytest.mark.parametrize(("time", "theta", "words"), [
    (np.arange(30), np.arange(29), "30 times and 29 angles"),
    (np.arange(5), np.arange(5), "at least 20"),
    (np.arange(30)[::-1], np.sin(np.arange(30)), "do not ascend"),
    (np.arange(30), np.full(30, np.nan), "not finite"),
    (np.arange(30), np.zeros(30), "does not move"),
    (np.linspace(0, 1, 30), np.linspace(0, 1, 30), "fewer than two whole swings"),
    (np.arange(30), 1e300 * np.sin(np.arange(30)), "the angles reach 1e\\+300 rad"),
    (1e-300 * np.arange(30), np.sin(np.arange(30)), "takes 2.9e-299 s"),
    (1e307 * np.arange(-15, 15), np.sin(np.arange(30)), "takes 2.9e\\+308 s|takes inf s"),
    (np.arange(30), 40 * np.sin(np.arange(30)), "are they in degrees"),
    (np.arange(40000), np.sin(2 * np.arange(40000)), "at most 10000"),
])
def test_tracks_that_cannot_be_used(time, theta, words):
    with pytest.raises(ValueError, match=words):
        kapitza.fit(time, theta)


COLUMNS = np.column_stack([np.linspace(0, 9, 60), np.degrees(track(DECAY, np.linspace(0, 9, 60)))])


def rows(mark, comma=False, scale=1.0):
    """The track as text, with a mark between columns."""
    lines = [f"{time * scale:.9g}{mark}{angle:.9g}" for time, angle in COLUMNS]
    return "".join(line.replace(".", ",") + "\n" if comma else line + "\n" for line in lines)


FILES = {
    "plain": ("time,theta_deg\n" + rows(","), "utf-8",
              "'theta_deg' in deg; ',' between columns, decimal points, UTF-8"),
    "bare": (rows(","), "utf-8", "column 2 in deg; ','"),
    "german": ("Zeit [s];Winkel [°]\n" + rows(";", comma=True), "latin-1",
               "'Winkel [°]' in °; ';' between columns, decimal commas, Latin-1"),
    "german without names": (rows(";", comma=True), "utf-8", "decimal commas"),
    "tabs": ("t / ms\tn\tangle (deg)\n" + rows("\t1\t", scale=1e3), "utf-8",
             "'t / ms' in ms, angles of 'angle (deg)' in deg; tabs"),
    "utf-16": ("time\ttheta\ns\t°\n" + rows("\t", comma=True), "utf-16",
               "'theta' in °; tabs between columns, decimal commas, UTF-16"),
    "utf-16 without a mark": ("time;theta\n" + rows(";"), "utf-16-le", "UTF-16"),
    "with a mark": ("time,angle_deg\n" + rows(","), "utf-8-sig", "'time' in s, angles of 'angle_deg' in deg"),
    "units in a row": ("# made by a sensor\nTime;Angle\n[s];[deg]\n" + rows(";"), "utf-8", "'Angle' in deg"),
    "blanks": ("t   theta_deg\n" + rows("   "), "utf-8", "blanks between columns"),
    "quoted": ('"time","angle [deg]"\n' + "".join(f'"{t:.9g}","{a:.9g}"\n'.replace(".", ",") for t, a in COLUMNS),
               "utf-8", "decimal commas"),
}


@pytest.mark.parametrize("name", FILES)
def test_files_of_laboratories_are_read(tmp_path, name):
    text, encoding, said = FILES[name]
    (tmp_path / "track.csv").write_bytes(text.encode(encoding))
    found = read_track(tmp_path / "track.csv", degrees=True)
    assert found.time == pytest.approx(COLUMNS[:, 0], abs=1e-8)
    assert found.theta == pytest.approx(np.radians(COLUMNS[:, 1]), abs=1e-8)
    assert said in found.taken and found.taken.startswith("60 samples")


@pytest.mark.parametrize(("data", "said"), [
    (b"", "is empty"),
    (b"time;theta\n0,5;1,2\n1;high\n", "row 2 holds no two finite numbers"),
    (b"time,theta [gon]\n0,5\n", "a column in 'gon'; the units are rad"),
    (b"time,speed\n0,1\n", "it needs time (s) and theta"),
    (b"\xff\xfe\x00", "UTF-16|utf-16"),
    (b"time,theta\n0,1,2,3\n0,1\n", "ected 2|columns|finite"),
])
def test_files_that_are_no_track_give_one_line(tmp_path, data, said):
    (tmp_path / "wrong.csv").write_bytes(data)
    done = run_script(partial(main, [str(tmp_path / "wrong.csv")]))
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert any(word in done.stderr for word in said.split("|")), done.stderr


def test_a_file_is_measured_before_it_is_read(tmp_path):
    with open(tmp_path / "huge.csv", "wb") as file:
        file.truncate(20 << 30)
    done = run_script(partial(main, [str(tmp_path / "huge.csv")]))
    said = f"kapitza: error: {tmp_path / 'huge.csv'}: is larger than 64 MB; no track is that large\n"
    assert (done.returncode, done.stderr) == (2, said)


@pytest.mark.parametrize(("viscous", "said"), with_extensive([(0.0, "quality_factor")], [(0.15, "quality_factor: 46")]))
def test_the_printed_pendulum_is_one_of_a_scene(tmp_path, viscous, said):
    """Of a pendulum without damping too, whose quality factor is no number."""
    time = np.linspace(0, 9, 60)
    np.savetxt(tmp_path / "track.csv", np.column_stack([time, track(DECAY | {"viscous": viscous}, time, 4)]),
               delimiter=",")
    done = subprocess.run([PROGRAM, "fit", "track.csv"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and said in done.stdout and ".inf" not in done.stdout, done.stderr
    (tmp_path / "scene.yaml").write_text(done.stdout.splitlines()[-1]
                                         + "\nattractors: {velocity: {min: -0.05, max: 0.05}}\n")
    checked = subprocess.run([PROGRAM, "check", "scene.yaml"], cwd=tmp_path, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stderr


def test_the_command_fit_reads_tables_with_and_without_names(tmp_path):
    """A file with names, one without, and what is refused."""
    time = np.linspace(0, 9, 60)
    angles = np.degrees(track(DECAY, time))
    np.savetxt(tmp_path / "track.csv", np.column_stack([time, angles]), delimiter=",", header="time,theta_deg",
               comments="")
    np.savetxt(tmp_path / "bare.csv", np.column_stack([time, angles]), delimiter=",")
    done = subprocess.run([PROGRAM, "fit", "bare.csv", "--degrees"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "natural frequency 1.11" in done.stdout, done.stderr
    assert "pendulum: {length: 0.2" in done.stdout and "quality_factor: 46" in done.stdout
    if EXTENSIVE:
        again = subprocess.run([PROGRAM, "fit", "track.csv"], cwd=tmp_path, capture_output=True, text=True)
        assert again.returncode == 0 and again.stdout.split("\n", 1)[1] == done.stdout.split("\n", 1)[1], again.stderr
    for words, said in ((["absent.csv"], "absent.csv: No such file"),
                        (["track.csv", "--frequency", "fast"], "'fast' is not a number")):
        done = run_script(partial(main, [str(tmp_path / words[0]), *words[1:]]))
        assert done.returncode == 2 and said in done.stderr
