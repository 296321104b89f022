"""Stories of the explorer: files of states of the page and sentences (docs/howto/stories.md)."""

from pathlib import Path

import yaml

from kapitza.scene import texts
from kapitza.units import written_frequency

from .scene import BadRequest

WHOLE = {"title": str, "pendulum": dict, "window": dict, "steps": list}  # keys of a story
STEP = {"say": str, "pendulum": dict, "window": dict, "boundary": (int, float), "start": dict, "view": str, "fill": str, "map": str,
        "speed": (int, float), "glide": (int, float)}
WORDS = {"view": ("pendulum", "trace", "phase", "strobe", "spectrum"), "fill": ("", "basins", "motion"), "map": ("on", "off")}


def written(folder):
    """The stories of a folder, in the order of their names."""
    return [read(path.read_text(encoding="utf-8"), path.name) for path in sorted(Path(folder).glob("*.yaml"))]


def read(text, name):
    """A story as the page takes it. BadRequest, with the place, where it is none. `name`: of its file."""
    try:
        story = yaml.safe_load(text)
    except (yaml.YAMLError, RecursionError) as error:
        place = getattr(error, "problem_mark", None)
        line = f":{place.line + 1}" if place else ""
        raise BadRequest(f"{name}{line}: is not YAML") from error
    _check(story, WHOLE, name, ("title", "pendulum", "steps"))
    for number, step in enumerate(story["steps"], 1):
        place = f"{name}: step {number}"
        _check(step, STEP, place, ("say",))
        for key, accepted in WORDS.items():
            if step.get(key, accepted[0]) not in accepted:
                raise BadRequest(f"{place}: {key}: {step[key]} is unknown; it must be {', '.join(word for word in accepted if word)}")
        if unknown := sorted(step.get("pendulum", {}).keys() - story["pendulum"].keys()):
            raise BadRequest(f"{place}: pendulum.{unknown[0]}: the story's own pendulum does not have this key")
        if "start" in step and not step["start"].keys() >= {"theta", "velocity"}:
            raise BadRequest(f"{place}: start: must have theta and velocity")
    return story | {"pivot_frequency": written_frequency(texts(story["pendulum"]))}


def _check(table, known, place, needed):
    """Refuses what is no mapping, lacks a key, or has one of another name or kind."""
    if not isinstance(table, dict):
        raise BadRequest(f"{place}: must be a mapping with the keys {', '.join(needed)}")
    for key, value in table.items():
        if key not in known:
            raise BadRequest(f"{place}: {key}: unknown key; known are {', '.join(known)}")
        if not isinstance(value, known[key]) or isinstance(value, bool):
            raise BadRequest(f"{place}: {key}: {value} is not what this key takes")
    if missing := [key for key in needed if key not in table]:
        raise BadRequest(f"{place}: {missing[0]}: is missing")
