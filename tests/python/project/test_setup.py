"""The scripts of the set-up: what they say of themselves, and that a shell which sources them stays as it was."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT


def shell(*arguments):
    return subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True)


@pytest.mark.parametrize("name", ["setup", "quickstart", "test"])
def test_an_argument_starts_nothing(name):
    """They take none: --help, and anything else that was meant for another script, prints what they do."""
    asked, mistaken = shell(ROOT / "scripts" / name, "--help"), shell(ROOT / "scripts" / name, "all")
    assert (asked.returncode, mistaken.returncode) == (0, 1)
    assert asked.stdout == mistaken.stdout and asked.stdout.count("\n") in (1, 3) and "# " not in asked.stdout


@pytest.mark.extensive
def test_sourcing_leaves_the_options_of_the_shell():
    """With errexit left behind, the next command that fails would close the user's terminal."""
    done = shell("bash", "-c", "before=$-; source scripts/setup && [ $- = $before ] && command -v python")
    assert done.returncode == 0 and done.stdout.strip() == str(ROOT / ".venv" / "bin" / "python"), done.stderr


def test_what_fails_in_the_set_up_ends_the_script_that_needs_it(tmp_path):
    """A package that cannot be installed: no mark that it was, and its status, although the build was tried beside
    it."""
    (tmp_path / "scripts").mkdir()
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    (tmp_path / "scripts" / "setup").write_text((ROOT / "scripts" / "setup").read_text())
    (tmp_path / "scripts" / "requirements.txt").write_text("")
    for name in ("pip", "python"):
        (tmp_path / ".venv" / "bin" / name).write_text("#!/bin/sh\nexit 3\n")
        (tmp_path / ".venv" / "bin" / name).chmod(0o755)
    done = shell("bash", "-c", f"set -eu; source {tmp_path}/scripts/setup; echo reached")
    assert done.returncode == 3 and "reached" not in done.stdout
    assert not (tmp_path / ".venv" / "requirements.done").exists()


@pytest.mark.parametrize("ends, calls", [
    (["0"], ["--resume"]),
    (["2 belongs to another run", "2 belongs to another run", "0"], ["--resume", "--resume", "--force"]),
    (["2 out of range", "2 out of range"], ["--resume", "--resume"]),
    (["75 stopped", "0"], ["--resume", "--resume"])])
def test_quickstart_replaces_only_a_result_of_another_run(tmp_path, ends, calls):
    """Status 2 is said for any bad input; only a result of another scene or program is replaced. mpirun and the program
    are stubs."""
    (tmp_path / "scripts").mkdir()
    shutil.copy(ROOT / "scripts" / "quickstart", tmp_path / "scripts")
    (tmp_path / "scripts"
     / "setup").write_text(f'cd {tmp_path}; PATH={tmp_path}:$PATH; say() {{ echo "$says: $*"; }}\n')
    (tmp_path / "ends").write_text("".join(f"{end} \n" for end in ends))
    (tmp_path / "mpirun").write_text(
        '#!/bin/bash\necho "${!#}" >> calls\nread -r status words < <(sed -n "$(wc -l < calls)p" ends)\n'
                                     'echo "$words" >&2\nexit "$status"\n')
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "kapitza").write_text("#!/bin/sh\n: > picture\n")
    for name in ("mpirun", "build/kapitza"):
        (tmp_path / name).chmod(0o755)
    done = shell(tmp_path / "scripts" / "quickstart")
    assert (tmp_path / "calls").read_text().split() == calls, done.stderr
    complete = ends[-1] == "0"
    assert done.stdout.startswith("quickstart: mpirun -n 2 ")
    assert ("build/kapitza view scenes/" in done.stdout and ".venv/bin/python " in done.stdout) == complete
    assert (done.returncode == 0) == complete and (tmp_path / "picture").exists() == complete


def git(folder, *arguments):
    """Runs git with an author of its own; what it prints."""
    done = subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@t.invalid", *arguments], cwd=folder,
                          capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.fixture
