"""The paper and the citation: sections, length, and figures that the validation pages hold."""

import re
import subprocess
import sys

import pytest
import yaml
from conftest import ROOT

PAPER = ROOT / "docs" / "paper" / "paper.md"


def test_it_has_the_sections_and_the_length_of_such_a_paper():
    text = PAPER.read_text()
    sections = ["Summary", "Statement of need", "State of the field", "Design", "Numbers", "Limits", "References"]
    assert re.findall(r"^## (.+)$", text, re.MULTILINE) == sections
    assert 750 <= len(text.split()) <= 1200


@pytest.mark.parametrize(("page", "words"), [
    ("validation/accuracy", "none of the 160,000 cells was wrong"),
    ("explanation/proof", "| 1000 x 1000 | 100 % | 0.08 % | 6e-5 | 14 | 0 of 2300 |")])
def test_its_numbers_are_those_of_the_validation(page, words):
    assert words in (ROOT / "docs" / f"{page}.md").read_text() and f"../{page}.md" in PAPER.read_text()


def test_its_speed_is_that_of_the_benchmark():
    low, high = re.search(r"some (\d+) to (\d+) times .*\(\[benchmarks\]", PAPER.read_text()).groups()
    measured = re.search(r"^\| direct \| (\d+) \(", (ROOT / "docs" / "validation" / "benchmarks.md").read_text(),
                         re.MULTILINE)[1]
    assert int(low) <= int(measured) <= int(high)


@pytest.mark.extensive
def test_the_page_is_made(tmp_path):
    pytest.importorskip("markdown_it", reason="scripts/requirements-docs.txt is not installed")
    done = subprocess.run([sys.executable, ROOT / "docs" / "paper" / "build.py", tmp_path], capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "<h2>Statement of need</h2>" in (tmp_path / "paper.html").read_text()


def test_the_citation_invents_nobody():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert cited["cff-version"] == "1.2.0" and cited["authors"] == [{"name": "The kapitza authors"}]
    assert {"title", "message", "version", "license", "type"} <= cited.keys()
