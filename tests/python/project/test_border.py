"""The border of C and Fortran: C headers say what the Fortran entries, their structures and their constants are."""

import re
import subprocess

import pytest
from conftest import PROGRAM, ROOT

SOURCES = ROOT / "src"
HEADERS = ROOT / "include" / "kapitza"
FORTRAN = sorted(SOURCES.rglob("*.f90"))

# Kinds of numbers by their names in C and in gfortran.
KINDS = {"int32_t": "int", "int64_t": "long", "uint64_t": "long", "uint8_t": "signed char", "int16_t": "short",
         "__float128": "float128", "kz_status": "int", "kz_stepper": "int", "kz_precision": "int", "kz_find": "int"}


def without_comments(text):
    # As gfortran writes it
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL).replace("long double", "long_double")


def declared(text):
    """{function: (result, [parameter types])} of the prototypes and definitions in C text; a type is (const, name,
    pointer)."""
    found = {}
    for result, name, parameters in re.findall(r"^((?:const )?\w+[ *]+)(kz_\w+) ?\(([^()]*)\)[^;{]*[;{]", text,
                                               re.MULTILINE):
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
                           f"-I{PROGRAM.parent / 'modules'}", f"-J{folder}", f"-I{path.parent}",
                           f"-I{ROOT / 'src' / 'kernel'}", str(path)],
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
        types |= {name: body for body, name in re.findall(r"^typedef struct \w+ \{(.*?)\} (\w+);", text,
                                                          re.DOTALL | re.MULTILINE)}
        for name, (_, parameters) in declared(text).items():
            for one, other in zip(parameters, functions_in_c.get(name, (None, []))[1], strict=False):
                agrees(one, other, met)
    def parts_of(fortran):
        """The types that it has members of, and itself, those that others need first."""
        parts = [name for name in types if re.search(rf"\b{name} ", types[fortran])]
        return [*(part for name in parts for part in parts_of(name)), fortran]

    ordered = list(dict.fromkeys(part for fortran in sorted({one for one, _ in met}) for part in parts_of(fortran)))
    assert types.keys() == set(ordered)
    headers = [f'#include "kapitza/{path.name}"' for path in sorted(HEADERS.glob("dynamics*.h"))]
    program = ["#include <stddef.h>", *headers, '#include "vector/vector.h"',
               "typedef _Float128 float128;",
               *(f"typedef struct {{{types[name]}}} {name};" for name in ordered)]
    for path, text in sources.items():  # structures that only one C file needs
        if path.suffix == ".c" and any(f"}} {c};" in text for _, c in met):
            program += re.findall(r"^enum \{[^}]*\};|^typedef struct \{[^}]*\} kz_\w+;", text, re.MULTILINE)
    for fortran, c in sorted(met):
        program.append(f'_Static_assert(sizeof({fortran}) == sizeof({c}), "size of {c}");')
        # C keeps quads as bytes
        for field in re.findall(r"^ *(?!float128)(?:signed )?\w+ (\w+)", types[fortran], re.MULTILINE):
            program.append(f'_Static_assert(offsetof({fortran}, {field}) == offsetof({c}, {field}), "{c}.{field}");')
            program.append(f'_Static_assert(sizeof((({fortran} *)0)->{field}) == sizeof((({c} *)0)->{field}), "size '
                           f'of {c}.{field}");')
    compiler = ["cc", "-x", "c", "-fsyntax-only", f"-I{ROOT / 'include'}", f"-I{SOURCES / 'kernel'}", "-"]
    done = subprocess.run(compiler, input="\n".join(program) + "\n", capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# ---- constants that both need ----

# (Fortran module, its name, name in C)
SHARED = [("kz_vector_map", "WIDTH", "KZ_LANES"),
          *(("kz_labels_levels", f"LEVEL_{name}", f"KZ_LEVEL_{name}")
            for name in ("FINE", "PAIRS_16", "PAIRS_28", "QUAD")),
          ("kz_taylor_taylor", "TAYLOR_STEPS", "KZ_REFERENCE_STEPS"),
          ("kz_processed_stages", "TERMS", "TERMS"),
          ("kz_model_pendulum", "MOST_HARMONICS", "KZ_HARMONICS")]


def test_constants_are_the_same_in_c_and_fortran(tmp_path):
    """gfortran prints its values, and the C compiler compares them."""
    uses = [f"use {module}, only: v{i} => {name}" for i, (module, name, _) in enumerate(SHARED)]
    values = ", ".join(f"v{i}" for i in range(len(SHARED)))
    (tmp_path / "values.f90").write_text("\n".join(["program values", *uses, f"print '(*(i0, :, \" \"))', {values}",
                                                    "end program values"]))
    subprocess.run(["gfortran", f"-I{PROGRAM.parent / 'modules'}", "values.f90", "-o", "values"], cwd=tmp_path,
                   check=True)
    printed = subprocess.run([tmp_path / "values"], capture_output=True, text=True, check=True).stdout.split()
    asserted = [f'_Static_assert({c} == {value}, "{name}");' for (_, name, c),
                value in zip(SHARED, printed, strict=True)]
    program = "\n".join(['#include "kapitza/dynamics_labels.h"', '#include "splitting/processed/tangents.c"', *asserted,
                         ""])
    compiler = ["cc", "-x", "c", "-fsyntax-only", "-march=native", "-DKAPITZA_FUSED=1", f"-I{ROOT / 'include'}",
                f"-I{SOURCES / 'kernel'}"]
    done = subprocess.run([*compiler, "-"], input=program, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
