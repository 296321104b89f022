"""The command lines of the package: what is wrong with one is said in one line, as the program says it."""

import argparse
import difflib
import re
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from kapitza.program import ERROR, REFUSED


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line and status 2. An operand `file` must not be empty."""

    def error(self, message: str) -> NoReturn:
        """Ends the command with what is wrong and, of an unknown option, the nearest one."""
        _, unknown, words = message.partition("unrecognized arguments: ")
        _, lacking, names = message.partition("the following arguments are required: ")
        if unknown:
            message = self._unknown(words.split()[0])
        elif lacking:
            message = f"{self._name}: {names.upper()} is missing; {self.prog} {names.upper()}"
        else:
            message = re.sub(r"^argument (?:\S+/)?(\S+): ", r"\1: ", message)
        print(f"{ERROR}{message}", file=sys.stderr)
        sys.exit(REFUSED)

    @property
    def _name(self) -> str:
        return self.prog.removeprefix("kapitza ")

    def _unknown(self, word: str) -> str:
        if not word.startswith("-"):
            return f"{word}: one argument too many; {self.prog} --help shows what it takes"
        nearest = difflib.get_close_matches(word.partition("=")[0], self._option_string_actions, 1, 0.8)
        return f"{word}: unknown option; " + (f"did you mean {nearest[0]}?" if nearest
                                              else f"{self.prog} --help lists the options")

    def parse_known_args(self, args: Sequence[str] | None = None,  # type: ignore[override]
                         namespace: Any = None) -> Any:
        found = super().parse_known_args(args, namespace)
        if "" in (sys.argv[1:] if args is None else args) and str(getattr(found[0], "file", "?")) in ("", "."):
            self.error(f"{self._name}: the name of FILE is empty; {self.prog} FILE")
        return found


def wrong_ending(name: Any, endings: Sequence[str]) -> str:
    """What is wrong with a name that has none of these endings."""
    listed = " or ".join(filter(None, [", ".join(endings[:-1]), endings[-1]]))
    return f"{name}: the name must end in {listed}"
