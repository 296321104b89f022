"""Method exact: every label decided in as much precision as it takes, or flagged."""

import json

import h5py
import numpy as np
import pytest
from conftest import ROOT, datasets, stopped_in_each_stage, with_extensive

SMALL = ROOT / "scenes" / "small.yaml"
# Some 13 % of these labels are wrong by any method in double precision.
LONG = """\
pendulum: {quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}
basin:
  theta: {count: 24}
  velocity: {min: -2, max: 2, count: 24}
  method: exact
  attractors: {starts: 512}
"""
# What of its numerics alone gets wrong.
COARSE = ("--set", "numerics={scheme: rk4, steps_per_period: 60}")
UNSETTLED, UNDECIDED, IN_QUAD, IN_FINE, IN_ARBITRARY, NOWHERE = 0, 3, 4, 7, 8, 12


def cells(path):
    with h5py.File(path) as file:
        basin, names = file["basin"], [*file["attractors/name"].asstr(), ""]
        return {name: basin[name][:] for name in basin} | dict(basin.attrs) | {"name": np.take(names, basin["attractor"][:])}


@pytest.fixture(scope="module")
def exact(kapitza, tmp_path_factory):
    folder = tmp_path_factory.mktemp("exact")
    (folder / "s.yaml").write_text(LONG)
    return folder, kapitza("run", "s.yaml", "--timings", folder=folder)


def test_labels_hang_on_no_numerics(kapitza, exact):
    """A fifth of the labels of coarse steps are wrong; followed in more precision from there all are right."""
    folder, done = exact
    kapitza("run", "s.yaml", "-o", "direct.h5", *COARSE, "--set", "basin.method=direct", folder=folder)
    kapitza("run", "s.yaml", "-o", "coarse.h5", *COARSE, folder=folder)
    fine, coarse, direct = (cells(folder / name) for name in ("s.h5", "coarse.h5", "direct.h5"))
    decided = (fine["evidence"] != UNDECIDED) & (coarse["evidence"] != UNDECIDED)
    assert decided.mean() > 0.9
    assert np.array_equal(fine["name"][decided], coarse["name"][decided])
    assert np.mean(direct["name"] != fine["name"]) > 0.1
    assert coarse["doubtful_share"] > fine["doubtful_share"] > 0.05
    assert {"cells 1", "pairs 16", "quad 1"} <= {line[:8].strip() for line in done.stdout.splitlines()}
    assert np.count_nonzero(fine["evidence"] == IN_QUAD) > 0
    assert np.count_nonzero(coarse["evidence"] == IN_FINE) > 0  # double precision with more steps gains nothing on fine ones
    assert np.count_nonzero(fine["evidence"] == IN_FINE) == 0


def test_what_is_left_is_flagged_with_two_candidates(exact):
    folder, done = exact
    basin = cells(folder / "s.h5")
    undecided = basin["evidence"] == UNDECIDED
    assert 0 < np.count_nonzero(undecided) == basin["undecided"] < 0.1 * undecided.size
    assert f"{basin['undecided']} cells are undecided (evidence 3)" in done.stdout
    assert np.array_equal(undecided, basin["other_attractor"] >= 0)
    assert np.all(basin["other_attractor"][undecided] != basin["attractor"][undecided])
    doubtful = np.count_nonzero(basin["evidence"] >= UNDECIDED) / undecided.size
    assert basin["doubtful_share"] == basin["doubtful_share_low"] == basin["doubtful_share_high"] == pytest.approx(doubtful)


def test_ranks_and_stops_change_nothing(kapitza, exact):
    folder, _ = exact
    stages = stopped_in_each_stage(kapitza, "s.yaml", "-o", "parts.h5", file="parts.h5", folder=folder, ranks=[1, 3])
    assert len(stages) > 5 and "quad 1" in stages
    assert datasets(folder / "parts.h5") == datasets(folder / "s.h5")


