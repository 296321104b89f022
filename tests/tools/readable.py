"""What keeps a source from being read: comments that need the line above, functions of one word, macros without a
prefix, wide lines."""

import io
import re
import tokenize

WIDEST = 120
# A comment is not the end of the line above it, nor does it begin in lower case, unless with a name, a symbol or a
# unit.
OPENING = re.compile(r"(?:of|the same|and|those|that|which|what|so)\b", re.IGNORECASE)
LOWER = re.compile(
    r"[a-z]{2,}(?= )(?! ?(?:\[|\(|[-+*<>]?=|[<>]|->|/ ))(?!(?:rad|theta|omega|beta|sin|cos|out|theta'') )")
DIRECTIVE = re.compile(r"clang-format|NOLINT|fortitude|noqa|type:|!")
STATIC = re.compile(r"^(?:static|OPERATION|KZ_INLINE)\b[^;={(]*?\b([a-z0-9]+)\(", re.MULTILINE)
MACRO = re.compile(r"^#define (?!KZ_|KAPITZA_|__)(\w+)", re.MULTILINE)


def comments(suffix, text):
    """(line, text, whether it stands alone on its line) of each comment; comments of lines below each other are one."""
    if suffix == ".py":
        return in_lines(text, [(*token.start, token.string.lstrip("#: ")) for token in tokenize.generate_tokens(
            io.StringIO(text).readline) if token.type == tokenize.COMMENT])
    if suffix in (".c", ".h") or text.startswith("/*"):
        return in_c(text)
    found = re.finditer(r"(?:'[^'\n]*'|\"[^\"\n]*\"|[^!'\"\n])*(![><]?(?!\$|GCC).*)?$", text, re.MULTILINE)
    starts = [(text.count("\n", 0, one.start()) + 1, one.start(1) - one.start(), one[1].lstrip("!<> "))
              for one in found if one[1]]
    return in_lines(text, starts)


def in_c(text):
    for found in re.finditer(r"\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'|/\*(.*?)\*/", text, re.DOTALL):
        if found[1] is not None:
            before = text[text.rfind("\n", 0, found.start()) + 1:found.start()]
            yield text.count("\n", 0, found.start()) + 1, " ".join(re.sub(r"\n\s*\*", "\n",
                                                                          found[1]).split()), not before.strip()


def in_lines(text, found):
    """Joins what stands alone on lines below each other at one column."""
    lines, joined = text.split("\n"), []
    for line, column, comment in found:
        alone = not lines[line - 1][:column].strip()
        if alone and joined and joined[-1][3] == (line - 1, column):
            joined[-1] = (joined[-1][0], f"{joined[-1][1]} {comment}".strip(), True, (line, column))
        else:
            joined.append((line, comment.strip(), alone, (line, column) if alone else None))
    return [row[:3] for row in joined]


def faults(suffix, text):
    """(line, what is wrong) of a source."""
    found = [(line, f"the comment cannot be read alone: {comment[:60]}") for line, comment,
             alone in comments(suffix, text)
             if not DIRECTIVE.match(comment) and (OPENING.match(comment) or comment.endswith(",") or
                                                  alone and LOWER.match(comment))]
    if suffix in (".c", ".h", ".inc"):
        found += [(line_of(text, one), f"{one[1]} needs its object: verb_object") for one in STATIC.finditer(text)
                  if one[1] != "main"]
    return found + wide(text)


def wide(text):
    return [(number, f"has {len(line)} columns") for number, line in enumerate(text.split("\n"), 1)
            if len(line) > WIDEST]


def macros(text):
    """(line, what is wrong) of the macros of a public header."""
    return [(line_of(text, one), f"{one[1]} does not begin with KZ_") for one in MACRO.finditer(text)]


def line_of(text, found):
    return text.count("\n", 0, found.start()) + 1
