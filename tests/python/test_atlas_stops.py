"""An atlas that is stopped in each of its stages, one after the other, and resumed on another number of ranks: the same bytes."""

import itertools
import json
import os
import subprocess

import pytest
from conftest import PROGRAM, datasets, with_extensive
from test_atlas import PENDULUM

STAGES = {"atlas births", "atlas branches", "atlas curves", "atlas checks", "atlas motions", "atlas shares"}
SMALL = {"pendulum": PENDULUM,
         "atlas": {"x": {"parameter": "drive_frequency", "min": 9, "max": 12}, "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.3},
                   "max_period": 1, "seeds": 2, "checks": 2, "points": 16, "shares": 40}}
LARGER = {"pendulum": PENDULUM,
          "atlas": SMALL["atlas"] | {"y": {"parameter": "drive_amplitude", "min": 0, "max": 0.5}, "max_period": 2, "seeds": 4,
                                     "checks": 80}}
TILTED = {"pendulum": dict(PENDULUM, tilt="5 deg"),
          "atlas": SMALL["atlas"] | {"y": {"parameter": "drive_amplitude", "min": 0.1, "max": 0.3}}}


def last_stage(checkpoint):
    """The name of the last stage that a checkpoint has."""
    data = checkpoint.read_bytes()
    return data[data.rindex(b"kzstage\0") + 8:][:32].split(b"\0")[0].decode()


def stops(folder, ranks, writes):
    """Starts and resumes a run until it is done; each time it is stopped in the first stage that is new: before its first tile (0 writes),
    or in the middle of the first record (1). The names of these stages."""
    found = []
    for start in itertools.count():
        n = ranks[start % len(ranks)]
        exports = {"LD_PRELOAD": str(PROGRAM.parent / "tests" / "stop_at.so"), "KZ_WRITES": str(writes[start % len(writes)])}
        launcher = ["mpirun", *(word for name in exports for word in ("-x", name)), "-n", str(n)] if n > 1 else []
        done = subprocess.run([*launcher, PROGRAM, "run", "s.yaml", *(["--resume"] if found else [])], cwd=folder, text=True,
                              capture_output=True, env=os.environ | exports)
        if done.returncode == 0:
            return found
        assert done.returncode == 75 and "stopped by SIGUSR1; finished work is in" in done.stderr, done.stderr
        found.append(last_stage(folder / "s.h5.checkpoint"))


@pytest.mark.parametrize(("scene", "others", "ranks", "writes"), with_extensive(
    [(SMALL, set(), [1], [1, 0])],
    [(LARGER, set(), [1, 2, 3, 7, 2], [1, 0]), (TILTED, {"atlas reference"}, [7, 3, 1, 2, 3], [1, *99 * [0]])]))
def test_a_stop_in_each_stage_changes_no_byte(kapitza, tmp_path, scene, others, ranks, writes):
    (tmp_path / "s.yaml").write_text(json.dumps(scene))
    kapitza("run", "s.yaml", "-o", "whole.h5", folder=tmp_path)
    found = stops(tmp_path, ranks, writes)
    assert STAGES | others <= set(found), found
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "whole.h5")
    assert not (tmp_path / "s.h5.checkpoint").exists()
