"""docs/validation/results.md, results.csv beside it with every number, and what is said on the terminal."""

import csv
import json
from dataclasses import replace
from pathlib import Path

from . import blackburn, butikov, flutter, tongues
from .number import FAILED
from .runs import ROOT, Runs

BLACKBURN, BUTIKOV = "Blackburn, Smith and Groenbech-Jensen (1992)", "Butikov (2018)"
PAPERS = [(BLACKBURN, blackburn.PARTS + flutter.PARTS), (BUTIKOV, butikov.PARTS + tongues.PARTS)]
HEAD = """\
# Every number of the two papers

What the two papers print or draw, beside what this program finds.

`scripts/reproduce --numbers` runs the program and writes this page, and [results.csv](results.csv) with a row for each
number. `agreement` is one of four:

| word | meaning |
| --- | --- |
| `right` | The program's number rounds to the printed number, or it differs from the reference by at most the `bar` of its row. |
| `approximation` | The paper prints the result of a formula that it calls approximate. |
| `erratum` | The paper's own equations do not give the printed number. The remark says what is right. |
| `FAILED` | The two numbers differ and no remark explains why, or a remark explains a difference that does not exist. |

A reference is a value with 10 to 16 digits that was computed without this program (`tests/literature/reference.json`): cycles by
a Taylor-series integrator in 80-bit arithmetic, checked by another of order 8, linear problems by Hill determinants with 30 digits.
"""
SYMBOLS = {
    BLACKBURN: """\
If a row names neither Q nor Omega, they are 5 and 11. A release begins at rest; it fails if the pendulum leaves the inverted
position. Angles of releases are measured from there.
""",
    BUTIKOV: """\
n is the order of a subharmonic; curves 1 to 5 bound the zones of stability. Line j/n of an orbit has j/n of the drive's
frequency; Cj and Sj are its cosine and sine part, Aj its amplitude with a sign. Tongues 1 and 2 are the zones of parametric
resonance at k = 1/4 and 1, where they are tuned exactly.
""",
}


def find_numbers(say):
    """[(title of the paper, its numbers)]; `say` receives what is being done."""
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
    """The page, and every number as rows of a CSV file of its name; returns the numbers that failed."""
    every = [number for _, numbers in found for number in numbers]
    failed = [number for number in every if number.agreement == FAILED]
    right, approximate, erratum = (sum(number.agreement == word for number in every)
                                   for word in ("right", "approximation", "erratum"))
    summary = (f"{right} of the {len(every)} numbers are right. {approximate} differ because the paper approximates, "
               f"{erratum} because of an erratum in the paper. {len(failed)} failed.\n")
    lines = [HEAD, summary]
    lines += [
        "## What failed\n",
        *(_table(failed, "place", "quantity", "paper", "reference", "ours", "agreement") if failed
          else ["No number failed.\n"]),
    ]
    for title, numbers in found:
        differing = [number for number in numbers if number.printed and number.agreement != "right"]
        lines += [
            f"## {title}\n",
            *([SYMBOLS[title]] if title in SYMBOLS else []),
            *_table(_first_of_each(differing), "place", "quantity", "paper", "ours", "ours - paper", "agreement",
                    "remark"),
            _others([number for number in numbers if not number.printed]),
        ]
    lines += [(Path(__file__).parent / "errata.md").read_text()]
    path.write_text("\n".join(lines))
    with path.with_suffix(".csv").open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["paper", *COLUMNS])
        rows.writerows([title, *(COLUMNS[column](number) for column in COLUMNS)] for title, numbers in found
                       for number in numbers)
    return failed


def _first_of_each(numbers):
    """The first number of each place and remark, which says how many more there are."""
    groups = {}
    for number in numbers:
        groups.setdefault((number.place, number.remark), []).append(number)
    more = {key: f" (and {len(group) - 1} more)" if len(group) > 1 else "" for key, group in groups.items()}
    return [replace(group[0], quantity=group[0].quantity + more[key]) for key, group in groups.items()]


def _others(numbers):
    """A sentence on the numbers of figures and equations, which the paper does not print."""
    parts = [abs(number.ours - number.reference) / number.bar for number in numbers if number.bar]
    return (f"{len(numbers)} numbers of its figures and equations were compared with references; the largest "
            "difference is "
            f"{max(parts, default=0):.1g} of its bar.\n")


COLUMNS = {
    "place": lambda number: number.place,
    "quantity": lambda number: number.quantity,
    "printed": lambda number: ("about " if number.printed_bar else "") + number.printed,
    "reference": lambda number: "" if number.reference is None else f"{number.reference:.12g}",
    "ours": lambda number: f"{number.ours:.12g}",
    "bar": lambda number: f"{number.bar:.1e}" if number.bar else "",
    "agreement": lambda number: number.agreement,
    "remark": lambda number: number.remark,
}
CELLS = COLUMNS | {
    "paper": lambda number: COLUMNS["printed"](number) or "-",
    "reference": lambda number: COLUMNS["reference"](number) or "-",
    "ours - paper": lambda number: f"{number.ours - float(number.printed):.1e}",
}


def _table(numbers, *columns):
    rows = [f"| {' | '.join(columns)} |", f"|{' --- |' * len(columns)}"]
    return [*rows, *(f"| {' | '.join(CELLS[column](number) for column in columns)} |" for number in numbers), ""]
