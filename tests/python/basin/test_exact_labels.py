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
# Numerics that get labels wrong.
COARSE = ("--set", "numerics={scheme: rk4, steps_per_period: 60}")
UNSETTLED, UNDECIDED, IN_QUAD, IN_FINE, IN_ARBITRARY, AVERAGED = 0, 3, 4, 7, 8, 12


def cells(result):
    basin, names = result.group("basin"), [*result.group("attractors")["name"].values, ""]
    return {name: basin[name].values
            for name in basin} | basin.attrs | {"name": np.take(names, basin["attractor"].values)}


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
    assert np.array_equal(fine["turns"][decided], coarse["turns"][decided],
                          equal_nan=True) and np.nanmax(fine["turns"]) > 10
    assert np.mean(direct["name"] != fine["name"]) > 0.1
    assert coarse["doubtful_share"] > fine["doubtful_share"] > 0.05
    assert {"cells 1", "pairs 16", "quad 1"} <= {line[:8].strip() for line in said.splitlines()}
    assert np.count_nonzero(fine["evidence"] == IN_QUAD) > 0
    # Double precision with more steps gains nothing where steps are fine already
    assert np.count_nonzero(coarse["evidence"] == IN_FINE) > 0
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
    assert basin["doubtful_share"] == basin["doubtful_share_low"] == basin["doubtful_share_high"] == pytest.approx(
        doubtful)


def test_ranks_and_stops_change_nothing(kapitza, exact, tmp_path):
    path = exact[0].path
    stages = stopped_in_each_stage(kapitza, path.with_suffix(".yaml"), file="s.h5", folder=tmp_path, ranks=[1, 3])
    assert len(stages) > 5 and "quad 1" in stages
    assert datasets(tmp_path / "s.h5") == datasets(path)


def test_nothing_is_exact_without_damping(kapitza, tmp_path):
    undamped = settings("pendulum={k: 0.01, damping: 0, m: 0.3}", "basin.method=exact")
    basin = cells(run_scene(kapitza, tmp_path, SMALL, *undamped)[0])
    assert np.all(basin["attractor"] == -1) and np.all(basin["other_attractor"]
                                                       == -1) and np.all(basin["evidence"] == UNSETTLED)


@pytest.mark.extensive
def test_what_is_open_is_decided_on_demand(kapitza, tmp_path):
    """By orbits of their own in as many digits as it takes; all other labels stay."""
    scene = LONG.replace("count: 24", "count: 10")
    flagged, decided = (cells(run_scene(kapitza, tmp_path, scene, "--set", f"basin.undecided={word}")[0])
                        for word in ("flag", "decide"))
    open_cells = flagged["evidence"] == UNDECIDED
    assert np.count_nonzero(open_cells) > 0 and decided["undecided"] == 0
    assert np.all(decided["evidence"][open_cells] == IN_ARBITRARY)
    assert np.array_equal(flagged["attractor"][~open_cells], decided["attractor"][~open_cells])


# Pushed round by a torque, or carried along by an elliptic pivot at its own pace: closed curves of the strobe map that
# are not cycles.
DRIVEN = {"torque": ("{k: 0.1, damping: 0.05, m: 0.05, torque: 0.1137}", 0),
          "ellipse": ("{k: 0, damping: 0.05, m: 0.5, ellipse: 1}", 1)}


@pytest.mark.parametrize("name", with_extensive(["ellipse"], ["torque"]))
def test_running_states_are_ends(kapitza, tmp_path, name):
    """Their starts were labelled -1, after quad precision; a band round the curve traps them in doubles."""
    pendulum, cycles = DRIVEN[name]
    scene = LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", pendulum)
    result, said = run_scene(kapitza, tmp_path, scene, "--timings")
    basin = cells(result)
    rows = result.group("attractors")
    running = rows["name"].values.tolist().index("running -" if name == "ellipse" else "running +")
    assert len(rows["period"]) == cycles + 1 and (rows["period"][running], abs(rows["winding"][running])) == (0, 1)
    assert abs(rows["lyapunov"][running]) <= rows["lyapunov_error"][running] < 1e-9
    assert rows["mean_velocity"][running] == pytest.approx({"torque": 2.273414659, "ellipse": -0.1745591202}[name],
                                                           abs=2e-9)
    assert np.count_nonzero(basin["attractor"] == running) > 200 and basin["undecided"] == 0
    assert set(np.unique(basin["evidence"])) <= {1, 2, 5, IN_FINE} and np.max(basin["settling_time"]) < 500
    assert "\nquad" not in said
    assert datasets(run_scene(kapitza, tmp_path, scene, ranks=3, name="three")[0].path) == datasets(result.path)
    direct, _ = run_scene(kapitza, tmp_path, scene, "--set", "basin.method=direct", name="direct")
    assert np.array_equal(cells(direct)["attractor"], basin["attractor"])


def test_where_names_a_running_state(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}",
                                                  DRIVEN["torque"][0]))
    found = json.loads(kapitza("where", "s.yaml", "1", "0", "--json", folder=tmp_path).stdout)
    assert (found["attractor"], found["name"], found["decided"], found["period"],
            found["winding"]) == (0, "running +", True, 0, 1)
    said = kapitza("where", "s.yaml", "1", "0", folder=tmp_path).stdout
    assert "ends on         running + (attractor 0)\n" in said and "mean velocity   2.273414659\n" in said


def test_a_running_state_without_a_band_is_flagged(kapitza, tmp_path):
    """Next to its birth the curve is too steep for its nodes."""
    scene = LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}",
                         "{k: 1, damping: 0.1, m: 0, torque: 0.1271}")
    result, said = run_scene(kapitza, tmp_path, scene)
    basin = cells(result)
    running = basin["name"].ravel() == "running +"
    assert np.count_nonzero(running) > 100 and np.array_equal(basin["evidence"].ravel() == AVERAGED, running)
    assert (f"{np.count_nonzero(running)} cells end on a running state that averages along orbits show "
            "(evidence 12)") in said
    (tmp_path / "s.yaml").write_text(scene)
    found = json.loads(kapitza("where", "s.yaml", "0", "2", "--json", folder=tmp_path).stdout)
    assert (found["name"], found["decided"], found["precision"]) == ("running +", False, None)


def test_a_rotation_without_drive_is_a_running_state_at_any_velocity(kapitza, tmp_path):
    """At the mean velocity 1 every state of the curve comes back after 2 pi: it was a cycle of the multiplier 1, or
    nothing."""
    scene = LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}",
                         "{k: 0, damping: 0.1, m: 0, torque: 0.1}")
    rows = run_scene(kapitza, tmp_path, scene)[0].group("attractors")
    assert rows["name"].values.tolist() == ["running +"] and abs(rows["mean_velocity"].values[0] - 1) < 1e-12


def test_a_circle_of_oscillations_is_no_running_state(kapitza, tmp_path):
    """Without gravity every angle keeps its own forced oscillation."""
    own = "{k: 0, damping: 0.3, m: 0, torque_amplitude: 1}"
    scene = LONG.replace("{quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}", own)
    assert len(run_scene(kapitza, tmp_path, scene)[0].group("attractors")["name"]) == 0
