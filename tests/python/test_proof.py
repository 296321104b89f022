"""basin.proof: proved labels are marked and are the proved ones, whoever worked on them; what cannot be proved is not."""

import json
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
import reference_check
from conftest import EXTENSIVE, PROGRAM, datasets

# One attractor, and a saddle whose stable manifold no cell's centre meets.
SCENE = """\
pendulum: {k: 0.05, damping: 0.4, m: 0.1}
basin:
  theta: {count: 40}
  velocity: {min: -1.5, max: 1.5, count: 31}
  proof: true
  attractors: {starts: 256}
"""
FIG12 = """\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}
basin:
  theta: {count: 60}
  velocity: {min: -2, max: 2, count: 60}
  proof: true
  attractors: {starts: 1024}
"""
PROVED, IN_PAIRS = 6, 10


def read(path):
    with h5py.File(path) as file:
        return {name: file["basin"][name][:] for name in ("attractor", "evidence")}, dict(file["basin"].attrs), \
               {name: file["attractors"][name][:] for name in file["attractors"]}


def test_every_label_is_proved_by_any_number_of_ranks(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE)
    done = kapitza("run", "s.yaml", folder=tmp_path)
    assert "100 % of the labels are proved" in done.stdout and "refuted" not in done.stdout
    cells, attributes, attractors = read(tmp_path / "s.h5")
    assert np.isin(cells["evidence"], [PROVED, IN_PAIRS]).all() and not cells["attractor"].any()
    with h5py.File(tmp_path / "s.h5") as file:
        assert file["basin/evidence"].attrs["flag_meanings"].split()[PROVED:12:5] == ["proved_in_doubles", "proved_in_triples_of_doubles"]
    assert attributes["proved_share"] == 1 and attributes["refuted"] == 0
    assert attributes["other_share_starts"] == 1240 and attributes["other_share_confidence"] == 0.95
    assert np.isclose(attributes["other_share_high"], 1 - 0.05 ** (1 / 1240))
    assert attractors["proved"].all() and (attractors["multiplier_half_width"] < 1e-9).all()
    assert (attractors["strobe_theta_half_width"] < 1e-11).all() and (attractors["strobe_velocity_half_width"] < 1e-11).all()
    for ranks in (2, 3) if EXTENSIVE else (3,):
        kapitza("run", "s.yaml", "-o", f"{ranks}.h5", ranks=ranks, folder=tmp_path)
        assert datasets(tmp_path / f"{ranks}.h5") == datasets(tmp_path / "s.h5")


def test_other_drives_are_proved(kapitza, tmp_path):
    """Without mirror symmetry, and with an overtone: the proof says what the method says."""
    (tmp_path / "s.yaml").write_text(SCENE)
    for change in ("pendulum.tilt=5 deg", "pendulum.torque=0.02", "pendulum.harmonics=[{order: 2, amplitude: 0.5}]"):
        kapitza("run", "s.yaml", "--force", "--set", change, "--set", "basin.theta.count=20", folder=tmp_path)
        cells, attributes, attractors = read(tmp_path / "s.h5")
        assert attributes["proved_share"] == 1 and attributes["refuted"] == 0 and attractors["proved"].all(), change


def test_labels_that_the_proof_refutes_are_replaced_and_counted(kapitza, tmp_path):
    """Three periods are too few for many orbits."""
    (tmp_path / "s.yaml").write_text(SCENE)
    kapitza("run", "s.yaml", "-o", "without.h5", "--set", "basin.proof=false", "--set", "basin.max_periods=3", folder=tmp_path)
    done = kapitza("run", "s.yaml", "--set", "basin.max_periods=3", folder=tmp_path)
    cells, attributes, _ = read(tmp_path / "s.h5")
    without, bare, _ = read(tmp_path / "without.h5")
    refuted = np.count_nonzero(without["attractor"] == -1)
    assert refuted > 0 and attributes["refuted"] == refuted and not cells["attractor"].any()
    assert "proved_share" not in bare and not np.isin(without["evidence"], [PROVED, IN_PAIRS]).any()
    assert f"warning: the proof gives {refuted} cells another label" in done.stdout


@pytest.mark.extensive
def test_a_wrong_list_of_attractors_leaves_basins_unproved(kapitza, tmp_path):
    """Without the cycles of 2 and 6 periods nothing is proved about starts that end on them, and everything about the others."""
    (tmp_path / "s.yaml").write_text(FIG12)
    kapitza("run", "s.yaml", "--set", "basin.proof=false", folder=tmp_path)
    kapitza("run", "s.yaml", "-o", "few.h5", "--set", "basin.attractors.max_period=1", folder=tmp_path)
    cells, _, attractors = read(tmp_path / "s.h5")
    few, wrong, _ = read(tmp_path / "few.h5")
    long = np.isin(cells["attractor"], np.flatnonzero(attractors["period"] > 1))
    assert long.any() and not long.all()
    assert np.array_equal(np.isin(few["evidence"], [PROVED, IN_PAIRS]), ~long)
    assert wrong["proved_share"] == np.mean(~long) and wrong["other_share_high"] > np.mean(long)


