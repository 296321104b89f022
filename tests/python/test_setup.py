"""The scripts of the set-up: what they say of themselves, and that a shell which sources them stays as it was."""

import re
import subprocess

import pytest
from conftest import ROOT


def shell(*arguments):
    return subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("name", ["setup", "quickstart", "test"])
def test_an_argument_starts_nothing(name):
    """They take none: --help, and anything else that was meant for another script, prints what they do."""
    asked, mistaken = shell(ROOT / "scripts" / name, "--help"), shell(ROOT / "scripts" / name, "all")
    assert (asked.returncode, mistaken.returncode) == (0, 1)
    assert asked.stdout == mistaken.stdout and asked.stdout.count("\n") in (1, 3) and "# " not in asked.stdout


def test_sourcing_leaves_the_options_of_the_shell():
    """With errexit left behind, the next command that fails would close the user's terminal."""
    done = shell("bash", "-c", "before=$-; source scripts/setup && [ $- = $before ] && command -v python")
    assert done.returncode == 0 and done.stdout.strip() == str(ROOT / ".venv" / "bin" / "python"), done.stderr


def test_what_fails_in_the_set_up_ends_the_script_that_needs_it(tmp_path):
    """A package that cannot be installed: neither a mark that it was, nor a build."""
    (tmp_path / "scripts").mkdir()
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    (tmp_path / "scripts" / "setup").write_text((ROOT / "scripts" / "setup").read_text())
    (tmp_path / "scripts" / "requirements.txt").write_text("")
    pip = tmp_path / ".venv" / "bin" / "pip"
    pip.write_text("#!/bin/sh\nexit 3\n")
    pip.chmod(0o755)
    done = shell("bash", "-c", f"set -eu; source {tmp_path}/scripts/setup; echo reached")
    assert done.returncode == 3 and "reached" not in done.stdout
    assert not (tmp_path / ".venv" / "requirements.done").exists() and not (tmp_path / "build").exists()


def test_commands_of_the_docs_name_the_python_that_has_the_packages():
    """The system's python3 lacks them."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "scenes").glob("*.yaml"), *(ROOT / "scripts").glob("*.py")]
    calls = [(page.name, line) for page in pages for line in page.read_text().splitlines() if re.search(r"scripts/\w+\.py [-\w./*]+", line)]
    assert len(calls) > 50
    assert not [call for call in calls if ".venv/bin/python scripts/" not in call[1]]
