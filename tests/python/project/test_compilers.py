"""Other compilers than GNU's take every source: what gfortran and gcc forgive, they may compile to something wrong."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT
from page_engine import in_order

BUILD = ROOT / "build"
FORTRAN, C = "flang-new-19", "clang-19"
# Two warnings of right code that no option turns off: flang has no arithmetic of 128 bits while it compiles, and
# Fortran 2018 lets c_f_pointer take any type.
EXPECTED = re.compile(r"cannot be folded on host|included here|FPTR= argument to C_F_POINTER")


def commands(suffix: str) -> dict[Path, list[str]]:
    """Source file: what its compiler was called with, for files of src."""
    listed = json.loads(subprocess.run(["ninja", "-C", BUILD, "-t", "compdb"], capture_output=True, check=True,
                                       text=True).stdout)
    source = (ROOT / "src").as_posix()
    return {Path(c["file"]): shlex.split(c["command"]) for c in listed if c["file"].startswith(source)
            and c["file"].endswith(suffix)}


@pytest.mark.skipif(not shutil.which(C), reason=f"{C} is not installed")
def test_clang_takes_all_c() -> None:
    wrong = []
    for file, words in commands(".c").items():
        kept = [w for w in words if w.startswith(("-I", "-D", "-U", "-W", "-std", "-m", "-ffp-contract"))]
        isystem = [part for i, w in enumerate(words) if w == "-isystem" for part in words[i : i + 2]]
        done = subprocess.run(
            [C, "-fsyntax-only", "-Werror", "-Wno-unknown-warning-option", *kept, *isystem, file],
            capture_output=True,
            text=True,
            cwd=BUILD,
        )
        if done.returncode:
            wrong.append(done.stderr)
    assert not wrong, "\n".join(wrong)


@pytest.mark.skipif(not shutil.which(FORTRAN), reason=f"{FORTRAN} is not installed")
def test_flang_takes_all_fortran(tmp_path: Path) -> None:
    words = commands(".f90")
    wrong = []
    for file in in_order(set(words)):
        include = [w for w in words[file] if w.startswith("-I") and BUILD.as_posix() not in w]
        done = subprocess.run(
            [FORTRAN, "-S", "-emit-llvm", "-O0", "-cpp", "-module-dir", tmp_path, f"-I{tmp_path}", *include, "-o",
             "/dev/null", file],
            capture_output=True,
            text=True,
        )
        said = [line for line in done.stderr.splitlines() if re.search("error|warning", line)
                and not EXPECTED.search(line)]
        if done.returncode or said:
            wrong.append(f"{file}: {done.returncode} {chr(10).join(said[:5])}")
    assert not wrong, "\n".join(wrong)
