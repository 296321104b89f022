"""Method exact: every label decided in as much precision as it takes, or flagged."""

import json

import numpy as np
import pytest
from conftest import ROOT, datasets, run_scene, settings, stopped_in_each_stage, with_extensive

SMALL = ROOT / "scenes" / "small.yaml"
# Some 13 % of these labels are wrong by any method in double precision.
LONG = """\
pendulum: {quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}
basin:
  theta: {count: 24}
  velocity: {min: -2, max: 2, count: 24}
  method: exact
  attractors: {starts: 512}
  turns: true
"""
# What of its numerics alone gets wrong.
COARSE = ("--set", "numerics={scheme: rk4, steps_per_period: 60}")
UNSETTLED, UNDECIDED, IN_QUAD, IN_FINE, IN_ARBITRARY, NOWHERE = 0, 3, 4, 7, 8, 12


def cells(result):
    basin, names = result.group("basin"), [*result.group("attractors")["name"].values, ""]
    return {name: basin[name].values for name in basin} | basin.attrs | {"name": np.take(names, basin["attractor"].values)}


@pytest.fixture(scope="module")
def exact(kapitza, tmp_path_factory):
    """The result of LONG and its summary."""
    return run_scene(kapitza, tmp_path_factory.mktemp("exact"), LONG, "--timings")


def test_labels_hang_on_no_numerics(kapitza, exact, tmp_path):
    """A fifth of the labels of coarse steps are wrong; followed in more precision from there all are right."""
    result, said = exact
    fine, coarse = cells(result), cells(run_scene(kapitza, tmp_path, LONG, *COARSE)[0])
    direct = cells(run_scene(kapitza, tmp_path, LONG, *COARSE, "--set", "basin.method=direct")[0])
    decided = (fine["evidence"] != UNDECIDED) & (coarse["evidence"] != UNDECIDED)
    assert decided.mean() > 0.9
    assert np.array_equal(fine["name"][decided], coarse["name"][decided])
    assert np.array_equal(fine["turns"][decided], coarse["turns"][decided], equal_nan=True) and np.nanmax(fine["turns"]) > 10
    assert np.mean(direct["name"] != fine["name"]) > 0.1
    assert coarse["doubtful_share"] > fine["doubtful_share"] > 0.05
    assert {"cells 1", "pairs 16", "quad 1"} <= {line[:8].strip() for line in said.splitlines()}
    assert np.count_nonzero(fine["evidence"] == IN_QUAD) > 0
    assert np.count_nonzero(coarse["evidence"] == IN_FINE) > 0  # double precision with more steps gains nothing on fine ones
    assert np.count_nonzero(fine["evidence"] == IN_FINE) == 0


def test_what_is_left_is_flagged_with_two_candidates(exact):
    result, said = exact
    basin = cells(result)
    undecided = basin["evidence"] == UNDECIDED
    assert 0 < np.count_nonzero(undecided) == basin["undecided"] < 0.1 * undecided.size
    assert f"{basin['undecided']} cells are undecided (evidence 3)" in said
    assert np.array_equal(undecided, basin["other_attractor"] >= 0)
    assert np.all(basin["other_attractor"][undecided] != basin["attractor"][undecided])
    doubtful = np.count_nonzero(basin["evidence"] >= UNDECIDED) / undecided.size
    assert basin["doubtful_share"] == basin["doubtful_share_low"] == basin["doubtful_share_high"] == pytest.approx(doubtful)


def test_ranks_and_stops_change_nothing(kapitza, exact, tmp_path):
    path = exact[0].path
    stages = stopped_in_each_stage(kapitza, path.with_suffix(".yaml"), file="s.h5", folder=tmp_path, ranks=[1, 3])
    assert len(stages) > 5 and "quad 1" in stages
    assert datasets(tmp_path / "s.h5") == datasets(path)


def test_nothing_is_exact_without_damping(kapitza, tmp_path):
    undamped = settings("pendulum={k: 0.01, damping: 0, m: 0.3}", "basin.method=exact")
    basin = cells(run_scene(kapitza, tmp_path, SMALL, *undamped)[0])
    assert np.all(basin["attractor"] == -1) and np.all(basin["other_attractor"] == -1) and np.all(basin["evidence"] == UNSETTLED)


@pytest.mark.extensive
def test_what_is_open_is_decided_on_demand(kapitza, tmp_path):
    """By orbits of their own in as many digits as it takes; all other labels stay."""
    scene = LONG.replace("count: 24", "count: 10")
    flagged, decided = (cells(run_scene(kapitza, tmp_path, scene, "--set", f"basin.undecided={word}")[0]) for word in ("flag", "decide"))
    open_cells = flagged["evidence"] == UNDECIDED
    assert np.count_nonzero(open_cells) > 0 and decided["undecided"] == 0
    assert np.all(decided["evidence"][open_cells] == IN_ARBITRARY)
    assert np.array_equal(flagged["attractor"][~open_cells], decided["attractor"][~open_cells])


# Pushed round by a torque, or carried along by an elliptic pivot at its own pace: closed curves of the strobe map that are not cycles.
DRIVEN = {"torque": ("{k: 0.1, damping: 0.05, m: 0.05, torque: 0.1137}", 0), "ellipse": ("{k: 0, damping: 0.05, m: 0.5, ellipse: 1}", 1)}


@pytest.mark.parametrize("name", with_extensive(["ellipse"], ["torque"]))
def test_quasi_periodic_motions_are_recognised(kapitza, tmp_path, name):
    """They were followed for all of max_periods, most of them in every precision."""
    pendulum, cycles = DRIVEN[name]
    scene = LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", pendulum)
    result, said = run_scene(kapitza, tmp_path, scene, "--timings")
    basin = cells(result)
    nowhere = basin["evidence"] == NOWHERE
    assert np.array_equal(nowhere, basin["attractor"] == -1) and np.count_nonzero(nowhere) > 200 and basin["undecided"] == 0
    assert len(basin["name"]) and len(set(basin["name"].ravel())) == cycles + 1
    assert np.max(basin["settling_time"]) < 500 < basin["max_periods"]
    assert f"{np.count_nonzero(nowhere)} of them settle nowhere (evidence 12)" in said and "\nquad" not in said
    assert datasets(run_scene(kapitza, tmp_path, scene, ranks=3, name="three")[0].path) == datasets(result.path)
    direct, _ = run_scene(kapitza, tmp_path, scene, "--set", "basin.method=direct", name="direct")
    assert np.array_equal(cells(direct)["attractor"], basin["attractor"])


def test_where_names_a_quasi_periodic_motion(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", DRIVEN["torque"][0]))
    found = json.loads(kapitza("where", "s.yaml", "1", "0", "--json", folder=tmp_path).stdout)
    assert (found["attractor"], found["name"], found["decided"], found["settling_time"]) == (-1, "quasi-periodic", True, None)
    assert "settles nowhere (quasi-periodic)" in kapitza("where", "s.yaml", "1", "0", folder=tmp_path).stdout
