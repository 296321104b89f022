"""The command `kapitza where SCENE THETA VELOCITY`, whose help the program has: ends of starts for people, as CSV or as
JSON."""

import argparse
import json
import math
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NoReturn

from kapitza.exit_status import run_script, words_of
from kapitza.library import load
from kapitza.program import MOST_BYTES, SceneError, checked, scene_bytes
from kapitza.starts import MOST, UNDAMPED, ends

PRECISIONS = {"pairs": "pairs of doubles", "arbitrary": "as many digits as needed", "double": "double precision",
              "quad": "quad precision"}


def main() -> None:
    run_script(_main)


def _main() -> None:
    parser = argparse.ArgumentParser(prog="kapitza where", add_help=False)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--boundary")
    parser.add_argument("operands", nargs="+")
    given = parser.parse_args(words_of(["--json"]))
    name, *numbers = given.operands
    places, starts = _given_starts(name, numbers, given.boundary is not None)
    try:
        if given.boundary is not None:
            return _tell_boundary(_text(name), name, given, starts)
        rows, pendulum = ends(_text(name), name, given.set, *zip(*starts, strict=True))
    except SceneError as error:
        raise SceneError(_placed(str(error), places)) from None
    _tell(rows, pendulum, given.json, len(numbers) == 1, numbers)


def _refuse(words: str) -> NoReturn:
    raise SceneError(words)


def _text(name: str) -> bytes:
    """A scene file, or standard input."""
    return checked(sys.stdin.buffer.read(MOST_BYTES + 1), name) if name == "-" else scene_bytes(Path(name))


def _given_starts(name: str, numbers: list[str], is_boundary: bool) -> tuple[list[str], list[tuple[str, str]]]:
    """Where each start stands, and its two numbers."""
    if is_boundary and len(numbers) != 4:
        _refuse("--boundary: takes two starts; kapitza where SCENE THETA VELOCITY THETA VELOCITY --boundary DIGITS")
    if len(numbers) == 1:
        if numbers[0] != "-":
            _refuse("VELOCITY: is missing; kapitza where SCENE THETA VELOCITY, or - for starts on standard input")
        if name == "-":
            _refuse("-: the scene and the starts cannot both come from standard input; give a scene file")
        return _table()
    if not is_boundary and len(numbers) > 2:
        _refuse(f"{numbers[2][:80]}: one argument too many; two starts go with --boundary alone")
    if len(numbers) == 3:
        _refuse("VELOCITY: is missing")
    return ["where", "where, the second start"], list(zip(numbers[::2], numbers[1::2], strict=True))


def _table() -> tuple[list[str], list[tuple[str, str]]]:
    """Starts of standard input; a first line of names, and empty lines, are none."""
    places: list[str] = []
    starts: list[tuple[str, str]] = []
    for number, line in enumerate(sys.stdin, 1):
        if not line.strip() or (number == 1 and line.startswith("theta")):
            continue
        parts = [part.strip() for part in line.split(",")]
        if len(parts) != 2 or "\0" in line:
            _refuse(f'standard input:{number}: "{line.strip()[:60]}" is not a start; write theta,velocity')
        if len(starts) == MOST:
            _refuse(f"standard input:{number}: one start too many (at most {MOST})")
        places.append(f"standard input:{number}")
        starts.append((parts[0], parts[1]))
    if not starts:
        _refuse("standard input: holds no start; write lines theta,velocity")
    return places, starts


def _placed(message: str, places: list[str]) -> str:
    """The message with the place of a start for its number."""
    head, _, rest = message.partition(": ")
    words = head.split(" ")
    numbered = words[0] == "start" and len(words) == 2 and words[1].isdigit()
    return f"{places[int(words[1]) - 1]}: {rest}" if numbered else message


def _tell_boundary(text: bytes, name: str, given: argparse.Namespace, starts: list[tuple[str, str]]) -> None:
    try:
        digits = int(given.boundary)
    except ValueError:
        _refuse(f'--boundary: "{given.boundary[:40]}" is not a whole number; give a number of digits from 1 to 900')
    if not 1 <= digits <= 900:
        _refuse(f'--boundary: "{given.boundary[:40]}" is out of range; give a number of digits from 1 to 900')
    library = load()
    point = library.ffi.new("kapitza_boundary *")
    (angles, _), (speeds, _), (scene, _) = kept = [*map(library.texts, zip(*starts, strict=True)),
                                                   library.scene(text, name, given.set)]
    library.call("kapitza_boundary_of", scene, angles, speeds, digits, point)
    del kept
    theta, velocity, *names = (library.ffi.string(part).decode() for part in (point.theta, point.velocity, *point.name))
    ids = list(point.attractor)
    if given.json:
        print(json.dumps({"theta": theta, "velocity": velocity, "attractors": ids, "names": names}))
    else:
        between = " and ".join(f"{name} (attractor {id})" for name, id in zip(names, ids, strict=True))
        print(f"theta     {theta}\nvelocity  {velocity}\nbetween   {between}")


