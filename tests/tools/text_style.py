"""Holds text files to .editorconfig: UTF-8, lines that end in one line feed, no blanks at their ends, no tabs.

    text_style.py FILE...      prints each place that differs; status 1 where there is one
"""

import sys
from pathlib import Path


def faults(data):
    """(line, what is wrong) of the bytes of a file."""
    try:
        lines = data.decode("utf-8").split("\n")
    except UnicodeDecodeError as error:
        return [(data[:error.start].count(b"\n") + 1, "is not UTF-8")]
    wrong = [("\r", "has a carriage return"), ("\t", "has a tab")]
    found = [(number, what) for number, line in enumerate(lines, 1) for sign, what in wrong if sign in line]
    found += [(number, "ends in blanks") for number, line in enumerate(lines, 1) if line != line.rstrip(" ")]
    if data and (lines[-1] or not lines[-2:][0]):
        found.append((len(lines), "must end in one line feed"))
    return found


def main():
    found = [f"{path}:{line}: {what}" for path in sys.argv[1:] for line, what in faults(Path(path).read_bytes())]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
