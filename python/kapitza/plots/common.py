"""What the pictures share: their arguments, their page, and how a figure is entitled."""

import argparse
import warnings
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from kapitza import style
from kapitza.result import BadFile, Result

FORMATS = (".png", ".svg", ".pdf")


def argument_parser(kind: str, description: str | None, study: str) -> argparse.ArgumentParser:
    """A parser of what every kind takes; `study`: what its file must hold, for the help."""
    parser = argparse.ArgumentParser(prog=f"kapitza-plot {kind}", description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help=f"result file that holds {study}")
    parser.add_argument("-o", "--output", type=Path, help="picture; .png, .svg or .pdf (default: FILE's name with .png, here)")
    parser.add_argument("--dpi", type=resolution, default=200)
    return parser


def resolution(text: str) -> int:
    """Dots per inch that a picture can have."""
    if not 10 <= int(text) <= 2400:
        raise argparse.ArgumentTypeError(f"{text} is out of range; from 10 to 2400")
    return int(text)


def parsed(parser: argparse.ArgumentParser, words: list[str]) -> argparse.Namespace:
    """The arguments, with the picture's name."""
    arguments = parser.parse_args(words)
    arguments.output = arguments.output or Path(f"{Path(arguments.file).stem or 'picture'}.png")
    if arguments.output.suffix.lower() not in FORMATS:
        parser.error(f"{arguments.output}: the name must end in {', '.join(FORMATS)}")
    return arguments


def write_picture(arguments: argparse.Namespace, draw: Callable[[Result, argparse.Namespace], Figure]) -> None:
    """Writes the figure that `draw` makes of the file. Values that no run writes and that no figure can show are the file's fault."""
    style.use()
    result = Result(arguments.file)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # values that are not there (NaN), axes of one value
            figure = draw(result, arguments)
        style.save(figure, arguments.output, arguments.dpi)
    except (ArithmeticError, LookupError, TypeError, ValueError, Warning) as error:
        reason = " ".join(str(error).split())
        raise BadFile(f"{result.path}: holds values that cannot be drawn ({type(error).__name__}: {reason})") from error


def new_figure(width: float, height: float) -> Figure:
    """An empty page (inches) that no window shows; its panels are laid out when it is written."""
    return Figure(figsize=(width, height), layout="constrained")


def title_text(result: Result) -> str:
    """The scene's title, or the file's name: plain text, to be drawn with parse_math=False."""
    title = str(result.attributes.get("title") or result.path.stem)
    return "".join(letter if letter.isprintable() else "?" for letter in title)


def entitle(figure: Figure, result: Result, *parts: str) -> None:
    """The scene's title above the figure, the parts that are not empty below it."""
    figure.suptitle(title_text(result), x=0.01, ha="left", fontsize=11, fontweight="bold", parse_math=False)
    figure.text(0.01, -0.01, "   |   ".join(filter(None, parts)), ha="left", va="top", fontsize=8, color=style.FAINT)
