"""The command `kapitza fit`: reads a recorded track, as laboratories write it, and fits a pendulum to it."""

import argparse
import io
import math
import os
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas
import yaml

from kapitza.bounded_reading import TABLE, read_bytes
from kapitza.fitting import Fit, fit
from kapitza.units import TURN, length_text

SEPARATORS = {"\t": "tabs", ";": "';'", ",": "','", r"\s+": "blanks"}
TIMES, ANGLES = ("time", "t", "zeit", "temps"), ("theta", "θ", "angle", "winkel", "phi", "φ")
SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6}
RADIANS = {
    "rad": 1.0,
    "mrad": 1e-3,
    "deg": math.pi / 180,
    "°": math.pi / 180,
    "degree": math.pi / 180,
    "degrees": math.pi / 180,
}


@dataclass(frozen=True)
class Track:
    """A recorded track: times in s, angles in rad, and what was read as what (`taken`)."""

    time: np.ndarray
    theta: np.ndarray
    taken: str


def read_track(path: str | os.PathLike[str], degrees: bool = False) -> Track:
    """The track in a text file with columns of times and angles: with tabs, semicolons, commas or blanks between
    them, decimal points or commas, names in the first row (or none, for two columns) and units in these or in a second
    row.

    :param degrees: whether angles without a unit are in degrees
    :raises ValueError: if the file is no such table
    """
    text, encoding = _decoded(read_bytes(path, TABLE, "track"))
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise ValueError("is empty; a track has columns of times and angles")
    separator = next((mark for mark in list(SEPARATORS)[:3] if all(mark in line for line in lines[:20])), r"\s+")
    table = pandas.read_csv(
        io.StringIO("\n".join(lines)),
        sep=separator,
        dtype=str,
        skipinitialspace=True,
        header=None,
        index_col=False,
        keep_default_na=False,
    )
    (time, theta), names, units, first = _columns(table)
    units = [unit or default for unit, default in zip(units, ("s", "deg" if degrees else "rad"), strict=True)]
    commas = bool(table.iloc[first:, [time, theta]].stack().str.contains(",").any())
    values = [_numbers(table[column].iloc[first:], commas) for column in (time, theta)]
    if wrong := np.flatnonzero(~np.isfinite(values[0] + values[1])).tolist():
        raise ValueError(f"row {wrong[0] + 1} holds no two finite numbers")
    for unit, known in zip(units, (SECONDS, RADIANS), strict=True):
        if unit not in known:
            raise ValueError(f"has a column in {unit!r}; the units are {', '.join(known)}")
    taken = (
        f"{values[0].size} samples, times of {names[0]} in {units[0]}, angles of {names[1]} in {units[1]}; "
        f"{SEPARATORS[separator]} between columns, decimal {'commas' if commas else 'points'}, {encoding}"
    )
    return Track(values[0] * SECONDS[units[0]], values[1] * RADIANS[units[1]], taken)


def _decoded(data: bytes) -> tuple[str, str]:
    """The text of a file and the name of its encoding, by its first bytes and by what its bytes can be."""
    for mark, name in ((b"\xff\xfe", "UTF-16"), (b"\xfe\xff", "UTF-16"), (b"\xef\xbb\xbf", "UTF-8-SIG")):
        if data.startswith(mark):
            return data.decode(name), name.removesuffix("-SIG")
    if b"\0" in data:
        return data.decode("UTF-16-LE" if data[1:2] == b"\0" else "UTF-16-BE"), "UTF-16"
    try:
        return data.decode("UTF-8"), "UTF-8"
    except UnicodeDecodeError:
        return data.decode("Latin-1"), "Latin-1"


def _columns(table: pandas.DataFrame) -> tuple[list[int], list[str], list[str], int]:
    """Times and angles: their columns, their names, their units ("" = not said), and the first row of numbers."""
    head = [str(cell).strip() for cell in table.iloc[0]]
    if len(head) >= 2 and all(_is_number(cell) for cell in head[:2]):
        return [0, 1], ["column 1", "column 2"], ["", ""], 0
    parts = [_name_and_unit(cell) for cell in head]
    places = [
        next((place for name in known for place, part in enumerate(parts) if part[0] == name), None)
        for known in (TIMES, ANGLES)
    ]
    if places[0] is None or places[1] is None:
        raise ValueError(f"has the columns {', '.join(head)}; it needs time (s) and theta (rad) or theta_deg")
    columns = [place for place in places if place is not None]
    units, first = [parts[place][1] for place in columns], 1
    if len(table) > 1 and not any(_is_number(str(table.iloc[1, place])) for place in columns):
        second = [str(table.iloc[1, place]).strip(" []()") for place in columns]
        units, first = [said or unit for said, unit in zip(second, units, strict=True)], 2
    return columns, [repr(head[place]) for place in columns], units, first


def _name_and_unit(cell: str) -> tuple[str, str]:
    """The name of a column in small letters and its unit, of "theta_deg", "Angle [°]" or "t / s"."""
    found = re.fullmatch(r"(\w+?)(?:\s*[\[(]\s*(.*?)\s*[\])]|\s*/\s*(\S+)|[_ ](\S+))?", cell.strip())
    if not found:
        return cell.lower(), ""
    return found[1].lower(), found[2] or found[3] or found[4] or ""


def _numbers(cells: pandas.Series, commas: bool) -> np.ndarray:
    plain = cells.str.strip().str.replace(",", ".", regex=False) if commas else cells
    return pandas.to_numeric(plain, errors="coerce").to_numpy(dtype=float)


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text.replace(",", ".")))
    except ValueError:
        return False


def _scene_line(found: Fit) -> str:
    """The pendulum of a scene; of a free decay with an example of a shaker that makes it stand."""
    if found.omega:
        pendulum, note = found.scene()["pendulum"], ""
    else:
        omega = TURN * max(50.0, 10 * found.best.values["omega0"] / TURN)
        standing = 1.2 * math.sqrt(2) * found.best.values["omega0"] / omega * found.length
        pendulum = found.scene(f"{omega / TURN:.4g} Hz", length_text(float(f"{standing:.3g}")))["pendulum"]
        note = "   # frequency and amplitude are examples; put those of your shaker"
    if math.isinf(found.quality_factor()):
        note += f"{',' if note else '   #'} quality_factor is the least that the track allows"
    return "pendulum: " + yaml.safe_dump(pendulum, default_flow_style=True, sort_keys=False, width=200).strip() + note


def main(words: Sequence[str] | None = None) -> None:
    """The command `kapitza fit`."""
    parser = argparse.ArgumentParser(prog="kapitza fit", description="finds the pendulum of a recorded track")
    parser.add_argument("track", type=Path, help="text file with columns of times and angles")
    parser.add_argument("--frequency", help="of the drive of a driven track: Hz, or with a unit such as 3000 rpm")
    parser.add_argument("--degrees", action="store_true", help="angles without a unit are in degrees")
    arguments = parser.parse_args(words)
    try:
        track = read_track(arguments.track, arguments.degrees)
        found = fit(track.time, track.theta, frequency=arguments.frequency)
    except (OSError, ValueError, pandas.errors.ParserError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else " ".join(str(error).split())
        print(f"kapitza: error: {arguments.track}: {reason}", file=sys.stderr)
        sys.exit(2)
    print(f"read: {track.taken}", found, _scene_line(found), sep="\n")
