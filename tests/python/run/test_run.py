"""The command run from end to end: the file's root, resuming, stopping, exit statuses."""

import math
import os
import re
import subprocess
from datetime import UTC, datetime

import pytest
import yaml
from conftest import PROGRAM, ROOT, datasets, run_scene, run_until_saved
from kapitza import Result

SMALL = ROOT / "scenes" / "small.yaml"
# A short search, then some seconds of cells.
SLOW = ["--set", "basin.method=direct", "--set", "basin.theta.count=400", "--set", "basin.velocity.count=400",
        "--set", "numerics.steps_per_period=160", "--set", "basin.attractors.starts=128"]


def test_root_tells_where_the_file_comes_from(small_result):
    root = Result(small_result).attributes
    assert root["program"] == "kapitza" and re.fullmatch(r"\d+\.\d+\.\d+", root["version"])
    assert root["scene"] == SMALL.read_text() and root["title"] in root["scene"]
    assert "run" in root["command"] and "small.yaml" in root["command"]
    assert root["ranks"] == 2 and root["instruction_set"] and root["git_revision"] and root["Conventions"]
    age = datetime.fromtimestamp(small_result.stat().st_mtime, UTC) - datetime.fromisoformat(root["created"])
    assert -2 < age.total_seconds() < 3600


def test_resolved_scene_gives_the_same_datasets(kapitza, small_result, tmp_path):
    resolved = Result(small_result).attributes["scene_resolved"]
    assert datasets(run_scene(kapitza, tmp_path, resolved)[0].path) == datasets(small_result)
    assert yaml.safe_load(resolved)["basin"]["attractors"]["starts"] == 8192


def test_a_resolved_scene_has_no_half_of_a_mapping(kapitza, tmp_path):
    """The measures strobe and ends have mappings with a required key: where it is not given, the defaults beside it are
    left out."""
    text = ("pendulum: {k: 0.1, damping: 0.1, m: 0.2}\nsweep: {parameter: m, min: 0.1, max: 0.2, count: 2, measure: "
            "[strobe]}\n")
    resolved = run_scene(kapitza, tmp_path, text)[0].scene
    assert "ends" not in resolved and "samples: 64" in resolved
    (tmp_path / "again.yaml").write_text(resolved)
    kapitza("check", "again.yaml", folder=tmp_path)


def test_resume_of_a_complete_file_is_success_at_once(kapitza, tmp_path):
    kapitza("run", SMALL, "-o", "x.h5", folder=tmp_path)
    before = (tmp_path / "x.h5").stat().st_mtime_ns
    done = kapitza("run", SMALL, "-o", "x.h5", "--resume", ranks=2, folder=tmp_path)
    assert "already complete" in done.stdout and (tmp_path / "x.h5").stat().st_mtime_ns == before
    assert [path.name for path in tmp_path.iterdir()] == ["x.h5"]
    other = kapitza("run", SMALL, "-o", "x.h5", "--resume", "--set", "basin.attractors.seed=2", folder=tmp_path,
                    status=2)
    assert ('x.h5: belongs to another run: it has "basin.attractors.seed: 1", this run has "basin.attractors.seed: 2"'
            in other.stderr)
    kapitza("run", SMALL, "-o", "x.h5", "--force", folder=tmp_path)


def test_a_stop_saves_and_resume_ends_with_the_same_bytes(kapitza, tmp_path):
    none = kapitza("run", SMALL, *SLOW, "--time-limit", "0.001", ranks=2, folder=tmp_path, status=75)
    assert none.stderr == "kapitza: stopped by the time limit of 0.001 s; nothing was saved\n"
    assert not list(tmp_path.iterdir())
    errors = run_until_saved(kapitza, SMALL, *SLOW, file="small.h5", folder=tmp_path)
    assert errors.count("\n") == 1 and "error" not in errors
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small.h5.checkpoint"]
    other = kapitza("run", SMALL, *SLOW, "--resume", "--set", "basin.max_periods=1999", folder=tmp_path, status=2)
    assert "basin.max_periods: 2000" in other.stderr and "basin.max_periods: 1999" in other.stderr
    kapitza("run", SMALL, *SLOW, "--resume", ranks=3, folder=tmp_path)
    kapitza("run", SMALL, *SLOW, "-o", "undisturbed.h5", ranks=2, folder=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small.h5", "undisturbed.h5"]
    assert datasets(tmp_path / "small.h5") == datasets(tmp_path / "undisturbed.h5")
    shares = [Result(tmp_path / name).group("basin").attrs["doubtful_share"] for name in ("small.h5", "undisturbed.h5")]
    assert 0 < shares[0] == shares[1] < 0.01


def test_si_values_stand_in_the_file(kapitza, tmp_path):
    """With the frequency in Hz: seconds and rad/s follow from pivot_frequency."""
    si = {"mass": 0.1, "radius": 0.2, "inertia": 0.008, "friction": 0.0145, "gravity": 33.06, "pivot_amplitude": 0.12}
    text = ", ".join(f"{key}: {value}" for key, value in si.items())
    result, _ = run_scene(kapitza, tmp_path, SMALL, "--set", f"pendulum={{{text}, frequency: 15.5}}")
    pendulum, resolved = result.group("pendulum").attrs, yaml.safe_load(result.attributes["scene_resolved"])["pendulum"]
    omega = 15.5 * 2 * math.pi
    assert {key: pendulum[key] for key in si} == si and pendulum["pivot_frequency"] == pytest.approx(omega, rel=1e-15)
    assert pendulum["k"] == pytest.approx(0.1 * 0.2 * 33.06 / (0.008 * omega**2),
                                          rel=1e-14) and resolved == si | {"frequency": 15.5}


def test_a_lone_process_starts_no_mpi(tmp_path):
    """MPI's start takes longer than a small run, may make a daemon, and needs a folder of its own. Here it would
    fail."""
    command = [PROGRAM, "run", SMALL, "-o", tmp_path / "out.h5"]
    broken = {"OMPI_MCA_pml": "none", "OPAL_BINDIR": str(tmp_path), "TMPDIR": "/proc"}
    done = subprocess.run(command, env=os.environ | broken, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_lone_processes_of_an_unknown_launcher_do_not_write_one_file(tmp_path):
    """Each believes that it is alone: one has the lock, the others are refused."""
    command = [PROGRAM, "run", SMALL, "-o", tmp_path / "out.h5", *SLOW[:6]]
    running = [subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
               for _ in range(3)]
    errors = [process.communicate()[1] for process in running]
    refused = [error for process, error in zip(running, errors, strict=True) if process.returncode]
    assert sorted(process.returncode for process in running) == [0, 2, 2] and len(refused) == 2
    assert all(error.count("\n") == 1 for error in refused), refused
