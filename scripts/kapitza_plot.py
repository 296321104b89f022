"""What the plotting scripts share: their arguments, and how a figure is entitled."""

import argparse
from pathlib import Path

import kapitza_style as style

FORMATS = (".png", ".svg", ".pdf")


def argument_parser(description, study):
    """A parser of what every script takes; `study`: what its file must hold, for the help."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help=f"result file that holds {study}")
    parser.add_argument("-o", "--output", type=Path, help="picture; .png, .svg or .pdf (default: FILE's name with .png, here)")
    parser.add_argument("--dpi", type=resolution, default=200)
    return parser


def resolution(text):
    """Dots per inch that a picture can have."""
    if not 10 <= int(text) <= 2400:
        raise argparse.ArgumentTypeError(f"{text} is out of range; from 10 to 2400")
    return int(text)


def parsed(parser):
    """The arguments, with the picture's name."""
    arguments = parser.parse_args()
    arguments.output = arguments.output or Path(f"{Path(arguments.file).stem or 'picture'}.png")
    if arguments.output.suffix.lower() not in FORMATS:
        parser.error(f"{arguments.output}: the name must end in {', '.join(FORMATS)}")
    return arguments


def title_text(result):
    """The scene's title, or the file's name: plain text, to be drawn with parse_math=False."""
    title = str(result.attributes.get("title") or result.path.stem)
    return "".join(letter if letter.isprintable() else "?" for letter in title)


def entitle(figure, result, *parts):
    """The scene's title above the figure, the parts that are not empty below it."""
    figure.suptitle(title_text(result), x=0.01, ha="left", fontsize=11, fontweight="bold", parse_math=False)
    figure.text(0.01, -0.01, "   |   ".join(filter(None, parts)), ha="left", va="top", fontsize=8, color=style.FAINT)
