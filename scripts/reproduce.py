"""Draws the figures of python/kapitza/figures.py, each scene run once, and writes the papers' numbers (see scripts/reproduce)."""

import argparse
import fnmatch
import os
import subprocess
import sys
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza.figures import FIGURES  # noqa: E402
from papers.page import find_numbers, write_page  # noqa: E402

RESULTS = ROOT / "results"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pattern", nargs="?", help="names of the figures, as a shell pattern (default: all, and the numbers)")
    parser.add_argument("--numbers", action="store_true", help="no figure: only the numbers of the papers, docs/validation/results.md")
    parser.add_argument("--ranks", type=int, default=int(os.environ.get("RANKS", os.cpu_count())))
    parser.add_argument("--list", action="store_true", help="print the table and run nothing")
    arguments = parser.parse_args()
    arguments.figures = [figure for figure in FIGURES if fnmatch.fnmatch(figure[0], arguments.pattern or "*")]
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


def draw_figures(arguments):
    RESULTS.mkdir(exist_ok=True)
    for scene in dict.fromkeys(scene for _, scene, _, _ in arguments.figures):
        if status := run_scene(scene, arguments.ranks):
            sys.exit(status)
    for name, scene, kind, options in arguments.figures:
        if status := step("build/kapitza", "plot", kind, f"results/{scene}.h5", "-o", f"results/{name}.png", *options):
            sys.exit(status)
        shrink(RESULTS / f"{name}.png")


def shrink(path):
    """Gives a picture a palette of 256 colours: a fifth of the bytes."""
    picture = Image.open(path)
    small = picture.convert("RGB").quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    small.save(path, optimize=True, dpi=picture.info.get("dpi"))


def write_numbers():
    """docs/validation/results.md; status 1 and a line for each number that failed."""
    found = find_numbers(lambda words: print("reproduce:", words, flush=True))
    failed = write_page(found, ROOT / "docs" / "validation" / "results.md")
    print(f"reproduce: docs/validation/results.md has {sum(len(numbers) for _, numbers in found)} numbers, {len(failed)} failed")
    for number in failed:
        print(f"reproduce: FAILED: {number.place}: {number.quantity}: ours {number.ours:.12g}, paper {number.printed or '-'}, "
              f"reference {'-' if number.reference is None else format(number.reference, '.12g')}", file=sys.stderr)
    if failed:
        sys.exit(1)


def main():
    arguments = parse_arguments()
    if arguments.list:
        for name, scene, kind, options in arguments.figures:
            print(f"{name:28} scenes/{scene}.yaml  {kind} {' '.join(options)}")
        return
    if not arguments.numbers:
        draw_figures(arguments)
    if arguments.numbers or not arguments.pattern:
        write_numbers()


if __name__ == "__main__":
    main()
