"""--log and --timings: what programs and people learn of a run."""

import json

import h5py
import pytest
from conftest import ROOT, run_until_saved

SMALL = ROOT / "scenes" / "small.yaml"


def events(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_log_tells_stages_and_the_end(kapitza, tmp_path):
    done = kapitza("run", SMALL, "--set", "basin.method=icm", "--log", "log.jsonl", "--timings", ranks=2,
                   folder=tmp_path)
    lines = events(tmp_path / "log.jsonl")
    assert lines[0]["event"] == "begin" and lines[0]["ranks"] == 2 and lines[0]["file"] == "small.h5"
    assert lines[-1] == lines[-1] | {"event": "end", "status": 0, "message": ""}
    assert [line["seconds"] for line in lines] == sorted(line["seconds"] for line in lines)
    stages = {line["stage"]: line for line in lines if line["event"] == "stage"}
    assert {"map table", "cells 1", "doubt", "file"} <= set(stages)
    assert all(stage["wall"] >= 0 and 0 <= stage["busy"] <= 1.01 for stage in stages.values())
    assert all(0 <= stage["most"] <= stage["processor"] + 1e-6
               for stage in stages.values()) and lines[-1]["outside"] > 0
    tiles = [tile for line in lines if line["event"] == "tiles" and line["stage"] == "map table"
             for tile in line["tile"]]
    own = sum(sum(line["processor"]) for line in lines if line["event"] == "tiles" and line["stage"] == "map table")
    assert 0 < len(set(tiles)) == len(tiles) <= stages["map table"]["tiles"]
    assert own <= stages["map table"]["processor"] + 1e-4
    table = {line[:12].strip(): line[12:].split() for line in done.stdout.splitlines()}
    assert int(table["cells 1"][1]) == stages["cells 1"]["tiles"] and "serial s" in done.stdout
    with h5py.File(tmp_path / "small.h5") as file:
        assert 0 < file.attrs["wall_seconds"] <= lines[-1]["seconds"] and {"compiler", "mpi", "hdf5"} <= set(file.attrs)


def test_a_log_goes_on_and_tells_how_a_run_was_stopped(kapitza, tmp_path):
    log = ["--log", "log.jsonl"]
    slow = ["--set", "basin.method=direct", "--set", "numerics.steps_per_period=1000"]
    run_until_saved(kapitza, SMALL, *slow, *log, file="small.h5", folder=tmp_path)
    first = events(tmp_path / "log.jsonl")
    assert first[-1]["status"] == 75 and "stopped by SIGUSR1" in first[-1]["message"]
    kapitza("run", SMALL, *log, "-o", "other.h5", folder=tmp_path)
    assert events(tmp_path / "log.jsonl")[: len(first)] == first


def test_warnings_are_logged(kapitza, tmp_path):
    doubtful = ["--set", "pendulum={quality_factor: 20, drive_frequency: 8, drive_amplitude: 0.35}"]
    kapitza("run", SMALL, *doubtful, "--set", "basin.method=direct", "--log", "log.jsonl", folder=tmp_path)
    assert any("doubtful" in line["text"] for line in events(tmp_path / "log.jsonl") if line["event"] == "warning")


@pytest.mark.parametrize("name", ["small.h5", "small.h5.part", "notes.txt", "link.jsonl", "missing/log.jsonl", "."])
def test_a_log_never_harms_another_file(kapitza, tmp_path, name):
    (tmp_path / "notes.txt").write_text("mine\n")
    (tmp_path / "link.jsonl").symlink_to("elsewhere")
    done = kapitza("run", SMALL, "--log", name, folder=tmp_path, status=2)
    assert "--log" in done.stderr and done.stderr.count("\n") == 1
    assert (tmp_path / "notes.txt").read_text() == "mine\n"
    assert {path.name for path in tmp_path.iterdir()} == {"notes.txt", "link.jsonl"}


def test_progress_names_stages_in_words(kapitza, tmp_path):
    """A file gets lines, no bar that is drawn again and again."""
    grid = [word for axis in ("theta", "velocity") for word in ("--set", f"basin.{axis}.count=300")]
    said = kapitza("run", ROOT / "scenes" / "small.yaml", "--progress", "always", *grid, "-o", tmp_path / "x.h5").stderr
    assert "kapitza: labels in double precision, round 1: 100 %" in said and "kapitza: writing the file: 100 %" in said
    assert "cells" not in said and "\r" not in said
