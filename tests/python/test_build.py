"""The build: which compilers it takes, what an installation holds, and what the program prints for it."""

import os
import shutil
import subprocess

import pytest
from conftest import PROGRAM, ROOT

EXTENSIVE = bool(os.environ.get("KAPITZA_EXTENSIVE"))


def call(*words, folder=ROOT, timeout=120, **more):
    return subprocess.run(list(map(str, words)), cwd=folder, capture_output=True, text=True, timeout=timeout, **more)


def need(tool):
    return shutil.which(tool) or pytest.skip(f"needs {tool}")


def configured(folder, *options):
    """A build folder of this project."""
    done = call("cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, *options)
    assert done.returncode == 0, done.stderr
    return folder


def test_clang_takes_every_c_file(tmp_path):
    """Compiled without a warning; with KAPITZA_EXTENSIVE=1 linked too, and the unit tests pass."""
    build = configured(tmp_path / "clang", f"-DCMAKE_C_COMPILER={need('clang')}", f"-DCMAKE_BUILD_TYPE={'Debug' if EXTENSIVE else 'None'}")
    targets = call("ninja", "-t", "targets", "all", folder=build).stdout.splitlines()
    objects = [line.split(":")[0] for line in targets if ".c.o:" in line and (EXTENSIVE or "dir/src/" in line)]
    assert len(objects) > 80
    done = call("ninja", "-j2", "kapitza_version", *objects, folder=build, timeout=280)
    assert done.returncode == 0, done.stdout[-4000:]
    if EXTENSIVE:
        done = call("cmake", "--build", build, "-j2", timeout=1200)
        assert done.returncode == 0, done.stdout[-4000:]
        done = call("ctest", "--test-dir", build, "-L", "unit", "--output-on-failure", timeout=1200)
        assert done.returncode == 0, done.stdout[-4000:]


@pytest.mark.parametrize("c, fortran, named", [("GNU", "GNU", ""), ("Clang", "GNU", ""), ("IntelLLVM", "GNU", "C compiler is IntelLLVM"),
                                               ("GNU", "IntelLLVM", "Fortran compiler is IntelLLVM"), ("", "GNU", "C compiler is ")])
def test_compilers_that_round_otherwise_are_refused(c, fortran, named):
    done = call("cmake", f"-DCMAKE_C_COMPILER_ID={c}", f"-DCMAKE_Fortran_COMPILER_ID={fortran}", "-P", "cmake/Compilers.cmake")
    assert (done.returncode != 0) == bool(named) and named in " ".join(done.stderr.split()), done.stderr


def test_no_link_line_names_a_compilers_library():
    """Which libraries Fortran needs is what CMake asked the compiler."""
    lists = [ROOT / "CMakeLists.txt", *(ROOT / "cmake").iterdir(), *ROOT.glob("*/CMakeLists.txt"), *(ROOT / "tests").rglob("*.cmake")]
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
    for path in ("bin/kapitza", "share/man/man1/kapitza.1", "share/bash-completion/completions/kapitza", "share/kapitza/kapitza.sbatch",
                 "share/zsh/site-functions/_kapitza", "share/fish/vendor_completions.d/kapitza.fish", "share/doc/kapitza/README.md",
                 "share/doc/kapitza/docs/user.md", "share/doc/kapitza/docs/figures/blackburn-fig12.png"):
        assert (installed / path).stat().st_size > 0, path
    scenes = sorted(path.name for path in (ROOT / "scenes").glob("*.yaml"))
    assert sorted(path.name for path in (installed / "share/kapitza/scenes").iterdir()) == scenes
    done = call(installed / "bin/kapitza", "check", installed / "share/kapitza/scenes/small.yaml", folder=tmp_path)
    assert done.returncode == 0, done.stderr


def named_options(*words):
    """Command -> its long options, as `kapitza --help` and `kapitza COMMAND --help` have them."""
    lines = call(PROGRAM, *words, "--help").stdout.splitlines()
    return [word.rstrip(",") for line in lines for word in line.split()[:2] if word.startswith("--")]


def commands():
    """The commands that `kapitza --help` lists before the options."""
    listed = call(PROGRAM, "--help").stdout.split("\n\n")[1]
    return [line.split()[0] for line in listed.splitlines() if line.startswith("  ") and not line.startswith("   ")]


def test_the_manual_page_has_every_command_and_option(installed):
    page = installed / "share/man/man1/kapitza.1"
    done = call(need("groff"), "-man", "-Tutf8", "-P-cbou", "-ww", page)
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert len(commands()) >= 3
    for word in {*commands(), *named_options(), *(option for name in commands() for option in named_options(name))}:
        assert word in done.stdout.split(), word
    assert " 75 " in done.stdout and "FILE.checkpoint" in done.stdout


def completed(script, *words):
    """What bash offers for the last of the words."""
    typed = f"COMP_WORDS=(kapitza {' '.join(map(repr, words))}); COMP_CWORD={len(words)}"
    done = call("bash", "-c", f'source {script}; {typed}; _kapitza; printf "%s\\n" "${{COMPREPLY[@]}}"', folder=ROOT / "scenes")
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout.split()


def test_bash_completes_commands_options_words_and_files(installed):
    script = installed / "share/bash-completion/completions/kapitza"
    assert set(commands()) | set(named_options()) <= set(completed(script, ""))
    for name in commands():
        assert completed(script, name, "--") == named_options(name)
    assert completed(script, "run", "--progress", "a") == ["auto", "always"]
    assert completed(script, "run", "smal") == ["small.yaml"]
    assert not completed(script, "run", "--time-limit", "s")


@pytest.mark.parametrize("shell, path", [("zsh", "zsh/site-functions/_kapitza"), ("fish", "fish/vendor_completions.d/kapitza.fish")])
def test_the_other_shells_can_read_theirs(installed, shell, path):
    done = call(need(shell), "-n", installed / "share" / path)
    assert done.returncode == 0 and not done.stderr, done.stderr


def test_fish_offers_commands_and_options(installed):
    script = installed / "share/fish/vendor_completions.d/kapitza.fish"
    done = call(need("fish"), "--no-config", "-c", f"source {script}; complete -C 'kapitza '; complete -C 'kapitza run --'")
    offered = {line.split("\t")[0] for line in done.stdout.splitlines()}
    assert set(commands()) | set(named_options("run")) <= offered, done.stdout + done.stderr


def test_an_unknown_shell_is_refused():
    done = call(PROGRAM, "--completion", "tcsh")
    assert done.returncode == 2 and "bash, zsh or fish" in done.stderr and not done.stdout
