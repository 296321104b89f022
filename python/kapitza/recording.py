"""What the explorer has recorded, a ZIP of pictures, as MP4 or GIF."""

import argparse
import io
import zipfile
from collections.abc import Iterator
from pathlib import Path

from PIL import Image, UnidentifiedImageError

from kapitza.films import write_film
from kapitza.result import BadFile

FORMATS = (".mp4", ".gif")
RATE = 25.0  # pictures a second, as the explorer plays them


def pictures_of(path: Path) -> Iterator[Image.Image]:
    """The pictures of a ZIP in the order of their names, all of the size of the first; BadFile where it holds anything else."""
    try:
        with zipfile.ZipFile(path) as archive:
            size = None
            for name in sorted(archive.namelist()):
                picture = Image.open(io.BytesIO(archive.read(name))).convert("RGB")
                size = size or picture.size
                yield picture if picture.size == size else picture.resize(size)
    except (zipfile.BadZipFile, UnidentifiedImageError, Image.DecompressionBombError, NotImplementedError, RuntimeError, EOFError) as error:
        raise BadFile(f"{path}: is not a ZIP of pictures as the explorer records them: {error}") from error


def main(words: list[str]) -> None:
    """Writes the film and prints its name."""
    parser = argparse.ArgumentParser(prog="kapitza plot film", description="an MP4 or GIF of the pictures that the explorer has recorded")
    parser.add_argument("file", type=Path, help="ZIP of PNG pictures")
    parser.add_argument("-o", "--output", type=Path, help="NAME.mp4 or NAME.gif (default: FILE's name with .mp4; .gif without ffmpeg)")
    parser.add_argument("--rate", type=float, default=RATE, help=f"pictures a second (default: {RATE:g})")
    given = parser.parse_args(words)
    output = given.output or given.file.with_suffix(".mp4")
    if output.suffix.lower() not in FORMATS:
        parser.error(f"{output}: the name must end in {' or '.join(FORMATS)}")
    if not 0.1 <= given.rate <= 1000:
        parser.error(f"--rate {given.rate:g} is out of range; give a number from 0.1 to 1000")
    print(write_film(output, pictures_of(given.file), given.rate))
