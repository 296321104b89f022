#!/usr/bin/env python3
"""A film of basins along one key of a scene, with a legend: a run and a picture for every value, and an MP4; a GIF
where the name says so, or ffmpeg is not installed.

    .venv/bin/python scripts/film_basin.py scenes/small.yaml pendulum.drive_amplitude 0.12 0.58 --count 116
    .venv/bin/python scripts/film_basin.py scenes/blackburn-fig12.yaml pendulum.drive_amplitude 0.12 0.58 --ranks 2

A film that was interrupted goes on with the frames that its folder holds; frames of another film are refused. film.txt
in the folder says which film it is: scene, key, values, resolution and program.
"""

import argparse
import os
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza import BadFile, run  # noqa: E402
from kapitza.exit_status import run_script  # noqa: E402
from kapitza.films import film_picture, heading, write_film  # noqa: E402
from kapitza.program import ask  # noqa: E402
from kapitza.scene import Scene  # noqa: E402


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, help="scene with a study basin")
    parser.add_argument("key", help="key of the scene that changes, such as pendulum.drive_amplitude")
    parser.add_argument("first", type=float)
    parser.add_argument("last", type=float)
    parser.add_argument("--count", type=int, default=100, help="frames, both ends included (default: 100)")
    parser.add_argument("--folder", type=Path, default=Path("film"), help="where the frames go (default: film)")
    parser.add_argument("-o", "--output", type=Path, help="NAME.mp4 or NAME.gif (default: film.mp4 in the folder)")
    parser.add_argument("--centre", choices=["down", "inverted"], default="inverted",
                        help="state in the middle (default: inverted)")
    parser.add_argument("--ranks", type=int, default=int(os.environ.get("RANKS", os.cpu_count())))
    parser.add_argument("--rate", type=int, default=12, help="frames per second (default: 12)")
    parser.add_argument("--dpi", type=int, default=150)
    arguments = parser.parse_args()
    if arguments.count < 2:
        parser.error("--count must be at least 2")
    return arguments


def description(arguments, values):
    """All that the frames depend on, as text."""
    settings = (f"{arguments.key} = {', '.join(map(repr, values))}\n{arguments.dpi} dots per inch, {arguments.centre} "
                "in the middle\n")
    return f"{settings}\n{ask(['--version'], Scene(arguments.scene))}\n{arguments.scene.read_text()}"


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
    result = run(arguments.scene, set={arguments.key: value}, ranks=arguments.ranks, progress=False)
    with whole(picture) as part:
        film_picture(result, heading(arguments.key, value), centre=arguments.centre,
                     dpi=arguments.dpi).save(part, "PNG")


def main():
    arguments = parse_arguments()
    values = [float(value) for value in np.linspace(arguments.first, arguments.last, arguments.count)]
    claim_folder(arguments.folder, description(arguments, values))
    pictures = [arguments.folder / f"frame-{index:04d}.png" for index in range(arguments.count)]
    for picture, value in zip(pictures, values, strict=True):
        if not picture.exists():
            make_frame(arguments, value, picture)
            print(f"{picture}: {arguments.key} = {value:.6g}", flush=True)
    print(write_film(arguments.output or arguments.folder / "film.mp4", map(Image.open, pictures), arguments.rate))


if __name__ == "__main__":
    run_script(main)
