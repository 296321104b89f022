"""An engine of the explorer for the tests: requests as a page sends them, and their answers."""

from pathlib import Path

import numpy as np
from kapitza.explorer.requests import Engine, packed
from kapitza.explorer.scene import Start
from kapitza.explorer.worker import plain_error

OFFSET = {1: 0, 2: 1, 4: 1, 8: 5}
TYPES = {"labels": np.uint8, "settling_time": np.dtype("<f4"), "smooth_time": np.dtype("<f4"), "doubt": np.uint8,
         "other": np.uint8, "turns": np.dtype("<f4")}


class Server:
    """An engine in this process."""

    def __init__(self, scene, *options):
        """options: --set KEY=VALUE ..."""
        start = Start(Path(scene), sets=options[1::2])
        self.engine, self.pendulum = Engine(*start.engine()), start.pendulum()
        self.catalogues = {}  # attractors by version

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def ask(self, request, between=lambda: True, **keys):
        """All answers to one request: header and payload."""
        answers = []

        def show(header, planes):
            if header["answer"] == "catalogue":
                self.catalogues[header["version"]] = header["attractors"]
            payload = b"".join(packed(planes))
            answers.append((header | {"bytes": len(payload)}, payload))

        try:
            if not self.engine.answers({"request": request, **keys}, show, between):
                show({"answer": "ended", "final": True}, ())
        except Exception as error:
            show(plain_error(error), ())
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
