"""The build: which compilers it takes, what an installation holds, and what the program prints for it."""

import os
import re
import shutil
import subprocess

import pytest
from conftest import EXTENSIVE, PROGRAM, ROOT, datasets


def call(*words, folder=ROOT, **more):
    return subprocess.run(list(map(str, words)), cwd=folder, capture_output=True, text=True, **more)


def need(tool):
    return shutil.which(tool) or pytest.skip(f"needs {tool}")


def configured(folder, *options):
    """A build folder of this project."""
    done = call("cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, *options)
    assert done.returncode == 0, done.stderr
    return folder


def test_an_unknown_power_is_refused(tmp_path):
    done = call("cmake", "-G", "Ninja", "-S", ROOT, "-B", tmp_path / "b", "-DKAPITZA_POWERS=flying")
    assert done.returncode != 0
    assert "KAPITZA_POWERS: flying is no power; there are tools;" in " ".join(done.stderr.split())


@pytest.mark.extensive
def test_the_program_builds_without_powers(tmp_path):
    """From nothing, with warnings as errors, and without FLINT; then without each power and those that need it."""
    build = configured(tmp_path / "core", "-DKAPITZA_POWERS=", "-DCMAKE_BUILD_TYPE=Release", "-DKAPITZA_WERROR=ON",
                       "-DBUILD_TESTING=OFF")
    assert call("ninja", "-j2", "kapitza", folder=build).returncode == 0
    assert "flint" not in call("ldd", build / "kapitza").stdout
    for study in ("basin: {velocity: {min: -1, max: 1}, shocks: {}}",
                  "sweep: {parameter: m, min: 0, max: 1, count: 2, measure: [share]}"):
        (tmp_path / "more.yaml").write_text(f"pendulum: {{k: 0.1, damping: 0.1, m: 0.4}}\n{study}\n")
        done = call(build / "kapitza", "check", tmp_path / "more.yaml")
        assert done.returncode == 2 and "the power measures, which this build leaves out" in done.stderr
        assert done.stderr.count("\n") == 1
    known = [re.search(r"kapitza_power\((\w+)", path.read_text())[1] for path in ROOT.glob("src/*/*/power.cmake")]
    build = configured(tmp_path / "trials", f"-DKAPITZA_TRIALS={';'.join(known)}", "-DCMAKE_BUILD_TYPE=Release",
                       "-DKAPITZA_WERROR=ON")
    small = ROOT / "scenes" / "small.yaml"
    assert call(PROGRAM, "run", small, "-o", tmp_path / "all.h5").returncode == 0
    for power in known:
        done = call("ninja", "-j2", f"trial_without_{power}", folder=build)
        assert done.returncode == 0, done.stdout[-4000:]
        assert call(build / f"trial_without_{power}", "run", small, "-o", tmp_path / f"{power}.h5").returncode == 0
        assert datasets(tmp_path / f"{power}.h5") == datasets(tmp_path / "all.h5"), power


def test_clang_takes_every_c_file(tmp_path):
    """Compiled without a warning; with KAPITZA_EXTENSIVE=1 linked too, and the unit tests pass."""
    build = configured(tmp_path / "clang", f"-DCMAKE_C_COMPILER={need('clang')}",
                       f"-DCMAKE_BUILD_TYPE={'Debug' if EXTENSIVE else 'None'}")
    targets = call("ninja", "-t", "targets", "all", folder=build).stdout.splitlines()
    objects = [line.split(":")[0] for line in targets if ".c.o:" in line and (EXTENSIVE or "dir/src/" in line)]
    assert len(objects) > 80
    done = call("ninja", "-j2", "kapitza_version", *objects, folder=build)
    assert done.returncode == 0, done.stdout[-4000:]
    if EXTENSIVE:
        done = call("cmake", "--build", build, "-j2")
        assert done.returncode == 0, done.stdout[-4000:]
        done = call("ctest", "--test-dir", build, "-L", "unit", "--output-on-failure")
        assert done.returncode == 0, done.stdout[-4000:]


@pytest.mark.parametrize("c, fortran, named",
                         [("GNU", "GNU", ""), ("Clang", "GNU", ""), ("IntelLLVM", "GNU", "C compiler is IntelLLVM"),
                                               ("GNU", "IntelLLVM", "Fortran compiler is IntelLLVM"),
                                               ("", "GNU", "C compiler is ")])
def test_compilers_that_round_otherwise_are_refused(c, fortran, named):
    done = call("cmake", f"-DCMAKE_C_COMPILER_ID={c}", f"-DCMAKE_Fortran_COMPILER_ID={fortran}", "-P",
                "cmake/Compilers.cmake")
    assert (done.returncode != 0) == bool(named) and named in " ".join(done.stderr.split()), done.stderr


def test_sources_that_are_compiled_otherwise_exist():
    """A file that has moved would lose its options without a word."""
    named = re.findall(r"\bsrc/[\w/]+\.(?:c|f90)\b", (ROOT / "CMakeLists.txt").read_text())
    assert len(named) > 8 and not [path for path in named if not (ROOT / path).exists()]


def test_no_link_line_names_a_compilers_library():
    """Which libraries Fortran needs is what CMake asked the compiler."""
    lists = [ROOT / "CMakeLists.txt", *(ROOT / "cmake").iterdir(), *ROOT.glob("*/CMakeLists.txt"),
             *(ROOT / "tests").rglob("*.cmake")]
    lines = [line for path in lists for line in path.read_text().splitlines() if "link_libraries" in line]
    assert len(lines) > 5 and not [line for line in lines if "gfortran" in line or "quadmath" in line]


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The root of an installation in /usr."""
    folder = tmp_path_factory.mktemp("installed")
    done = call("cmake", "--install", PROGRAM.parent, "--prefix", "/usr", env=os.environ | {"DESTDIR": str(folder)})
    assert done.returncode == 0 and "left out" not in done.stderr, done.stderr
    return folder / "usr"


def test_an_installation_is_whole(installed, tmp_path):
    for path in ("bin/kapitza", "share/man/man1/kapitza.1", "share/bash-completion/completions/kapitza",
                 "share/kapitza/kapitza.sbatch",
                 "share/zsh/site-functions/_kapitza", "share/fish/vendor_completions.d/kapitza.fish",
                 "share/doc/kapitza/README.md",
                 "share/doc/kapitza/docs/reference/commands.md", "share/doc/kapitza/docs/figures/blackburn-fig12.png"):
        assert (installed / path).stat().st_size > 0, path
    there = installed / "share/kapitza/scenes"
    scenes = sorted(path.relative_to(ROOT / "scenes") for path in (ROOT / "scenes").rglob("*.yaml"))
    assert sorted(path.relative_to(there) for path in there.rglob("*.yaml")) == scenes
    done = call(installed / "bin/kapitza", "check", installed / "share/kapitza/scenes/small.yaml", folder=tmp_path)
    assert done.returncode == 0, done.stderr
