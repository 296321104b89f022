"""Scheme and steps: what auto takes, what it says of them, what stays the same."""

import h5py
import pytest
from conftest import ROOT, datasets

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=60", "--set", "basin.velocity.count=60", "--set", "basin.attractors.starts=1024"]
DIRECT = [*TINY, "--set", "basin.method=direct"]


def attributes(path):
    with h5py.File(path) as file:
        return dict(file["basin"].attrs)


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


def test_a_looser_tolerance_takes_fewer_steps(kapitza, tmp_path):
    kapitza("run", SMALL, "-o", "a.h5", *DIRECT, folder=tmp_path)
    kapitza("run", SMALL, "-o", "b.h5", *DIRECT, "--set", "numerics.tolerance=1e-6", folder=tmp_path)
    fine, loose = attributes(tmp_path / "a.h5"), attributes(tmp_path / "b.h5")
    assert loose["steps_per_period"] < fine["steps_per_period"] and 1e-9 < loose["step_error"] < 2e-6


@pytest.mark.parametrize("words, key", [("basin.method=hybrid", "use direct"), ("numerics.tolerance=0", "numerics.tolerance"),
                                        ("numerics.steps_per_period=many", "from 1 to 100000, or auto")])
def test_bad_words_name_what_would_do(kapitza, tmp_path, words, key):
    done = kapitza("check", SMALL, "--set", words, folder=tmp_path, status=2)
    assert key in done.stderr and done.stderr.count("\n") == 1
