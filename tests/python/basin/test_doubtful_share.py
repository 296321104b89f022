"""The share of labels that steps and rounding may change: its attributes, its sample, and what quad precision says of
it."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, run_scene, settings

SMALL = ROOT / "scenes" / "small.yaml"
NAMES = [f"{name}_share{end}" for name in ("doubtful", "differing") for end in ("", "_low", "_high")]
SIDES = ("--set", "pendulum.drive_amplitude=0.46", "--set", "basin.theta.count=160")


def doubt(kapitza, folder, *options, ranks=None):
    """The shares of a scene without a symmetric window, so that the sample is not all cells; and the summary."""
    result, said = run_scene(kapitza, folder, SMALL, *SIDES, "--set", "basin.velocity.max=1.9", *options, ranks=ranks)
    return {name: float(result.group("basin").attrs[name]) for name in NAMES}, said


def test_shares_are_stored_told_and_warned_of(kapitza, tmp_path):
    shares, summary = doubt(kapitza, tmp_path, "--set", "numerics.scheme=split6", "--set", "basin.method=icm",
                            "--set", "basin.icm={theta: 250, velocity: 250}")
    # Measured: 14.4 % (13.7 .. 15.1) and 0.1 %. So few cells grow no regions: orbits are trapped later, and more lose
    # their labels.
    assert 0.11 < shares["doubtful_share_low"] < shares["doubtful_share"] < shares["doubtful_share_high"] < 0.16
    assert shares["doubtful_share_high"] - shares["doubtful_share_low"] < 0.02
    assert 0.0003 < shares["differing_share"] < 0.003, "errors of a coarse map table"
    assert f"{100 * shares['doubtful_share']:.3g} % of the labels are doubtful" in summary
    assert "warning: more than 5 % of the labels are doubtful" in summary
    assert "differ from the label by integration" in summary


def test_sample_depends_on_the_scene_alone(kapitza, tmp_path):
    table = ("--set", "basin.method=icm")
    alone, _ = doubt(kapitza, tmp_path, *table)
    assert doubt(kapitza, tmp_path, *table, ranks=3)[0] == alone
    assert doubt(kapitza, tmp_path, *table, "--set", "basin.attractors.seed=2")[0] != alone


def test_a_share_that_was_counted_has_no_interval(kapitza, tmp_path):
    """All cells of a small map are in the sample: "95 % interval: 0.34 to 0.34 %" stood beside a count."""
    few = ("--set", "basin.theta.count=20", "--set", "basin.velocity.count=20", "--set", "basin.method=icm")
    shares, summary = doubt(kapitza, tmp_path, *few)
    assert shares["doubtful_share_low"] == shares["doubtful_share"] == shares["doubtful_share_high"]
    assert "% of the labels are doubtful: the error of the orbit may change them. This is from 400 cells" in summary
    assert "interval" not in summary


def test_direct_integration_tells_doubtful_cells_one_by_one(kapitza, tmp_path):
    """They are the ones that method exact follows in more precision where both take the same steps, which exact takes
    for a tenth of the tolerance; all others have its labels and settling times."""
    def basin(method, tolerance):
        options = settings(f"basin.method={method}", f"numerics.tolerance={tolerance}")
        return run_scene(kapitza, tmp_path, SMALL, *SIDES, *options, name=method)[0].group("basin")

    direct, exact = basin("direct", 1e-13), basin("exact", 1e-12)
    share, doubtful = {name: float(direct.attrs[name]) for name in NAMES}, direct["evidence"].values == 9
    assert np.array_equal(doubtful, np.isin(exact["evidence"].values, (3, 4, 5, 7)))
    assert share["doubtful_share_low"] == share["doubtful_share"] == share["doubtful_share_high"] == pytest.approx(
        doubtful.mean())
    assert 0.03 < share["doubtful_share"] < 0.12 and share["differing_share_high"] == 0
    for name in ("attractor", "settling_time"):
        differ = direct[name].values != exact[name].values
        assert np.any(differ) and np.all(doubtful[differ])


@pytest.mark.extensive
def test_twenty_random_pendulums():
    done = subprocess.run([sys.executable, ROOT / "benchmarks" / "doubt_coverage.py"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stdout + done.stderr
