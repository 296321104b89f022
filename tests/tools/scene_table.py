"""Runs scenes and tells what `check` foretold of each, what it took, and whether another program's results are the same.

    scene_table.py [--against FOLDER] [--longest SECONDS] FOLDER PROGRAM SCENE...

Results stay in FOLDER as SCENE.h5, and are not made again; those of an earlier program, made by the same command, are what --against names.
Times are processor time of one rank. Scenes whose `check` foretells more than --longest seconds are left out. Example:
    scene_table.py /tmp/old old/build/kapitza scenes/*.yaml
    scene_table.py --against /tmp/old /tmp/new build/kapitza scenes/*.yaml
"""

import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import h5py

UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
TIMED = {"tradeoff/seconds", "tradeoff/seconds_per_cell"}  # of a clock: never the same


def foretold(program, scene):
    """Seconds that `check` tells, or None where it does not serve the scene."""
    told = subprocess.run([program, "check", scene], capture_output=True, text=True, check=False).stdout
    found = re.search(r"^estimated time +(\S+) (\w+)", told, re.MULTILINE)
    return float(found[1]) * UNITS[found[2]] if found else None


def run(program, scene, out):
    """Makes the file; seconds of processor time."""
    subprocess.run([program, "run", scene, "-o", out, "--force"], capture_output=True, check=True)


def timed(program, scene, out):
    before = os.times()
    run(program, scene, out)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def datasets(path):
    """{name: bytes and shape} of all datasets of a file, text as it is."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and name not in TIMED:
            value = item[()]
            found[name] = (item.shape, value.tolist() if item.dtype.hasobject else value.tobytes())

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


def differences(path, other):
    ours, theirs = datasets(path), datasets(other)
    gone = [f"{name} is gone" for name in theirs.keys() - ours.keys()]
    new = [f"{name} is new" for name in ours.keys() - theirs.keys()]
    return sorted(gone + new) + sorted(name for name in ours.keys() & theirs.keys() if ours[name] != theirs[name])


def row(program, scene, folder, against):
    out = folder / f"{scene.stem}.h5"
    note = out.with_suffix(".seconds")
    if not (out.exists() and note.exists()):
        note.write_text(json.dumps(timed(program, scene, out)))
    told, took = foretold(program, scene), json.loads(note.read_text())
    same = ""
    if against and (against / out.name).exists():
        same = ", ".join(differences(out, against / out.name)) or "the same"
    return f"{scene.stem:28} {told:9.3g} {took:9.3g} {told / took:7.2f}  {same}"


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("--against", type=Path)
    reader.add_argument("--longest", type=float, default=60)
    reader.add_argument("folder", type=Path)
    reader.add_argument("program")
    reader.add_argument("scenes", type=Path, nargs="+")
    asked = reader.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    print(f"{'scene':28} {'check, s':>9} {'took, s':>9} {'ratio':>7}  {'datasets' if asked.against else ''}")
    for scene in asked.scenes:
        seconds = foretold(asked.program, scene)
        if seconds is None or seconds > asked.longest:
            print(f"{scene.stem:28} left out: check says {seconds} s")
            continue
        print(row(asked.program, scene, asked.folder, asked.against), flush=True)


if __name__ == "__main__":
    sys.exit(main())
