"""Scenes of the explorer: what it is opened with, and the scene that gives a view."""

import copy
import math
from pathlib import Path

import yaml

from kapitza import units
from kapitza.bounded_reading import read_text
from kapitza.result import BadFile, Result
from kapitza.scene import flow, put, read_yaml, texts, tree_of
from kapitza.units import written_frequency

from . import picture
from .requests import BadRequest

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
# The window of a scene that has none: the whole circle, and velocities of two turns a shake.
WINDOW = {"theta": {"min": str(-math.pi), "max": str(math.pi)}, "velocity": {"min": "-2", "max": "2"}}
GRAVITY = 9.80665  # m/s^2, where a scene gives none
EDGES = ("min", "max", "centre", "width")
# Keys of a basin that a view has of its own, or does not need
LEFT_OUT = ("accuracy", "proof", "theta", "velocity", "method")


class Start:
    """A scene: of a file, of a result (whose groups bring overlays), of a picture that the page saved, or a text.
    `sets`: words KEY=VALUE that change it; `name`: as messages call it."""

    def __init__(self, source, is_text=False, sets=()):
        self.result, self.name = None, "the scene" if is_text else str(source)
        self.path = None if is_text else Path(source)
        if is_text:
            self.text = source
        elif (first := _first_bytes(self.path)) == HDF5_SIGNATURE:
            self.result = Result(self.path)
            self.text, self.path = _scene_of(self.result), None
        elif first == picture.SIGNATURE:
            self.text, self.path = picture.scene_in(self.path), None
        else:
            self.text = _text_of(self.path)
        self.sets = list(sets)
        self.tree = _changed(tree_of(self.text), self.sets)

    def engine(self):
        """The arguments of an engine of the scene: text, name, changes, starts of charts. A text that nobody wrote has
        no name."""
        sweep = self.tree.get("sweep")
        return self.text, "scene" if self.path is None else str(self.path), self.sets, sweep.get("ends") if isinstance(
            sweep, dict) else None

    def pendulum(self):
        """The mapping pendulum: numbers, and texts where the scene writes a unit or a word."""
        written = self.tree.get("pendulum")
        values = {name: _value(value) for name, value in written.items()} if isinstance(written, dict) else {}
        return {"gravity": GRAVITY} | values if values.keys() & {"length", "radius"} else values

    def window(self):
        """The window of the scene's basin, with the digits that it gives; in rad and rad per drive radian where it has
        units."""
        basin, omega = self.tree.get("basin"), written_frequency(self.pendulum())
        axes = basin if isinstance(basin, dict) else WINDOW
        return {"theta": _edges(axes.get("theta"), units.angle) or WINDOW["theta"],
                "velocity": _edges(axes.get("velocity"), lambda text: units.velocity(text, omega))
                or WINDOW["velocity"]}

    def view(self, request):
        """The scene of a view as people write it. What the scene leaves out stays left out."""
        tree = {name: copy.deepcopy(self.tree[name]) for name in ("title", "numerics") if name in self.tree}
        tree["pendulum"] = _mapping(request, "pendulum")
        window, basin = _mapping(request, "window"), self.tree.get("basin")
        kept = {name: value for name, value in basin.items() if name not in LEFT_OUT} if isinstance(basin, dict) else {}
        axes = {axis: {**_mapping(window, axis), "count": _count(request, name)} for axis, name in
                (("theta", "columns"), ("velocity", "rows"))}
        lines = (f"  {name}: {flow(value)}\n" for name, value in {**axes, "method": "exact", **kept}.items())
        return _written(tree) + "basin:\n" + "".join(lines)


def _scene_of(result):
    """The scene of a result as written, with the pendulum and the window that it was run with (they may have been set
    beside it)."""
    written, resolved = (tree_of(str(result.attributes.get(name, ""))) for name in ("scene", "scene_resolved"))
    if "pendulum" not in resolved:
        raise BadFile(f"{result.path}: holds no scene of a pendulum")
    tree = {name: value for name, value in written.items()
            if name in ("title", "numerics", "basin")} | {"pendulum": resolved["pendulum"]}
    if isinstance(resolved.get("basin"), dict):
        basin = tree["basin"] if isinstance(tree.get("basin"), dict) else {}
        tree["basin"] = basin | {axis: resolved["basin"][axis] for axis in ("theta", "velocity")
                                 if axis in resolved["basin"]}
    return _written(tree)


def _written(tree):
    return "".join(f"{name}: {flow(value)}\n" for name, value in tree.items())


def _changed(tree, sets):
    """The tree with the keys that --set changes; what cannot be read is refused by the program."""
    for word in sets:
        key, _, value = word.partition("=")
        try:
            put(tree, key, read_yaml(value, as_texts=True))
        except yaml.YAMLError:
            pass
    return tree


def _edges(axis, read):
    """Edges or middle of an axis, as written, or as `read` reads their units; None where they are not given."""
    found = {name: axis[name] for name in EDGES if name in axis} if isinstance(axis, dict) else {}
    try:
        return {name: value if _is_number(value) else read(value) for name, value in found.items()} \
            if found.keys() in ({"min", "max"}, {"centre", "width"}) else None
    except (TypeError, ValueError):
        return None


def _is_number(value):
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


def _value(value):
    """A number where the text is one."""
    if isinstance(value, dict):
        return {name: _value(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_value(item) for item in value]
    return float(value) if _is_number(value) else value


def _first_bytes(path):
    """As many as the signatures of a result and of a picture have."""
    if path.exists() and not path.is_file():
        raise BadFile(f"{path}: is not a regular file; give a scene or a result")
    try:
        with open(path, "rb") as file:
            return file.read(len(HDF5_SIGNATURE))
    except OSError as error:
        raise BadFile(f"{path}: cannot be read: {error.strerror}") from error


def _text_of(path):
    try:
        return read_text(path, "scene", "replace")
    except ValueError as error:
        raise BadFile(f"{path}: {error}") from None


def _mapping(request, name):
    value = request.get(name)
    if not isinstance(value, dict) or not value:
        raise BadRequest(f"{name}: must be a mapping")
    try:
        return texts(value)
    except TypeError:
        raise BadRequest(f"{name}: a key of it has no value") from None


def _count(request, name):
    value = request.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 1_000_000:
        raise BadRequest(f"{name}: must be a whole number from 1 to 1000000")
    return value
