"""The sources keep their order: no include upwards, no circles, nothing kept, safe signal handlers."""

import re
import subprocess
import tempfile
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT

SOURCES = ROOT / "src"
HEADERS = ROOT / "include" / "kapitza"
FORTRAN = sorted(SOURCES.rglob("*.f90"))
LONGEST, LONGEST_OF_PACKAGE = 400, 280  # lines of a file


# Files and folders at the top of the repository.
TOP = """.ci .clang-format .dockerignore .editorconfig .gitignore .pre-commit-config.yaml .proselintrc.json
CHANGELOG.md CITATION.cff CMakeLists.txt CMakePresets.json CONTRIBUTING.md LICENSE LICENSES README.md
REUSE.toml SECURITY.md pyproject.toml
benchmarks cmake docs include packaging python scenes scripts src tests web""".split()


def test_top_of_the_repository_has_no_stray_file():
    """The output of a command that was added by mistake would also go into the source distribution."""
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    assert {name.split("/")[0] for name in tracked} == set(TOP)


def layers():
    """The layers that each layer may include: those below it, from CMakeLists.txt, and itself."""
    below = {}
    for name, rest in re.findall(r"^kapitza_layer\((\w+)([^)]*)\)", (ROOT / "CMakeLists.txt").read_text(),
                                 re.MULTILINE):
        direct = re.search(r"LAYERS ([a-z ]+)", rest)
        below[name] = {name}.union(*(below[layer] for layer in (direct[1].split() if direct else [])))
    return below


def test_a_module_is_named_after_its_folder_and_file():
    named = {path.relative_to(SOURCES): name for name, path in modules_and_uses()[0].items()}
    assert len(named) == len(FORTRAN)
    assert not {path: name for path, name in named.items() if name != f"kz_{path.parent.name}_{path.stem}"}


def test_no_file_is_long():
    folders = [SOURCES, HEADERS, ROOT / "tests", ROOT / "scripts", ROOT / "python", ROOT / "benchmarks", ROOT / "cmake"]
    files = [path for folder in folders for path in folder.rglob("*")
             if path.suffix in {".c", ".h", ".f90", ".inc", ".py", ".cmake"}]
    lines = {path: len(path.read_text().splitlines()) for path in files}
    assert not {str(path): n for path, n in lines.items()
                if n > (LONGEST_OF_PACKAGE if path.is_relative_to(ROOT / "python") else LONGEST)}


