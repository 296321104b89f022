"""Procedures of Fortran and C sources: name, number of arguments, lines with those of inner procedures."""

import re

_FORTRAN = re.compile(r"\s*(?!end)(?:\w+(?:\((?:[^()]|\([^()]*\))*\))?\s+)*(subroutine|function)\s+(\w+)", re.I)
_C = re.compile(r"^(?!typedef|enum|extern)[A-Za-z_][^;{}=]*?\b(\w+)\(((?:[^();{}]|\([^()]*\))*)\)\s*\{", re.M)


def _count(words):
    """Arguments of a list, whose own brackets may hold commas."""
    flat = re.sub(r"\([^()]*\)", "", words).strip()
    return 0 if flat in ("", "void") else flat.count(",") + 1


def of_fortran(text):
    lines = [re.sub(r"'[^']*'|!.*", "", line) for line in text.splitlines()]
    for i, line in enumerate(lines):
        begun = _FORTRAN.match(line)
        if not begun:
            continue
        head, last = line.rstrip(), i
        while head.endswith("&"):
            last += 1
            head = head[:-1] + lines[last].strip()
        listed = re.match(r"\s*\(([^)]*)\)", head[begun.end():])
        depth, end = 1, last
        while depth > 0:
            end += 1
            depth += -1 if re.match(r"\s*end\s+(subroutine|function)\b", lines[end],
                                    re.I) else bool(_FORTRAN.match(lines[end]))
        yield begun[2], _count(listed[1]) if listed else 0, end - i + 1


def of_c(text):
    def blank(match):
        return "\n" * match[0].count("\n")

    plain = re.sub(r"^#(?:.*\\\n)*.*", blank, re.sub(r"/\*.*?\*/", blank, text, flags=re.S), flags=re.M)
    plain = re.sub(r'"(?:[^"\\\n]|\\.)*"|\'.\'', '""', plain)
    for begun in _C.finditer(plain):
        depth, end = 1, begun.end()
        while depth > 0:
            depth += {"{": 1, "}": -1}.get(plain[end], 0)
            end += 1
        yield begun[1], _count(begun[2]), plain[begun.start():end].count("\n") + 1
