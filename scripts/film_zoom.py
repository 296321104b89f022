#!/usr/bin/env python3
"""A film that falls into a boundary of basins: from the whole circle down to a width of any depth, about one point.

    build/kapitza where SCENE THETA VELOCITY THETA VELOCITY --boundary 120     # finds a point
    .venv/bin/python scripts/film_zoom.py SCENE THETA VELOCITY --to 1e-100 -o zoom.mp4

One reference orbit serves all frames (docs/validation/accuracy.md). MP4 by ffmpeg where it is there; a name that ends
in .gif, or a machine without ffmpeg, gives an animated GIF. Cells are labelled as in the explorer's moving frames: the
map makes a curve of a deep window, and 16 starts a cell along it stand for all cells. Where a boundary is fractal
throughout, some cells in a hundred have the label of a start beside theirs.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import xarray
from PIL import Image, ImageDraw

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza import Engine, style  # noqa: E402
from kapitza.exit_status import run_script  # noqa: E402
from kapitza.films import write_film  # noqa: E402

UNSETTLED = (255, 255, 255)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, help="scene with a study basin")
    parser.add_argument("theta", help="angle of the point, decimal text of any digits, rad")
    parser.add_argument("velocity", help="its velocity, rad per drive radian")
    parser.add_argument("--to", default="1e-100", help="width of the last frame, 1e-300 to 1 (default: 1e-100)")
    parser.add_argument("--count", type=int, default=300, help="frames (default: 300)")
    parser.add_argument("--columns", type=int, default=600)
    parser.add_argument("--rows", type=int, default=400)
    parser.add_argument("--rate", type=int, default=25, help="frames per second (default: 25)")
    parser.add_argument("-o", "--output", type=Path, default=Path("zoom.mp4"))
    arguments = parser.parse_args()
    if arguments.count < 2 or not 1e-300 <= float(arguments.to) <= 1:
        parser.error("--count must be at least 2, and --to from 1e-300 to 1")
    if arguments.columns % 2 or arguments.rows % 2:
        parser.error("--columns and --rows must be even numbers")
    return arguments


def window(arguments, decades):
    """The window whose width is 2 pi and so many decades less."""
    mantissa, exponent = 2 * np.pi * 10 ** (-decades % 1), int(np.floor(-decades))
    widths = (mantissa, mantissa * arguments.rows / arguments.columns)
    return {name: {"centre": centre, "width": f"{width:.16g}e{exponent}"}
            for name, centre, width in zip(("theta", "velocity"), (arguments.theta, arguments.velocity), widths,
                                           strict=True)}


def picture(engine, labels, decades):
    """A frame with its width written into it."""
    attractors = xarray.Dataset.from_dataframe(engine.attractors)
    palette = [tuple(int(colour[i:i + 2], 16) for i in (1, 3, 5)) for colour in style.colours(attractors)]
    image = Image.fromarray(np.array([*palette, UNSETTLED], dtype=np.uint8)[labels[::-1]])
    draw = ImageDraw.Draw(image)
    draw.text((9, image.height - 19), f"width {2 * np.pi * 10.0 ** -decades:.1e}", fill=(0, 0, 0))
    return image


def frames(arguments):
    """All pictures, from the widest on. The widest and the deepest window are asked for first: what they need serves
    all between."""
    depth = np.log10(2 * np.pi) - np.log10(float(arguments.to))
    with Engine(arguments.scene) as engine:
        for decades in (0, depth):
            engine.frame(window(arguments, decades), (4, 6), quality="moving")
        for decades in np.linspace(0, depth, arguments.count):
            labels = engine.frame(window(arguments, decades), (arguments.rows, arguments.columns), quality="moving")
            yield picture(engine, labels, decades)


def main():
    arguments = parse_arguments()
    print(write_film(arguments.output, frames(arguments), arguments.rate))


if __name__ == "__main__":
    run_script(main)
