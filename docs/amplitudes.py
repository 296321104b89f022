"""The tables of docs/howto/amplitude.md: .venv/bin/python docs/amplitudes.py

Each cell is an answer of kapitza.needs. The page's text stands in the page; its two tables are written between their
marks.
"""

import math
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

import kapitza  # noqa: E402

PAGE = Path(__file__).resolve().parent / "howto" / "amplitude.md"
LENGTHS = ["5 cm", "10 cm", "15 cm", "20 cm", "30 cm", "50 cm"]
FREQUENCIES = [10, 20, 30, 40, 50, 60, 80, 100, 120]
# Name -> amplitude (mm) and frequency (Hz) that it reaches without being built for this.
SHAKERS = {"loudspeaker, 25 cm wide": (4, 50), "jigsaw, stroke 20 mm": (10, 45),
           "sewing machine motor, crank 3 mm": (3, 100)}


def smallest(length: str, hertz: float) -> float:
    """The smallest amplitude for standing, mm."""
    return 1e3 * float(kapitza.needs(length, hertz)["stands"][0])


def row(hertz: float) -> str:
    """A line of the first table."""
    return " | ".join([f"| {hertz} Hz", *(f"{smallest(length, hertz):.3g}" for length in LENGTHS)]) + " |"


def shaker(name: str) -> str:
    """A line of the second table: which lengths stand on this shaker."""
    amplitude, hertz = SHAKERS[name]
    stands = [length for length in LENGTHS if smallest(length, hertz) <= amplitude]
    force = amplitude * 1e-3 * (2 * math.pi * hertz) ** 2 / 9.80665
    return (f"| {name} | {amplitude} mm | {hertz} Hz | {force:.0f} g | "
            f"{'up to ' + stands[-1] if stands else 'none of these'} |")


def tables() -> dict[str, str]:
    """Mark -> the lines between it and its end."""
    first = ["| frequency | " + " | ".join(LENGTHS) + " |", "| --- |" + " --- |" * len(LENGTHS), *map(row, FREQUENCIES)]
    second = ["| shaker | amplitude | frequency | acceleration | stands |", "| --- | --- | --- | --- | --- |",
              *map(shaker, SHAKERS)]
    return {"amplitudes": "\n".join(first), "shakers": "\n".join(second)}


def main() -> None:
    text = PAGE.read_text()
    for mark, table in tables().items():
        text = re.sub(rf"(<!-- {mark} -->\n\n).+?(\n\n<!-- end -->)", rf"\g<1>{table}\g<2>", text, flags=re.DOTALL)
    PAGE.write_text(text)


if __name__ == "__main__":
    main()
