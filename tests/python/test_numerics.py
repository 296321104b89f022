"""Scheme and steps: what auto takes, what it says of them, what stays the same."""

import h5py
import numpy as np
import pytest
from conftest import ROOT, datasets
from kapitza import Result

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=60", "--set", "basin.velocity.count=60", "--set", "basin.attractors.starts=1024"]
DIRECT = [*TINY, "--set", "basin.method=direct"]


def attributes(path):
    with h5py.File(path) as file:
        return dict(file["basin"].attrs)


def labels(kapitza, path, *options):
    kapitza("run", SMALL, "-o", path, *options)
    return Result(path).group("basin")["attractor"].values


def test_the_default_is_processed_and_reruns_from_its_resolved_scene(kapitza, tmp_path):
    done = kapitza("run", SMALL, *DIRECT, "-o", "a.h5", folder=tmp_path)
    held = attributes(tmp_path / "a.h5")
    assert held["scheme"] == "processed" and held["tolerance"] == 1e-12 and 0 < held["step_error"] < 2e-12
    assert f"processed splitting, {held['steps_per_period']} steps per drive period" in done.stdout
    with h5py.File(tmp_path / "a.h5") as file:
        (tmp_path / "b.yaml").write_text(str(file.attrs["scene_resolved"]))
    assert "steps_per_period: auto" in (tmp_path / "b.yaml").read_text()
    kapitza("run", tmp_path / "b.yaml", "-o", "b.h5", folder=tmp_path)
    assert datasets(tmp_path / "a.h5") == datasets(tmp_path / "b.h5")


@pytest.mark.parametrize("amplitude, unlike", [(0.3, 0.001), (0.46, 0.03)])
def test_labels_are_those_of_fine_split6(kapitza, tmp_path, amplitude, unlike):
    """At 0.46 rounding alone changes 0.7 % of them."""
    words = [*DIRECT, "--set", f"pendulum.drive_amplitude={amplitude}"]
    fine = labels(kapitza, tmp_path / "fine.h5", *words, "--set", "numerics={scheme: split6, steps_per_period: 96}")
    assert np.mean(labels(kapitza, tmp_path / "auto.h5", *words) != fine) <= unlike


def test_a_looser_tolerance_takes_fewer_steps(kapitza, tmp_path):
    labels(kapitza, tmp_path / "a.h5", *DIRECT)
    labels(kapitza, tmp_path / "b.h5", *DIRECT, "--set", "numerics.tolerance=1e-6")
    fine, loose = attributes(tmp_path / "a.h5"), attributes(tmp_path / "b.h5")
    assert loose["steps_per_period"] < fine["steps_per_period"] and 1e-9 < loose["step_error"] < 2e-6


def test_split6_where_the_series_does_not_carry(kapitza, tmp_path):
    done = kapitza("run", SMALL, *DIRECT, "--set", "pendulum={k: 100, damping: 0.1, m: 1}", "-o", "x.h5", folder=tmp_path)
    assert "split6, " in done.stdout and "(processed does not reach numerics.tolerance = 1e-12 for this pendulum)" in done.stdout
    assert attributes(tmp_path / "x.h5")["scheme"] == "split6"


@pytest.mark.parametrize("words, key", [("basin.method=hybrid", "use direct"), ("numerics.tolerance=0", "numerics.tolerance"),
                                        ("numerics.steps_per_period=many", "from 1 to 100000, or auto")])
def test_bad_words_name_what_would_do(kapitza, tmp_path, words, key):
    done = kapitza("check", SMALL, "--set", words, folder=tmp_path, status=2)
    assert key in done.stderr and done.stderr.count("\n") == 1
