"""The model of many ranks (benchmarks/scaling.py): cases with a known answer, and the rules that it shares with
src/parallel."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import scaling_model  # noqa: E402
from scaling import Run, predictions  # noqa: E402
from scaling_model import Costs, Stage, delivered  # noqa: E402

FREE = Costs(0, 0, 0)


def test_constants_are_those_of_the_program():
    text = (ROOT / "src" / "parallel" / "schedule.c").read_text()
    numbers = re.search(r"BATCH_SECONDS = ([\d.e-]+), SECONDS_A_RANK = ([\d.e-]+)", text)
    assert tuple(map(float, numbers.groups())) == (scaling_model.BATCH_SECONDS, scaling_model.SECONDS_A_RANK)


@pytest.mark.parametrize("ranks", [1, 2, 7, 40])
def test_the_model_of_ranks_has_known_answers(ranks):
    """Free messages: equal tiles, as many for each; one tile longer than all others; every tile is done once."""
    even = Stage([0.5] * (ranks * 6), ranks, FREE)
    assert even.end == pytest.approx(3) and even.idle() == pytest.approx(0)
    uneven = Stage([0.01] * 50 + [9.0] + [0.01] * 50, ranks, FREE)
    assert 9 <= uneven.end <= 9 + 1.01 and sorted(sum((rank.tiles for rank in uneven.workers), [])) == list(range(101))
    assert Stage([1.0], ranks, FREE).end == 1  # one tile: the others have nothing to do


def test_nobody_waits_for_a_slow_rank():
    """Near the end it gets no more tiles: seven others do the last ones in less time than it needs for one."""
    stage = Stage([0.05] * 730, 8, FREE, slower=10)
    assert stage.end == pytest.approx(730 * 0.05 / 7.1, rel=0.03) and stage.idle() < 0.03


def test_whole_commands_follow_amdahl():
    """One second alone, ten shared, and a writer who takes a tenth of a second for each of ten messages."""
    run = Run(100, [("cells 1", [0.1] * 100)], 1.0)
    assert [row[1] for row in predictions(run, [1, 2, 10], FREE)] == pytest.approx([11, 6, 2])
    workers = Stage([1.0] * 10, 10, FREE).workers
    assert delivered(workers, [0.0] * 10, 0.1) == pytest.approx(1)
    assert delivered(workers, [5.0] * 10, 0.1) == pytest.approx(6)


@pytest.mark.extensive
def test_a_log_is_read(kapitza, tmp_path):
    """The seconds of the stages are those of the log, which the program itself wrote."""
    kapitza("run", ROOT / "scenes" / "small.yaml", "--log", "log.jsonl", folder=tmp_path)
    run = Run.read(tmp_path / "log.jsonl")
    assert run.cells == 10_000 and run.take > 0 and [name for name, _ in run.stages][-1] == "file"
    done = subprocess.run([sys.executable, ROOT / "benchmarks" / "scaling.py", "load", tmp_path / "log.jsonl"],
                          capture_output=True, text=True)
    assert list(map(float, done.stdout.split())) == pytest.approx(dict(run.stages)["cells 1"], abs=1e-6)