def test_windows_that_are_too_fast_for_a_proof_are_refused(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE.replace("1.5", "5000"))
    for command in ("run", "check"):
        done = kapitza(command, "s.yaml", "--set", "numerics.scheme=split6", folder=tmp_path, status=2)
        assert "basin.proof: speeds of 5e+03 rad per drive radian are too fast for a proof" in done.stderr
    assert not (tmp_path / "s.h5").exists()


@pytest.mark.parametrize("change, said", [
    ("basin.theta={centre: 1, width: 1e-27, count: 40}", "basin.proof: cells below 1e-28 are too small for a proof"),
    ("basin.start_phase=1", "basin.start_phase: basin.proof needs starts at phase 0 and no ramp"),
], ids=["deep", "phase"])
def test_what_cannot_be_proved_is_refused(kapitza, tmp_path, change, said):
    (tmp_path / "s.yaml").write_text(SCENE)
    for command in ("run", "check"):
        assert said in kapitza(command, "s.yaml", "--set", change, folder=tmp_path, status=2).stderr
    assert not (tmp_path / "s.h5").exists()


def ended(log):
    """The stages that have ended; lines of progress, which a slow machine has too, name those that are at work."""
    lines = log.read_text().split("\n")[:-1] if log.exists() else []
    return [event["stage"] for event in map(json.loads, lines) if event["event"] == "stage"]


def stop_after(stage, ranks, folder):
    """kapitza run, resumed and asked to stop when a stage has ended; one that was faster is made again, ten times at most."""
    log = folder / "log.jsonl"
    for _ in range(10):
        log.unlink(missing_ok=True)
        (folder / "s.h5").unlink(missing_ok=True)
        words = ["mpirun", "-n", str(ranks), PROGRAM, "run", "s.yaml", "--resume", "--log", log.name]
        process = subprocess.Popen(words, cwd=folder, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        while process.poll() is None and stage not in ended(log):
            time.sleep(0.005)
        process.send_signal(signal.SIGUSR1)
        message = process.communicate()[1]
        if process.returncode != 0:
            break
    assert "stopped by SIGUSR1" in message and process.returncode == 75
    return ended(log)


def test_a_proof_goes_on_where_it_was_stopped(kapitza, tmp_path):
    """Behind the region, twice, each time on other ranks."""
    (tmp_path / "s.yaml").write_text(SCENE)
    kapitza("run", "s.yaml", "-o", "undisturbed.h5", folder=tmp_path)
    for ranks in (1, 2):
        assert stop_after("proof region 1", ranks, tmp_path)[-1].startswith("proof")
    kapitza("run", "s.yaml", "--resume", folder=tmp_path)
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "undisturbed.h5")


PENDULUMS = {
    "Fig. 12": "{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}",
    "Fig. 13": "{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.46}",
    "Fig. 15": "{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.52}",
    "fast": "{k: 0.1, damping: 0.1, m: 0.4}",
    "gravity upward": "{k: -0.05, damping: 0.05, m: 0.5}",
    "no gravity": "{k: 0, damping: 0.05, m: 0.4}",
    "strong damping": "{k: 0.05, damping: 0.9, m: 0.4}",
    "weak damping": "{k: 0.00826, damping: 0.004, m: 0.3}",
    "tilted": "{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3, tilt: 5 deg}",
    "square wave": "{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3, waveform: square,"
                   " harmonics: [{order: 2, amplitude: 0.0667, phase: 90 deg}]}",
    "Josephson": "{k: 0.02, damping: 0.1, m: 0, torque: 0.1, torque_amplitude: 1.5}",
}


def contradicted(kapitza, folder, name, count, most):
    """How many of `most` cells of a window of count x count are proved, and how many of these quad precision labels otherwise."""
    (folder / "s.yaml").write_text(f"pendulum: {PENDULUMS[name]}\nbasin:\n  theta: {{count: {count}}}\n"
                                   f"  velocity: {{min: -2, max: 2, count: {count}}}\n  proof: true\n  attractors: {{starts: 1024}}\n")
    kapitza("run", "s.yaml", folder=folder)
    cells, _, _ = read(folder / "s.h5")
    _, (_, _, labels, true_labels) = reference_check.check_file(folder / "s.h5", most, 1, 2, 4000)
    proved = np.isin(cells["evidence"], [PROVED, IN_PAIRS])[reference_check.sample_cells(cells["evidence"].shape, most, 1)]
    return proved.sum(), (labels[proved] != true_labels[proved]).sum()


@pytest.mark.extensive
@pytest.mark.parametrize("name", PENDULUMS)
def test_quad_precision_contradicts_no_proof(kapitza, tmp_path, name):
    """4000 proved labels in doubles and pairs; what only quads prove is beyond it."""
    proved, wrong = contradicted(kapitza, tmp_path, name, 64, 4096)
    assert wrong == 0 and proved > 3000


@pytest.mark.extensive
def test_triples_prove_what_pairs_leave(kapitza, tmp_path):
    """The lace under a square wave, whose orbits wander for long."""
    (tmp_path / "s.yaml").write_text(f"pendulum: {PENDULUMS['square wave']}\nbasin:\n  theta: {{count: 40}}\n"
                                     "  velocity: {min: -2, max: 2, count: 40}\n  proof: true\n")
    kapitza("run", "s.yaml", folder=tmp_path)
    cells, attributes, _ = read(tmp_path / "s.h5")
    assert attributes["proved_share"] > 0.99 and (cells["evidence"] == 11).any()
