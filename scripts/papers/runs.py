"""Runs of the program that the numbers come from; each scene is run once."""

import json
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
FIVE = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.5}  # of Blackburn's Figs 8 to 15


class Runs:
    """`runs(scene, group)`: (variables, attributes) of a group of the result."""

    def __init__(self, program=ROOT / "build" / "kapitza"):
        self.program = program
        self.folder = tempfile.TemporaryDirectory(prefix="kapitza-numbers-")
        self.paths = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def path(self, scene):
        """The result file of a scene, which is a mapping or the name of one of scenes/."""
        key = scene if isinstance(scene, str) else json.dumps(scene)
        if key not in self.paths:
            path = Path(self.folder.name) / f"{len(self.paths)}.h5"
            source = ROOT / "scenes" / f"{scene}.yaml" if isinstance(scene, str) else "-"
            done = subprocess.run(
                [self.program, "run", source, "-o", path, "--progress", "never"], input=key, text=True,
                capture_output=True
            )
            if done.returncode != 0:
                raise RuntimeError(f"{key}: {done.stderr.strip()}")
            self.paths[key] = path
        return self.paths[key]

    def __call__(self, scene, group):
        with h5py.File(self.path(scene)) as file:
            return {name: _values(item) for name, item in file[group].items()}, dict(file[group].attrs)


def _values(item):
    return item.asstr()[:] if h5py.check_string_dtype(item.dtype) else item[()]


def curves(runs, first, last, count, names=(), subharmonics=(), **damping):
    """Transition curves over k from first to last."""
    chart = {"k": {"min": first, "max": last, "count": count}, "m": {"min": 0, "max": 1, "count": 2}, **damping}
    chart |= {key: list(words) for key, words in (("curves", names), ("subharmonics", subharmonics)) if words}
    return runs({"stability": chart}, "stability")


def at(values, k, name):
    """A curve at a value of its k axis."""
    row = int(np.argmin(np.abs(values["k"] - k)))
    if abs(values["k"][row] - k) > 1e-12:
        raise LookupError(f"{k} is not on the axis of {name}")
    return float(values[name][row])


def undamped(runs, names=(), subharmonics=()):
    """value(k, name) of curves without damping: from one chart, or where k is not on its axis from one of its own."""
    chart, _ = curves(runs, -2, 2, 4001, names, subharmonics)

    def value(k, name):
        try:
            return at(chart, k, name)
        except LookupError:
            return at(curves(runs, k, k + 1, 2, names, subharmonics)[0], k, name)

    return value


def cycle(runs, pendulum, theta, velocity, **more):
    """The closed orbit near a start."""
    start = {"theta": theta, "velocity": velocity}
    return runs({"pendulum": pendulum, "orbit": {"start": start, "closed": True, **more}}, "orbit")


def sweep(runs, pendulum, parameter, low, high, count, measure, **more):
    return runs(
        {"pendulum": pendulum, "sweep": {"parameter": parameter, "min": low, "max": high, "count": count,
                                         "measure": [measure], **more}},
        "sweep",
    )


def cosine(values, line):
    """The cosine part of a line of an orbit."""
    return float(values["line_amplitude"][line] * np.cos(values["line_phase"][line]))


def sine(values, line):
    """Its sine part."""
    return float(-values["line_amplitude"][line] * np.sin(values["line_phase"][line]))
