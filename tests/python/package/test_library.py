"""libkapitza.so, as others link it: its names, its header, the examples of docs/howto/library.md against the installed
one."""

import ctypes
import re
import shutil
import subprocess

import kapitza
import pytest
from conftest import PROGRAM, ROOT
from kapitza.library import load

LIBRARY = PROGRAM.parent / "libkapitza.so"
PAGE = (ROOT / "docs" / "howto" / "library.md").read_text()
OTHERS = (ROOT / "docs" / "howto" / "other-languages.md").read_text()


def example(language, page=PAGE):
    return re.search(rf"```{language}\n(.*?)```", page, re.DOTALL)[1]


def done(*words, **more):
    finished = subprocess.run([*map(str, words)], capture_output=True, text=True, **more)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("installed")
    done("cmake", "--install", PROGRAM.parent, "--prefix", folder, "--component", "library")
    return folder


def test_the_library_shows_the_names_of_its_header_alone_and_needs_no_mpi():
    shown = set(re.findall(r" T (\w+)", done("nm", "-D", "--defined-only", LIBRARY)))
    header = re.sub(r"/\*.*?\*/", "", (ROOT / "include" / "kapitza.h").read_text(), flags=re.DOTALL)
    assert shown == set(re.findall(r"\b(kapitza_\w+)\(", header)) - {"kapitza_pause"}
    assert "libmpi" not in done("ldd", LIBRARY)


def test_the_c_example_links_by_pkg_config(installed, tmp_path):
    (tmp_path / "example.c").write_text(example("c"))
    assert len(example("c").splitlines()) <= 30
    package = next(installed.rglob("kapitza.pc")).parent
    flags = done("pkg-config", "--cflags", "--libs", "kapitza",
                 env={"PKG_CONFIG_PATH": str(package), "PATH": "/usr/bin:/bin"}).split()
    path = f"-Wl,-rpath,{next(installed.rglob('libkapitza.so')).parent}"
    done("cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "example.c", *flags, path, "-o", "example", cwd=tmp_path)
    assert done(tmp_path / "example").splitlines() == ["3 0: inverted", "3.1 0.2: inverted"]


def test_the_fortran_example_links(installed, tmp_path):
    (tmp_path / "example.f90").write_text(example("fortran"))
    folder = next(installed.rglob("libkapitza.so")).parent
    done("gfortran", "-Wall", "example.f90", f"-L{folder}", "-lkapitza", f"-Wl,-rpath,{folder}", "-o", "example",
         cwd=tmp_path)
    rows = done(tmp_path / "example").split()
    assert len(rows) == 4 and all(abs(float(number)) < 3.2 for number in rows)


def test_the_c_example_links_by_cmake(installed, tmp_path):
    (tmp_path / "example.c").write_text(example("c"))
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.24)\nproject(example C)\nfind_package(kapitza REQUIRED)\n"
                                             "add_executable(example example.c)\ntarget_link_libraries(example "
                                             "kapitza::kapitza)\n")
    done("cmake", "-G", "Ninja", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={installed}")
    done("cmake", "--build", tmp_path / "build")
    assert "inverted" in done(tmp_path / "build" / "example")


@pytest.mark.skipif(not shutil.which("c++"), reason="no C++ compiler")
def test_the_header_is_c_plus_plus_too(tmp_path):
    (tmp_path / "example.cc").write_text("#include <kapitza.h>\nint main() { return kapitza_version()[0] != '0'; }\n")
    done("c++", "-Wall", "-Werror", "example.cc", f"-I{ROOT / 'include'}", LIBRARY, f"-Wl,-rpath,{LIBRARY.parent}",
         "-o", "x", cwd=tmp_path)
    done(tmp_path / "x")


def test_a_run_in_this_process_writes_the_datasets_of_the_program(tmp_path):
    from conftest import datasets
    scene = (ROOT / "scenes" / "small.yaml").read_text()
    library = load()
    summary = library.ffi.new("char **")
    library.call("kapitza_run", scene.encode(), str(tmp_path / "own.h5").encode(), 0, summary)
    assert "Rest down: stable" in library.ffi.string(summary[0]).decode()
    library.lib.kapitza_free(summary[0])
    done(PROGRAM, "run", ROOT / "scenes" / "small.yaml", "-o", tmp_path / "program.h5")
    own, wanted = datasets(tmp_path / "own.h5"), datasets(tmp_path / "program.h5")
    assert own.keys() == wanted.keys()
    assert all(own[name] == wanted[name] for name in wanted)
    assert not list(tmp_path.glob("*.part"))


def test_the_c_between_r_and_the_library_works(tmp_path):
    """Its pointers are those that R's .C hands over."""
    (tmp_path / "ends.c").write_text(example("c", OTHERS))
    done("cc", "-shared", "-fPIC", "-Wall", "-Werror", "ends.c", f"-I{ROOT / 'include'}", LIBRARY,
         f"-Wl,-rpath,{LIBRARY.parent}", "-o", "ends.so", cwd=tmp_path)
    scene = (ctypes.c_char_p * 1)(re.search(r'scene <- "(.*)"', OTHERS)[1].encode())
    label, status = (ctypes.c_int * 2)(-9, -9), ctypes.c_int(-9)
    ctypes.CDLL(str(tmp_path / "ends.so")).ends(scene, ctypes.byref(ctypes.c_int(2)), (ctypes.c_double * 2)(3, 3.1),
                                                (ctypes.c_double * 2)(0, 0.2), label, ctypes.byref(status))
    names = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3).attractors()["name"]
    assert status.value == 0 and [names[id] for id in label] == ["inverted", "inverted"]


def test_julia_steps_from_cycle_to_cycle_as_c_does():
    """No Julia runs here: its calls are those that the header declares, and a cycle has the bytes that it counts."""
    ffi = load().ffi
    assert f"size = {ffi.sizeof('kapitza_cycle')} " in OTHERS and ffi.offsetof("kapitza_cycles", "cycle") == 8
    called = set(re.findall(r"\b(kapitza_\w+)\(", OTHERS)) | set(re.findall(r"'(kapitza_\w+)'", OTHERS))
    assert called and all(hasattr(load().lib, name) for name in called)
