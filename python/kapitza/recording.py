"""What the explorer has recorded, a ZIP of pictures, as MP4 or GIF."""

import io
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path

from PIL import Image, UnidentifiedImageError

from kapitza.films import check_rate, write_film
from kapitza.options import Parser, wrong_ending
from kapitza.result import BadFile

FORMATS = (".mp4", ".gif")
RATE = 25.0  # pictures a second, as the explorer plays them
MOST_PIXELS = 7680 * 4320  # pixels of a picture on an 8K screen
MOST_BYTES = 4 * MOST_PIXELS  # bytes of a PNG
PNG = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"  # how each begins; width and height follow


def pictures_of(path: Path) -> Iterator[Image.Image]:
    """The pictures of a ZIP in the order of their names, all of the size of the first; BadFile where it holds anything
    else."""
    try:
        with zipfile.ZipFile(path) as archive:
            size = None
            for entry in sorted(archive.infolist(), key=lambda entry: entry.filename):
                picture = _picture_of(archive, entry)
                size = size or picture.size
                yield picture if picture.size == size else picture.resize(size)
    except (zipfile.BadZipFile, zlib.error, UnidentifiedImageError, NotImplementedError, RuntimeError, EOFError,
            SyntaxError, ValueError) as error:
        raise BadFile(f"{path}: is not a ZIP of pictures as the explorer records them: {error}") from error


def _picture_of(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Image.Image:
    """One picture. What the directory and its header say of its size is looked at before it is read; ValueError where
    it is no PNG or too large."""
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or entry.file_size > MOST_BYTES:
        raise ValueError(
            f"{entry.filename} takes more than {MOST_BYTES / 1e6:.0f} MB, or is packed in a way of its own")
    with archive.open(entry) as file:
        head = file.read(len(PNG) + 8)
    if not head.startswith(PNG) or len(head) < len(PNG) + 8:
        raise ValueError(f"{entry.filename} is no PNG")
    width, height = struct.unpack(">2I", head[len(PNG):])
    if width * height > MOST_PIXELS:
        raise ValueError(f"{entry.filename} has {width} x {height} pixels; it may have {MOST_PIXELS / 1e6:.0f} million")
    return Image.open(io.BytesIO(archive.read(entry)), formats=["PNG"]).convert("RGB")


def main(words: list[str]) -> None:
    """Writes the film and prints its name."""
    parser = Parser(prog="kapitza plot film",
                    description="an MP4 or GIF of the pictures that the explorer has recorded")
    parser.add_argument("file", type=Path, help="ZIP of PNG pictures")
    parser.add_argument("-o", "--output", type=Path,
                        help="NAME.mp4 or NAME.gif (default: FILE's name with .mp4; .gif without ffmpeg)")
    parser.add_argument("--rate", type=float, default=RATE, help=f"pictures a second (default: {RATE:g})")
    given = parser.parse_args(words)
    output = given.output or given.file.with_suffix(".mp4")
    if output.suffix.lower() not in FORMATS:
        parser.error(wrong_ending(output, FORMATS))
    try:
        check_rate(given.rate)
    except ValueError as error:
        parser.error(f"--{error}")
    print(write_film(output, pictures_of(given.file), given.rate))
