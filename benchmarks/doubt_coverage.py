#!/usr/bin/env python3
"""Does `doubtful_share` understate, and does `exact` err? Random pendulums of no scene against quad precision.

    scripts/benchmark doubt_coverage                              20 pendulums
    scripts/benchmark doubt_coverage --pendulums 40 --seed 2 --ranks 2
    scripts/benchmark doubt_coverage --first 14 --samples 400     the last six of them, in less time
    scripts/benchmark doubt_coverage --hard --pendulums 14 strong damping and drive, no gravity, fast starts, boundaries
    1e-8 wide

For each pendulum one run of the program: `basin` with its doubtful share, and `tradeoff`, which compares the same
scheme and steps on random cells of the same window by quad precision. A share is understated where the wrong share of
the cells of the trade-off is above the doubtful one's interval. `exact` labels the same cells: none of those that it
decides may be wrong. Exit status 1 where a share is or a label.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from kapitza.exit_status import run_script  # noqa: E402
from reference_coverage import FAMILIES, PROGRAM, Kapitza, draw, lively_scene  # noqa: E402

SETTING = "processed-1e-12"  # what direct takes by default
HARD = [
    *FAMILIES,
    {"k": (-0.1, -0.005, "linear"), "damping": (0.03, 0.3, "log"), "m": (0.3, 1.5, "log")},
    {"k": (0, 0, "linear"), "damping": (0.01, 0.2, "log"), "m": (0.1, 1, "log")},
    {"k": (0.05, 0.3, "linear"), "damping": (0.1, 0.5, "log"), "m": (2, 10, "log")},
]
WINDOWS = ["slow", "fast", "boundary"]
LOOK = 60  # cells an axis of the first look
WIDTH = 1e-8


def boundary_window(scene, basin):
    """A window about a point where the basins of two neighbouring cells meet."""
    label = basin["attractor"].values
    row, column = np.argwhere((label[:, 1:] != label[:, :-1]) & (label[:, 1:] >= 0) & (label[:, :-1] >= 0))[0]
    pair = [str(basin[name].values[i]) for place in (column, column + 1) for name,
            i in (("theta", place), ("velocity", row))]
    done = subprocess.run([PROGRAM, "where", "-", *pair, "--boundary", "12", "--json"], input=json.dumps(scene),
                          capture_output=True, text=True, check=True)
    centre = json.loads(done.stdout.splitlines()[-1])
    return {name: {"min": float(centre[name]) - WIDTH / 2, "max": float(centre[name]) + WIDTH / 2}
            for name in ("theta", "velocity")}


def hard_scene(kapitza, random, number, cells):
    """The first random scene of a kind whose cells take more than a period to settle, and have more than one end."""
    kind, window = HARD[number % len(HARD)], WINDOWS[number // len(HARD) % len(WINDOWS)]
    while True:
        slowest = draw(random, 5, 12, "linear") if window == "fast" else -draw(random, 1, 3, "linear")
        velocity = {"min": slowest, "max": slowest + draw(random, 2, 3, "linear"), "count": LOOK}
        scene = {"pendulum": {key: draw(random, *span) for key, span in kind.items()},
                 "basin": {"theta": {"count": LOOK}, "velocity": velocity}}
        basin = kapitza(scene).group("basin")
        label = basin["attractor"].values
        if basin["settling_time"].values.mean() <= 1 or not np.any(label[:, 1:] != label[:, :-1]):
            continue
        if window == "boundary":
            scene["basin"] |= boundary_window(scene, basin)
        for axis in ("theta", "velocity"):
            scene["basin"][axis]["count"] = cells
        return scene


def compare(kapitza, scene, samples):
    """(doubtful, low, high) and (wrong, low, high) of a scene, and (wrong, undecided) of `exact`."""
    scene = scene | {"basin": scene["basin"] | {"method": "direct"},
                     "tradeoff": {"samples": samples, "settings": [SETTING, "exact"]}}
    result = kapitza(scene)
    basin, trade = result.group("basin").attrs, result.group("tradeoff")
    stated = tuple(float(basin[f"doubtful_share{end}"]) for end in ("", "_low", "_high"))
    exact = tuple(float(trade[name].values[1]) for name in ("wrong", "undecided"))
    return stated, tuple(float(trade[f"wrong{end}"].values[0]) for end in ("", "_low", "_high")), exact


def understates(stated, wrong):
    return wrong[0] > stated[2]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pendulums", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--samples", type=int, default=4000, help="cells that are compared")
    parser.add_argument("--cells", type=int, default=300, help="of the window, an axis")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--hard", action="store_true", help="pendulums and windows that are hard to label")
    arguments = parser.parse_args()
    print("pendulum, window; % doubtful, its interval; % wrong, its interval (! = understated); exact: % wrong, % "
          "undecided")
    low = mistaken = 0
    with tempfile.TemporaryDirectory() as folder:
        kapitza = Kapitza(folder, arguments.ranks)
        for number in range(arguments.first, arguments.pendulums):
            make = hard_scene if arguments.hard else lively_scene
            scene = make(kapitza, np.random.default_rng([arguments.seed, number]), number, arguments.cells)
            stated, wrong, exact = compare(kapitza, scene, arguments.samples)
            low += understates(stated, wrong)
            mistaken += exact[0] > 0
            speeds = scene["basin"]["velocity"]
            names = " ".join(f"{value:g}" for value in [*scene["pendulum"].values(), speeds["min"], speeds["max"]])
            shares = " ".join(f"{100 * share:6.2f}" for share in [*stated, *wrong])
            mark = "!" if understates(stated, wrong) else " "
            print(f"{number:3} {names:42} {shares} {mark} {100 * exact[0]:6.3f} {100 * exact[1]:6.3f}", flush=True)
    print(f"{low} of {arguments.pendulums - arguments.first} understated, exact wrong on {mistaken}")
    sys.exit(low + mistaken > 0)


if __name__ == "__main__":
    run_script(main)