def _tell(rows: list[dict[str, Any]], pendulum: Mapping[str, float], as_json: bool, is_table: bool,
          numbers: list[str]) -> None:
    damped, omega = pendulum["beta"] > 0, pendulum["pivot_frequency"]
    if is_table and not as_json:
        print(",".join(rows[0]))
    for row in rows:
        if as_json:
            print(json.dumps(row, ensure_ascii=False))
        elif is_table:
            print(",".join(_cell(value) for value in row.values()))
        else:
            print("\n".join(_lines(row, omega, damped)))
    if not damped and (as_json or is_table):
        print(f"warning: {UNDAMPED}", file=sys.stderr)
    if not as_json and not is_table:
        _note(rows[0], numbers, omega)


def _cell(value: Any) -> str:
    """A value as CSV has it: of a list the first."""
    if isinstance(value, list):
        value = value[0] if value else None
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else shortest(value) if isinstance(value, float) else str(value)


def shortest(value: float) -> str:
    """The fewest digits that read back as the number."""
    return repr(value).removesuffix(".0")


def _lines(row: Mapping[str, Any], omega: float, damped: bool) -> Iterator[str]:
    """What a person is told; omega (rad/s) is NaN where the scene is not in SI units."""
    si = math.isfinite(omega)
    yield (f"theta = {row['theta']:.10g} ({math.degrees(row['theta']):.6g} deg), velocity = {row['velocity']:.10g}"
           + (f" ({row['velocity'] * omega:.6g} rad/s)" if si else ""))
    if row["attractor"] < 0:
        unsettled = "no known attractor: it has not settled"
        yield "ends on         " + (unsettled if damped else "nothing: without damping there are no attractors")
        return
    yield f"ends on         {row['name']} (attractor {row['attractor']})"
    for words, name in (("certain", "settling_time"), ("within 1 deg", "near_time")):
        if row[name] is not None:
            seconds = f" ({_seconds(row[name], omega)})" if si else ""
            yield f"{words:<15} after {row[name]} drive periods{seconds}"
    yield f"decided         {_decision(row)}"
    if row["turns"] is not None:
        yield f"turns           {row['turns']}"
    if row["period"] == 0:
        running = row["winding"] != 0
        closes = f"it never closes\nmean velocity   {row['mean_velocity']:.10g}"
        yield "period          none: " + (closes if running else "chaotic")
        return
    yield (f"period          {row['period']}\nwinding         {row['winding']}\nstrobe points   theta, velocity"
           + (", in deg and rad/s" if si else ""))
    for theta, velocity in zip(row["strobe_theta"], row["strobe_velocity"], strict=True):
        units = f"  {math.degrees(theta):12.6f}  {velocity * omega:12.6f}" if si else ""
        yield f"  {theta:18.12f}  {velocity:18.12f}{units}"


def _seconds(periods: int, omega: float) -> str:
    return f"{periods * 2 * math.pi / omega:.4g} s"


def _decision(row: Mapping[str, Any]) -> str:
    bound = f" (error at most {row['error']:.2g} rad when the trapping region holds the orbit)"
    other = row["other_name"] or "another attractor"
    words = f"yes, in {PRECISIONS[row['precision']]}" if row["decided"] else \
        f"no: the start ends on {row['name']} or on {other}, and quad precision cannot decide which"
    return words + (bound if row["error"] is not None else "")


def _note(row: Mapping[str, Any], numbers: list[str], omega: float) -> None:
    """A number without a unit may be meant in degrees, and in a scene in SI units in rad/s."""
    angle, speed = row["theta"], row["velocity"]
    if abs(angle) > 4 * math.pi and _is_number(numbers[0]):
        print(f'note            an angle without a unit is in rad; write "{angle:.6g} deg" for degrees')
    if math.isfinite(omega) and speed != 0 and "/s" not in numbers[1]:
        print(f"note            a velocity without a unit is in rad per drive radian: {speed:.6g} is "
              f'{speed * omega:.6g} rad/s; for rad/s write "{speed:.6g} rad/s"')


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False
