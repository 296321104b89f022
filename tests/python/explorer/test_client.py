"""The client of `kapitza serve` in Python: threads, Ctrl-C, time limits and forked processes."""

import os
import signal
import threading

import kapitza
import numpy as np
import pytest
from conftest import ROOT, wait_for
from kapitza.client import Client, Ended
from kapitza.program import command

SMALL = ROOT / "scenes" / "small.yaml"
FAST = {"pendulum.drive_amplitude": 0.3}


@pytest.fixture
def engine():
    with kapitza.Engine(SMALL, FAST) as running:
        yield running


def interrupt(_number, _frame):
    raise KeyboardInterrupt


def test_ctrl_c_ends_a_request_and_not_the_engine(engine):
    """The next requests get their own answers, those of the cancelled ones are passed over."""
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for ask in (lambda: engine.frame(None, (3000, 3000)),
                    lambda: engine.orbit(1, 0, 4000, samples_per_period=4000)):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(KeyboardInterrupt):
                ask()
            assert engine.frame(None, (3, 5), quality="moving").shape == (3, 5)
            assert engine.where(3.1, 0)["name"] == "inverted"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_threads_share_an_engine(engine):
    """Frames of different threads end none of each other."""
    shapes, found = [(rows, 30) for rows in range(20, 28)], {}

    def ask(shape):
        found[shape] = engine.frame((-3, 3, -1, 1), shape).shape, engine.where(3.1,
                                                                               0)["name"], len(engine.orbit(1, 0, 2))

    threads = [threading.Thread(target=ask, args=[shape], daemon=True) for shape in shapes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {shape: (shape, "inverted", 129) for shape in shapes}


def test_a_request_has_a_time_limit():
    with kapitza.Engine(SMALL, FAST, timeout=0.3) as engine:
        with pytest.raises(TimeoutError, match="no answer from the program after 0.3 s"):
            engine.orbit(1, 0, 4000, samples_per_period=4000)


def test_what_is_refused_is_told_in_the_programs_words(engine):
    """The program's own refusals are in test_protocol.py."""
    with pytest.raises(kapitza.SceneError, match=r"pendulum\.k"):
        engine.where(1, 0, pendulum={"k": np.zeros([1] * 17), "damping": 0.1, "m": 0.3})
    assert engine.where(3.1, 0)["name"] == "inverted"


def test_the_end_of_the_process_ends_every_request(engine):
    """It is killed amid a frame: the thread that waits is woken, and so is who asks later."""
    ends = []

    def ask():
        try:
            engine.frame(None, (4000, 4000))
        except RuntimeError as error:
            ends.append(str(error))

    thread = threading.Thread(target=ask, daemon=True)
    thread.start()
    wait_for(lambda: engine._client._waiting)  # the frame has been asked for
    os.kill(engine._client._process.pid, signal.SIGKILL)
    thread.join()
    assert ends
    with pytest.raises(RuntimeError):
        engine.where(1, 0)


def test_refusals_keep_the_programs_line():
    """Whichever of the program's two streams ends first."""
    for _ in range(8):
        with pytest.raises(kapitza.SceneError, match=r"pendulum\.damping: is missing"):
            kapitza.Engine("pendulum: {k: 1, m: 1}\nbasin: {velocity: {min: -1, max: 1}}\n")


def test_a_program_that_is_none_is_told(tmp_path):
    (tmp_path / "program").write_text("#!/bin/sh\necho nonsense\necho 'kapitza: error: out of order' >&2\nsleep 100\n")
    (tmp_path / "program").chmod(0o755)
    with pytest.raises(Ended, match="out of order"):
        Client([str(tmp_path / "program")])


def test_the_launcher_beside_the_program_is_taken(tmp_path, monkeypatch):
    """It is of the program's own MPI, as in an environment of pip. Another one that a variable names is taken with a
    warning."""
    for name in ("kapitza", "mpiexec", "other"):
        (tmp_path / name).touch(0o755)
    monkeypatch.setenv("KAPITZA", str(tmp_path / "kapitza"))
    monkeypatch.delenv("KAPITZA_MPIRUN", raising=False)
    assert command(["check"], ranks=2) == [str(tmp_path / "mpiexec"), "-n", "2", str(tmp_path / "kapitza"), "check"]
    monkeypatch.setenv("KAPITZA_MPIRUN", str(tmp_path / "other"))
    with pytest.warns(UserWarning, match="the launcher of this program's own MPI is .*mpiexec"):
        assert command(["check"], ranks=2)[0] == str(tmp_path / "other")
    monkeypatch.setenv("KAPITZA_MPIRUN", str(tmp_path / "mpiexec"))
    assert command(["check"], ranks=2)[0] == str(tmp_path / "mpiexec")
    (tmp_path / "mpiexec").unlink()
    monkeypatch.setenv("KAPITZA_MPIRUN", "srun")
    assert command(["check"], ranks=2)[0] == "srun"


def test_a_forked_process_leaves_its_parents_results_and_engine(engine):
    result = kapitza.run(SMALL, set={"basin.theta.count": 8, "basin.velocity.count": 8}, progress=False)
    if (child := os.fork()) == 0:
        try:
            engine.close()
            with pytest.raises(RuntimeError, match="belongs to the process"):
                engine.where(3.1, 0)
        finally:
            import atexit
            atexit._run_exitfuncs()
            os._exit(0)
    os.waitpid(child, 0)
    assert result.path.exists() and engine.where(3.1, 0)["name"] == "inverted"
