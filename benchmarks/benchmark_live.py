"""Frames of an engine of the library on one core: processor time of its process.

A loop of known arithmetic spins between the frames: on a machine that others load, processor time is longer too, and
the yardstick tells by how much it varied. Ratios of whole commands against another build are taken in turns
(--base)."""

import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from kapitza.explorer import process, requests
from kapitza.explorer.scene import Start

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "build" / "kapitza"
SCENE = ROOT / "scenes" / "blackburn-fig12.yaml"
ZOOM = {"theta": {"min": 1.05, "max": 1.065}, "velocity": {"min": 0.44, "max": 0.45}}
BLACKBURN = {"quality_factor": 5, "drive_frequency": 11}
# name: pendulum, key that moves, first and last value
SLIDERS = {
    "slider-fig12": (BLACKBURN, "drive_amplitude", 0.30, 0.31),
    "slider-k01": ({"k": 0.1, "damping": 0.1}, "m", 0.40, 0.41),
    "slider-eps046": (BLACKBURN, "drive_amplitude", 0.46, 0.47),
}
# The plane of the explorer's map for Fig. 12; its point goes along a line that crosses curves, or around a circle.
PLANE = {"x": {"parameter": "drive_frequency", "min": 3.1, "max": 30},
         "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.75}, "max_period": 4, "checks": 0}
WAYS = {
    "map-fig12": lambda share: (11 + share, 0.30 + 0.02 * share),
    "map-fig12-circle": lambda share: (11.5 - 0.5 * math.cos(2 * math.pi * share),
                                       0.31 - 0.01 * math.sin(2 * math.pi * share)),
}
# Q of weakly damped pendulums, whose first picture is made by a new program
WEAK = [20, 200]
EXACT = ["basin.method=exact", "basin.theta.count=500", "basin.velocity.count=320"]
# name: scene and keys of whole commands against another build
RUNS = {
    "direct-1000x1000": ("blackburn-fig12", ["basin.method=direct"]),
    "direct-400x250": ("blackburn-fig12", ["basin.method=direct", "basin.theta.count=400", "basin.velocity.count=250"]),
    "icm-1000x1000": ("blackburn-fig12", ["basin.method=icm"]),
    "exact-1000x1000": ("blackburn-fig12", ["basin.method=exact"]),
    "exact-fig13": ("blackburn-fig13", EXACT),
    "exact-fig15": ("blackburn-fig15", EXACT),
    "drive-square": ("blackburn-fig12", [*EXACT, "pendulum.waveform=square"]),
    "sweep-walk": ("blackburn-walk", ["sweep.count=30"]),
    "sweep-torque": ("josephson", []),
}


class Engine:
    """An engine in a process of its own, on one core."""

    def __init__(self, core):
        self.view = process.View(requests.Engine, Start(SCENE).engine(), lambda catalogue: None)
        self.number = self.view._process.pid
        os.sched_setaffinity(self.number, {core})

    def frame(self, rows, columns, **keys):
        """Processor milliseconds of the levels of a frame, by level."""
        times = {}
        for header, _ in self.view.answers({"request": "frame", "rows": rows, "columns": columns, "quality": "moving",
                                            **keys}):
            if header["answer"] == "error":
                sys.exit(header["message"])
            if header["answer"] == "frame":
                times[header["level"]] = header["milliseconds"]
        return times

    def seconds(self):
        """Processor time of the process so far, births between frames included."""
        fields = Path(f"/proc/{self.number}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def close(self):
        self.view.close()


def spin():
    """Milliseconds of a fixed amount of arithmetic."""
    values = np.linspace(0.1, 0.9, 4096)
    begin = time.process_time()
    for _ in range(400):
        values = 3.7 * values * (1 - values)
    return 1e3 * (time.process_time() - begin)


def still(engine, rounds, window=None):
    """The least of several frames of a pendulum that stays, after one that prepares it."""
    keys = {"window": window} if window else {}
    engine.frame(250, 400, **keys)
    return min(engine.frame(250, 400, **keys)[1] for _ in range(rounds))


def slide(engine, pendulum, key, first, last):
    """Mean over 50 values, births of attractors between the frames included."""
    engine.frame(250, 400, pendulum={**pendulum, key: first})
    begin = engine.seconds()
    for i in range(1, 51):
        engine.frame(250, 400, pendulum={**pendulum, key: first + (last - first) * i / 50})
    return 1e3 * (engine.seconds() - begin) / 50


def map_drags(engine, folder):
    """Means over 50 points of the explorer's map, whose atlas gives the attractors, by the way that its point goes."""
    scene, atlas = (Path(folder) / name for name in ("map.yaml", "map.h5"))
    scene.write_text(json.dumps({"pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3},
                                 "atlas": PLANE}))
    subprocess.run([str(PROGRAM), "run", str(scene), "-o", str(atlas)], check=True, stdout=subprocess.DEVNULL)

    def go(x, y):
        pendulum = {"quality_factor": 5, "drive_frequency": x, "drive_amplitude": y}
        engine.frame(250, 400, levels=[8, 4, 2, 1], pendulum=pendulum, atlas=str(atlas), x=x, y=y)
    means = {}
    for name, way in WAYS.items():
        go(*way(0))
        begin = engine.seconds()
        for i in range(1, 51):
            go(*way(i / 50))
        means[name] = 1e3 * (engine.seconds() - begin) / 50
    return means


def first_picture(core, **keys):
    """A new program: 8x8 cells, and the whole picture, with all that it took to start."""
    engine = Engine(core)
    begin = 1e3 * engine.seconds()
    times = engine.frame(551, 1000, levels=[8, 4, 2, 1], **keys)
    engine.close()
    return {level: begin + milliseconds for level, milliseconds in times.items()}


def measure(core, rounds):
    engine = Engine(core)
    frames = {"frame-400x250": still(engine, rounds), "zoom-400x250": still(engine, rounds, ZOOM)}
    yardstick = [spin()]
    for name, slider in SLIDERS.items():
        frames[name] = slide(engine, *slider)
        yardstick.append(spin())
    with tempfile.TemporaryDirectory() as folder:
        frames |= map_drags(engine, folder)
    yardstick.append(spin())
    engine.close()
    kinds = {"first-1000x551": {}}
    kinds |= {f"first-Q{q}": {"pendulum": {**BLACKBURN, "drive_amplitude": 0.3, "quality_factor": q}} for q in WEAK}
    for name, keys in kinds.items():
        pictures = [first_picture(core, **keys) for _ in range(min(rounds, 3))]
        frames[name] = min(picture[1] for picture in pictures)
        frames[name + "-8x8"] = min(picture[8] for picture in pictures)
    return frames, yardstick


def run_seconds(program, scene, sets, output):
    """Of all processes of a run, daemons of MPI included."""
    words = [word for key in sets for word in ("--set", key)]
    path = ROOT / "scenes" / f"{scene}.yaml"
    command = [str(program), "run", str(path), "-o", str(output), "--force", "--progress", "never", *words]
    counted = subprocess.run(["perf", "stat", "-x", ",", "-e", "task-clock", *command], check=True, text=True,
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    return float(counted.stderr.strip().splitlines()[-1].split(",")[0])


def compare(base, rounds, wanted):
    """Least time of this build over that of another one, in turns."""
    ratios = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (scene, sets) in RUNS.items():
            if not re.fullmatch(wanted, name):
                continue
            times = [[run_seconds(program, scene, sets, Path(folder) / "out.h5") for program in (base, PROGRAM)]
                     for _ in range(rounds)]
            ratios[name] = min(own for _, own in times) / min(other for other, _ in times)
    return ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5, help="frames of which the least counts")
    parser.add_argument("--core", type=int, default=0, help="on which it runs")
    parser.add_argument("--base", type=Path, help="another kapitza: ratios of whole commands too (needs perf)")
    parser.add_argument("--runs", default=".*", help="names of those commands, a regular expression (default: all)")
    parser.add_argument("--json", action="store_true", help="figures for other programs")
    options = parser.parse_args()
    frames, yardstick = measure(options.core, options.rounds)
    result = {
        "frames": [{"name": name, "ms": ms, "frames_per_second": 1e3 / ms} for name, ms in frames.items()],
        "yardstick_ms": {"least": min(yardstick), "median": statistics.median(yardstick), "most": max(yardstick)},
    }
    if options.base:
        result["runs"] = [{"name": name, "ratio": ratio} for name,
                          ratio in compare(options.base, options.rounds, options.runs).items()]
    if options.json:
        print(json.dumps(result, indent=1))
        return
    for row in result["frames"]:
        print(f"{row['name']:20} {row['ms']:8.2f} ms {row['frames_per_second']:8.1f} frames/s")
    print(f"yardstick {min(yardstick):.2f} to {max(yardstick):.2f} ms")
    for row in result.get("runs", []):
        print(f"{row['name']:20} {row['ratio']:8.3f} of the other build's time")


if __name__ == "__main__":
    main()
