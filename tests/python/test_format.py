"""The hooks of .pre-commit-config.yaml on every file of the project."""

import re
import shlex
import subprocess
from pathlib import Path

import house_words
import pytest
import yaml
from conftest import ROOT
from text_style import faults

HOOKS = {hook["id"]: hook for hook in yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"][0]["hooks"]}
ENDINGS = {"python": {".py"}, "c": {".c", ".h"}, "markdown": {".md"}, "text": None}
BINARY = {".gif", ".png", ".h5"}


def files(kind):
    """The project's files of a type of pre-commit."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("needs the project's git repository")
    paths = [Path(name) for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]
    return [path for path in paths if (path.suffix not in BINARY if ENDINGS[kind] is None else path.suffix in ENDINGS[kind])]


@pytest.mark.parametrize("name", HOOKS)
def test_a_hook_finds_nothing(name):
    hook = HOOKS[name]
    names = [name for name in files(*hook["types"]) if not re.search(hook.get("exclude", "(?!)"), str(name))]
    assert len(names) > 20
    done = subprocess.run([*shlex.split(hook["entry"]), *names], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("data, found", [
    (b"", []), (b"a\n", []), (b"a\n\nb\n", []), (b"a", [(1, "must end in one line feed")]), (b"a\n\n", [(3, "must end in one line feed")]),
    (b"a \nb\n", [(1, "ends in blanks")]), (b"a\r\n", [(1, "has a carriage return")]), (b"\ta\n", [(1, "has a tab")]),
    (b"a\n\xff\n", [(2, "is not UTF-8")]),
])
def test_text_is_held_to_editorconfig(data, found):
    assert faults(data) == found


def test_house_words_are_read_from_the_style_page():
    pairs = house_words.unwanted((ROOT / "docs" / "develop" / "conventions.md").read_text())
    assert ("hangs on", "depends on") in pairs and len(pairs) > 10
    page = "It hangs\nwell, and\nHangs on it.\n```\nhangs on\n```\n`hangs on`\n"
    assert house_words.faults(page, pairs) == [(3, "hangs on", "depends on")]
