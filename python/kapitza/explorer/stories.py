"""Stories of the explorer: files of states of the page and sentences (docs/reference/explorer.md)."""

import math
from pathlib import Path

import yaml

from kapitza.bounded_reading import read_text
from kapitza.scene import read_yaml, texts
from kapitza.units import written_frequency

from .requests import BadRequest

WHOLE = {"title": str, "pendulum": dict, "window": dict, "steps": list}  # keys of a story
STEP = {"say": str, "pendulum": dict, "window": dict, "boundary": (int, float), "start": dict, "view": str, "fill": str,
        "map": str, "speed": (int, float), "glide": (int, float)}
LONGEST = 100  # characters of a value in a message
WORDS = {"view": ("pendulum", "trace", "phase", "strobe", "spectrum"), "fill": ("", "basins", "motion"),
         "map": ("on", "off")}


def written(folder):
    """The stories of a folder, in the order of their names."""
    return [read(read_text(path, "story"), path.name) for path in sorted(Path(folder).glob("*.yaml"))]


def read(text, name):
    """A story as the page takes it. BadRequest, with the place, where it is none. `name`: of its file."""
    try:
        story = read_yaml(text)
    except yaml.YAMLError as error:
        place, problem = getattr(error, "problem_mark", None), getattr(error, "problem", None) or error
        line = f":{place.line + 1}" if place else ""
        raise BadRequest(f"{name}{line}: is not YAML that a story can be: {_short(problem)}") from error
    _check(story, WHOLE, name, ("title", "pendulum", "steps"))
    for number, step in enumerate(story["steps"], 1):
        place = f"{name}: step {number}"
        _check(step, STEP, place, ("say",))
        for key, accepted in WORDS.items():
            if step.get(key, accepted[0]) not in accepted:
                known = ", ".join(word for word in accepted if word)
                raise BadRequest(f"{place}: {key}: {_short(step[key])} is unknown; it must be {known}")
        if unknown := sorted(step.get("pendulum", {}).keys() - story["pendulum"].keys()):
            raise BadRequest(f"{place}: pendulum.{_short(unknown[0])}: the story's own pendulum does not have this key")
        if "start" in step and not step["start"].keys() >= {"theta", "velocity"}:
            raise BadRequest(f"{place}: start: must have theta and velocity")
    return story | {"pivot_frequency": written_frequency(texts(story["pendulum"]))}


def _check(table, known, place, needed):
    """Refuses what is no mapping, lacks a key, or has one of another name or kind."""
    if not isinstance(table, dict):
        raise BadRequest(f"{place}: must be a mapping with the keys {', '.join(needed)}")
    for key, value in table.items():
        if key not in known:
            raise BadRequest(f"{place}: {_short(key)}: unknown key; known are {', '.join(known)}")
        if not isinstance(value, known[key]) or isinstance(value, bool) or (key != "steps" and not _is_plain(value)):
            raise BadRequest(f"{place}: {key}: {_short(value)} is not what this key takes")
    if missing := [key for key in needed if key not in table]:
        raise BadRequest(f"{place}: {missing[0]}: is missing")


def _is_plain(value):
    """Whether it is a text, a number, or lists and mappings of them: no date, nothing that is left out, no number
    beyond doubles."""
    if isinstance(value, dict):
        return all(isinstance(key, str) for key in value) and all(map(_is_plain, value.values()))
    if isinstance(value, list):
        return all(map(_is_plain, value))
    try:
        return isinstance(value, str | bool) or (isinstance(value, int | float) and math.isfinite(value))
    except OverflowError:
        return False


def _short(value):
    """As much of a value, in words, as a message needs."""
    try:
        words = str(value)
    except ValueError:  # Python writes no number of more than 4300 digits
        return "a number of thousands of digits"
    return words if len(words) <= LONGEST else f"{words[:LONGEST]} …"
