"""The explorer's server: its numbers held against runs of the program, what it refuses, what attacks do to it, what it
leaves behind."""

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import PROGRAM, ROOT, wait_for, with_extensive
from explorer_page import Server, children_of, words_of
from kapitza import Pendulum, manifolds
from kapitza.explorer.access import Access
from kapitza.result import Result

SMALL = ROOT / "scenes" / "small.yaml"
PENDULUM = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
WINDOW = {"theta": {"min": -3.0, "max": 2.5}, "velocity": {"min": -1.0, "max": 1.5}}
VIEW = {"window": WINDOW, "pendulum": PENDULUM | {"drive_amplitude": 0.35}, "rows": 40, "columns": 60}
FRAME = {"request": "frame", **VIEW}


@pytest.fixture(scope="module")
def server():
    running = Server(SMALL)
    yield running
    assert running.hint == "Each address serves one browser. Ctrl-C ends it."
    assert f"ssh -L {running.port}:127.0.0.1:{running.port} " in running.forward and running.end() == (0, "")


@pytest.fixture(scope="module")
def striped():
    """With the double of its engine."""
    running = Server(None, striped=True)
    yield running
    assert running.end() == (0, "")


def frame_of(answers):
    """Labels of the last frame, and the catalogue before it."""
    (catalogue, _), (header, payload) = answers[-2:] if len(answers) == 2 else (answers[0], answers[-1])
    return np.frombuffer(payload, np.uint8, header["rows"] * header["columns"]).reshape(header["rows"],
                                                                                        header["columns"]), catalogue


# ---- answers ----


def test_a_frame_has_the_labels_of_a_run_of_the_saved_scene(server, kapitza, tmp_path):
    labels, catalogue = frame_of(server.ask(FRAME))
    (tmp_path / "view.yaml").write_text(server.request("scene", VIEW)[1]["text"])
    scene = yaml.safe_load((tmp_path / "view.yaml").read_text())
    assert scene["pendulum"] == VIEW["pendulum"] and scene["basin"]["method"] == "exact"
    assert "max_periods" not in scene["basin"]
    kapitza("run", "view.yaml", folder=tmp_path)
    basin = Result(tmp_path / "view.h5").group("basin")
    decided = basin["evidence"].values != 3
    assert decided.mean() > 0.99 and np.array_equal(labels[decided], basin["attractor"].values[decided])
    assert all(re.fullmatch("#[0-9a-f]{6}", row["colour"]) for row in catalogue["attractors"])


def test_each_stream_says_its_catalogue_whoever_heard_it_before(server):
    first, second = server.ask(FRAME), server.ask(FRAME)
    assert [answers[0][0]["answer"] for answers in (first, second)] == ["catalogue", "catalogue"]
    assert second[0][0]["version"] == second[-1][0]["catalogue"]


def test_what_a_scene_leaves_out_stays_left_out(server):
    """With less damping orbits need more periods than the scene as it stands: no number of them is frozen."""
    pendulum = PENDULUM | {"quality_factor": 40}
    labels, _ = frame_of(server.ask(FRAME | {"pendulum": pendulum, "quality": "moving"}))
    assert np.mean(labels == 255) < 0.02
    text = server.request("scene", VIEW | {"pendulum": pendulum | {"quality_factor": 200}})[1]["text"]
    assert "max_periods" not in text and "quality_factor: 200" in text


@pytest.mark.parametrize("change", [{"pendulum": PENDULUM | {"drive_frequency": -1}},
                                    {"window": WINDOW | {"theta": {"min": 1, "max": 0}}},
                                    {"rows": 0}, {"planes": ["colour"]}])
def test_what_the_program_refuses_is_said_in_its_words_and_ends_nothing(server, change):
    answer = server.ask(FRAME | change)[-1][0]
    assert answer["answer"] == "error" and not re.match(r"-:|kapitza|/proc", answer["message"]), answer
    assert server.ask(FRAME)[-1][0]["answer"] == "frame" and len(server.children()) == 1


@pytest.mark.extensive
def test_set_changes_the_scene():
    running = Server(SMALL, "--set", "pendulum.drive_amplitude=0.4", "--set", "basin.method=exact", "--set",
                     "basin.theta={centre: 1, width: 1e-20}", "--set", "basin.velocity={centre: 0, width: 1e-20}")
    state = running.request("state", {})[1]
    assert running.end()[0] == 0
    assert state["pendulum"]["drive_amplitude"] == 0.4 and state["window"]["theta"] == {"centre": "1", "width": "1e-20"}


