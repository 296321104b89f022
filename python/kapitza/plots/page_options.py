"""The options that say what the page of a picture is like, and what they may be."""

import argparse
import os
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import yaml
from matplotlib.axes import Axes
from matplotlib.colors import is_color_like

from kapitza import style
from kapitza.bounded_reading import read_text
from kapitza.plots.page import LEGENDS, NARROW, Page
from kapitza.scene import read_yaml

NAMES = (*style.KINDS, "not settled")  # names that may have a colour, beside those of attractors
MOTION = re.compile(
    r"(rotation [+-]\d+/\d+|(down|inverted|wide) \d+-nodding|down|inverted|flutter|chaotic|running [+-])( \(\d+\))?")
UNITS = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, "pt": 1 / 72}


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """The options that every picture takes."""
    parser.add_argument("--width", type=length, metavar="LENGTH",
                        help="width of the page, such as 86mm or 3.4in (default: that of the kind)")
    parser.add_argument("--font-size", type=points, metavar="POINTS",
                        help=f"size of the letters, and of lines and marks (default: {style.FONT_SIZE:g})")
    parser.add_argument("--legend", choices=LEGENDS,
                        help=f"where it stands (default: right; below on pages under {NARROW:g} in)")
    parser.add_argument("--colours", type=colours_of, metavar="FILE",
                        help='YAML file of "name of an attractor or kind of motion: colour"')
    parser.add_argument("--title", metavar="TEXT", help="instead of the scene's title")
    parser.add_argument("--no-title", action="store_true", help="neither title nor parameters")


def page_of(options: Mapping[str, Any], legend: str = "", axes: Axes | None = None) -> Page:
    """The page that the options ask for; `legend`: where the kind of picture has it."""
    page = Page(options.get("width"), options.get("font_size", style.FONT_SIZE), "none", not options.get("no_title"),
                options.get("title"), options.get("colours", {}), axes)
    place = options.get("legend") or legend or ("below" if page.narrow else "right")
    return page if options.get("no_legend") else replace(page, legend=place)


def length(text: str) -> float:
    """Inches of a text such as 86mm."""
    number, unit = text[:-2].strip(), text[-2:]
    if unit not in UNITS or not 0.5 <= float(number) * UNITS[unit] <= 60:
        units = ", ".join(UNITS)
        raise argparse.ArgumentTypeError(
            f"{text} is not a width; give a number and one of {units}, such as 86mm, from 0.5 to 60 inches")
    return float(number) * UNITS[unit]


def points(text: str) -> float:
    """A size of letters."""
    if not 3 <= float(text) <= 72:
        raise argparse.ArgumentTypeError(f"{text} is out of range; give 3 to 72 points")
    return float(text)


def colours_of(given: str | os.PathLike[str] | Mapping[Any, Any]) -> dict[str, str]:
    """The colours of a mapping, or of the one in a YAML (or JSON) file."""
    text = "colours" if isinstance(given, Mapping) else str(given)
    try:
        colours = given if isinstance(given, Mapping) else read_yaml(read_text(text, "list of colours"))
    except (OSError, yaml.YAMLError, ValueError) as error:
        raise argparse.ArgumentTypeError(f"{text} cannot be read: {' '.join(str(error).split())}") from error
    if not isinstance(colours, Mapping):
        raise argparse.ArgumentTypeError(f'{text} contains no colours; write lines such as inverted: "#f2b233"')
    for name, colour in colours.items():
        if str(name) not in NAMES and not MOTION.fullmatch(str(name)):
            raise argparse.ArgumentTypeError(
                f"{text}: {name!s} is the name of no motion; the names are {', '.join(NAMES)}, and those of "
                                             "attractors, such as rotation +1/2, inverted 3-nodding, inverted "
                                             "3-nodding (2)")
        if not is_color_like(colour):
            raise argparse.ArgumentTypeError(
                f'{text}: {name}: {colour!r} is not a colour; write one such as "#f2b233" or gold')
    return {str(name): colour for name, colour in colours.items()}
