"""MPICH and Open MPI 5 from their Python wheels: both build the program and pass the MPI tests, and take over each
other's work."""

import subprocess
import sys

import pytest
from conftest import ROOT, datasets

MPIS = ["mpich", "openmpi"]
SCENE = [ROOT / "scenes" / "small.yaml", "--set", "basin.method=direct", "--set", "basin.theta.count=1200",
         "--set", "basin.velocity.count=1200", "-o", "x.h5"]
pytestmark = [pytest.mark.extensive, pytest.mark.timeout(2400)]


def call(*words, status=0, **more):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, **more)
    assert done.returncode == status, (done.stdout + done.stderr)[-4000:]
    return done


class Build:
    """The program and the MPI tests, built with one MPI in a virtual environment of its own."""

    def __init__(self, name, folder):
        self.tools, self.folder = folder / "venv" / "bin", folder / "build"
        call(sys.executable, "-m", "venv", folder / "venv")
        pip = [self.tools / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", name]
        if subprocess.run(pip, capture_output=True).returncode != 0:
            pytest.skip(f"{name} cannot be installed")
        call("cmake", "-G", "Ninja", "-S", ROOT, "-B", self.folder, f"-DMPI_C_COMPILER={self.tools / 'mpicc'}",
             f"-DMPIRUN={self.tools / 'mpirun'}", "-DCMAKE_BUILD_TYPE=Release")
        targets = call("ninja", "-t", "targets", "all", cwd=self.folder).stdout.splitlines()
        tests = {line.split(":")[0] for line in targets if line.startswith("test_parallel_")}
        call("ninja", "-j2", "kapitza", "worker", *tests, cwd=self.folder)

    def run(self, folder, *options, status=0):
        call(self.tools / "mpirun", "-n", "2", self.folder / "kapitza", "run", *SCENE, *options, cwd=folder,
             status=status)


@pytest.fixture(scope="module")
def builds(tmp_path_factory):
    return {name: Build(name, tmp_path_factory.mktemp(name)) for name in MPIS}


@pytest.mark.parametrize("name", MPIS)
def test_the_mpi_tests_pass(builds, name):
    call("ctest", "--test-dir", builds[name].folder, "-L", "parallel", "--output-on-failure", "--no-tests=error")


@pytest.mark.parametrize("first, second", [MPIS, MPIS[::-1]])
def test_a_checkpoint_of_one_is_resumed_under_the_other(builds, tmp_path, first, second):
    (tmp_path / "whole").mkdir()
    builds[second].run(tmp_path / "whole")
    builds[first].run(tmp_path, "--time-limit", "2", status=75)
    assert (tmp_path / "x.h5.checkpoint").exists()
    builds[second].run(tmp_path, "--resume")
    assert datasets(tmp_path / "x.h5") == datasets(tmp_path / "whole" / "x.h5")
