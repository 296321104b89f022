"""The sources keep their order: no include upwards, no circles, C headers that say what the Fortran entries are."""

import re
import subprocess
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT

SOURCES = ROOT / "src"
HEADERS = ROOT / "include" / "kapitza"
FORTRAN = sorted(SOURCES.rglob("*.f90"))
LONGEST, LONGEST_OF_PACKAGE = 350, 250  # lines of a file


def layers():
    """The layers that each layer may include: those below it, from CMakeLists.txt, and itself."""
    below = {}
    for name, rest in re.findall(r"^kapitza_layer\((\w+)([^)]*)\)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE):
        direct = re.search(r"LAYERS ([a-z ]+)", rest)
        below[name] = {name}.union(*(below[layer] for layer in (direct[1].split() if direct else [])))
    return below


def modules():
    """The file of each Fortran module."""
    return {name: path for path in FORTRAN for name in re.findall(r"^module (\w+)", path.read_text(), re.MULTILINE)}


def test_a_module_is_named_after_its_folder_and_file():
    named = {path.relative_to(SOURCES): name for name, path in modules().items()}
    assert not {path: name for path, name in named.items() if name != f"kz_{path.parent.name}_{path.stem}"}


def test_no_file_is_long():
    folders = [SOURCES, HEADERS, ROOT / "tests", ROOT / "scripts", ROOT / "python", ROOT / "benchmarks", ROOT / "cmake"]
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix in {".c", ".h", ".f90", ".inc", ".py", ".cmake"}]
    lines = {path: len(path.read_text().splitlines()) for path in files}
    assert not {str(path): n for path, n in lines.items() if n > (LONGEST_OF_PACKAGE if path.is_relative_to(ROOT / "python") else LONGEST)}


def place_of(include, path):
    """The file that `path` includes by that name."""
    layer = SOURCES / path.relative_to(SOURCES).parts[0] if path.is_relative_to(SOURCES) else SOURCES
    for folder in (path.parent, layer, ROOT / "include"):
        if (folder / include).is_file():
            return (folder / include).resolve()
    assert include == "kapitza/version.h", f"{path} includes {include}, which is nowhere"  # made by the build
    return None


def edges():
    """(file, file that it includes or whose module it uses), within the project."""
    module = modules()
    for path in sorted([*SOURCES.rglob("*.[ch]"), *SOURCES.rglob("*.inc"), *FORTRAN, *HEADERS.glob("*.h")]):
        text = path.read_text()
        for include in re.findall(r"""^ *#? *include ["']([^"']+)["']""", text, re.MULTILINE):
            if place := place_of(include, path):
                yield path, place
        for name in re.findall(r"^ *use (kz_\w+)", text, re.MULTILINE):
            yield path, module[name]


def layer_of(path):
    """A header is named after its layer, or after its layer and a part of it."""
    return path.stem.split("_")[0] if path.is_relative_to(HEADERS) else path.relative_to(SOURCES).parts[0]


def folder_of(path):
    """A file that lies beside folders, such as src/study/values.c, counts by itself, as does a plan, a part of study.h."""
    alone = path.is_relative_to(HEADERS) or path.name == "plan.h" or path.parent.parent == SOURCES and path.parent.name == "study"
    return path.relative_to(ROOT).with_suffix("") if alone else path.parent.relative_to(ROOT)


def file_of(path):
    """A source and its header count as one file."""
    return path.relative_to(ROOT).with_suffix("")


def test_no_include_goes_up():
    allowed = layers()
    up = [f"{path.relative_to(ROOT)} -> {other.relative_to(ROOT)}" for path, other in edges()
          if layer_of(other) not in allowed[layer_of(path)]]
    assert not up


def symbols():
    """(file, name, kind) of the symbols of all C objects: T is defined, U is needed."""
    objects = [path for path in (PROGRAM.parent / "CMakeFiles").glob("kapitza_*.dir/src/**/*.c.o") if source_of(path).exists()]
    done = subprocess.run(["nm", "-A", "-P", *objects], capture_output=True, text=True, check=True)
    rows = [re.match(r"(.*\.o): (\S+) (\w)", line) for line in done.stdout.splitlines()]
    return [(source_of(Path(row[1])), row[2], row[3]) for row in rows if row]


