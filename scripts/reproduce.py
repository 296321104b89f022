"""Draws the figures of scripts/kapitza/figures.py: each scene is run once, each figure drawn from its result (see scripts/reproduce)."""

import argparse
import fnmatch
import os
import subprocess
import sys
from pathlib import Path

from kapitza.figures import FIGURES

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "results"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pattern", nargs="?", default="*", help="names of the figures, as a shell pattern (default: all)")
    parser.add_argument("--ranks", type=int, default=int(os.environ.get("RANKS", os.cpu_count())))
    parser.add_argument("--list", action="store_true", help="print the table and run nothing")
    arguments = parser.parse_args()
    arguments.figures = [figure for figure in FIGURES if fnmatch.fnmatch(figure[0], arguments.pattern)]
    if not arguments.figures:
        parser.error(f"no figure is called {arguments.pattern}; --list shows the names")
    return arguments


def step(*command):
    """Runs one command and returns its status."""
    print("reproduce:", *command, flush=True)
    return subprocess.run(command, cwd=ROOT).returncode


def run_scene(scene, ranks):
    """Goes on from an interrupted run, keeps a complete result, replaces one of another scene or program (status 2)."""
    run = ["mpirun", "-n", str(ranks), "build/kapitza", "run", f"scenes/{scene}.yaml", "-o", f"results/{scene}.h5"]
    status = step(*run, "--resume")
    return step(*run, "--force") if status == 2 else status


def main():
    arguments = parse_arguments()
    if arguments.list:
        for name, scene, kind, options in arguments.figures:
            print(f"{name:28} scenes/{scene}.yaml  {kind} {' '.join(options)}")
        return
    RESULTS.mkdir(exist_ok=True)
    for scene in dict.fromkeys(scene for _, scene, _, _ in arguments.figures):
        if status := run_scene(scene, arguments.ranks):
            sys.exit(status)
    for name, scene, kind, options in arguments.figures:
        if status := step(sys.executable, f"scripts/plot_{kind}.py", f"results/{scene}.h5", "-o", f"results/{name}.png", *options):
            sys.exit(status)


if __name__ == "__main__":
    main()