def test_a_newer_frame_ends_the_one_before_and_a_sudden_end_is_said(striped):
    slow = striped.answers(FRAME | {"pendulum": {"m": 7}, "levels": [8, 4, 2, 1]}, "slow")
    assert next(slow)[0]["answer"] == "catalogue"  # it is at work
    assert striped.ask(FRAME | {"pendulum": {"m": 1}}, "slow")[-1][0]["answer"] == "frame"
    assert list(slow)[-1][0]["answer"] == "ended"
    ended = striped.ask(FRAME | {"pendulum": {"m": 9}}, "slow")[-1][0]
    assert (ended["answer"], ended["message"]) == ("error", "the engine has ended")
    assert striped.ask(FRAME | {"pendulum": {"m": 1}}, "slow")[-1][0]["answer"] == "frame"
    assert striped.ask(FRAME | {"pendulum": {"m": 8}}, "slow")[-1][0]["message"] == "pendulum.m: must not be 8"


def test_an_engine_that_is_killed_in_the_middle_of_a_frame_is_replaced_and_the_frame_made(server):
    """Within 2 s where the machine is idle; the page is told."""
    whole = frame_of(server.ask(FRAME, "whole"))[0]
    answers = server.answers(FRAME | {"rows": 400, "columns": 600, "levels": [8, 4, 2, 1]}, "killed")
    assert next(answers)[0]["answer"] == "catalogue"
    for child in server.children():
        os.kill(child, signal.SIGKILL)
    later = list(answers)
    told = [header["restarted"] for header, _ in later if "restarted" in header]
    assert told == ["the engine has ended (SIGKILL)"] and later[-1][0]["level"] == 1 and later[-1][0]["final"]
    assert np.array_equal(frame_of(server.ask(FRAME, "whole"))[0], whole)


def test_a_program_that_does_not_hear_is_replaced(striped):
    deaf = striped.answers(FRAME | {"pendulum": {"m": 6}, "levels": [2, 1]}, "deaf")
    assert next(deaf)[0]["answer"] == "catalogue"
    assert striped.ask({"request": "cancel"}, "deaf")[-1][0]["answer"] == "ended"
    assert list(deaf)[-1][0]["answer"] == "ended"  # as if it had heard
    assert striped.ask(FRAME | {"pendulum": {"m": 1}}, "deaf")[-1][0]["answer"] == "frame"


def test_views_that_nobody_uses_make_room(striped):
    for name in range(9):
        striped.ask({"request": "catalogue"}, f"view-{name}")
    assert len(striped.children()) <= 6
    with striped.post("close", {"token": striped.token, "view": "view-8"}, X_Kapitza_Token=None) as answer:
        assert answer.status == 200
    assert len(striped.children()) <= 5


# ---- who may ask ----


@pytest.mark.parametrize("headers", [
    {"X_Kapitza_Token": None}, {"X_Kapitza_Token": "wrong"}, {"X_Kapitza_Token": "\u00e4"},
    {"Origin": "http://example.org"},
    {"Host": "example.org"}, {"Host": "localhost.example.org:80"}, {"Origin": "null"}, {"Origin": "http://127.0.0.1:1"},
])
def test_tokens_and_origins_that_are_not_the_pages_own_are_refused(striped, headers):
    assert striped.request("state", {}, **headers)[0] == 403


@pytest.mark.parametrize(("host", "origin", "known"), [
    ("127.0.0.1:8123", None, True), ("localhost:9000", "http://localhost:9000", True),
    ("[::1]:9000", "http://[::1]:9000", True),
    ("[::1]", None, True), ("localhost:9000", "http://localhost:9001", False),
    ("localhost:9000", "https://hub.example.org", True),
    ("hub.example.org", "https://hub.example.org", True), ("hub.example.org", "http://hub.example.org", False),
    ("hub.example.org:80", None, False), ("evil.org", "http://evil.org", False), ("localhost.evil.org:1", None, False),
    (None, None, False),
])
def test_hosts_and_origins(host, origin, known):
    assert Access(["https://hub.example.org/"]).knows(host, origin) == known


def test_an_address_serves_once(striped):
    once = striped.address().partition("once=")[2]
    assert striped.request("token", {"once": once}, X_Kapitza_Token=None)[0] == 200
    status, answer = striped.request("token", {"once": once}, X_Kapitza_Token=None)
    assert status == 403 and "has been used" in answer["error"]
    striped.process.stdout.readline()


