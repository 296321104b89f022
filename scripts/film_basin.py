#!/usr/bin/env python3
"""A film of basins along one key of a scene: a run and a picture for every value, and an MP4 where ffmpeg is there.

    .venv/bin/python scripts/film_basin.py scenes/small.yaml pendulum.drive_amplitude 0.12 0.58 --count 116
    .venv/bin/python scripts/film_basin.py scenes/blackburn-fig12.yaml pendulum.drive_amplitude 0.12 0.58 --ranks 2

A film that was interrupted goes on with the frames that its folder holds; frames of another film are refused. film.txt in the folder
says which film it is: scene, key, values, resolution and program.
"""

import argparse
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza import BadFile  # noqa: E402
from kapitza.script import run_script  # noqa: E402


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, help="scene with a study basin")
    parser.add_argument("key", help="key of the scene that changes, such as pendulum.drive_amplitude")
    parser.add_argument("first", type=float)
    parser.add_argument("last", type=float)
    parser.add_argument("--count", type=int, default=100, help="frames, both ends included (default: 100)")
    parser.add_argument("--folder", type=Path, default=Path("film"), help="where the frames go (default: film)")
    parser.add_argument("--ranks", type=int, default=int(os.environ.get("RANKS", os.cpu_count())))
    parser.add_argument("--rate", type=int, default=12, help="frames per second (default: 12)")
    parser.add_argument("--dpi", type=int, default=150)
    arguments = parser.parse_args()
    if arguments.count < 2:
        parser.error("--count: at least 2")
    return arguments


def step(command):
    """Runs one command; its failure ends the script with its status."""
    status = subprocess.run(list(map(str, command)), stdout=subprocess.DEVNULL).returncode
    if status:
        sys.exit(status)


def description(arguments, values):
    """All that the frames depend on, as text."""
    version = subprocess.run([ROOT / "build" / "kapitza", "--version"], capture_output=True, text=True).stdout
    settings = f"{arguments.key} = {', '.join(repr(float(value)) for value in values)}\n{arguments.dpi} dots per inch\n"
    return f"{settings}\n{version}\n{arguments.scene.read_text()}"


def claim_folder(folder, film):
    """Makes the folder this film's; BadFile if it holds frames of another one."""
    folder.mkdir(parents=True, exist_ok=True)
    record = folder / "film.txt"
    known = record.read_text() if record.is_file() else None
    if known == film:
        return
    if known is not None or any(folder.glob("frame-*.png")):
        raise BadFile(f"{folder}: holds frames of another film (another scene, key, values, resolution or program); "
                      "take another --folder or empty it")
    with whole(record) as part:
        part.write_text(film)


@contextmanager
def whole(path):
    """A name to write to, which becomes `path` when all is written: what a kill cuts short never carries the name."""
    part = path.with_name(f"part-{path.name}")
    part.unlink(missing_ok=True)  # a link there would lead elsewhere
    yield part
    part.replace(path)


def make_frame(arguments, value, picture):
    """Models one value and draws it."""
    result = picture.with_suffix(".h5")
    step(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", arguments.ranks, ROOT / "build" / "kapitza", "run",
          arguments.scene, "--set", f"{arguments.key}={float(value)!r}", "-o", result, "--force", "--progress", "never"])
    with whole(picture) as part:
        step([sys.executable, ROOT / "scripts" / "plot_basin.py", result, "--centre", "inverted", "--no-legend",
              "--dpi", arguments.dpi, "-o", part])
    result.unlink()


def make_film(arguments):
    """The frames as an MP4, each fitted into one size."""
    if not shutil.which("ffmpeg"):
        print(f"frames in {arguments.folder}; ffmpeg is not installed, so there is no film")
        return
    film = arguments.folder / "film.mp4"
    fit = "scale=1280:960:force_original_aspect_ratio=decrease,pad=1280:960:-1:-1:white,format=yuv420p"
    with whole(film) as part:
        step(["ffmpeg", "-y", "-loglevel", "error", "-framerate", arguments.rate, "-i", arguments.folder / "frame-%04d.png",
              "-vf", fit, part])
    print(film)


def main():
    arguments = parse_arguments()
    values = np.linspace(arguments.first, arguments.last, arguments.count)
    claim_folder(arguments.folder, description(arguments, values))
    for index, value in enumerate(values):
        picture = arguments.folder / f"frame-{index:04d}.png"
        if not picture.exists():
            make_frame(arguments, value, picture)
            print(f"{picture}: {arguments.key} = {value:.6g}", flush=True)
    make_film(arguments)


if __name__ == "__main__":
    run_script(main)