def rules(command):
    """[(targets, files)] of the make rules that a compiler prints."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=True, cwd=ROOT)
    return [[part.split() for part in rule.split(": ", 1)] for rule in done.stdout.replace("\\\n", " ").splitlines()
            if ": " in rule]


def of_objects(kept=None):
    """(C source, file that it includes, or that such a file includes), as ninja has kept it from the compiler."""
    if kept is None:
        kept = subprocess.run(["ninja", "-C", PROGRAM.parent, "-t", "deps"], capture_output=True, text=True,
                              check=True).stdout
    for block in kept.strip().split("\n\n"):
        first, *files = block.splitlines()
        if re.match(r"CMakeFiles/kapitza\w*\.dir/src/.*\.c\.o: .*VALID", first):  # else its source is gone
            assert files, (f"{first.split(':')[0]}: a build that was interrupted left an object without its includes; "
                           "delete it and build")
            path, *others = ((PROGRAM.parent / file.strip()).resolve() for file in files
                             if not file.strip().startswith("/usr"))
            yield from ((path, other) for other in others)


def of_headers():
    """The same of headers, in the folders that the sources of their layer see; libraries need not be found (-MG)."""
    compiler = ["cc", "-MM", "-MG", "-DKAPITZA_FUSED=0", f"-I{ROOT / 'include'}", f"-I{PROGRAM.parent / 'include'}"]
    for folder in (HEADERS, *SOURCES.iterdir()):
        headers = sorted(folder.rglob("*.h"))
        for _targets, files in rules([*compiler, f"-I{folder}", *headers]) if headers else ():
            path, *others = (ROOT / file for file in files)
            yield from ((path, other.resolve()) for other in others if other.exists())


@cache
def modules_and_uses():
    """{module: its file}, [(Fortran file, module or part of a file that it uses)]."""
    module, uses = {}, []
    with tempfile.TemporaryDirectory() as folder:
        compiler = ["gfortran", "-cpp", "-ffree-line-length-none", "-M", f"-I{PROGRAM.parent / 'modules'}",
                    f"-J{folder}", *(f"-I{path}" for path in SOURCES.iterdir())]
        for targets, files in rules([*compiler, *FORTRAN]):
            path, *others = (Path(file) for file in files)
            module |= {Path(target).stem: path for target in targets if target.endswith(".mod")}
            uses += [(path, other) for other in others if other.suffix in {".mod", ".inc"}]
    return module, uses


@cache
def edges():
    """(file, file whose text or module it uses, or that such a file uses), within the project, as the compilers
    tell."""
    module, uses = modules_and_uses()
    of_fortran = [(path, module.get(other.stem, other) if other.suffix == ".mod" else other.resolve()) for path,
                  other in uses]
    found = {pair for pair in [*of_objects(), *of_headers(), *of_fortran] if all(map(within, pair))}
    assert len(found) > 1000
    return found


def within(path):
    # Objects of removed sources stay
    return (path.is_relative_to(SOURCES) or path.is_relative_to(HEADERS)) and path.exists()


def layer_of(path):
    """A header is named after its layer, or after its layer and a part of it."""
    return path.stem.split("_")[0] if path.is_relative_to(HEADERS) else path.relative_to(SOURCES).parts[0]


def folder_of(path):
    """A file that lies beside folders, such as src/study/sweep_values.c, counts by itself, as does a plan, a part of
    study.h."""
    alone = (path.is_relative_to(HEADERS) or path.name == "plan.h"
             or path.parent.parent == SOURCES and path.parent.name == "study")
    return path.relative_to(ROOT).with_suffix("") if alone else path.parent.relative_to(ROOT)


def file_of(path):
    """A source and its header count as one file."""
    return path.relative_to(ROOT).with_suffix("")


def test_what_an_interrupted_build_has_left_is_named():
    with pytest.raises(AssertionError, match=r"src/a\.c\.o: a build that was interrupted"):
        list(of_objects("CMakeFiles/kapitza_app.dir/src/a.c.o: #deps 0, deps mtime 1 (VALID)"))


def test_no_include_goes_up():
    allowed = layers()
    up = [f"{path.relative_to(ROOT)} -> {other.relative_to(ROOT)}" for path, other in edges()
          if layer_of(other) not in allowed[layer_of(path)]]
    assert not up


def symbols():
    """(file, name, kind) of the symbols of all C objects: T is defined, U is needed."""
    objects = [path for path in (PROGRAM.parent / "CMakeFiles").glob("kapitza_*.dir/src/**/*.c.o")
               if source_of(path).exists()]
    done = subprocess.run(["nm", "-A", "-P", *objects], capture_output=True, text=True, check=True)
    rows = [re.match(r"(.*\.o): (\S+) (\w)", line) for line in done.stdout.splitlines()]
    return [(source_of(Path(row[1])), row[2], row[3]) for row in rows if row]


def source_of(path):
    """The source of an object."""
    return ROOT / str(path).split(".dir/")[1].removesuffix(".o")


def calls():
    """(file, file whose function it calls), as the linker sees them: no include shows a declaration that is written by
    hand."""
    found = symbols()
    place = {name: path for path, name, kind in found if kind == "T"}
    assert len(place) > 300
    return {(path, place[name]) for path, name, kind in found if kind == "U" and name in place}


def calls_of_studies():
    return ((path, other) for path, other in calls() if path.is_relative_to(SOURCES / "study"))


@pytest.mark.parametrize(("node_of", "pairs"), [(folder_of, edges), (file_of, edges), (file_of, calls),
                                                (folder_of, calls_of_studies)])
def test_no_folder_calls_itself_through_others(node_of, pairs):
    graph = {}
    for path, other in pairs():
        if node_of(path) != node_of(other):
            graph.setdefault(node_of(path), set()).add(node_of(other))
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(" <- ".join(map(str, circle.args[1])))


def test_the_labeller_knows_no_study():
    """It takes starts from a function of its caller. It included the plan of the basin, as 25 other files did."""
    names = {path.parent.name for path in SOURCES.glob("study/*/keys.c")} | {"cells"}
    includes = [(path.name, line) for path in SOURCES.glob("study/labelling/*.[ch]")
                for line in re.findall(r'^#include "(.+)"$', path.read_text(), re.MULTILINE)]
    found = [pair for pair in includes if names & {pair[1].split("/")[0],
                                                   pair[1].removesuffix(".h").removeprefix("kapitza/study_")}]
    assert found == []


# ---- no saved state ----


def writable(library):
    """{object: its variables} of a static library: what stands in sections that a program can write to. gfortran keeps
    descriptions of types there (__vtab_, __def_init_), to which nothing writes."""
    found, member = {}, None
    done = subprocess.run(["nm", "-f", "sysv", str(library)], capture_output=True, text=True, check=True)
    for line in done.stdout.splitlines():
        if named := re.match(r"Symbols from .*\[(.*)\]:", line):
            member = named[1]
        columns = [column.strip() for column in line.split("|")]
        if len(columns) != 7 or columns[3] not in ("OBJECT",
                                                   "TLS") or columns[6].startswith((".rodata", ".data.rel.ro")):
            continue
        if not re.search(r"_MOD___(vtab|def_init)_", columns[0]):
            found.setdefault(member, []).append(columns[0])
    return found


@pytest.mark.parametrize("layer", ["model", "kernel", "dynamics", "analysis", "study"])
def test_nothing_is_kept_between_two_calls(layer):
    assert not writable(PROGRAM.parent
                        / f"libkapitza_{layer}.a"), "what is kept belongs to an object that the caller owns"


@pytest.mark.parametrize("layer", ["common", "store", "parallel", "app"])
def test_tables_are_made_once(layer):
    """What other layers keep between two calls is made by pthread_once; the handlers of failures and signals are set by
    who begins."""
    for member, names in writable(PROGRAM.parent / f"libkapitza_{layer}.a").items():
        once = [name for name in names if name.startswith("once.")]
        handlers = {"memory.c.o", "status.c.o", "signals.c.o", "abandon.c.o", "border.c.o"}
        assert 2 * len(once) == len(names) or member in handlers, (member, names)


def test_writable_data_is_found():
    assert any("on_failure" in names for names in writable(PROGRAM.parent / "libkapitza_common.a").values())


# ---- memory ----


def test_memory_is_asked_for_where_it_is_checked():
    asks = {"malloc", "calloc", "realloc", "strdup", "strndup", "aligned_alloc"}
    unchecked = {str(path.relative_to(ROOT)) for path, name, _ in symbols() if name in asks
                 and path.parent.name != "common"}
    assert not unchecked, ("kz_malloc and the other functions of memory end the run where there is no memory "
                           "(include/kapitza/common.h)")


# ---- signal handlers ----

# POSIX.1-2017, 2.4.3: what a signal handler may call; the last two are of the compiler.
ASYNC_SAFE = {"_exit", "alarm", "close", "fstat", "lstat", "memchr", "memcmp", "memcpy", "memset", "pread", "read",
              "sleep", "stat", "strchr", "strlen", "unlink", "write", "__errno_location", "__stack_chk_fail"}
HANDLERS = {"record_signal", "end_overdue", "abandon_overdue", "at_abort", "exit_failed"}


def called():
    """{function: functions that it calls} of the objects of app and parallel, as the assembler sees them; what the
    compiler has split off a function (`.cold`, `.part.0`) counts as the function."""
    objects = [path for layer in ("app", "parallel")
               for path in (PROGRAM.parent / "CMakeFiles" / f"kapitza_{layer}.dir").rglob("*.c.o")
               if source_of(path).exists()]
    done = subprocess.run(["objdump", "-dr", "--no-show-raw-insn", *objects], capture_output=True, text=True,
                          check=True)
    found, function = {}, None
    for line in done.stdout.splitlines():
        if named := re.match(r"[0-9a-f]+ <([\w$]+)[^>]*>:", line):
            function = found.setdefault(named[1], set())
        elif call := re.search(r"R_\w+_(?:PLT32|CALL26|JUMP26)\s+(\w+)|\t(?:call|jmp|bl|b)\s+[0-9a-f]+ <([\w$]+)[^+]*>",
                               line):
            function.add(re.sub(r"^__(\w+)_chk$", r"\1", call[1] or call[2]))
    return found


def test_signal_handlers_make_safe_calls_alone():
    known, seen, unsafe = called(), set(), set()
    waiting = [(name, name) for name in HANDLERS]
    while waiting:
        name, path = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        if name not in known and name not in ASYNC_SAFE:
            unsafe.add(path)
        waiting += [(other, f"{path} -> {other}") for other in known.get(name, ())]
    assert not unsafe
    assert {"unlink", "write", "_exit", "kz_bytes_read"} <= seen


# ---- the guide for developers ----


def test_the_guide_names_files_that_exist():
    guide = (ROOT / "docs" / "develop" / "developer.md").read_text()
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", guide.split("| to add | touch |")[1].split("\n## ")[0],
                      re.MULTILINE)[1:]
    assert {word for name, _ in rows for word in name.split()} >= {
        "scheme", "study", "key", "variable", "measure", "level", "drive", "interpolation", "plot",
        "command", "curve", "colour", "test"}
    for name, files in rows:
        ways = [re.findall(r"`((?:src|include|python|scripts|docs|tests|scenes)/[^`]*)`", way)
                for way in files.split("; in Python")]
        most = {"a study": 5, "a drive": 5}.get(name, 3)
        assert all(1 <= len(way) <= most for way in ways), name
        paths = sum(ways, [])
        missing = [path for path in paths if not re.search("[A-Z]", path) and not (ROOT / path).exists()]
        assert not missing, name
    folders = re.findall(r"^\| `(src/[a-z/]+)` \|", guide, re.MULTILINE)
    assert folders and all((ROOT / folder).is_dir() for folder in folders)
    drawn = guide.split("```")[1]
    assert {path.name for path in (SOURCES / "dynamics").iterdir()} <= {folder.split("/")[2] for folder in folders
                                                                        if folder.count("/") > 1}
    assert {path.name for layer in ("study", "dynamics") for path in (SOURCES / layer).iterdir()
            if path.is_dir()} <= set(
        re.findall(r"\w+", drawn))
