"""What the pictures share: their arguments, their page, and how a figure is entitled."""

import argparse
import warnings
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from kapitza import style
from kapitza.options import Parser, wrong_ending
from kapitza.plots.dark import darken
from kapitza.plots.page import SEPARATOR, Picture, current, drawing, lay_out, new_figure
from kapitza.plots.page_options import add_page_options, page_of
from kapitza.plots.strokes import scale_strokes
from kapitza.result import BadFile, Result

__all__ = ["argument_parser", "entitle", "figure_of", "new_figure", "parsed", "write_picture"]

FORMATS = (".png", ".svg", ".pdf")


def argument_parser(kind: str, description: str | None, study: str) -> Parser:
    """A parser of what every kind takes; `study`: what its file must hold, for the help."""
    parser = Parser(prog=f"kapitza plot {kind}", description=description,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help=f"result file that holds {study}")
    parser.add_argument("-o", "--output", type=Path, help="picture; .png, .svg or .pdf (default: FILE's name with .png, here)")
    parser.add_argument("--dpi", type=resolution, default=200)
    add_page_options(parser)
    return parser


def resolution(text: str) -> int:
    """Dots per inch that a picture can have."""
    if not 10 <= int(text) <= 2400:
        raise argparse.ArgumentTypeError(f"{text} is out of range; give a number from 10 to 2400")
    return int(text)


def parsed(parser: Parser, words: list[str], ending: str = "") -> argparse.Namespace:
    """The arguments, with the picture's name: that of the file, with `ending`, where none is given."""
    arguments = parser.parse_args(words)
    arguments.output = arguments.output or Path(f"{Path(arguments.file).stem or 'picture'}{ending}.png")
    if arguments.output.suffix.lower() not in FORMATS:
        parser.error(wrong_ending(arguments.output, FORMATS))
    return arguments


def write_picture(arguments: argparse.Namespace, draw: Callable[[Result, argparse.Namespace], Figure]) -> None:
    """Writes the figure that `draw` makes of the file."""
    figure = figure_of(Result(arguments.file), arguments, draw)
    try:
        with drawing(page_of(arguments)):
            style.save(figure, arguments.output, arguments.dpi)
    except UserWarning as error:
        raise BadFile(f"{arguments.output}: its panels do not fit on the page; give a larger --width or a smaller --font-size") from error


def figure_of(result: Result, arguments: argparse.Namespace, draw: Callable[[Result, argparse.Namespace], Figure]) -> Figure:
    """The figure that `draw` makes of a result, laid out on its page.

    Values that no run writes and that no figure can show are the file's fault.
    """
    try:
        with warnings.catch_warnings(), drawing(page_of(arguments)):
            warnings.simplefilter("ignore")  # values that are not there (NaN), axes of one value
            figure = lay_out(draw(result, arguments))
            scale_strokes(figure, page_of(arguments).scale)
            if getattr(arguments, "theme", "light") == "dark":
                darken(figure)
            return figure
    except (ArithmeticError, LookupError, TypeError, ValueError, Warning) as error:
        reason = " ".join(str(error).split())
        raise BadFile(f"{result.path}: holds values that cannot be drawn ({type(error).__name__}: {reason})") from error


def title_text(result: Result) -> str:
    """The scene's title, or the file's name: plain text, to be drawn with parse_math=False."""
    return "".join(letter if letter.isprintable() else "?" for letter in result.title)


def entitle(figure: Figure, result: Result, *parts: str) -> None:
    """The title that the page asks for, else the scene's, above the figure; the parts that are not empty below it."""
    title = current().heading or title_text(result)
    heading = figure.suptitle(title, x=0.01, ha="left", fontsize="large", fontweight="bold", parse_math=False)
    footer = figure.supxlabel(SEPARATOR.join(filter(None, parts)), x=0.01, ha="left", fontsize="small", color=style.FAINT)
    if isinstance(figure, Picture):
        figure.heading, figure.footer = heading, footer
