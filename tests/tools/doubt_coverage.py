#!/usr/bin/env python3
"""Does `doubtful_share` understate, and does `exact` err? Random pendulums of no scene against quad precision.

    tests/tools/doubt_coverage.py                              20 pendulums
    tests/tools/doubt_coverage.py --pendulums 40 --seed 2 --ranks 2
    tests/tools/doubt_coverage.py --first 14 --samples 400     the last six of them, in less time

For each pendulum one run of the program: `basin` with its doubtful share, and `tradeoff`, which compares the same scheme and steps on
random cells of the same window by quad precision. A share is understated where the wrong share of the cells of the trade-off is above
the doubtful one's interval. `exact` labels the same cells: none of those that it decides may be wrong. Exit status 1 where a share is
or a label.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "tools")]

from kapitza.script import run_script  # noqa: E402
from reference_coverage import Kapitza, lively_scene  # noqa: E402

SETTING = "processed-1e-12"  # what direct takes by default


def compare(kapitza, scene, samples):
    """(doubtful, low, high) and (wrong, low, high) of a scene, and (wrong, undecided) of `exact`."""
    scene = scene | {"basin": scene["basin"] | {"method": "direct"}, "tradeoff": {"samples": samples, "settings": [SETTING, "exact"]}}
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
    arguments = parser.parse_args()
    print("pendulum, window; % doubtful, its interval; % wrong, its interval (! = understated); exact: % wrong, % undecided")
    low = mistaken = 0
    with tempfile.TemporaryDirectory() as folder:
        kapitza = Kapitza(folder, arguments.ranks)
        for number in range(arguments.first, arguments.pendulums):
            scene = lively_scene(kapitza, np.random.default_rng([arguments.seed, number]), number, arguments.cells)
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
