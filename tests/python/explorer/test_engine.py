"""Engines: in this process, shared by threads, ended by Ctrl-C; and in processes of their own, whose frames newer ones
end."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import kapitza
import numpy as np
import pytest
from conftest import ROOT, wait_for
from kapitza.explorer.process import Refused, Views
from kapitza.explorer.scene import Start

SMALL = ROOT / "scenes" / "small.yaml"
FAST = {"pendulum.drive_amplitude": 0.3}
FRAME = {"request": "frame", "rows": 10, "columns": 10, "quality": "moving"}
SLOW = {"request": "frame", "rows": 2000, "columns": 2000}


@pytest.fixture
def engine():
    return kapitza.Engine(SMALL, FAST)


def interrupt(_number, _frame):
    raise KeyboardInterrupt


def test_ctrl_c_ends_a_call_and_not_the_engine(engine):
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for ask in (lambda: engine.frame(None, (3000, 3000)),
                    lambda: engine.orbit(1, 0, 100_000, samples_per_period=400)):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(KeyboardInterrupt):
                ask()
            assert engine.frame(None, (3, 5), quality="moving").shape == (3, 5)
            assert engine.where(3.1, 0)["name"] == "inverted"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_threads_share_an_engine(engine):
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


def test_what_is_refused_is_told(engine):
    with pytest.raises(kapitza.SceneError, match=r"nested too deeply"):
        engine.where(1, 0, pendulum={"k": np.zeros([1] * 17), "damping": 0.1, "m": 0.3})
    assert engine.where(3.1, 0)["name"] == "inverted"
    with pytest.raises(kapitza.SceneError, match=r"line 1, column 11: pendulum\.damping: is missing") as caught:
        kapitza.Engine("pendulum: {k: 1, m: 1}\nbasin: {velocity: {min: -1, max: 1}}\n")
    assert caught.value.key == "pendulum.damping"


# ---- in processes of their own ----


@pytest.fixture(scope="module")
def views():
    running = Views(Start(ROOT / "scenes" / "blackburn-fig12.yaml").engine(), lambda: lambda catalogue: None)
    yield running
    running.close()


def last(answers):
    return list(answers)[-1][0]


def begun(answers):
    """The answers of a request that is at work, from its second on."""
    assert next(answers)[0]["answer"] == "catalogue"
    return answers


def test_a_newer_frame_ends_an_older_one_of_its_view_alone(views):
    slow = {name: begun(views.answers(name, SLOW | {"levels": [8, 1]})) for name in "ab"}
    assert last(views.answers("a", FRAME))["answer"] == "frame" and last(slow["a"])["answer"] == "ended"
    assert next(slow["b"])[0]["level"] == 8 and last(views.answers("b", {"request": "cancel"}))["answer"] == "ended"
    assert last(slow["b"])["answer"] == "ended"


def test_starts_and_orbits_are_answered_between_the_parts_of_a_frame(views):
    slow = begun(views.answers("a", SLOW | {"levels": [8, 1]}))
    assert last(views.answers("a", {"request": "where", "theta": 3.1, "velocity": 0}))["name"] == "inverted"
    header, payload = list(views.answers("a", {"request": "orbit", "theta": 1, "velocity": 0, "periods": 2}))[-1]
    assert np.frombuffer(payload).reshape(2, header["samples"])[:, 0].tolist() == [1, 0]
    slow.close()  # nobody reads on
    assert last(views.answers("a", FRAME))["answer"] == "frame"


def test_a_view_that_is_closed_ends_its_process(views):
    slow = begun(views.answers("c", SLOW | {"levels": [8, 1]}))
    process = views.view("c")._process
    views.close("c")
    assert last(slow)["answer"] == "ended" and not process.is_alive()


def test_a_scene_that_is_wrong_is_refused(tmp_path):
    (tmp_path / "bad.yaml").write_text("pendulum: {k: 0.1, damping: 0.1}\nbasin: {velocity: {min: -1, max: 1}}\n")
    with pytest.raises(Refused, match=r"bad.yaml:1:11: pendulum.m: is missing"):
        Views(Start(tmp_path / "bad.yaml").engine(), dict).view("a")


def test_an_engine_ends_with_its_server():
    """Amid a frame of many seconds."""
    script = f"""
import time
from kapitza.explorer.process import Views
from kapitza.explorer.scene import Start
if __name__ == "__main__":
    views = Views(Start({str(SMALL)!r}).engine(), lambda: lambda catalogue: None)
    answers = views.answers("a", {SLOW!r})
    next(answers)
    print(views.view("a")._process.pid, flush=True)
    time.sleep(100)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as parent:
        stat = Path(f"/proc/{int(parent.stdout.readline())}/stat")
        assert state_of(stat) in "RSD"
        os.kill(parent.pid, signal.SIGKILL)
    assert wait_for(lambda: state_of(stat) in "ZX")


def state_of(stat):
    """The state of a process; X once it has gone."""
    try:
        return stat.read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return "X"