def test_it_listens_on_loopback_alone(striped):
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", striped.port)).close()
    if socket.has_ipv6:
        with socket.create_connection(("::1", striped.port)) as other:
            other.sendall(b"GET / HTTP/1.1\r\nHost: [::1]:%d\r\n\r\n" % striped.port)
            assert other.recv(15) == b"HTTP/1.1 200 OK"


# ---- attacks ----


def raw(port, data):
    with socket.create_connection(("127.0.0.1", port)) as connection:
        with suppress(OSError):  # it may have been shut out before the end
            connection.sendall(data)
            connection.shutdown(socket.SHUT_WR)
            return connection.makefile("rb").read()
        return b""


def test_malformed_requests_are_answered_without_a_traceback(striped):
    """The fixture asserts that nothing was said on the terminal."""
    head = f"Host: 127.0.0.1:{striped.port}\r\nX-Kapitza-Token: {striped.token}\r\n".encode()
    deep = b"[" * 19000
    for data in (b"GET http://[x HTTP/1.1\r\n" + head + b"\r\n", b"GET /\xff HTTP/1.1\r\n\r\n", b"nonsense\r\n\r\n",
                 b"\0" * 100, b"", b"POST /state HTTP/1.1\r\n" + head + b"Content-Length: \xc2\xb2\r\n\r\n{}",
                 b"POST /state HTTP/1.1\r\n" + head + b"Content-Length: " + b"9" * 5000 + b"\r\n\r\n{}",
                 b"POST /state HTTP/1.1\r\n" + head + b"Content-Length: -1\r\n\r\n{}",
                 b"POST /state HTTP/1.1\r\n" + head + b"Content-Length: 19000\r\n\r\n" + deep,
                 b"POST /state HTTP/1.1\r\n" + head + b"\r\n{}",
                 b"POST /token HTTP/1.1\r\n" + head + b"Content-Length: 13\r\n\r\n{\"once\": 1.5}",
                 b"POST /ask?view= HTTP/1.1\r\n" + head + b"Content-Length: 9\r\n\r\n[\"frame\"]",
                 b"GET " + b"/x" * 40000 + b" HTTP/1.1\r\n\r\n"):
        assert b"Traceback" not in raw(striped.port, data)
    for body in (b"x" * 65_537, b"{", b"[]", b'{"a": NaN'):
        assert striped.request("scene", body)[0] == 400
    assert striped.request("nothing", {})[0] == 404 and striped.request("ask", {})[0] == 404
    for window in ({}, [], {"theta": 1, "velocity": 2}, {"theta": {"min": 0}, "velocity": {}}):
        assert striped.request("scene", VIEW | {"window": window})[0] == 400
    assert striped.request("state", {})[0] == 200


def test_strangers_cannot_lock_the_owner_out(striped):
    """More idle connections than are kept: those without a token make room, and processor time is not burnt on them."""
    strangers = [socket.create_connection(("127.0.0.1", striped.port)) for _ in range(400)]
    before = processor_time(striped.process.pid)
    assert striped.request("state", {})[0] == 200
    time.sleep(0.5)
    assert striped.request("state", {})[0] == 200
    assert processor_time(striped.process.pid) - before < 0.4
    for stranger in strangers:
        stranger.close()


def processor_time(process):
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.extensive
def test_few_descriptors_are_an_answer_not_a_traceback(tmp_path):
    limit = tmp_path / "limited"
    limit.write_text(f'#!/bin/sh\nulimit -n 40\nexec "{PROGRAM}" "$@"\n')
    limit.chmod(0o755)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("explorer_page.PROGRAM", limit)
        running = Server(SMALL)
    strangers = [socket.create_connection(("127.0.0.1", running.port)) for _ in range(60)]
    for name in range(8):
        try:
            assert running.request(f"ask?view={name}", {"request": "quit"})[0] in (200, 400)
        except (OSError, ValueError):
            pass  # turned away, or several answers
    assert wait_for(lambda: answers(running))
    _ = [stranger.close() for stranger in strangers]
    assert running.end() == (0, "")


def answers(running):
    try:
        return running.request("state", {})[0] == 200
    except OSError:
        return False


# ---- what stays behind ----


@pytest.mark.parametrize("number", with_extensive([signal.SIGTERM], [signal.SIGKILL]))
def test_it_leaves_no_process_and_no_file_behind(tmp_path, number):
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    running = Server(SMALL, environment=environment)
    slow = FRAME | {"rows": 2000, "columns": 2000, "pendulum": PENDULUM | {"quality_factor": 150}}
    asked = threading.Thread(target=lambda: attempt(running.ask, slow))
    asked.start()
    assert wait_for(running.children)
    computing = running.children()
    running.process.send_signal(number)
    running.process.communicate()
    asked.join()
    assert wait_for(lambda: not any(parent(process) for process in computing))
    assert not list(tmp_path.iterdir())