def project(tmp_path):
    """A project with this one's set-up and version header, whose program prints its git revision and a word."""
    folder = tmp_path / "first"
    for name in ("scripts/setup", "cmake/Version.cmake", "cmake/version.h.in", "CMakePresets.json", ".gitignore"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    (folder / "scripts" / "requirements.txt").write_text("")
    (folder / ".venv").mkdir()
    (folder / ".venv" / "requirements.done").write_text("")
    (folder / "CMakeLists.txt").write_text("""\
cmake_minimum_required(VERSION 3.24)
project(kapitza VERSION 1.0 LANGUAGES C)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
include(cmake/Version.cmake)
add_executable(kapitza main.c)
target_include_directories(kapitza PRIVATE ${PROJECT_BINARY_DIR}/include)
add_dependencies(kapitza kapitza_version)
""")
    write_word(folder, "first")
    git(folder, "init", "--quiet")
    git(folder, "add", ".")
    git(folder, "commit", "--quiet", "--message", "first")
    return folder


def write_word(folder, word):
    (folder / "main.c").write_text('#include <stdio.h>\n#include "kapitza/version.h"\n'
                                   f'int main(void) {{ puts(KZ_GIT_REVISION " {word}"); }}\n')


def built(folder):
    """What the project's program prints after its set-up: revision and word."""
    done = shell(folder / "scripts" / "setup")
    assert done.returncode == 0, done.stderr
    return shell(folder / "build" / "kapitza").stdout.split()


@pytest.mark.extensive
def test_a_copied_or_moved_project_builds_its_own_sources(project):
    assert built(project)[1] == "first"
    copy, moved = project.with_name("copy"), project.with_name("moved")
    shutil.copytree(project, copy, symlinks=True)
    write_word(copy, "copied")
    assert built(copy)[1] == "copied" and built(project)[1] == "first"
    project.rename(moved)
    write_word(moved, "moved")
    assert built(moved)[1] == "moved"


def test_set_up_makes_the_package_importable_wherever_the_project_is_moved(project):
    """In .venv, without variables, from any folder; the second set-up changes nothing."""
    def imported(folder):
        done = subprocess.run([folder / ".venv" / "bin" / "python", "-c", "import kapitza; print(kapitza.__file__)"],
                              cwd="/", env={}, capture_output=True, text=True)
        return done.stdout.strip()

    subprocess.run([sys.executable, "-m", "venv", "--without-pip", project / ".venv"], check=True)
    (project / "python" / "kapitza").mkdir(parents=True)
    (project / "python" / "kapitza" / "__init__.py").touch()
    assert imported(project) == ""
    for _ in range(2):
        built(project)
        assert imported(project) == str(project / "python" / "kapitza" / "__init__.py")
    moved = project.rename(project.with_name("moved"))
    assert imported(moved) == str(moved / "python" / "kapitza" / "__init__.py")


def test_set_up_says_each_stage_with_its_time(project):
    """How long it takes and how much disk before it begins, a line for each stage, nothing the second time."""
    (project / ".venv" / "requirements.done").unlink()
    (project / ".venv" / "bin").mkdir()
    for name in ("pip", "python"):
        (project / ".venv" / "bin" / name).write_text("#!/bin/sh\n")
        (project / ".venv" / "bin" / name).chmod(0o755)
    first, second = (shell(project / "scripts" / "setup") for _ in range(2))
    lines = re.findall(r"^setup: \d+ min \d\d s: (.+)$", first.stdout, re.MULTILINE)
    assert len(lines) == len(first.stdout.splitlines()) and "minutes on two cores" in lines[0]
    assert "GB of disk" in lines[0]
    assert {"configuring and building build", "build is built", "the Python packages are installed"} < set(lines)
    assert (first.returncode, second.returncode, second.stdout) == (0, 0, ""), first.stderr


@pytest.mark.extensive
def test_the_revision_is_that_of_the_build(project):
    first = built(project)[0]
    assert first == git(project, "describe", "--always", "--abbrev=10")
    write_word(project, "second")
    assert built(project)[0] == first + "-dirty"
    git(project, "commit", "--quiet", "--all", "--message", "second")
    second = built(project)[0]
    assert second == git(project, "describe", "--always", "--abbrev=10") != first
    header = project / "build" / "include" / "kapitza" / "version.h"
    written = header.stat().st_mtime_ns
    assert built(project)[0] == second and header.stat().st_mtime_ns == written


def test_the_revision_is_never_that_of_a_repository_around_the_project(project):
    (project / ".git").rename(project.parent / ".git")
    assert built(project)[0] == "unknown"


def test_commands_of_the_docs_name_the_python_that_has_the_packages():
    """The system's python3 lacks them."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "scenes").glob("*.yaml"),
             *(ROOT / "scripts").glob("*.py")]
    calls = [(page.name, line) for page in pages for line in page.read_text().splitlines()
             if re.search(r"scripts/\w+\.py [-\w./*]+", line)]
    assert calls
    assert not [call for call in calls if ".venv/bin/python scripts/" not in call[1]]
