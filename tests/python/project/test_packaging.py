"""Packages, without a build of them: one version, what each recipe names, the launcher of the wheel, its lists and
metadata."""

import json
import os
import re
import subprocess
import sys
import tomllib

import pytest
import yaml
from conftest import ROOT

WHEEL = ROOT / "packaging" / "wheel"
sys.path.insert(0, str(WHEEL))
import assemble  # noqa: E402
import old_symbols  # noqa: E402

VERSION = re.search(r"project\(kapitza VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
SHOW = '#!/bin/sh\necho "$(basename "$0") [$*] $MPIR_CVAR_NOLOCAL $FI_PROVIDER $KAPITZA_PYTHON $LD_LIBRARY_PATH"\n'


@pytest.mark.parametrize("name, pattern, count", [
    ("CITATION.cff", r"^version: ([0-9.]+)$", 1), ("CHANGELOG.md", r"\A.*?^## ([0-9.]+)", 1),
    ("packaging/conda/meta.yaml", r'set version = "([0-9.]+)"', 1),
    ("packaging/spack/package.py", r'kapitza@([0-9.]+)|version\("([0-9.]+)"\)', 2),
    ("docs/start/install.md", r"kapitza-([0-9.]+)(?:-py3|\.tar)", 2)])
def test_every_file_says_one_version(name, pattern, count):
    found = ["".join(match.groups(default="")) for match in re.finditer(pattern, (ROOT / name).read_text(),
                                                                        re.MULTILINE | re.DOTALL)]
    assert found == [VERSION] * count


def libraries(column):
    """What the program is linked with, by the names of a packager: `cmake/packages.txt`, and FLINT."""
    rows = [[cell.strip() for cell in line.split("|")]
            for line in (ROOT / "cmake" / "packages.txt").read_text().splitlines()]
    names = {row[column] for row in rows if row[0] == "program" and row[1].startswith(("module", "command mpicc"))}
    return names | {{2: "libflint-dev", 4: "libflint"}[column]}


def conda_recipe():
    """YAML once its expressions are replaced."""
    text = re.sub(r"{%.*?%}", "", (ROOT / "packaging" / "conda" / "meta.yaml").read_text())
    text = re.sub(r"{{ compiler\('(\w+)'\) }}", r"\1-compiler", text)
    return yaml.safe_load(text.replace("{{ version }}", VERSION).replace("{{ PYTHON }}",
                                                                         "python").replace("{{ mpi }}", "openmpi"))


@pytest.mark.parametrize("name", ["packaging/images/Dockerfile", "packaging/images/kapitza.def",
                                  "packaging/debian/control"])
def test_builds_on_debian_install_every_library(name):
    assert libraries(2) <= set((ROOT / name).read_text().replace(",", "").split())


def test_the_recipes_of_conda_and_spack_need_every_library():
    recipe = conda_recipe()
    assert libraries(4) <= set(recipe["requirements"]["host"])
    spack = (ROOT / "packaging" / "spack" / "package.py").read_text()
    given = set(re.findall(r'depends_on\("([\w-]+)', spack))
    names = {"openmpi": "mpi", "yaml": "libyaml", "zlib": "zlib-api", "libflint": "flint"}
    assert {names.get(name, name) for name in libraries(4)} <= given
    compile(spack, "package.py", "exec")


def test_the_recipes_leave_mpi_and_processor_to_their_tools():
    variants = yaml.safe_load((ROOT / "packaging" / "conda" / "conda_build_config.yaml").read_text())
    assert variants == {"mpi": ["openmpi", "mpich"]} and "{{ mpi }}" in (ROOT / "packaging" / "conda"
                                                                         / "meta.yaml").read_text()
    assert "native" not in (ROOT / "packaging" / "spack" / "package.py").read_text()


def test_the_conda_recipe_needs_what_pip_needs():
    given = {word.split()[0].removesuffix("-base") for word in conda_recipe()["requirements"]["run"]}
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert {re.match(r"\w+", word)[0].lower() for word in needed} <= given


def test_install_names_every_library():
    """The sentence for other systems, and the static libraries of the wheel."""
    text = (ROOT / "docs" / "start" / "install.md").read_text()
    assert all(name in text for name in ("MPI", "HDF5", "GSL", "FFTW 3", "FLINT", "json-c", "libyaml", "zlib"))
    wheel = (ROOT / "scripts" / "wheel").read_text() + (WHEEL / "sources.txt").read_text()
    built = {"libopenmpi-dev", "libhdf5-dev", "libflint-dev"}  # MPI is PyPI's; these two are compiled
    assert all(re.search(rf"\b{name}\b", wheel) for name in libraries(2) - built)


# Tests of the commands of the page on installing: a script or a test, and a text in it.
TRIED = {
    "pip install kapitza-VERSION-py3-none-manylinux_2_28_x86_64.whl": ("packaging/wheel/try",
                                                                       "version-check ./kapitza-*.whl"),
    "pip install kapitza-VERSION.tar.gz": ("scripts/test_install", '"$folder"/kapitza-*.tar.gz'),
    "scripts/setup": ("tests/python/project/test_setup.py", "source scripts/setup"),
    "cmake --preset release": ("scripts/setup", 'cmake --fresh --preset "$1"'),
    "cmake --build build": ("tests/python/project/test_build.py", 'call("cmake", "--build", build')}


def test_every_block_of_the_page_on_installing_is_tried():
    blocks = re.findall(r"^```\n(.*?)^```$", (ROOT / "docs" / "start" / "install.md").read_text(),
                        re.MULTILINE | re.DOTALL)
    commands = [line.partition("#")[0].strip().replace(VERSION, "VERSION") for block in blocks
                for line in block.splitlines()]
    assert commands == list(TRIED)
    assert not [name for name, text in TRIED.values() if text not in (ROOT / name).read_text()]


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """An environment as pip makes it: bin/kapitza, three builds that say how they were started, and an MPI."""
    root = tmp_path_factory.mktemp("environment")
    for name in ("bin", "libexec", "lib"):
        (root / name).mkdir()
    command = ["gcc", "-O2", "-Wall", "-Wextra", "-Werror", "-march=x86-64", WHEEL / "launcher.c", "-o",
               root / "bin" / "kapitza"]
    subprocess.run(command, check=True, capture_output=True)
    for arch in ("x86-64", "x86-64-v3", "x86-64-v4"):
        (root / "libexec" / f"kapitza-{arch}").write_text(SHOW)
        (root / "libexec" / f"kapitza-{arch}").chmod(0o755)
    (root / "lib" / "libmpi_abi.so.1").touch()
    return root


def start(root, *words, **variables):
    done = subprocess.run([root / "bin" / "kapitza", *words], capture_output=True, text=True,
                          env={"PATH": "/usr/bin:/bin", **variables})
    return done.returncode, done.stdout + done.stderr


def test_the_launcher_takes_a_build_that_this_processor_has(environment):
    flags = re.search(r"^flags\s*:(.*)$", open("/proc/cpuinfo").read(), re.MULTILINE)[1].split()
    best = "x86-64-v4" if "avx512vl" in flags else "x86-64-v3" if "avx2" in flags else "x86-64"
    assert start(environment, "check", "a b.yaml") == (0, f"kapitza-{best} [check a b.yaml]    \n")


@pytest.mark.parametrize("arch", ["x86-64", "x86-64-v3"])
def test_a_variable_pins_the_build(environment, arch):
    assert start(environment, KAPITZA_ARCH=arch)[1].startswith(f"kapitza-{arch} ")


def test_an_unknown_build_is_refused(environment):
    status, text = start(environment, KAPITZA_ARCH="sparc")
    assert (status,
            text) == (2, "kapitza: error: KAPITZA_ARCH is 'sparc'; this wheel has x86-64, x86-64-v3 and x86-64-v4\n")


def test_a_missing_mpi_is_named(environment, tmp_path):
    hidden = environment / "lib" / "libmpi_abi.so.1"
    moved = hidden.rename(tmp_path / hidden.name)
    try:
        status, text = start(environment, HOME=str(tmp_path / "home"))
        assert status == 2 and "pip install 'mpich>=5,<6'" in text and text.count("\n") == 1
        assert start(environment, KAPITZA_MPI_LIB=str(tmp_path))[1].endswith(f" {tmp_path}\n")
    finally:
        moved.rename(hidden)


def test_ranks_that_take_all_cores_wait_over_tcp(environment):
    cores = len(os.sched_getaffinity(0))
    for ranks in {max(cores, 2), 4096}:
        assert " 1 tcp " in start(environment, MPI_LOCALNRANKS=str(ranks), PMI_SIZE=str(ranks))[1]
    assert cores < 3 or "tcp" not in start(environment, MPI_LOCALNRANKS=str(cores - 1), PMI_SIZE=str(cores - 1))[1]
    assert "tcp" not in start(environment, MPI_LOCALNRANKS="1", PMI_SIZE="1")[1]
    # On several machines the network is theirs
    assert "tcp" not in start(environment, MPI_LOCALNRANKS="4096", PMI_SIZE="8192")[1]


def test_commands_of_the_package_take_the_python_of_pip(environment):
    script = environment / "bin" / "kapitza-plot"
    script.write_text(f"#!{sys.executable}\n")
    assert f" {sys.executable} " in start(environment)[1]
    assert " /bin/true " in start(environment, KAPITZA_PYTHON="/bin/true")[1]
    script.unlink()


def test_a_folder_of_other_files_is_left_alone(tmp_path):
    (tmp_path / "venv").mkdir()
    done = subprocess.run([ROOT / "scripts" / "wheel", tmp_path], capture_output=True, text=True)
    assert (done.returncode,
            done.stderr) == (1, f"wheel: {tmp_path} holds other files: name a new folder, or one of an earlier build\n")
    assert [path.name for path in tmp_path.iterdir()] == ["venv"]


def test_every_source_and_tool_has_its_hash():
    rows = [line.split() for line in (WHEEL / "sources.txt").read_text().splitlines() if not line.startswith("#")]
    assert len(rows) > 5 and all(row[0] in ("binary", "source", "static") and re.fullmatch("[0-9a-f]{64}", row[2])
                                 for row in rows)
    tools = [line for line in (WHEEL / "requirements.txt").read_text().splitlines() if not line.startswith("#")]
    assert tools and all(re.fullmatch(r"[\w-]+==\S+ --hash=sha256:[0-9a-f]{64}", line) for line in tools)


def test_the_wheel_lists_what_it_contains():
    """Every pinned file is a component of the CycloneDX list, and the libraries that are linked in are pinned by their
    versions."""
    sources = (WHEEL / "sources.txt").read_text()
    bill = json.loads(assemble.bill_of_materials(sources, VERSION))
    parts = {part["name"]: part for part in bill["components"]}
    script = (ROOT / "scripts" / "wheel").read_text()
    linked = re.search(r"cp \$from/lib\{([\w,-]+)\}\.a", script)[1].split(",")
    linked += re.findall(r"-print-file-name=lib(\w+)\.a", script)
    names = {"gsl": "libgsl-dev", "gmp": "libgmp-dev", "mpfr": "libmpfr-dev", "fftw3": "libfftw3-dev",
             "json-c": "libjson-c-dev", "yaml": "libyaml-dev", "z": "zlib1g-dev", "gslcblas": "libgsl-dev",
             "gfortran": "libgfortran-12-dev", "quadmath": "libgcc-12-dev"}
    assert {names[word] for word in linked} | {"flint", "hdf5"} == {name for name in parts if parts[name]["scope"]
                                                                    == "required"}
    assert len(parts) == len([line for line in sources.splitlines() if line and not line.startswith("#")])
    assert bill["specVersion"] == "1.6" and bill["metadata"]["component"]["version"] == VERSION
    for part in parts.values():
        assert part["licenses"][0]["expression"] and re.fullmatch("[0-9a-f]{64}",
                                                                  part["hashes"][0]["content"]), part["name"]
        assert part["purl"].startswith(f"pkg:deb/debian/{part['name']}@") and ":" not in part["purl"].split("@")[1]


@pytest.mark.parametrize("name", ["requirements", "requirements-docs"])
def test_every_python_package_has_its_hash(name):
    """What is named in the list of direct ones is in the list that pip takes, of the same version; both lists of pip
    agree."""
    def pinned(text):
        words = (re.match(r"([\w.-]+)==([^ ;\\]+)", line) for line in text.splitlines())
        return {re.sub(r"[-_.]+", "-", word[1]).lower(): word[2] for word in words if word}

    text = (ROOT / "scripts" / f"{name}.txt").read_text()
    blocks = re.split(r"\n(?=\w)", text.strip())
    assert all(re.match(r"[\w.-]+==\S+", block) and "--hash=sha256:" in block
               for block in blocks) and len(blocks) == len(pinned(text))
    assert pinned((ROOT / "scripts" / f"{name}.in").read_text()).items() <= pinned(text).items()
    first = pinned((ROOT / "scripts" / "requirements.txt").read_text())
    assert all(first.get(package, version) == version for package, version in pinned(text).items())


def test_images_begin_with_one_digest():
    files = [(ROOT / "packaging" / "images" / name).read_text() for name in ("Dockerfile", "kapitza.def")]
    named = re.findall(r"^FROM:? (\S+)", "\n".join(files), re.MULTILINE | re.IGNORECASE)
    assert len(named) == 3 and len({re.fullmatch(r"debian.*@(sha256:[0-9a-f]{64})", name)[1] for name in named}) == 1


def test_metadata_names_licences_and_mpi():
    text = ("Name: kapitza\nLicense-Expression: MIT\nLicense-File: LICENSE\nRequires-Dist: numpy>=2\nRequires-Dist: "
            "h5py>=3\n")
    lines = assemble.rewrite_metadata(text, ["GPL-3", "hdf5.txt"]).splitlines()
    assert "License-Expression: GPL-3.0-or-later" in lines and [line for line in lines
                                                                if line.startswith("License-File: ")] == [
        "License-File: LICENSE", "License-File: GPL-3", "License-File: hdf5.txt"]
    assert lines[-3:] == ["Requires-Dist: mpich>=5,<6; sys_platform == 'linux'", "Requires-Dist: numpy>=2",
                          "Requires-Dist: h5py>=3"]


def test_symbols_are_those_of_the_older_glibc(tmp_path):
    """Versions of this machine's libm: exp has one of 2.29, which is left out."""
    library = subprocess.run(["gcc", "-print-file-name=libm.so.6"], capture_output=True, text=True,
                             check=True).stdout.strip()
    found = old_symbols.symbols(library, "2.28")
    assert "2.2.5" in found["exp"] and all(old_symbols.number(version) <= (2, 28) for kinds in found.values()
                                           for version in kinds)
    code, script = old_symbols.source_of({"exp": {"2.2.5": None}, "signgam": {"2.2.5": 4, "2.23": 4}})
    assert "exp@@GLIBC_2.2.5" in code and "signgam@GLIBC_2.2.5" in code and "signgam@@GLIBC_2.23" in code
    assert script.splitlines() == ["GLIBC_2.2.5 { local: old_*; } ;", "GLIBC_2.23 {  } GLIBC_2.2.5;"]
