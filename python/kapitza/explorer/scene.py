"""Scenes of the explorer: where it begins, and what each view, orbit and saved file asks the program for."""

import copy
import json
import math
import sys
from pathlib import Path

from kapitza.result import BadFile, Result

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
# Of each way to give the pendulum: the keys that the sliders move, in the order drive amplitude, drive frequency, damping.
SLIDERS = [("drive_amplitude", "drive_frequency", "quality_factor"), ("m", "k", "damping"),
           ("pivot_amplitude", "pivot_frequency", "friction"), ("pivot_amplitude", "frequency", "friction")]
# The window of a scene that has none: the whole circle, and velocities of two turns a shake.
WINDOW = {"theta": {"min": -math.pi, "max": math.pi}, "velocity": {"min": -2.0, "max": 2.0}}
COARSE = {"icm": {"theta": 300, "velocity": 300}, "attractors": {"starts": 1024}}
MOST_CELLS = 2_000_000
NARROWEST = 1e-11     # width of a window, relative to its edges, whose pixels doubles can tell apart
PERIODS = (24, 400)  # drive periods of a motion that is played: at least, at most
SAMPLES = 48         # of a motion, a drive period


class BadRequest(Exception):
    """A request of the page that cannot be meant; the text says why."""


def read_resolved(text):
    """A resolved scene (block mappings, flow values: what the program writes) as nested dicts."""
    scene = {}
    parents = [scene]
    for line in filter(str.strip, text.splitlines()):
        name, _, value = line.strip().partition(":")
        depth = (len(line) - len(line.lstrip())) // 2
        del parents[depth + 1:]
        if value:
            parents[-1][name] = _value(value.strip())
        else:
            parents.append(parents[-1].setdefault(name, {}))
    return scene


def _value(text):
    """A number, a truth value, a text in double quotes, a word, or a list of them."""
    if text.startswith("["):
        return [_value(item.strip()) for item in text[1:-1].split(",")]
    try:
        return json.loads(text)
    except ValueError:
        return text


class Start:
    """What the explorer was opened with: a scene, or a result whose groups bring overlays."""

    def __init__(self, path, program):
        self.path = Path(path)
        self.result = None
        if _is_hdf5(self.path):
            self.result = Result(self.path)
            text = self.result.attributes.get("scene_resolved", "")
        else:
            text = program.resolved(self.path)
        whole = read_resolved(text)
        if "pendulum" not in whole:
            raise BadFile(f"{self.path}: holds no scene")
        self.scene = {key: whole[key] for key in ("title", "pendulum", "numerics", "basin") if key in whole}
        self.scene["basin"] = {**copy.deepcopy(WINDOW), **self.scene.get("basin", {})}
        for name in WINDOW:
            self.scene["basin"][name] = _edges(self.scene["basin"][name], f"{self.path}: basin.{name}")

    @property
    def title(self):
        return self.scene.get("title") or self.path.stem

    @property
    def window(self):
        """theta_min, theta_max, velocity_min, velocity_max."""
        return [self.scene["basin"][axis][end] for axis in ("theta", "velocity") for end in ("min", "max")]

    @property
    def sliders(self):
        """The keys of the pendulum that the page may change, with their values."""
        pendulum = self.scene["pendulum"]
        names = next(names for names in SLIDERS if names[0] in pendulum and names[1] in pendulum)
        return {name: pendulum[name] for name in names if name in pendulum}

    def moved(self, pendulum):
        """The scene's parts that every request shares, with the sliders where the page has them."""
        known = self.sliders
        if not isinstance(pendulum, dict) or not pendulum.keys() <= known.keys():
            raise BadRequest(f"the pendulum's keys here are {', '.join(known)}")
        values = {name: _number(value, name) for name, value in pendulum.items()}
        scene = {"pendulum": {**self.scene["pendulum"], **values}}
        return scene | ({"numerics": self.scene["numerics"]} if "numerics" in self.scene else {})

    def view(self, request, methods):
        """The scene of one view; `coarse`: a quick look with a coarse map table."""
        basin = {key: value for key, value in self.scene["basin"].items() if key not in ("accuracy", "proof")}
        width, height = (_count(request.get(name), name) for name in ("width", "height"))
        if width * height > MOST_CELLS:
            raise BadRequest(f"{width} x {height} cells are too many; at most {MOST_CELLS}")
        if request.get("method") not in methods:
            raise BadRequest(f"the method must be one of {', '.join(methods)}")
        window = request.get("window")
        if not isinstance(window, list) or len(window) != 4:
            raise BadRequest("the window must be a list of four numbers")
        low, high, slow, fast = (_number(value, "window") for value in window)
        basin |= {"theta": {"min": low, "max": high, "count": width}, "velocity": {"min": slow, "max": fast, "count": height}}
        basin["method"] = "icm" if request.get("coarse") else request["method"]
        if request.get("coarse"):
            basin |= {"icm": {**basin.get("icm", {}), **COARSE["icm"]},
                      "attractors": {**basin.get("attractors", {}), **COARSE["attractors"]}}
        return {"title": self.title} | self.moved(request.get("pendulum", {})) | {"basin": basin}

    def orbit(self, request, periods):
        """The scene of the motion from a start."""
        theta, velocity = (_number(request.get(name), name) for name in ("theta", "velocity"))
        least, most = PERIODS
        return self.moved(request.get("pendulum", {})) | {"orbit": {
            "start": {"theta": theta, "velocity": velocity},
            "periods": max(least, min(most, periods)), "samples_per_period": SAMPLES}}


def _edges(axis, place):
    """A window by its edges, also where the scene gives centre and width: the explorer's numbers are doubles."""
    if "centre" not in axis:
        return axis
    centre, width = (math.radians(float(text.removesuffix(" deg"))) if text.endswith(" deg") else float(text)
                     for text in (axis["centre"], axis["width"]))
    low, high = centre - width / 2, centre + width / 2
    if width < NARROWEST * max(abs(low), abs(high)):
        raise BadFile(f"{place}: is {width:g} wide, finer than the explorer can show; kapitza run can")
    return {key: value for key, value in axis.items() if key not in ("centre", "width")} | {"min": low, "max": high}


def _is_hdf5(path):
    try:
        with open(path, "rb") as file:
            return file.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE
    except OSError as error:
        raise BadFile(f"{path}: cannot be read: {error.strerror}") from error


def _number(value, name):
    if isinstance(value, bool) or not isinstance(value, int | float) or not -sys.float_info.max <= value <= sys.float_info.max:
        raise BadRequest(f"{name}: must be a finite number")
    return value


def _count(value, name):
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MOST_CELLS:
        raise BadRequest(f"{name}: must be a whole number from 1 to {MOST_CELLS}")
    return value


def block_text(mapping, depth=0):
    """A scene as people write it: one key a line, flow mappings for axes and lists."""
    lines = []
    for name, value in mapping.items():
        if isinstance(value, dict) and any(isinstance(item, dict) for item in value.values()) or (isinstance(value, dict) and depth == 0):
            lines += [f"{'  ' * depth}{name}:", block_text(value, depth + 1).rstrip("\n")]
        else:
            lines.append(f"{'  ' * depth}{name}: {_flow(value, name)}")
    return "\n".join(lines) + "\n"


def _flow(value, name):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(item, key)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_flow(item, name) for item in value) + "]"
    return value if isinstance(value, str) and name != "title" else json.dumps(value, ensure_ascii=False)
