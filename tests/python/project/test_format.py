"""The hooks of .pre-commit-config.yaml on every file of the project."""

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import house_words
import pytest
import readable
import yaml
from conftest import ROOT
from procedures import of_c, of_fortran
from text_style import faults

HOOKS = {hook["id"]: hook
         for hook in yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"][0]["hooks"]}
ENDINGS = {"python": {".py"}, "javascript": {".js"}, "c": {".c", ".h"}, "markdown": {".md"}, "text": None}
BINARY = {".gif", ".png", ".h5"}


def files(kind):
    """The project's files of a type of pre-commit."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("needs the project's git repository")
    paths = [Path(name) for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]
    return [path for path in paths
            if (path.suffix not in BINARY if ENDINGS[kind] is None else path.suffix in ENDINGS[kind])]


@pytest.mark.parametrize("name", HOOKS)
def test_a_hook_finds_nothing(name):
    hook = HOOKS[name]
    names = [name for name in files(*hook["types"]) if not re.search(hook.get("exclude", "(?!)"), str(name))]
    assert len(names) > 20
    command = shlex.split(hook["entry"])
    if not ((ROOT / command[0]).exists() or shutil.which(command[0])):
        pytest.skip(f"needs {command[0]}, which Debian's node-typescript has")
    done = subprocess.run([*command, *(names if hook.get("pass_filenames", True) else [])], cwd=ROOT,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("data, found", [
    (b"", []), (b"a\n", []), (b"a\n\nb\n", []), (b"a", [(1, "must end in one line feed")]),
    (b"a\n\n", [(3, "must end in one line feed")]),
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


# ---- names, comments and columns ----

CODE = {".c", ".h", ".f90", ".inc", ".py"}


def test_sources_can_be_read():
    """Each comment alone, static functions with their object, public macros with their prefix, 120 columns."""
    found = []
    for path in files("text"):
        text = (ROOT / path).read_text() if path.suffix in CODE | {".js", ".css", ".html"} else ""
        if path.suffix in CODE and path.parts[0] in ("src", "include", "tests", "python"):
            rows = readable.faults(path.suffix, text) + (readable.macros(text) if path.parts[0] == "include" else [])
        else:
            rows = readable.wide(text) if path.parts[0] == "web" else []
        found += [f"{path}:{line}: {wrong}" for line, wrong in rows]
    assert found == []


@pytest.mark.parametrize("suffix, text, lines", [
    (".c", "/* Of one. */\n/* Returns one. */\nint a; /* of it */ int b; /* rad */\n", [1, 3]),
    (".c", "/* which goes on */\n/* kz_name of it. */\n/* and */ char *s = \"/* of */\";\n/* Begins, */\n", [1, 3, 4]),
    (".c", "static int end(void);\nstatic int orbit_end(void);\nstatic const char *name(int a) {\n", [1, 3]),
    (".f90", "!> Of the first\n!> of the second\nx = '! of' ! of it\n!$omp of\ny = 1 !< rad\n  ! so far\n", [1, 3, 6]),
    (".py", "# What is it\n# that\nx = '# of'  # which\n# Sum\n# of it\n", [1, 3]),
    (".py", "x" * 120 + "\n" + "x" * 121 + "\n", [2]),
])
def test_unreadable_lines_are_found(suffix, text, lines):
    assert [line for line, _ in readable.faults(suffix, text)] == lines


def test_macros_of_public_headers_have_a_prefix():
    assert [line for line, _ in readable.macros("#define KZ_A 1\n#define B 2\n#define __C 3\n")] == [2]


# ---- size of procedures ----

LONGEST, MOST_ARGUMENTS = 60, 7
# Procedures that are larger, by file; a kernel and its interface in Fortran count twice.
LARGER = {
    "src/dynamics/api/follow.f90": {"follow_starts"},
    "src/dynamics/maps/map_table.f90": {"sum_nodes"},
    "src/dynamics/maps/sum_nodes.c": {"kz_sum_nodes"}, "src/kernel/digits/series.c": {"kz_series_add_product"},
    "src/kernel/linear.f90": {"floquet"}, "src/kernel/splitting/jets.c": {"advance_jet", "kz_jets_advance"},
    "src/kernel/splitting/jets.f90": {"advance_lanes", "advance_jets"},
    "src/kernel/splitting/processed/pair_products.c": {"kz_pair_bracket"},
    "src/kernel/splitting/processed/pair_products.f90": {"bracket_pairs"},
    "src/kernel/splitting/processed/processor.c": {"kz_processed_change"},
    "src/kernel/splitting/processed/processor.f90": {"change_lanes"},
    "src/kernel/splitting/processed/stages.c": {"kz_processed_kicks", "kz_processed_kicks_single"},
    "src/kernel/splitting/processed/stages.f90": {"run_stages", "run_single_stages", "run_tangents", "run_displaced"},
    "src/kernel/splitting/processed/tangents.c": {"move_tangents", "kz_processed_tangents", "kz_processed_displaced"},
    "src/kernel/taylor/pairs.c": {"run_stages", "kz_pairs_stages"},
    "src/kernel/taylor/pairs_table.f90": {"pairs_stages"},
    "src/library/api/labels.c": {"kapitza_labels"}, "src/library/api/motion.c": {"kapitza_orbit", "kapitza_manifold"},
    "src/study/live/engine.c": {"kz_engine_labels"}, "src/study/live/record.c": {"record_stretch"},
}


def larger(path):
    procedures = (of_fortran if path.suffix == ".f90" else of_c)(path.read_text())
    return {name for name, arguments, lines in procedures if arguments > MOST_ARGUMENTS or lines > LONGEST}


def test_procedures_are_short():
    """At most 60 lines with inner procedures, and 7 arguments; one that has become small leaves the list."""
    sources = [path for path in (ROOT / "src").rglob("*") if path.suffix in {".f90", ".c", ".h"}]
    found = {str(path.relative_to(ROOT)): larger(path) for path in sources}
    assert len(found) > 300 and {path: names for path, names in found.items() if names} == LARGER


def test_procedures_are_measured():
    fortran = """\
  pure integer(c_int64_t) function f(a, &
    b) result(c) ! end function
    integer :: end
    s = 'end subroutine'
  contains
    subroutine g
    end subroutine g
  end function f
"""
    c = """\
#define M(x) { \\
  x }
/* int f(int a) { */
static const int (*table)[2] = {0};
static void f(void) { g("}"); }

int g(int (*call)(int, int), const char *b) {
  if (b) { return '}'; }
  return 0;
}
"""
    assert list(of_fortran(fortran)) == [("f", 2, 8), ("g", 0, 2)]
    assert list(of_c(c)) == [("f", 0, 1), ("g", 2, 4)]
