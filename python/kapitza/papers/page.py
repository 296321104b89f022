"""docs/validation/results.md, and what is said on the terminal."""

import json
from pathlib import Path

from . import blackburn, butikov, flutter, tongues
from .number import FAILED
from .runs import ROOT, Runs

PAPERS = [
    ("Blackburn, Smith and Groenbech-Jensen (1992)", blackburn.PARTS + flutter.PARTS),
    ("Butikov (2018)", butikov.PARTS + tongues.PARTS),
]
HEAD = """\
# Every number of the two papers

What the papers print, what this program finds, and the agreement. `scripts/reproduce --numbers` runs the program and writes this page;
do not edit.

- **right**: ours rounds to what is printed, or meets the reference within the stated bar.
- **approximation**: what is printed comes from a formula that its paper calls approximate; ours is exact.
- **erratum**: what is printed is not what the paper's own equations give; the last column says what is meant.
- **FAILED**: ours is neither, or an erratum no longer explains the difference.

References are values by other methods, with 10 to 16 digits (`tests/literature/reference.json`); how they were found is said in
[theory.md](../explanation/theory.md).
"""


def find_numbers(say):
    """[(title of the paper, its numbers)]; `say` hears what is being done."""
    known = json.loads((ROOT / "tests" / "literature" / "reference.json").read_text())
    found = []
    with Runs() as runs:
        for title, parts in PAPERS:
            numbers = []
            for part in parts:
                say(f"{title}: {part.__doc__.splitlines()[0]}")
                numbers += part(runs, known)
            found.append((title, numbers))
    return found


def write_page(found, path: Path):
    """The page; returns the numbers that failed."""
    every = [number for _, numbers in found for number in numbers]
    failed = [number for number in every if number.agreement == FAILED]
    counts = {word: sum(number.agreement == word for number in every) for word in ("right", "approximation", "erratum", FAILED)}
    lines = [HEAD, f"{len(every)} numbers: " + ", ".join(f"{count} {word}" for word, count in counts.items()) + ".\n"]
    lines += [
        "## What failed\n",
        *(_table(failed, "place", "quantity", "paper", "reference", "ours", "agreement") if failed else ["Nothing.\n"]),
    ]
    for title, numbers in found:
        printed = [number for number in numbers if number.printed]
        lines += [
            f"## {title}: what is printed\n",
            *_table(printed, "place", "quantity", "paper", "ours", "ours - paper", "agreement", "remark"),
            f"## {title}: what its figures and equations hold\n",
            *_table(
                [number for number in numbers if not number.printed],
                "place",
                "quantity",
                "reference",
                "ours",
                "ours - reference",
                "bar",
                "agreement",
            ),
        ]
    lines += [(Path(__file__).parent / "errata.md").read_text()]
    path.write_text("\n".join(lines))
    return failed


CELLS = {
    "place": lambda number: number.place,
    "quantity": lambda number: number.quantity,
    "paper": lambda number: ("about " if number.printed_bar else "") + number.printed or "-",
    "reference": lambda number: "-" if number.reference is None else f"{number.reference:.12g}",
    "ours": lambda number: f"{number.ours:.12g}",
    "ours - paper": lambda number: f"{number.ours - float(number.printed):.1e}",
    "ours - reference": lambda number: f"{number.ours - number.reference:.1e}",
    "bar": lambda number: f"{number.bar:.1e}" if number.bar else "equal",
    "agreement": lambda number: number.agreement,
    "remark": lambda number: number.remark,
}


def _table(numbers, *columns):
    rows = [f"| {' | '.join(columns)} |", f"|{' --- |' * len(columns)}"]
    return [*rows, *(f"| {' | '.join(CELLS[column](number) for column in columns)} |" for number in numbers), ""]
