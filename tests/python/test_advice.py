"""Messages where something is odd: keys that do nothing, words in the wrong place, ranks that were given different things,
file systems without locks, logs that a kill has cut. Nothing is left behind that stops the next run."""

import json

import pytest
from conftest import ROOT, launched

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=8", "--set", "basin.velocity.count=8", "--set", "basin.icm={theta: 40, velocity: 40}"]
IDLE = "warning: basin.icm: is not used by this basin.method"
UNDAMPED = "warning: pendulum: has no damping"


TABLE = "basin={velocity: {min: -2, max: 2}, icm: {theta: 40, velocity: 40}}"


@pytest.mark.parametrize("setting, warning", [(TABLE, IDLE), ("basin.method=direct", ""), ("basin.method=icm", ""),
                                              ("pendulum={k: 0.01, damping: 0, m: 0.3}", UNDAMPED)])
def test_what_does_nothing_is_said(kapitza, tmp_path, setting, warning):
    said = kapitza("check", SMALL, "--set", setting, folder=tmp_path).stdout
    assert said.count("warning: ") == (warning != "") and warning in said


def test_no_scene_of_the_repository_has_keys_that_do_nothing(kapitza, tmp_path):
    """One check for all: scenes that give a map table and leave the method out."""
    scenes = [path.read_text() for path in (ROOT / "scenes").glob("*.yaml")]
    assert not [text for text in scenes if "icm:" in text and "method: icm" not in text]


def test_a_file_system_without_locks(kapitza, tmp_path):
    """The empty checkpoint stayed and stopped the next run."""
    done = kapitza("run", SMALL, *TINY, folder=tmp_path, launcher=launched(None, "no_locks"), status=2)
    assert "cannot be locked: No locks available" in done.stderr, done.stderr
    assert not list(tmp_path.iterdir())


def test_a_log_whose_last_line_was_cut(kapitza, tmp_path):
    for _ in range(2):
        kapitza("run", SMALL, *TINY, "--force", "--log", "run.log", folder=tmp_path)
        lines = (tmp_path / "run.log").read_text().splitlines()
        assert json.loads(lines[-1])["event"] == "end"
        (tmp_path / "run.log").write_text("\n".join(lines)[:-20])
    kapitza("run", SMALL, *TINY, "--force", "--log", "run.log", folder=tmp_path)
    broken = [line for line in (tmp_path / "run.log").read_text().splitlines() if not line.endswith("}")]
    assert len(broken) == 2
