"""A scene as Python has it: the path of a file, YAML text, or a mapping; with the keys that a call changes."""

import atexit
import json
import os
import re
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from kapitza.bounded_reading import read_text

# Symbols that a scene may write instead of these keys of the pendulum and of the study stability.
SYMBOLS = {"Q": "quality_factor", "Omega": "drive_frequency", "epsilon": "drive_amplitude", "beta": "damping",
           "gamma": "torque_ratio"}
_PLAIN = re.compile(r"(?!-( |$))[\w.+/-]([\w.+/ -]*[\w.+/-])?")  # a text that YAML takes as it is, on one line


class _Dumper(yaml.emitter.Emitter, yaml.serializer.Serializer, yaml.representer.SafeRepresenter,
              yaml.resolver.BaseResolver):
    """Writes texts as they are: quoted only where YAML needs it, so that a number given as text stays a number."""

    def __init__(self, stream: Any, **options: Any) -> None:
        yaml.emitter.Emitter.__init__(self, stream, width=10**6, allow_unicode=True)
        yaml.serializer.Serializer.__init__(self)
        yaml.representer.SafeRepresenter.__init__(self, sort_keys=False)
        yaml.resolver.BaseResolver.__init__(self)

    def ignore_aliases(self, data: Any) -> bool:
        return True


class Scene:
    """`text`: YAML. `is_file`: whether it was read from `path`. `sets`: words `--set KEY=VALUE` of a command line."""

    def __init__(self, scene: "SceneLike", changes: Mapping[str, Any] | None = None, method: str | None = None) -> None:
        changes = dict(_single_keys(changes or {})) | ({"basin.method": method} if method else {})
        self.sets = [word for key, value in changes.items() for word in ("--set", f"{key}={flow(value)}")]
        self._changes = changes
        self.is_file = False
        self.path, self.text = Path(), ""
        if isinstance(scene, Scene):
            self.is_file, self.path, self.text = scene.is_file, scene.path, scene.text
            self.sets, self._changes = scene.sets + self.sets, scene._changes | changes
        elif isinstance(scene, Mapping):
            try:
                self.text = yaml.dump(texts(scene), Dumper=_Dumper)
            except RecursionError:
                raise ValueError("the scene is nested too deeply; a scene has four levels at most") from None
        elif _is_text(scene):
            self.text = str(scene)
        elif not isinstance(scene, str | os.PathLike):
            raise TypeError(f"a scene is the path of a file, YAML text or a mapping, not {scene!r}")
        else:
            self.is_file, self.path = True, Path(scene)
            self.text = _text_of(self.path)
        if not self.is_file and not isinstance(scene, Scene):
            self.path = write_scene(self.text)

    @property
    def stem(self) -> str:
        """The name of its result, without the folder and the suffix."""
        return self.path.stem if self.is_file else "scene"

    def tree(self) -> dict[str, Any]:
        """The scene as nested dicts and lists of texts, changes included; {} where it is no mapping."""
        tree = tree_of(self.text)
        for key, value in self._changes.items():
            put(tree, key, texts(value))
        return tree

    def value(self, key: str) -> Any:
        """What the scene gives a key: a text, list or dict; None where it is not given."""
        place: Any = self.tree()
        for name in key.split("."):
            place = place.get(name) if isinstance(place, dict) else None
        return place


SceneLike = str | os.PathLike[str] | Mapping[str, Any] | Scene


def _text_of(path: Path) -> str:
    """The text of a scene file; "" where it is none, which the program refuses."""
    try:
        return read_text(path, "scene", "replace") if path.is_file() else ""
    except ValueError:
        return ""


def _is_text(scene: Any) -> bool:
    """Whether it is YAML rather than the name of a file."""
    return isinstance(scene, str) and ("\n" in scene or (": " in scene and not Path(scene).exists()))


