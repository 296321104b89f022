"""kapitza plot [KIND] FILE: one table says which function draws which kind of result, reports on it, opens it to
ParaView, or makes a film of pictures. Without KIND the main study of the file is drawn. The command kapitza-plot does
the same."""

import sys
from collections.abc import Callable
from functools import partial

from kapitza import recording, vtkhdf
from kapitza.exit_status import run_apart
from kapitza.plots import kinds, picture
from kapitza.program import ERROR
from kapitza.report import command as report
from kapitza.representation import main_kind
from kapitza.result import Result

# KIND -> a function that takes the other words of the command line.
_MAINS: dict[str, Callable[[list[str]], None]] = {"film": recording.main, "report": report.main, "vtkhdf": vtkhdf.main}
KINDS = {kind: _MAINS.get(kind) or partial(picture.main, kind) for kind in sorted({*_MAINS, *kinds.KINDS})}
USAGE = f"""\
usage: kapitza plot [KIND] FILE [options]
KIND: {', '.join(KINDS)}; without it the main study of FILE is drawn
kapitza plot KIND --help says which options there are."""


def main(*kind: str) -> None:
    """Draws what the command line asks for, and ends; `kind` goes before its words."""
    words = [*kind, *sys.argv[1:]]
    if words[:1] in (["-h"], ["--help"]):
        print(USAGE)
        return
    if words[:1] == [""]:
        print(f"{ERROR}plot: the name of FILE is empty; kapitza plot [KIND] FILE", file=sys.stderr)
        sys.exit(2)
    is_file = [word.startswith("-") for word in words[:2]] in ([False], [False, True])  # FILE [options]
    if not words or (words[0] not in KINDS and not is_file):
        print(USAGE, file=sys.stderr)
        sys.exit(2)
    run_apart(lambda: _draw(words))


def _draw(words: list[str]) -> None:
    if words[0] in KINDS:
        KINDS[words[0]](words[1:])
    else:
        KINDS[main_kind(Result(words[0]))](words)
