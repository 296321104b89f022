"""Holds pages to the words of docs/develop/conventions.md: what its table "write, not" has under "not" stands in no
page.

    house_words.py FILE...      prints each place; status 1 where there is one. Code in back quotes may hold any word.
"""

import re
import sys
from pathlib import Path

STYLE = Path(__file__).resolve().parents[2] / "docs" / "develop" / "conventions.md"


def unwanted(style):
    """(word, what to write) of the table with the head "write, not", longest first."""
    table = style.split("\n| write | not |\n")[1].split("\n\n")[0]
    rows = [line.strip("|").split("|") for line in table.splitlines()][1:]
    pairs = [(word.strip(), better.strip()) for better, words in rows for word in words.split(",")]
    return sorted(pairs, key=lambda pair: -len(pair[0]))


def faults(text, pairs):
    """(line, word, what to write) of a page; blocks of code and code in a line are left out."""
    text = re.sub(r"^```.*?^```$", lambda block: "\n" * block[0].count("\n"), text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"`[^`\n]*`", "", text)
    found = [(text.count("\n", 0, hit.start()) + 1, word, better)
             for word, better in pairs for hit in re.finditer(rf"\b{re.escape(word)}\b", text, re.IGNORECASE)]
    return sorted(found)


def main():
    pairs = unwanted(STYLE.read_text())
    found = [f'{path}:{line}: "{word}": write {better}'
             for path in map(Path, sys.argv[1:]) if path.resolve() != STYLE for line, word,
             better in faults(path.read_text(), pairs)]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