def test_what_is_computed_in_the_background_ends_with_a_server_that_is_killed(tmp_path):
    """The run of a map went on, as a child of process 1. Here it is one that would not end by itself."""
    (tmp_path / "endless").write_text("#!/bin/sh\nexec sleep 3000\n")
    (tmp_path / "endless").chmod(0o755)
    script = ("import sys; from kapitza.explorer.run_cache import RunCache; "
              "list(RunCache(sys.argv[1], folder=sys.argv[2]).answers({}, None))")
    owner = subprocess.Popen([sys.executable, "-c", script, tmp_path / "endless", tmp_path])
    assert wait_for(lambda: any(b"sleep" in words_of(process) for process in children_of(owner.pid)))
    (computing,) = children_of(owner.pid)
    owner.kill()
    owner.wait()
    try:
        assert wait_for(lambda: not parent(computing))
    finally:
        with suppress(ProcessLookupError):
            os.kill(computing, signal.SIGKILL)


def parent(process):
    """Whether the process is at work."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def attempt(call, *arguments):
    """The server may go before it answers."""
    with suppress(OSError, ValueError):
        call(*arguments)


# ---- what it is opened with ----


@pytest.mark.extensive
def test_a_result_opens_with_what_lies_over_its_basins(model):
    window = {"velocity": {"min": -2, "max": 2}}
    result = model(PENDULUM, basin={"theta": {"count": 8}, "velocity": window["velocity"] | {"count": 8},
                                    "method": "direct"},
                   saddles=window)
    result = result.add("manifolds", manifolds(Pendulum({"pendulum": PENDULUM}), result.group("saddles"), length=1))
    running = Server(result.path)
    state, text = running.request("state", {})[1], running.request("scene", VIEW)[1]["text"]
    assert running.end()[0] == 0
    saddles, curves = result.group("saddles"), result.group("manifolds")
    assert state["pendulum"]["quality_factor"] == 5 and "max_periods" not in text
    assert state["overlays"]["saddles"]["points"] == np.column_stack([saddles["strobe_theta"],
                                                                      saddles["strobe_velocity"]]).tolist()
    lines = state["overlays"]["manifolds"]["lines"]
    assert len(lines) >= 16 and lines[0][0] == [curves["theta"].values[0], curves["velocity"].values[0]]
    assert all(np.abs(np.diff(line, axis=0)[:, 0]).max() < np.pi for line in lines)  # cut where the angle wraps


@pytest.mark.parametrize(("arguments", "message"), with_extensive(
    [(["nothing.yaml"], "nothing.yaml: cannot be opened"), ([SMALL, "--port", "80"], "is not a port"),
     ([], "view: SCENE is missing")],
    [([SMALL, "--port", "8\u00b2"], "is not a port"), ([SMALL, "--set", "pendulum.m=x"], "pendulum.m"),
     ([ROOT / "README.md"], "README.md"),
     ([SMALL, "--origin", "hub.example.org"], "--origin: hub.example.org is not an origin")]))
def test_what_cannot_be_opened_is_one_line(arguments, message):
    done = subprocess.run([PROGRAM, "view", *arguments, "--no-browser"], capture_output=True, text=True)
    assert done.returncode == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr


@pytest.mark.parametrize("python", ["/nonexistent/python", "bare"])
def test_without_python_or_its_packages_one_line_says_what_to_set(python, tmp_path):
    if python == "bare":
        python = tmp_path / "python"
        python.write_text('#!/bin/sh\nexec "$REAL_PYTHON" -S "$@"\n')
        python.chmod(0o755)
    environment = os.environ | {"KAPITZA_PYTHON": str(python), "REAL_PYTHON": os.path.realpath(shutil.which("python3"))}
    done = subprocess.run([PROGRAM, "view", SMALL], env=environment, capture_output=True, text=True)
    assert done.returncode == 1 and "KAPITZA_PYTHON" in done.stderr and len(done.stderr.splitlines()) == 1


def test_an_output_that_is_full_is_an_answer_not_a_traceback():
    with open("/dev/full", "w") as full:
        done = subprocess.run([PROGRAM, "view", SMALL, "--no-browser"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1 and done.stderr.startswith("kapitza: error: view: No space left"), done.stderr
