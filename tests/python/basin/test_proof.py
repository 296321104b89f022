"""basin.proof: proved labels are marked and are the proved ones, whoever worked on them; what cannot be proved is
not."""

import numpy as np
import pytest
import reference_check
from conftest import EXTENSIVE, datasets, refused_scene, run_scene, settings, stopped_in_each_stage

# One attractor, and a saddle whose stable manifold no cell's centre meets.
SCENE = """\
pendulum: {k: 0.05, damping: 0.4, m: 0.1}
basin:
  theta: {count: 40}
  velocity: {min: -1.5, max: 1.5, count: 31}
  proof: true
  attractors: {starts: 256}
"""
WINDOW = """\
pendulum: {}
basin:
  theta: {{count: {}}}
  velocity: {{min: -2, max: 2, count: {}}}
  proof: true
  {}
"""
FIG12 = WINDOW.format("{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}", 60, 60,
                      "attractors: {starts: 1024}")
PROVED, IN_PAIRS = 6, 10


def read(result):
    """Cells, their attributes, and attractors."""
    basin, attractors = result.group("basin"), result.group("attractors")
    cells = {name: basin[name].values for name in ("attractor", "evidence")}
    return cells, basin.attrs, {name: attractors[name].values for name in attractors}


def test_every_label_is_proved_by_any_number_of_ranks(kapitza, tmp_path):
    result, said = run_scene(kapitza, tmp_path, SCENE)
    assert "100 % of the labels are proved" in said and "refuted" not in said
    cells, attributes, attractors = read(result)
    assert np.isin(cells["evidence"], [PROVED, IN_PAIRS]).all() and not cells["attractor"].any()
    meanings = result.group("basin")["evidence"].attrs["flag_meanings"].split()
    assert meanings[PROVED:12:5] == ["proved_in_doubles", "proved_in_triples_of_doubles"]
    assert attributes["proved_share"] == 1 and attributes["refuted"] == 0
    assert attributes["other_share_starts"] == 1240 and attributes["other_share_confidence"] == 0.95
    assert np.isclose(attributes["other_share_high"], 1 - 0.05 ** (1 / 1240))
    assert attractors["proved"].all() and (attractors["multiplier_half_width"] < 1e-9).all()
    assert (attractors["strobe_theta_half_width"] < 1e-11).all() and (attractors["strobe_velocity_half_width"]
                                                                      < 1e-11).all()
    for ranks in (2, 3) if EXTENSIVE else (3,):
        assert datasets(run_scene(kapitza, tmp_path, SCENE, ranks=ranks, name="more")[0].path) == datasets(result.path)


def test_other_drives_are_proved(kapitza, tmp_path):
    """Without mirror symmetry, and with an overtone: the proof says what the method says."""
    for change in ("pendulum.tilt=5 deg", "pendulum.torque=0.02", "pendulum.harmonics=[{order: 2, amplitude: 0.5}]"):
        _, attributes, attractors = read(run_scene(kapitza, tmp_path, SCENE,
                                                   *settings(change, "basin.theta.count=20"))[0])
        assert attributes["proved_share"] == 1 and attributes["refuted"] == 0 and attractors["proved"].all(), change


def test_labels_that_the_proof_refutes_are_replaced_and_counted(kapitza, tmp_path):
    """Three periods are too few for many orbits."""
    without, bare, _ = read(run_scene(kapitza, tmp_path, SCENE,
                                      *settings("basin.proof=false", "basin.max_periods=3"))[0])
    result, said = run_scene(kapitza, tmp_path, SCENE, "--set", "basin.max_periods=3")
    cells, attributes, _ = read(result)
    refuted = np.count_nonzero(without["attractor"] == -1)
    assert refuted > 0 and attributes["refuted"] == refuted and not cells["attractor"].any()
    assert "proved_share" not in bare and not np.isin(without["evidence"], [PROVED, IN_PAIRS]).any()
    assert f"warning: the proof gives {refuted} cells another label" in said


@pytest.mark.extensive
def test_a_wrong_list_of_attractors_leaves_basins_unproved(kapitza, tmp_path):
    """Without the cycles of 2 and 6 periods nothing is proved about starts that end on them, and everything about the
    others."""
    cells, _, attractors = read(run_scene(kapitza, tmp_path, FIG12, "--set", "basin.proof=false")[0])
    few, wrong, _ = read(run_scene(kapitza, tmp_path, FIG12, "--set", "basin.attractors.max_period=1")[0])
    long = np.isin(cells["attractor"], np.flatnonzero(attractors["period"] > 1))
    assert long.any() and not long.all()
    assert np.array_equal(np.isin(few["evidence"], [PROVED, IN_PAIRS]), ~long)
    assert wrong["proved_share"] == np.mean(~long) and wrong["other_share_high"] > np.mean(long)


@pytest.mark.parametrize("command", ["run", "check"])
@pytest.mark.parametrize("change, said", [
    ("basin.velocity={min: -5000, max: 5000, count: 31}",
     "basin.proof: speeds of 5e+03 rad per drive radian are too fast for a proof"),
    ("basin.theta={centre: 1, width: 1e-27, count: 40}", "basin.proof: cells below 1e-28 are too small for a proof"),
    ("basin.start_phase=1", "basin.start_phase: basin.proof needs starts at phase 0 and no ramp"),
], ids=["fast", "deep", "phase"])
def test_what_cannot_be_proved_is_refused(kapitza, tmp_path, change, said, command):
    assert said in refused_scene(kapitza, tmp_path, "numerics: {scheme: split6}\n" + SCENE, "--set", change,
                                 command=command)


def test_a_proof_goes_on_where_it_was_stopped(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE)
    kapitza("run", "s.yaml", "-o", "undisturbed.h5", folder=tmp_path)
    stages = stopped_in_each_stage(kapitza, "s.yaml", file="s.h5", folder=tmp_path, ranks=[1, 2, 3])
    assert "proof region 1" in stages and stages[-1].startswith("proof")
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
    """How many of `most` cells of a window of count x count are proved, and how many of these quad precision labels
    otherwise."""
    result, _ = run_scene(kapitza, folder, WINDOW.format(PENDULUMS[name], count, count, "attractors: {starts: 1024}"))
    cells, _, _ = read(result)
    _, (_, _, labels, true_labels) = reference_check.check_file(result.path, most, 1, 2, 4000)
    proved = np.isin(cells["evidence"],
                     [PROVED, IN_PAIRS])[reference_check.sample_cells(cells["evidence"].shape, most, 1)]
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
    cells, attributes, _ = read(run_scene(kapitza, tmp_path, WINDOW.format(PENDULUMS["square wave"], 40, 40, ""))[0])
    assert attributes["proved_share"] > 0.99 and (cells["evidence"] == 11).any()