def source_of(path):
    """The source of an object."""
    return ROOT / str(path).split(".dir/")[1].removesuffix(".o")


def calls():
    """(file, file whose function it calls), as the linker sees them: no include shows a declaration that is written by hand."""
    found = symbols()
    place = {name: path for path, name, kind in found if kind == "T"}
    assert len(place) > 300
    return {(path, place[name]) for path, name, kind in found if kind == "U" and name in place}


def calls_of_studies():
    return ((path, other) for path, other in calls() if path.is_relative_to(SOURCES / "study"))


@pytest.mark.parametrize(("node_of", "pairs"), [(folder_of, edges), (file_of, edges), (file_of, calls), (folder_of, calls_of_studies)])
def test_no_circle(node_of, pairs):
    graph = {}
    for path, other in pairs():
        if node_of(path) != node_of(other):
            graph.setdefault(node_of(path), set()).add(node_of(other))
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(" <- ".join(map(str, circle.args[1])))


# ---- Fortran entries and their C headers ----

# The same number, by its name in C and by the one that gfortran takes.
KINDS = {"int32_t": "int", "int64_t": "long", "uint64_t": "long", "uint8_t": "signed char", "int16_t": "short", "__float128": "float128",
         "kz_status": "int"}


def without_comments(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL).replace("long double", "long_double")  # as gfortran writes it


def declared(text):
    """{function: (result, [parameter types])} of the prototypes and definitions in C text; a type is (const, name, pointer)."""
    found = {}
    for result, name, parameters in re.findall(r"^((?:const )?\w+[ *]+)(kz_\w+) ?\(([^()]*)\)[^;{]*[;{]", text, re.MULTILINE):
        types = [] if parameters.strip() in ("", "void") else [type_of(part) for part in parameters.split(",")]
        found[name] = (type_of(result + " it"), types)
    return found


def type_of(declaration):
    words = re.sub(r"\*", " ", declaration).split()
    const, pointer = "const" in words, "*" in declaration or "[" in declaration
    name = " ".join(word for word in words if word not in ("const", "struct"))
    name = name.rsplit(" ", 1)[0]
    return const, KINDS.get(name, name), pointer


