"""Files that a user names are read up to a bound, since a name may lead to a file of any size."""

import io
import os
from pathlib import Path

SCENE, TABLE = 1_000_000, 64_000_000  # bytes of a scene or a story, which the program takes too, and of a table


def read_bytes(path: str | os.PathLike[str], most: int, what: str) -> bytes:
    """The bytes of a file of at most `most`; ValueError, with `what` it should be, for a larger one."""
    with open(path, "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise ValueError(f"is larger than {most // 1_000_000} MB; no {what} is that large")
    return data


def read_text(path: str | os.PathLike[str], what: str, errors: str = "strict") -> str:
    """The text of a file that is at most as large as a scene."""
    return read_bytes(path, SCENE, what).decode("utf-8", errors)


def table_file(path: str | os.PathLike[str]) -> io.BytesIO:
    """A table of at most 64 MB as a file in memory; the ValueError for a larger one names it."""
    try:
        return io.BytesIO(read_bytes(path, TABLE, "table"))
    except ValueError as error:
        raise ValueError(f"{Path(path)}: {error}") from None
