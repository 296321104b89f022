"""kapitza-plot KIND FILE: one table says which function draws which kind of result, reports on it, opens it to ParaView, or
makes a film of pictures."""

import sys
from collections.abc import Callable

from kapitza import recording, vtkhdf
from kapitza.plots import atlas, basin, chart, compare, orbit, potential, stability, sweep, tradeoff
from kapitza.report import command as report
from kapitza.script import run_apart

# KIND -> a function that takes the other words of the command line.
KINDS: dict[str, Callable[[list[str]], None]] = {
    "atlas": atlas.main,
    "basin": basin.main,
    "chart": chart.main,
    "compare": compare.main,
    "film": recording.main,
    "orbit": orbit.main,
    "potential": potential.main,
    "report": report.main,
    "stability": stability.main,
    "sweep": sweep.main,
    "tradeoff": tradeoff.main,
    "vtkhdf": vtkhdf.main,
}
USAGE = f"""\
usage: kapitza-plot KIND FILE [options]
KIND: {', '.join(KINDS)}
kapitza-plot KIND --help says which options there are."""


def main(kind: str | None = None) -> None:
    """Draws what the command line asks for, and ends; `kind`: given by the script, else the first word."""
    words = sys.argv[1:]
    if kind is None and words[:1] in (["-h"], ["--help"]):
        print(USAGE)
        return
    if kind is None and words[:1] and words[0] in KINDS:
        kind, *words = words
    if kind is None:
        print(USAGE, file=sys.stderr)
        sys.exit(2)
    draw = KINDS[kind]
    run_apart(lambda: draw(words))