def generated(path, folder):
    """What gfortran says of a file's bind(C) entries."""
    done = subprocess.run(["gfortran", "-cpp", "-ffree-line-length-none", "-fsyntax-only", "-fc-prototypes",
                           f"-I{PROGRAM.parent / 'modules'}", f"-J{folder}", f"-I{path.parent}", f"-I{ROOT / 'src' / 'kernel'}", str(path)],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return without_comments(done.stdout)


def agrees(fortran, c, structures):
    """Whether a type of a Fortran entry is the C one; `structures` collects the derived types that meet."""
    if fortran[1] == "void" and fortran[2]:
        return c[2]
    if fortran[1].endswith("_t") and c[1].startswith("kz_"):
        structures.add((fortran[1], c[1]))
        return fortran[2] == c[2] and fortran[0] == c[0]
    return fortran == c


@pytest.fixture(scope="module")
def entries(tmp_path_factory):
    """{Fortran file: gfortran's C text} of the files with bind(C) entries."""
    folder = tmp_path_factory.mktemp("modules")
    return {path: generated(path, folder) for path in FORTRAN if "bind(C" in path.read_text()}


def test_c_headers_declare_the_fortran_entries(entries):
    headers = {}
    for path in [*HEADERS.glob("*.h"), *SOURCES.rglob("*.[ch]"), *SOURCES.rglob("*.inc")]:
        headers |= declared(without_comments(path.read_text()))
    differing, known = [], 0
    for path, text in entries.items():
        for name, (result, parameters) in declared(text).items():
            there = headers.get(name)
            known += there is not None
            if there is None or len(there[1]) != len(parameters) or not agrees(result, there[0], set()) or not all(
                    agrees(one, other, set()) for one, other in zip(parameters, there[1], strict=True)):
                differing.append(f"{path.relative_to(ROOT)}: {name}: {result, parameters} in Fortran, {there} in C")
    assert not differing, "\n".join(differing)
    assert known > 40


def test_c_structures_are_the_fortran_types(entries):
    sources = {path: without_comments(path.read_text()) for path in [*HEADERS.glob("*.h"), *SOURCES.rglob("*.[ch]")]}
    functions_in_c = declared("\n".join(sources.values()))
    met, types = set(), {}
    for text in entries.values():
        types |= {name: body for body, name in re.findall(r"^typedef struct \w+ \{(.*?)\} (\w+);", text, re.DOTALL | re.MULTILINE)}
        for name, (_, parameters) in declared(text).items():
            for one, other in zip(parameters, functions_in_c.get(name, (None, []))[1], strict=False):
                agrees(one, other, met)
    members = {name for fortran, _ in met for name in types if re.search(rf"\b{name} ", types[fortran])}
    assert types.keys() == {fortran for fortran, _ in met} | members
    program = ["#include <stddef.h>", '#include "kapitza/dynamics.h"', '#include "kapitza/dynamics_curves.h"', '#include "vector/vector.h"',
               "typedef _Float128 float128;", *(f"typedef struct {{{types[name]}}} {name};" for name in sorted(members))]
    for path, text in sources.items():  # structures that only one C file needs
        if path.suffix == ".c" and any(f"}} {c};" in text for _, c in met):
            program += re.findall(r"^enum \{[^}]*\};|^typedef struct \{[^}]*\} kz_\w+;", text, re.MULTILINE)
    for fortran, c in sorted(met):
        program.append(f"typedef struct {{{types[fortran]}}} {fortran};")
        program.append(f'_Static_assert(sizeof({fortran}) == sizeof({c}), "size of {c}");')
        for field in re.findall(r"^ *(?!float128)\w+ (\w+)", types[fortran], re.MULTILINE):  # C keeps quads as bytes
            program.append(f'_Static_assert(offsetof({fortran}, {field}) == offsetof({c}, {field}), "{c}.{field}");')
            program.append(f'_Static_assert(sizeof((({fortran} *)0)->{field}) == sizeof((({c} *)0)->{field}), "size of {c}.{field}");')
    compiler = ["cc", "-x", "c", "-fsyntax-only", f"-I{ROOT / 'include'}", f"-I{SOURCES / 'kernel'}", "-"]
    done = subprocess.run(compiler, input="\n".join(program) + "\n", capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# ---- no saved state ----


def writable(library):
    """{object: its variables} of a static library: what stands in sections that a program can write to. gfortran keeps descriptions of
    types there (__vtab_, __def_init_), to which nothing writes."""
    found, member = {}, None
    done = subprocess.run(["nm", "-f", "sysv", str(library)], capture_output=True, text=True, check=True)
    for line in done.stdout.splitlines():
        if named := re.match(r"Symbols from .*\[(.*)\]:", line):
            member = named[1]
        columns = [column.strip() for column in line.split("|")]
        if len(columns) != 7 or columns[3] not in ("OBJECT", "TLS") or columns[6].startswith((".rodata", ".data.rel.ro")):
            continue
        if not re.search(r"_MOD___(vtab|def_init)_", columns[0]):
            found.setdefault(member, []).append(columns[0])
    return found


@pytest.mark.parametrize("layer", ["model", "kernel", "dynamics"])
def test_nothing_is_kept_between_two_calls(layer):
    assert not writable(PROGRAM.parent / f"libkapitza_{layer}.a"), "what is kept belongs to an object that the caller owns"


def test_writable_data_is_found():
    assert any("on_failure" in names for names in writable(PROGRAM.parent / "libkapitza_common.a").values())


# ---- memory ----


def test_memory_is_asked_for_where_it_is_checked():
    asks = {"malloc", "calloc", "realloc", "strdup", "strndup", "aligned_alloc"}
    unchecked = {str(path.relative_to(ROOT)) for path, name, _ in symbols() if name in asks and path.parent.name != "common"}
    assert not unchecked, "kz_malloc and its like end the run where there is no memory (include/kapitza/common.h)"


# ---- signal handlers ----

# POSIX.1-2017, 2.4.3: what a signal handler may call; the last two are of the compiler.
ASYNC_SAFE = {"_exit", "alarm", "close", "fstat", "lstat", "memchr", "memcmp", "memcpy", "memset", "pread", "read", "sleep", "stat",
              "strchr", "strlen", "unlink", "write", "__errno_location", "__stack_chk_fail"}
HANDLERS = {"note", "ring", "overdue", "at_abort", "give_up"}


def called():
    """{function: functions that it calls} of the objects of app and parallel, as the assembler sees them; what the compiler has split off a
    function (`.cold`, `.part.0`) counts as the function."""
    objects = [path for layer in ("app", "parallel") for path in (PROGRAM.parent / "CMakeFiles" / f"kapitza_{layer}.dir").rglob("*.c.o")
               if source_of(path).exists()]
    done = subprocess.run(["objdump", "-dr", "--no-show-raw-insn", *objects], capture_output=True, text=True, check=True)
    found, function = {}, None
    for line in done.stdout.splitlines():
        if named := re.match(r"[0-9a-f]+ <([\w$]+)[^>]*>:", line):
            function = found.setdefault(named[1], set())
        elif call := re.search(r"R_\w+_(?:PLT32|CALL26|JUMP26)\s+(\w+)|\t(?:call|jmp|bl|b)\s+[0-9a-f]+ <([\w$]+)[^+]*>", line):
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
    assert {"unlink", "write", "_exit", "kz_header_is_marked"} <= seen


# ---- the guide for developers ----


def test_the_guide_names_files_that_exist():
    guide = (ROOT / "docs" / "develop" / "developer.md").read_text()
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", guide.split("| to add | touch |")[1].split("\n## ")[0], re.MULTILINE)[1:]
    assert {word for name, _ in rows for word in name.split()} >= {
        "scheme", "study", "key", "variable", "measure", "level", "drive", "interpolation", "plot",
        "command", "curve", "colour", "test"}
    for name, files in rows:
        ways = [re.findall(r"`((?:src|include|python|scripts|docs|tests|scenes)/[^`]*)`", way) for way in files.split("; in Python")]
        assert all(1 <= len(way) <= (5 if name in ("a study", "a drive") else 3) for way in ways), name
        paths = sum(ways, [])
        missing = [path for path in paths if not re.search("[A-Z]", path) and not (ROOT / path).exists()]
        assert not missing, name
    folders = re.findall(r"^\| `(src/[a-z/]+)` \|", guide, re.MULTILINE)
    assert folders and all((ROOT / folder).is_dir() for folder in folders)
    drawn = guide.split("```")[1]
    assert {path.name for path in (SOURCES / "dynamics").iterdir()} <= {folder.split("/")[2] for folder in folders if folder.count("/") > 1}
    assert {path.name for layer in ("study", "dynamics") for path in (SOURCES / layer).iterdir() if path.is_dir()} <= set(
        re.findall(r"\w+", drawn))


# ---- constants that C and Fortran both need ----

# (Fortran file, its name, C file, its name)
SHARED = [("kernel/vector/map.f90", "WIDTH", "src/kernel/vector/vector.h", "KZ_LANES"),
          *(("dynamics/labels/levels.f90", f"LEVEL_{n}", "include/kapitza/dynamics.h", f"KZ_LEVEL_{n}") for n in ("FINE", "PAIRS_28")),
          ("dynamics/labels/orbits.f90", "NO_LEVEL", "include/kapitza/dynamics.h", "KZ_LEVELS"),
          ("kernel/taylor/taylor.f90", "TAYLOR_STEPS", "include/kapitza/kernel.h", "KZ_REFERENCE_STEPS"),
          ("kernel/splitting/processed/stages.f90", "TERMS", "src/kernel/splitting/processed/tangents.c", "TERMS"),
          ("model/pendulum.f90", "MOST_HARMONICS", "include/kapitza/model.h", "KZ_HARMONICS")]


@pytest.mark.parametrize("fortran, name, c, name_in_c", SHARED)
def test_constants_are_the_same_in_c_and_fortran(fortran, name, c, name_in_c):
    there = re.search(rf"parameter.*:: .*\b{name} = (\d+)", (SOURCES / fortran).read_text())
    here = re.search(rf"enum \{{[^}}]*\b{name_in_c} = (\d+)", (ROOT / c).read_text())
    assert there and here and there[1] == here[1]
