"""A client of `kapitza serve` for the tests: requests out, answers in."""

import json
import subprocess

import numpy as np
from conftest import PROGRAM

OFFSET = {1: 0, 2: 1, 4: 1, 8: 5}
TYPES = {"labels": np.uint8, "settling_time": np.dtype("<f4"), "smooth_time": np.dtype("<f4"), "doubt": np.uint8,
         "other": np.uint8, "turns": np.dtype("<f4")}


class Server:
    """A running program; `with` ends it."""

    def __init__(self, scene, *arguments, folder=None, memory=None):
        """memory: bytes of address space that the program may use."""
        command = [PROGRAM, "serve", scene, *arguments]
        limited = ["prlimit", f"--as={memory}"] if memory else []
        self.process = subprocess.Popen([*limited, *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder)
        self.ready, _ = self.receive()
        self.sequence = 0
        self.catalogues = {}  # attractors by version

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.stdout.close()
        assert self.process.wait() == 0

    def send(self, text):
        self.process.stdin.write(text.encode() + b"\n")
        self.process.stdin.flush()

    def receive(self):
        """The next answer: header and payload."""
        header = json.loads(self.process.stdout.readline())
        if header["answer"] == "catalogue":
            self.catalogues[header["version"]] = header["attractors"]
        return header, self.process.stdout.read(header["bytes"])

    def post(self, request, **keys):
        self.sequence += 1
        self.send(json.dumps({"request": request, "sequence": self.sequence, **keys}))
        return self.sequence

    def ask(self, request, **keys):
        """All answers to one request."""
        sequence, answers = self.post(request, **keys), []
        while not answers or not answers[-1][0]["final"]:
            answers.append(self.receive())
            assert answers[-1][0]["sequence"] == sequence
        return answers

    def frame(self, rows, columns, planes=("labels",), **keys):
        """The catalogue, if it came, and the planes of each level."""
        answers = self.ask("frame", rows=rows, columns=columns, planes=list(planes), **keys)
        catalogue = [header for header, _ in answers if header["answer"] == "catalogue"]
        return (catalogue[-1] if catalogue else None), [(header, split(*answer)) for answer in answers
                                                        if (header := answer[0])["answer"] == "frame"]


def split(header, payload):
    """The planes of a frame by name, [row, column]."""
    planes, at = {}, 0
    for name in header["planes"]:
        kind = np.dtype(TYPES[name])
        count = header["rows"] * header["columns"]
        planes[name] = np.frombuffer(payload, kind, count, at).reshape(header["rows"], header["columns"])
        at += count * kind.itemsize
    assert at == header["bytes"]
    return planes


def places(level, count):
    """Rows or columns of a frame that a level shows."""
    return np.minimum(level * np.arange(-(-count // level)) + OFFSET[level], count - 1)
