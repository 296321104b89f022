"""Films of basins: pictures of one size with a legend that stays, and files of pictures as MP4 or GIF.

What draws is imported where it draws: a session that draws nothing does not wait for matplotlib.
"""

import itertools
import os
import shutil
import subprocess
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from kapitza.result import BadFile, Result
from kapitza.scene import SceneLike
from kapitza.session import run

SIZE = (8.0, 4.8)  # inches
PANEL = (0.09, 0.13, 0.64, 0.76)  # left, bottom, width, height: parts of the picture
GIF_COLOURS = 128


def film(scene: SceneLike, key: str, values: Iterable[Any], output: str | os.PathLike[str] = "film.mp4", *,
         rate: float = 12, ranks: int = 1, set: Mapping[str, Any] | None = None, centre: str = "inverted") -> Path:
    """Makes a film of the scene's basins, with one picture for each value of a key, and returns its path.

    :param key: the key that changes, such as "pendulum.drive_amplitude"
    :param values: its values, in order
    :param output: NAME.mp4 or NAME.gif; an MP4 needs ffmpeg, and becomes a GIF if ffmpeg is not installed
    :param rate: pictures a second
    :param ranks: number of MPI processes
    :param set: other keys to change
    :param centre: angle in the middle of the picture: "inverted" or "down"
    """
    check_rate(rate)

    def pictures() -> Iterable[Image.Image]:
        for value in values:
            result = run(scene, set={**(set or {}), key: value}, ranks=ranks, progress=False)
            yield film_picture(result, heading(key, value), centre=centre)

    return write_film(output, pictures(), rate)


def check_rate(rate: float) -> None:
    """ValueError where it is none that a film can have."""
    if not 0.1 <= rate <= 1000:
        raise ValueError(f"rate {rate:g} is out of range; give a number from 0.1 to 1000")


def film_picture(result: Result, heading: str, *, centre: str = "inverted", dpi: float = 150) -> Image.Image:
    """One picture of a film: the basins, and a legend with a line for each kind of motion, whether it occurs or not."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from kapitza import style
    from kapitza.plots.basin import draw_basins, write_legend

    basin, attractors = result.group("basin"), result.group("attractors")
    with style.using():
        figure = Figure(figsize=SIZE, dpi=dpi)
        canvas = FigureCanvasAgg(figure)
        axes = draw_basins(figure.add_axes(PANEL), basin, attractors, legend=False, centre=centre)
        write_legend(axes, kind_entries(result))
        axes.set_title(heading)
        canvas.draw()
        return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def kind_entries(result: Result) -> list[tuple[str, str, float]]:
    """(colour, name, share of the starts) of every kind of motion, in one order; the unsettled starts last."""
    from kapitza import style

    table, labels = result.group("attractors"), result.group("basin")["attractor"].values
    kinds = [style.kind(*row) for row in zip(*(table[name].values for name in ("period", "winding", "centre")),
                                             strict=True)]
    shares = dict.fromkeys(style.KINDS, 0.0)
    for index, kind in enumerate(kinds):
        shares[kind] += float(np.mean(labels == index))
    return [*((style.kind_colour(kind), kind, share) for kind, share in shares.items()),
            (style.UNSETTLED, "not settled", float(np.mean(labels < 0)))]


def write_film(output: str | os.PathLike[str], pictures: Iterable[Image.Image], rate: float) -> Path:
    """Writes pictures of one size as MP4, or as GIF: where the name says so, or ffmpeg is not installed. The film
    stands under its name when it is complete."""
    path = Path(output)
    is_gif = path.suffix.lower() == ".gif" or not shutil.which("ffmpeg")
    path = path.with_suffix(".gif") if is_gif else path
    part = path.with_name(f"part-{path.name}")
    part.unlink(missing_ok=True)  # a link there would lead elsewhere
    try:
        (_write_gif if is_gif else _write_mp4)(part, pictures, rate)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def _write_mp4(path: Path, pictures: Iterable[Image.Image], rate: float) -> None:
    rest = iter(pictures)
    if (first := next(rest, None)) is None:
        raise BadFile(f"{path}: there are no pictures to make a film of")
    with suppress(BrokenPipeError), subprocess.Popen(_ffmpeg(path, first.size, rate), stdin=subprocess.PIPE) as process:
        assert process.stdin
        for picture in itertools.chain([first], rest):
            process.stdin.write(picture.tobytes())
    if process.returncode:
        raise BadFile(f"{path}: ffmpeg could not write the film")


def _ffmpeg(path: Path, size: tuple[int, int], rate: float) -> list[str]:
    """H.264 wants even sizes."""
    pictures = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-framerate", f"{rate:g}", "-i",
                "-"]
    film = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-preset", "veryfast", "-pix_fmt", "yuv420p", "-f",
            "mp4"]
    return ["ffmpeg", "-y", "-loglevel", "error", *pictures, *film, str(path)]


def _write_gif(path: Path, pictures: Iterable[Image.Image], rate: float) -> None:
    frames = (picture.quantize(GIF_COLOURS, dither=Image.Dither.NONE) for picture in pictures)
    first = next(iter(frames), None)
    if first is None:
        raise BadFile(f"{path}: there are no pictures to make a film of")
    first.save(path, format="GIF", save_all=True, append_images=frames, duration=round(1000 / rate), loop=0)


def heading(key: str, value: Any) -> str:
    """What a picture of a film says of its value."""
    words = f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"{key.split('.')[-1].replace('_', ' ')} = {words}"
