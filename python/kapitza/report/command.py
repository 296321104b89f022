"""`kapitza plot report FILE [-o FILE.html]`."""

from pathlib import Path

from kapitza.options import Parser, wrong_ending
from kapitza.report.page import report
from kapitza.result import Result


def main(words: list[str]) -> None:
    """Writes the report of a result file, and prints its name."""
    parser = Parser(prog="kapitza plot report",
                    description="one self-contained page on a result: pictures, attractors, "
                                  "numbers, scene, provenance")
    parser.add_argument("file", help="result file")
    parser.add_argument("-o", "--output", type=Path, help="the page (default: FILE's name with .html, here)")
    given = parser.parse_args(words)
    output = given.output or Path(f"{Path(given.file).stem or 'report'}.html")
    if output.suffix.lower() != ".html":
        parser.error(wrong_ending(output, [".html"]))
    # A crafted text may hold what UTF-8 does not
    output.write_bytes(report(Result(given.file)).encode("utf-8", "replace"))
    print(output)
