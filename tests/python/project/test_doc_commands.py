"""Every command of the how-tos, the tutorials and the README is run in the order in which a reader types it."""

import re
import subprocess

import pytest
from conftest import ROOT

ELSEWHERE = {"cluster", "other-languages", "page"}  # run by test_cluster.py, test_library.py, test_explorer_tab.py
PAGES = [ROOT / "README.md", ROOT / "docs" / "reference" / "python.md", ROOT / "docs" / "explanation" / "stability.md",
         *sorted((ROOT / "docs").glob("howto/*.md")), *sorted((ROOT / "docs").glob("tutorials/*.md"))]
LONG = {"first-basin", "map", "my-pendulum", "python", "questions", "shaker", "stability", "track", "why-it-stands"}
PAGES = [pytest.param(page, marks=[pytest.mark.extensive] * (page.stem in LONG), id=page.stem)
         for page in PAGES if page.stem not in ELSEWHERE]


def blocks(page):
    """(language, text) of the blocks that are to be run, or (text) that show lines which the block before prints."""
    return re.findall(r"^```(bash|python|text)\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.fixture
def clone(tmp_path):
    """A folder that looks like the clone in which a reader works; what is written stays in it."""
    for name in ("build", "scenes", "scripts", "python", ".venv"):
        (tmp_path / name).symlink_to(ROOT / name)
    return tmp_path


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_work(clone, page, user_python):
    texts = blocks(page)
    assert texts
    printed = session = ""
    for language, text in texts:
        if language == "text":
            lines = [line.rstrip() for line in printed.splitlines()]
            assert [line for line in text.splitlines() if line != "..." and line not in lines] == []
            continue
        if language == "bash":
            done = subprocess.run(["bash", "-euc", text], cwd=clone, capture_output=True, text=True)
        else:
            session = text if "import kapitza" in text else session + text  # else the session goes on
            done = user_python("-c", session, cwd=clone)
        assert done.returncode == 0, text + done.stdout + done.stderr
        printed = done.stdout


MESSAGES = re.findall(r"^\$ (kapitza .+)\n(.+)$", (ROOT / "docs" / "reference" / "messages.md").read_text(),
                      re.MULTILINE)


@pytest.mark.parametrize(("command", "message"), MESSAGES)
def test_the_program_says_what_the_page_of_messages_shows(clone, command, message):
    done = subprocess.run(["bash", "-c", f"build/{command}"], cwd=clone, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message + "\n")
