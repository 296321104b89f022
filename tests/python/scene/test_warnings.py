"""Messages where something is odd: keys that do nothing, words in the wrong place, ranks that were given different
things, file systems without locks, logs that a kill has cut. Nothing is left behind that stops the next run."""

import json

import pytest
from conftest import ROOT, launched

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=8", "--set", "basin.velocity.count=8"]
IDLE = "warning: basin.icm: is not used by this basin.method"
UNDAMPED = "warning: pendulum: has no damping"


TABLE = "basin={velocity: {min: -2, max: 2}, icm: {theta: 40, velocity: 40}}"


@pytest.mark.parametrize("setting, warning", [(TABLE, IDLE), ("basin.method=direct", ""), ("basin.method=icm", ""),
                                              ("pendulum={k: 0.01, damping: 0, m: 0.3}", UNDAMPED)])
def test_what_does_nothing_is_said(kapitza, tmp_path, setting, warning):
    said = kapitza("check", SMALL, "--set", setting, folder=tmp_path).stdout
    assert said.count("warning: ") == (warning != "") and warning in said


@pytest.mark.parametrize("words, said", [
    (["check", SMALL, "--set", "a.b", "=", "4"], "--set a.b = 4: is three words; write --set a.b=4"),
    (["check", SMALL, "--set", "a.b=", "4"], "--set a.b= 4: is two words; write --set a.b=4"),
    (["check", SMALL, "--set", "a.b", "=4"], "--set a.b =4: is two words; write --set a.b=4"),
    (["where", SMALL, "--set", "a.b", "=", "4", "3", "0"], "--set a.b = 4: is three words; write --set a.b=4"),
    (["run", SMALL, "--ranks=4"], "--ranks=4: unknown option; several ranks: mpirun -n 4 kapitza run SCENE"),
    (["help", "rum"], "rum: unknown command; did you mean run?"),
    (["plot", "basin", "a.h5", "--center", "inverted"], "--center: unknown option; did you mean --centre?"),
    (["plot", "basin", "a.h5", "--colors=b"], "--colors=b: unknown option; did you mean --colours?"),
    (["plot", "basin", "a.h5", "b.h5"], "b.h5: one argument too many; kapitza plot basin --help shows what it takes"),
    (["plot", "basin", "a.h5", "-o", "x.jpg"], "x.jpg: the name must end in .png, .svg or .pdf"),
    (["plot", "basin"], "plot basin: FILE is missing; kapitza plot basin FILE"),
    (["plot", ""], "plot: the name of FILE is empty; kapitza plot [KIND] FILE"),
    *((["plot", kind, ""], f"plot {kind}: the name of FILE is empty; kapitza plot {kind} FILE")
      for kind in ("basin", "film", "report", "vtkhdf")),
])
def test_a_wrong_command_line_is_told_what_to_write(kapitza, tmp_path, words, said):
    """In one line, with status 2; a library's list of options buried it."""
    done = kapitza(*words, folder=tmp_path, status=2)
    assert (done.stdout, done.stderr) == ("", f"kapitza: error: {said}\n") and not list(tmp_path.iterdir())


def test_help_is_a_command_too(kapitza):
    assert kapitza("help").stdout == kapitza("--help").stdout
    assert kapitza("help", "run").stdout == kapitza("run", "--help").stdout


@pytest.mark.parametrize("words", [["plot"], ["plot", "basin"], ["info"]])
def test_a_scene_in_place_of_a_result_is_told_the_way(kapitza, tmp_path, words):
    done = kapitza(*words, SMALL, folder=tmp_path, status=1)
    assert done.stderr == (f"kapitza: error: {SMALL}: is a scene, not a result; "
                           f"kapitza run {SMALL} makes its result small.h5\n")


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
