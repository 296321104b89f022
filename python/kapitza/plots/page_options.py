"""The options of the command line that say what the page of a picture is like."""

import argparse
from dataclasses import replace
from pathlib import Path

import yaml
from matplotlib.colors import is_color_like

from kapitza import style
from kapitza.plots.page import LEGENDS, NARROW, Page
from kapitza.scene import read_yaml

UNITS = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, "pt": 1 / 72}


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """The options that every picture takes."""
    parser.add_argument("--width", type=length, metavar="LENGTH",
                        help="width of the page, such as 86mm or 3.4in (default: that of the kind)")
    parser.add_argument("--font-size", type=points, metavar="POINTS", default=style.FONT_SIZE,
                        help=f"size of the letters, and of lines and marks (default: {style.FONT_SIZE:g})")
    parser.add_argument("--legend", choices=LEGENDS, help=f"where it stands (default: right; below on pages under {NARROW:g} in)")
    parser.add_argument("--colours", type=colour_file, metavar="FILE", default={},
                        help='YAML file of "name of an attractor or kind of motion: colour"')
    parser.add_argument("--title", metavar="TEXT", help="instead of the scene's title")
    parser.add_argument("--no-title", action="store_true", help="neither title nor parameters")


def page_of(arguments: argparse.Namespace) -> Page:
    """The page that the options ask for."""
    page = Page(arguments.width, arguments.font_size, "none", not arguments.no_title, arguments.title, arguments.colours)
    if getattr(arguments, "no_legend", False):
        return page
    return replace(page, legend=arguments.legend or ("below" if page.narrow else "right"))


def length(text: str) -> float:
    """Inches of a text such as 86mm."""
    number, unit = text[:-2].strip(), text[-2:]
    if unit not in UNITS or not 0.5 <= float(number) * UNITS[unit] <= 60:
        units = ", ".join(UNITS)
        raise argparse.ArgumentTypeError(f"{text} is not a width; give a number and one of {units}, such as 86mm, from 0.5 to 60 inches")
    return float(number) * UNITS[unit]


def points(text: str) -> float:
    """A size of letters."""
    if not 3 <= float(text) <= 72:
        raise argparse.ArgumentTypeError(f"{text} is out of range; give 3 to 72 points")
    return float(text)


def colour_file(text: str) -> dict[str, str]:
    """The mapping in a YAML (or JSON) file."""
    try:
        colours = read_yaml(Path(text).read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError, UnicodeDecodeError) as error:
        raise argparse.ArgumentTypeError(f"{text} cannot be read: {' '.join(str(error).split())}") from error
    if not isinstance(colours, dict):
        raise argparse.ArgumentTypeError(f'{text} contains no colours; write lines such as inverted: "#f2b233"')
    for name, colour in colours.items():
        if not is_color_like(colour):
            raise argparse.ArgumentTypeError(f'{text}: {name}: {colour!r} is not a colour; write one such as "#f2b233" or gold')
    return {str(name): colour for name, colour in colours.items()}