class _Plain:
    """Refuses what the program refuses in a scene: a few aliases stand for gigabytes, and tags for values of any
    kind."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        event = self.peek_event()  # type: ignore[attr-defined]
        for part, words in (("anchor", "an anchor (&name) or an alias (*name)"), ("tag", "a tag (!name)")):
            if getattr(event, part, None) is not None:
                raise yaml.MarkedYAMLError(problem=f"{words} stands here; write the value out",
                                           problem_mark=event.start_mark)
        return super().compose_node(parent, index)  # type: ignore[misc]


class _Texts(_Plain, yaml.BaseLoader):
    pass


class _Values(_Plain, yaml.SafeLoader):
    pass


def read_yaml(text: str, as_texts: bool = False) -> Any:
    """What a YAML text says, numbers as texts where `as_texts`; yaml.YAMLError where it is none, or has anchors,
    aliases or tags."""
    try:
        return yaml.load(text, _Texts if as_texts else _Values)
    except RecursionError:
        raise yaml.YAMLError("it is nested too deeply") from None
    except ValueError as error:  # the 99th of a month, a number of 5000 digits
        raise yaml.YAMLError(str(error)) from error


def tree_of(text: str) -> dict[str, Any]:
    """YAML text as nested dicts and lists of texts; {} where it is no mapping, of which the program says what is wrong.
    Symbols become the names of their keys."""
    try:
        tree = read_yaml(text, as_texts=True)
    except yaml.YAMLError:
        return {}
    return {key: _named(key, value) for key, value in tree.items()} if isinstance(tree, dict) else {}


def _named(key: str, value: Any) -> Any:
    """The value of a key of the scene with the names of its keys in place of their symbols."""
    if key not in ("pendulum", "stability") or not isinstance(value, Mapping):
        return value
    return {SYMBOLS.get(name, name): item for name, item in value.items()}


def _single_keys(changes: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """The changes by the full names of their keys: those of a mapping one by one; a key that stands alone is one of the
    pendulum, as a scene itself has mappings and a title only."""
    for name, value in ((str(name), value) for name, value in changes.items()):
        key = above + name
        if isinstance(value, Mapping) and value and (above or "." not in name):
            yield from _single_keys(value, f"{key}.")
        elif key.startswith("ramp.") or not (above or "." in name or name == "title" or isinstance(value, Mapping)):
            yield f"pendulum.{key}", value
        else:
            yield key, value


def put(tree: dict[str, Any], key: str, value: Any) -> None:
    """Sets a key such as basin.theta.count of a tree."""
    *above, last = key.split(".")
    if above in (["pendulum"], ["stability"]):
        last = SYMBOLS.get(last, last)
    for name in above:
        if not isinstance(tree.get(name), dict):
            tree[name] = {}
        tree = tree[name]
    tree[last] = value if above else _named(last, value)


def texts(value: Any) -> Any:
    """The value as nested dicts and lists of texts that the program reads."""
    if isinstance(value, Mapping):
        return {str(key): texts(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # a number or an array of numpy
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [texts(item) for item in value]
    if value is None:
        raise TypeError("a scene cannot contain None; leave the key out")
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def flow(value: Any) -> str:
    """The value on one line of YAML, as --set takes it."""
    plain = texts(value)
    if isinstance(plain, dict):
        return "{" + ", ".join(f"{key}: {flow(item)}" for key, item in plain.items()) + "}"
    if isinstance(plain, list):
        return "[" + ", ".join(map(flow, plain)) + "]"
    if not plain.isprintable():  # a line break in single quotes would become a blank
        return json.dumps(plain, ensure_ascii=False)
    return str(plain) if _PLAIN.fullmatch(plain) else "'" + plain.replace("'", "''") + "'"


@cache
def session_folder() -> Path:
    """A folder of this Python session, removed at its end: results and scenes that were given no name of their own. A
    forked process that ends leaves it to its parent."""
    folder, owner = Path(tempfile.mkdtemp(prefix="kapitza-")), os.getpid()
    atexit.register(lambda: shutil.rmtree(folder, ignore_errors=True) if os.getpid() == owner else None)
    return folder


def new_path(name: str) -> Path:
    """A path in the session's folder that nothing has yet."""
    return Path(tempfile.mkdtemp(dir=session_folder())) / name


def passed_on(text: str, file_name: bool = False) -> str:
    """The text, if a program can be given it; names of files may hold bytes that are no letters, which Python has as
    surrogates."""
    try:
        text.encode(errors="surrogateescape" if file_name else "strict")
    except UnicodeEncodeError as error:
        raise ValueError(f"{text[:60]!a} holds half of a character: {text[error.start]!a}") from None
    if "\0" in text:
        raise ValueError(f"{text[:60]!a} holds the character NUL")
    return text


def write_scene(text: str) -> Path:
    """A file with this text, for commands whose standard input holds something else."""
    path = new_path("scene.yaml")
    path.write_text(passed_on(text), encoding="utf-8")
    return path
