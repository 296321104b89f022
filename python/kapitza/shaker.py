"""How large the amplitude of the pivot must be: kapitza.needs and the command `kapitza needs`, whose help the program
has."""

import argparse
import json
import math
from typing import Any

from kapitza.exit_status import run_script, words_of
from kapitza.live import Live, change, finite
from kapitza.program import SceneError

GRAVITY = 9.80665  # m/s^2
USUAL_QUALITY = 20
MOTIONS = {"stands": "stands upside down", "flutters": "flutters"}


def needs(length: Any, frequency: Any, quality_factor: Any = None) -> dict[str, Any]:
    """How large the amplitude of the pivot must be for a pendulum to stand upside down.

    The answer has `stands` and `flutters`, the smallest and the largest amplitude (half of the stroke) in m, or None;
    `stands_g` and `flutters_g`, the peak accelerations of the pivot there in units of gravity; and `length` (m),
    `frequency` (Hz), `quality_factor`.

    :param length: of a point mass on a light rod: m, or a text such as "20 cm"
    :param frequency: of the pivot: Hz, or a text such as "50 Hz" or "3000 rpm"
    :param quality_factor: of small swings; None = 20
    :raises SceneError: if the program refuses a value
    """
    keys = {"length": length, "frequency": frequency, "quality_factor": USUAL_QUALITY if quality_factor is None
            else quality_factor}
    live = Live(f"{{{change(pendulum=keys | {'amplitude': 0})}}}")
    numbers, omega = live.parameters, live.parameters["pivot_frequency"]
    metres = GRAVITY * (numbers["drive_frequency"] / omega) ** 2
    if not 0 < numbers["k"] < 1:
        swings = omega / numbers["drive_frequency"] / (2 * math.pi)
        raise SceneError(f"frequency: {omega / (2 * math.pi):g} Hz is not above that of the pendulum's own swings, "
                         f"{swings:.4g} Hz; give a higher one", "pendulum.frequency")
    found: dict[str, Any] = {"length": metres, "frequency": omega / (2 * math.pi),
                             "quality_factor": numbers["quality_factor"]}
    drives = live.needs()
    for name, pair in zip(MOTIONS, (drives[:2], drives[2:]), strict=True):
        found[name] = [finite(drive * metres) for drive in pair]
        found[f"{name}_g"] = [finite(drive * metres * omega ** 2 / GRAVITY) for drive in pair]
    return found


def main() -> None:
    run_script(_main)


def _main() -> None:
    parser = argparse.ArgumentParser(prog="kapitza needs", add_help=False)
    for name in ("length", "frequency", "quality-factor"):
        parser.add_argument(f"--{name}")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args(words_of(["--json"]))
    for name in ("length", "frequency"):
        if getattr(given, name) is None:
            raise SceneError(f"needs: --{name} is missing; kapitza needs --length 20 cm --frequency 50 Hz")
    try:
        found = needs(given.length, given.frequency, given.quality_factor)
    except SceneError as error:
        name = str(error.key).removeprefix("pendulum.")
        words = str(error).removeprefix("pendulum.").removeprefix(f"{name}: ")
        raise SceneError(f"--{name.replace('_', '-')}: {words}") from None
    print(json.dumps(found) if given.json else "\n".join(_lines(found)))


def _lines(found: dict[str, Any]) -> list[str]:
    swings = math.sqrt(GRAVITY / found["length"]) / (2 * math.pi)
    return [f"pendulum           length {100 * found['length']:.6g} cm, own swings {swings:.4g} Hz, quality factor "
            f"{found['quality_factor']:.6g}",
            f"pivot              {found['frequency']:.6g} Hz; amplitudes (half of the stroke) and peak accelerations:",
            *(f"{words:<19}{_amplitudes(found[name], found[f'{name}_g'])}" for name, words in MOTIONS.items())]


def _amplitudes(metres: list[float | None], gravities: list[float | None]) -> str:
    parts = [None if amplitude is None else f"{1e3 * amplitude:.4g} mm ({gravity:.3g} g)"
             for amplitude, gravity in zip(metres, gravities, strict=True)]
    if parts[0] is None:
        return "at no amplitude"
    return f"from {parts[0]}" + (" on; no end was found" if parts[1] is None else f" to {parts[1]}")
