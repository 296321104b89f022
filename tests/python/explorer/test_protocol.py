"""The protocol of the command serve: every line is answered, newer requests end older ones, ends and errors are
answers."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, wait_for
from serving import Server

FIG12 = ROOT / "scenes" / "blackburn-fig12.yaml"


@pytest.fixture(scope="module")
def server():
    with Server(FIG12) as running:
        yield running


def test_a_newer_frame_ends_an_older_one_of_its_view(server):
    first = server.post("frame", rows=2000, columns=2000, view="a")
    second = server.post("frame", rows=10, columns=10, view="b", quality="moving")
    third = server.post("frame", rows=10, columns=10, view="a", quality="moving")
    last = {}
    while len(last) < 3:
        header, _ = server.receive()
        if header["final"]:
            last[header["sequence"]] = header["answer"]
    assert last == {first: "ended", second: "frame", third: "frame"}


def test_a_frame_is_cancelled(server):
    first = server.post("frame", rows=2000, columns=2000)
    server.post("cancel")
    answers = {header["sequence"]: header["answer"] for header in (server.receive()[0] for _ in range(2))}
    assert answers == {first: "ended", first + 1: "ended"}


@pytest.mark.parametrize(("line", "words"), [
    ("nonsense {", "is not JSON: null expected at byte 2"),
    ("", "is not JSON"),
    ("[1, 2]", "is not a JSON object"),
    ('{"request": "cancel"} # why', "is not JSON: unexpected character at byte 23"),
    ("{'request': 'cancel'}", "is not JSON: unexpected character at byte 2"),
    ('{"request": "cancel", "view": "a\tb"}', "is not JSON: unexpected character at byte 33"),
    ("{" * 200, "is not JSON"),
    ('{"request": "fame' + "\u20ac" * 30 + '"}', "is unknown"),
    ("{}", "request: is missing; it must be one of frame, where"),
    ('{"request": "where", "theta": 1' + "0" * 40 + ', "velocity": 0}',
     "is not a finite decimal number; it must be a number"),
    ('{"request": "orbit", "theta": 1, "velocity": 0, "periods": 100000, "samples_per_period": 4096}',
     "more than 16777216 samples"),
    ('{"request": "fame"}', '"fame" is unknown; it must be one of frame, where'),
    ('{"request": "frame", "columns": 10}', "rows: is missing"),
    ('{"request": "motions", "x": 1, "y": 1}', "atlas: is missing"),
    ('{"request": "motions", "atlas": "none.h5", "x": 1}', "y: is missing"),
    ('{"request": "motions", "atlas": "none.h5", "x": 1, "y": 2}', "none.h5: cannot be opened"),
    ('{"request": "motions", "atlas": "README.md", "x": 1, "y": 2, "z": 3}', "z: unknown key"),
    ('{"request": "line", "atlas": "none.h5", "x": 1, "y": 2}', "a line has x or y, not both"),
    ('{"request": "frame", "rows": 8192, "columns": 8192}', "more than 16777216 cells"),
    ('{"request": "frame", "rows": 10, "columns": 10, "levels": [1, 8]}', "falling order"),
    ('{"request": "frame", "rows": 10, "columns": 10, "level": 8}', "level: unknown key"),
    ('{"request": "frame", "rows": 10, "columns": 10, "pendulum": {"k": 0.1, "m": 0.3}}',
     "pendulum.damping: is missing"),
    ('{"request": "frame", "rows": 10, "columns": 10, "window": {"velocity": {"min": 2, "max": 1}}}',
     "basin.velocity.max"),
    ('{"request": "where", "theta": "x", "velocity": 1}', 'theta: "x" is not'),
    ('{"request": "orbit", "theta": 1}', "orbit.start.velocity: is missing"),
    ('{"request": "quit", "why": 1}', "why: unknown key"),
    ("x" * 70000, "more than 65536 bytes"),
])
def test_what_is_wrong_is_answered(server, line, words):
    server.send(line)
    header, _ = server.receive()
    assert header["answer"] == "error" and header["status"] == 2 and words in header["message"]
    assert "\n" not in header["message"] and not header["message"].startswith("-:")
    assert server.ask("cancel")[0][0]["answer"] == "ended"


@pytest.mark.parametrize(("keys", "words"), [
    ({"theta": "\U0001f600", "velocity": 0}, "is not a finite decimal number; it must be a number"),
    ({"theta": 1, "velocity": 0, "x" * 2000: 1}, "unknown key"),
    ({"theta": 1, "velocity": json.loads("[" * 17 + "]" * 17)}, "is a list; it must be a number"),
    ({"theta": 1, "velocity": "\0"}, "holds a line break or a control character"),
    ({"theta": 1, "velocity": float("nan")}, "\"NaN\" is not a finite decimal number"),
    ({"theta": 1, "velocity": 0, "view": "\ud83d"}, "sequence"),
])
def test_an_error_has_the_sequence_of_its_request(server, keys, words):
    """Emoji are two escapes of a surrogate pair in what json.dumps writes."""
    header, _ = server.ask("where", **keys)[-1]
    assert words in (header["message"] if header["answer"] == "error" else header)


def test_an_orbit_is_cancelled_at_once():
    """Amid minutes of transients, also between two parts of a frame, which goes on."""
    with Server(FIG12) as server:
        for frames in (0, 1):
            frame = [server.post("frame", rows=300, columns=400, view="a", quality="moving") for _ in range(frames)]
            orbits = [server.post("orbit", theta=1, velocity=speed, view="b", transient=10_000_000)
                      for speed in (0.1, 1e3, 0.2)]
            cancel = server.post("cancel", view="b")
            ended = {}
            while len(ended) < 4:
                header, _ = server.receive()
                if header["sequence"] in (cancel, *orbits):
                    ended[header["sequence"]] = header["answer"]
            assert ended == dict.fromkeys((cancel, *orbits), "ended")
            while frame:
                header, _ = server.receive()
                if header["final"]:
                    frame.remove(header["sequence"])


@pytest.mark.extensive
def test_a_thousand_requests_wait_at_most():
    """While a frame is made, each of the others waits in a view of its own: the oldest are ended."""
    with Server(FIG12) as server:
        server.post("frame", rows=2000, columns=2000, levels=[8, 1], view="first")
        while server.receive()[0]["answer"] != "frame":
            pass
        others = [server.post("frame", rows=10, columns=10, view=str(i)) for i in range(1100)]
        ended = [server.receive()[0] for _ in range(100)]
        assert [(header["answer"], header["sequence"]) for header in ended] == [("ended", sequence)
                                                                                for sequence in others[:100]]
        server.post("quit")


@pytest.mark.parametrize("behind", [False, True])
def test_quit_answers_everything(behind):
    """Requests that are at work, that wait, and that stand behind it in the input."""
    with Server(FIG12) as server:
        lines = [{"request": "frame", "rows": 4000, "columns": 4000, "view": str(i), "sequence": i} for i in range(3)]
        lines += [{"request": "orbit", "theta": 1, "velocity": 0, "transient": 10_000_000, "sequence": i}
                  for i in (3, 4)]
        lines.insert(0 if behind else 5, {"request": "quit", "sequence": 5})
        server.send("\n".join(map(json.dumps, lines)))
        answers = [server.receive()[0] for _ in range(6)]
        assert {header["sequence"]: (header["answer"], header["final"])
                for header in answers} == {i: ("ended", True) for i in range(6)}
        assert answers[-1]["sequence"] == 5 and server.process.wait() == 0


def test_a_scene_that_is_wrong_ends_it(tmp_path):
    (tmp_path / "bad.yaml").write_text("pendulum: {k: 0.1, damping: 0.1}\nbasin: {velocity: {min: -1, max: 1}}\n")
    done = subprocess.run([PROGRAM, "serve", tmp_path / "bad.yaml"], check=False, capture_output=True, text=True,
                          input="")
    assert done.returncode == 2 and done.stdout == "" and "pendulum.m: is missing" in done.stderr


def test_the_end_of_the_input_ends_no_request():
    """The last line, of two frames of different views, has no newline."""
    frame = {"request": "frame", "rows": 60, "columns": 60, "quality": "moving"}
    lines = [json.dumps({**frame, "sequence": i, "view": str(i)}) for i in (1, 2)]
    done = subprocess.run([PROGRAM, "serve", FIG12], input="\n".join(lines).encode(), capture_output=True, check=True)
    headers = [json.loads(line) for line in re.findall(rb'^.*({ "answer": "frame".* })$', done.stdout, re.MULTILINE)]
    assert [(header["sequence"], header["final"]) for header in headers] == [(1, True), (2, True)]


def test_it_ends_with_its_parent():
    """Amid a frame of many seconds."""
    script = f"""
import subprocess, time
server = subprocess.Popen([{str(PROGRAM)!r}, "serve", {str(FIG12)!r}], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
server.stdin.write(b'{{"request": "frame", "rows": 4000, "columns": 4000}}\\n')
server.stdin.flush()
print(server.pid, flush=True)
time.sleep(100)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as parent:
        stat = Path(f"/proc/{int(parent.stdout.readline())}/stat")
        assert state_of(stat) in "RSD"
        parent.kill()
    assert wait_for(lambda: state_of(stat) in "ZX")


def state_of(stat):
    """The state of a process; X once it has gone."""
    try:
        return stat.read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return "X"