def test_nothing_is_exact_without_damping(kapitza, tmp_path):
    kapitza("run", SMALL, "-o", "x.h5", "--set", "pendulum={k: 0.01, damping: 0, m: 0.3}", "--set", "basin.method=exact", folder=tmp_path)
    basin = cells(tmp_path / "x.h5")
    assert np.all(basin["attractor"] == -1) and np.all(basin["other_attractor"] == -1) and np.all(basin["evidence"] == UNSETTLED)


@pytest.mark.extensive
def test_what_is_open_is_decided_on_demand(kapitza, tmp_path):
    """By orbits of their own in as many digits as it takes; all other labels stay."""
    (tmp_path / "s.yaml").write_text(LONG.replace("count: 24", "count: 10"))
    for name in ("flag", "decide"):
        kapitza("run", "s.yaml", "-o", f"{name}.h5", "--set", f"basin.undecided={name}", folder=tmp_path)
    flagged, decided = cells(tmp_path / "flag.h5"), cells(tmp_path / "decide.h5")
    open_cells = flagged["evidence"] == UNDECIDED
    assert np.count_nonzero(open_cells) > 0 and decided["undecided"] == 0
    assert np.all(decided["evidence"][open_cells] == IN_ARBITRARY)
    assert np.array_equal(flagged["attractor"][~open_cells], decided["attractor"][~open_cells])
    refused = kapitza("check", SMALL, "--set", "basin.undecided=decide", folder=tmp_path, status=2)
    assert "basin.undecided: decide needs basin.method: exact; choose that method, or flag" in refused.stderr


def test_the_former_flag_names_what_replaces_it(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(LONG.replace("method: exact", "flag_undecided: true"))
    for words in ["s.yaml"], [SMALL, "--set", "basin.flag_undecided=true"]:
        done = kapitza("check", *words, folder=tmp_path, status=2)
        assert "basin.flag_undecided: is no longer a key; use basin.method exact" in done.stderr


# Pushed round by a torque, or carried along by an elliptic pivot at its own pace: closed curves of the strobe map that are not cycles.
DRIVEN = {"torque": ("{k: 0.1, damping: 0.05, m: 0.05, torque: 0.1137}", 0), "ellipse": ("{k: 0, damping: 0.05, m: 0.5, ellipse: 1}", 1)}


@pytest.mark.parametrize("name", with_extensive(["ellipse"], ["torque"]))
def test_quasi_periodic_motions_are_recognised(kapitza, tmp_path, name):
    """They were followed for all of max_periods, most of them in every precision."""
    pendulum, cycles = DRIVEN[name]
    (tmp_path / "s.yaml").write_text(LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", pendulum))
    done = kapitza("run", "s.yaml", "--timings", folder=tmp_path)
    basin = cells(tmp_path / "s.h5")
    nowhere = basin["evidence"] == NOWHERE
    assert np.array_equal(nowhere, basin["attractor"] == -1) and np.count_nonzero(nowhere) > 200 and basin["undecided"] == 0
    assert len(basin["name"]) and len(set(basin["name"].ravel())) == cycles + 1
    assert np.max(basin["settling_time"]) < 500 < basin["max_periods"]
    assert f"{np.count_nonzero(nowhere)} of them settle nowhere (evidence 12)" in done.stdout
    assert "\nquad" not in done.stdout + done.stderr
    kapitza("run", "s.yaml", "-o", "three.h5", ranks=3, folder=tmp_path)
    assert datasets(tmp_path / "three.h5") == datasets(tmp_path / "s.h5")
    kapitza("run", "s.yaml", "-o", "direct.h5", "--set", "basin.method=direct", folder=tmp_path)
    assert np.array_equal(cells(tmp_path / "direct.h5")["attractor"], basin["attractor"])


def test_where_names_a_quasi_periodic_motion(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", DRIVEN["torque"][0]))
    found = json.loads(kapitza("where", "s.yaml", "1", "0", "--json", folder=tmp_path).stdout)
    assert (found["attractor"], found["name"], found["decided"], found["settling_time"]) == (-1, "quasi-periodic", True, None)
    assert "settles nowhere (quasi-periodic)" in kapitza("where", "s.yaml", "1", "0", folder=tmp_path).stdout
