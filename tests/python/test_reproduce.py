"""The table of figures: every scene that it names exists, every scene is named, every name is used once."""

import re
import shlex
import subprocess
import sys

from conftest import ROOT
from kapitza.command import KINDS
from kapitza.figures import FIGURES


def test_every_scene_has_a_figure_and_every_figure_a_scene():
    scenes = {path.stem for path in (ROOT / "scenes").glob("*.yaml")}
    assert {scene for _, scene, _, _ in FIGURES} == scenes


def test_names_are_used_once_and_kinds_exist():
    names = [name for name, _, _, _ in FIGURES]
    assert len(set(names)) == len(names)
    assert all(kind in KINDS and (ROOT / "scripts" / f"plot_{kind}.py").is_file() for _, _, kind, _ in FIGURES)


def test_scenes_say_what_they_show_and_how_to_run_them():
    for path in (ROOT / "scenes").glob("*.yaml"):
        text = path.read_text()
        assert text.startswith("# ") and f"build/kapitza run scenes/{path.name}" in text, path.name


def test_the_list_shows_the_table():
    script = ROOT / "scripts" / "reproduce.py"
    done = subprocess.run([sys.executable, script, "--list", "small"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout.split()[:2] == ["small", "scenes/small.yaml"]


def test_the_gallery_names_every_figure_of_the_papers():
    gallery = (ROOT / "docs" / "gallery.md").read_text()
    scenes = [path.stem for path in (ROOT / "scenes").glob("b*-fig*.yaml")]
    assert len(scenes) > 30 and not [name for name in scenes if f"`{name}`" not in gallery]


def test_the_commands_of_the_gallery_are_valid(kapitza):
    """Each is checked, not run: its keys, its values, its steps."""
    commands = re.findall(r"^\| .* \| `(scenes/.*)` \|$", (ROOT / "docs" / "gallery.md").read_text(), re.MULTILINE)
    assert len(commands) > 12
    for command in commands:
        kapitza("check", *shlex.split(command))
