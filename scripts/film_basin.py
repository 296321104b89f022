#!/usr/bin/env python3
"""A film of basins along one key of a scene: a run and a picture for every value, and an MP4 where ffmpeg is there.

    .venv/bin/python scripts/film_basin.py scenes/small.yaml pendulum.drive_amplitude 0.12 0.58 --count 116
    .venv/bin/python scripts/film_basin.py scenes/blackburn-fig12.yaml pendulum.drive_amplitude 0.12 0.58 --ranks 2

Pictures that are in the folder already are not made again, so that a film can be gone on with.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


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


def make_frame(arguments, value, picture):
    """Models one value and draws it."""
    result = picture.with_suffix(".h5")
    step(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", arguments.ranks, ROOT / "build" / "kapitza", "run",
          arguments.scene, "--set", f"{arguments.key}={float(value)!r}", "-o", result, "--force", "--progress", "never"])
    step([sys.executable, ROOT / "scripts" / "plot_basin.py", result, "--centre", "inverted", "--no-legend",
          "--dpi", arguments.dpi, "-o", picture])
    result.unlink()


def make_film(arguments):
    """The frames as an MP4, each fitted into one size."""
    if not shutil.which("ffmpeg"):
        print(f"frames in {arguments.folder}; ffmpeg is not installed, so there is no film")
        return
    film = arguments.folder / "film.mp4"
    fit = "scale=1280:960:force_original_aspect_ratio=decrease,pad=1280:960:-1:-1:white,format=yuv420p"
    step(["ffmpeg", "-y", "-loglevel", "error", "-framerate", arguments.rate, "-i", arguments.folder / "frame-%04d.png",
          "-vf", fit, film])
    print(film)


def main():
    arguments = parse_arguments()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for index, value in enumerate(np.linspace(arguments.first, arguments.last, arguments.count)):
        picture = arguments.folder / f"frame-{index:04d}.png"
        if not picture.exists():
            make_frame(arguments, value, picture)
            print(f"{picture}: {arguments.key} = {value:.6g}", flush=True)
    make_film(arguments)


if __name__ == "__main__":
    main()
