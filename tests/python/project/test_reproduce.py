"""The table of figures: every scene that it names exists, every scene is named, every name is used once. The papers'
numbers."""

import csv
import json
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest
import reproduce
from conftest import PROGRAM, ROOT
from kapitza.command import KINDS
from kapitza.figures import COLUMN, FIGURES, PAGE, TUTORIALS
from papers import butikov
from papers.number import FAILED, Number
from papers.page import write_page
from papers.runs import Runs
from PIL import Image


def test_every_scene_has_a_figure_and_every_figure_a_scene():
    scenes = {path.stem for path in (ROOT / "scenes").glob("*.yaml")}
    assert {scene for _, scene, _, _ in FIGURES if "/" not in scene} == scenes


def test_names_are_used_once_and_kinds_exist():
    names = [name for name, _, _, _ in FIGURES]
    assert len(set(names)) == len(names)
    assert all(kind in KINDS for _, _, kind, _ in FIGURES)


def test_every_figure_has_one_style_and_keeps_its_colours_as_it_shrinks(tmp_path):
    assert all(options[-len(PAGE):] in (PAGE, COLUMN) and options.count("--dpi") == 1 for _, _, _, options in FIGURES)
    path = tmp_path / "a.png"
    noise = np.random.default_rng(1).integers(0, 2, (200, 200, 3),
                                              dtype=np.uint8) * np.array([240, 9, 77], dtype=np.uint8)
    Image.fromarray(noise).save(path, dpi=(300, 300))
    reproduce.shrink(path)
    kept = Image.open(path)
    assert kept.mode == "P" and round(kept.info["dpi"][0]) == 300 and np.abs(np.array(kept.convert("RGB")).astype(int)
                                                                             - noise).max() <= 4


def test_the_pages_show_figures_of_print_size():
    """One column of a journal or two, 300 dots per inch; what no table draws is named here."""
    known = {name: options for name, _, _, options in FIGURES} | {name: options for name,
                                                                  (_, _, _, options) in TUTORIALS.items()}
    shown = {name for name in reproduce.shown() if not name.startswith("drawing-")}
    assert len(shown) > 40 and shown - known.keys() == {"explorer", "explorer-phone", "explorer-story", "scaling"}
    known["scaling"] = ["178mm"]  # benchmarks/scaling.py
    for name in shown & known.keys():
        picture = Image.open(ROOT / "docs" / "figures" / f"{name}.png")
        picture.load()  # whole, not the beginning of a file
        millimetres = 178 if "178mm" in known[name] else 86
        assert round(picture.info["dpi"][0]) == 300 and abs(picture.width - millimetres / 25.4 * 300) < 2, name
    drawings = {path.stem: path.read_text() for path in (ROOT / "docs" / "figures").glob("drawing-*.svg")}
    widths = {name: float(re.search(r'width="([\d.]+)pt"', text)[1]) / 72 * 25.4 for name, text in drawings.items()}
    assert all(min(abs(width - 86), abs(width - 178)) < 0.1 for width in widths.values()), widths
    assert not any("font-family" in text or "<text" in text for text in drawings.values())


def test_scenes_say_what_they_show_and_how_to_run_them():
    for path in (ROOT / "scenes").glob("*.yaml"):
        text = path.read_text()
        assert text.startswith("# ") and f"build/kapitza run scenes/{path.name}" in text, path.name


def test_the_list_shows_the_table():
    script = ROOT / "scripts" / "reproduce.py"
    done = subprocess.run([sys.executable, script, "--list", "small"], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.split()[:2] == ["small", "scenes/small.yaml"]


def test_the_gallery_names_every_figure_of_the_papers():
    gallery = (ROOT / "docs" / "reference" / "gallery.md").read_text()
    scenes = [path.stem for path in (ROOT / "scenes").glob("b*-fig*.yaml")]
    assert len(scenes) > 30 and not [name for name in scenes if f"`{name}`" not in gallery]


@pytest.mark.extensive
def test_the_commands_of_the_gallery_are_valid(kapitza, tmp_path):
    """Each is tried as far as the checks before the work: its keys, its values, its steps."""
    commands = re.findall(r"^\| .* \| `(scenes/.*)` \|$", (ROOT / "docs" / "reference" / "gallery.md").read_text(),
                          re.MULTILINE)
    assert len(commands) >= 6
    for command in commands:
        scene, *words = shlex.split(command)
        done = kapitza("run", ROOT / scene, *words, "--time-limit", "1e-6", "--force", folder=tmp_path, status=None)
        assert done.returncode == 0 or done.returncode == 75 and "time limit" in done.stderr, (command, done.stderr)


def test_a_number_agrees_within_half_a_digit_or_its_bar():
    """What is printed counts to half a unit of its last digit, a reference to its bar; a remark that explains nothing
    fails."""
    def found(ours, **more):
        return Number("place", "quantity", ours, **more).agreement
    assert found(0.12905, printed="0.129") == found(0.1285, printed="0.129") == found(37.8, printed="40",
                                                                                      printed_bar=5) == "right"
    assert found(0.1284, printed="0.129") == found(1.0, reference=1.1,
                                                   bar=0.09) == found(float("nan"), reference=1) == FAILED
    assert found(0.1284, printed="0.129", remark="why") == "erratum" and found(0.129, printed="0.129",
                                                                               remark="why") == FAILED
    assert found(0.1284, printed="0.129", remark="why", kind="approximation") == "approximation"
    assert found(0.129, printed="0.129", reference=0.13, bar=1e-6) == FAILED


@pytest.mark.extensive
def test_a_part_of_the_papers_numbers(kapitza):
    """The cheapest parts are found anew; the page in docs/ holds every part of them, with what is not right
    explained."""
    known = json.loads((ROOT / "tests" / "literature" / "reference.json").read_text())
    with Runs(PROGRAM) as runs:
        numbers = [number for part in (butikov.zones, butikov.turns, butikov.subharmonic_orbits)
                   for number in part(runs, known)]
    assert len(numbers) > 100 and {number.agreement for number in numbers} == {"right", "approximation", "erratum"}
    page = ROOT / "docs" / "validation" / "results.md"
    with page.with_suffix(".csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {(number.place, number.quantity) for number in numbers} <= {(row["place"], row["quantity"]) for row in rows}
    assert len(rows) > 900 and "FAILED" not in {row["agreement"]
                                                for row in rows} and f"of the {len(rows)} numbers" in page.read_text()


def test_a_number_that_fails_is_said(tmp_path):
    wrong = Number("Fig. 1", "m", 0.2, "0.1")
    assert write_page([("A paper", [wrong, Number("Fig. 2", "k", 0.1, reference=0.1)])],
                      tmp_path / "results.md") == [wrong]
    text = (tmp_path / "results.md").read_text()
    assert "1 of the 2 numbers are right." in text and "paper. 1 failed." in text
    assert "| Fig. 1 | m | 0.1 | 0.2 | 1.0e-01 | FAILED |" in text and "1 numbers of its figures" in text
    rows = (tmp_path / "results.csv").read_text().splitlines()
    assert rows[1:] == ["A paper,Fig. 1,m,0.1,,0.2,,FAILED,", "A paper,Fig. 2,k,,0.1,0.1,,right,"]
