"""A picture of a result, for Python by keywords and for the command line by words: both name the options of its
kind."""

import argparse
import inspect
import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kapitza import style
from kapitza.options import Parser, wrong_ending
from kapitza.plots.dark_theme import darken
from kapitza.plots.kinds import KINDS
from kapitza.plots.line_widths import scale_strokes
from kapitza.plots.page import BadOption, Page, drawing, lay_out
from kapitza.plots.page_options import add_page_options, page_of
from kapitza.result import BadFile, Result

FORMATS = (".png", ".svg", ".pdf")
FILES = ("help", "file", "output", "dpi")  # options of the command line alone
PAGES = ("width", "title", "no_title", "theme")  # options of a page, which an axes has already


def parser_of(kind: str) -> Parser:
    """The options of a kind; what is not given is left out, so that the keywords of its `draw` have the defaults."""
    parser = Parser(prog=f"kapitza plot {kind}", description=KINDS[kind].__doc__, argument_default=argparse.SUPPRESS,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help=f"result file that holds {KINDS[kind].STUDY}")
    parser.add_argument("-o", "--output", type=Path,
                        help="picture; .png, .svg or .pdf (default: FILE's name with .png, here)")
    parser.add_argument("--dpi", type=resolution)
    add_page_options(parser)
    KINDS[kind].add_options(parser)
    return parser


def resolution(text: str) -> int:
    """Dots per inch that a picture can have."""
    if not 10 <= int(text) <= 2400:
        raise argparse.ArgumentTypeError(f"{text} is out of range; give a number from 10 to 2400")
    return int(text)


def main(kind: str, words: list[str]) -> None:
    """Writes the picture that the words of a command line ask for, and prints its name."""
    parser = parser_of(kind)
    given = vars(parser.parse_args(words))
    file, dpi = given.pop("file"), given.pop("dpi", 200)
    ending = "-compare" if "other" in given else ""  # FILE.png is the basin itself
    output = given.pop("output", Path(f"{Path(file).stem or 'picture'}{ending}.png"))
    if output.suffix.lower() not in FORMATS:
        parser.error(wrong_ending(output, FORMATS))
    try:
        figure = drawn(Result(file), kind, given)
    except BadOption as error:
        parser.error(str(error))
    try:
        with drawing(_page(kind, given)):
            style.save(figure, output, dpi)
    except UserWarning as error:
        raise BadFile(
            f"{output}: its panels do not fit on the page; give a larger --width or a smaller --font-size") from error
    print(output)


def picture(result: Result, kind: str, ax: Axes | None = None, **options: Any) -> Figure:
    """The figure of a kind with these options, or that of `ax` with the picture in it.

    :raises BadOption: if the kind does not take an option or its value
    """
    if kind not in KINDS:
        raise BadOption(f"{kind!r} is not a kind of picture; the kinds are {', '.join(KINDS)}")
    actions = {action.dest: action for action in parser_of(kind)._actions if action.dest not in FILES}
    for name in options:
        if name not in actions:
            raise BadOption(f"{name!r} is no option of the kind {kind}; its options are {', '.join(actions)}")
        if ax is not None and name in PAGES:
            raise BadOption(f"{name} is of a page of its own; leave it out with ax")
    values = {name: _value(actions[name], value) for name, value in options.items() if value is not None}
    try:
        return drawn(result, kind, values, ax)
    except BadOption as error:
        raise BadOption(str(error).replace("--", "")) from None  # dashes stand for options of the command line


def _value(action: argparse.Action, value: Any) -> Any:
    """What an option becomes: of a text as the command line reads it, else the value itself, checked in the same
    way."""
    if action.nargs == 0:
        return bool(value)
    if action.nargs == "+":
        return [value] if isinstance(value, str) else [str(item) for item in value]
    if action.type is not None:
        read: Callable[[Any], Any] = action.type  # type: ignore[assignment]
        text = f"{value}in" if action.dest == "width" and not isinstance(value, str) else value
        try:
            value = read(text if isinstance(text, str | os.PathLike | Mapping) else str(text))
        except (argparse.ArgumentTypeError, ValueError) as error:
            raise BadOption(f"{action.dest}: {error}") from error
    if action.choices is not None and value not in action.choices:
        raise BadOption(f"{action.dest}: {value!r} is unknown; it must be one of {', '.join(map(str, action.choices))}")
    return value


def _page(kind: str, options: Mapping[str, Any], ax: Axes | None = None) -> Page:
    return page_of(options, getattr(KINDS[kind], "LEGEND", ""), ax)


def drawn(result: Result, kind: str, options: Mapping[str, Any], ax: Axes | None = None) -> Figure:
    """The figure that a kind makes of a result, laid out on its page; options are of the page or keywords of the kind.

    Values that no run writes and that no figure can show are the file's fault.
    """
    draw, page = KINDS[kind].draw, _page(kind, options, ax)
    mine = {name: value for name, value in options.items() if name in inspect.signature(draw).parameters}
    try:
        with warnings.catch_warnings(), drawing(page):
            warnings.simplefilter("ignore")  # values that are not there (NaN), axes of one value
            figure: Figure = lay_out(draw(result, **mine))
            if ax is None:
                scale_strokes(figure, page.scale)
            if options.get("theme") == "dark":
                darken(figure)
            return figure
    except BadOption:
        raise
    except (ArithmeticError, LookupError, TypeError, ValueError, Warning) as error:
        reason = " ".join(str(error).split())
        raise BadFile(f"{result.path}: holds values that cannot be drawn ({type(error).__name__}: {reason})") from error
