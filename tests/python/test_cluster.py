"""Two hosts and a batch system on one machine (tests/cluster); skipped by name where the machine does not allow them."""

import os
import subprocess

import pytest
from conftest import PROGRAM, ROOT, datasets

SMALL = ROOT / "scenes" / "small.yaml"
DIRECT = ["--set", "basin.method=direct"]  # enough tiles for both hosts


def run(tool, folder, *words):
    """A command on a cluster of tests/cluster; skips the test where there can be none."""
    settings = {name: value for name, value in os.environ.items() if name != "OMPI_MCA_pml"}
    done = subprocess.run(list(map(str, [ROOT / "tests" / "cluster" / tool, folder / "cluster", *words])), cwd=folder, text=True,
                          capture_output=True, timeout=120, env=settings)
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    return done


@pytest.fixture(scope="module")
def alone(kapitza, tmp_path_factory):
    """The datasets of one rank."""
    folder = tmp_path_factory.mktemp("alone")
    kapitza("run", SMALL, *DIRECT, folder=folder)
    return datasets(folder / "small.h5")


def test_two_hosts_over_tcp(tmp_path, alone):
    """Open MPI as it comes: the same bytes as one rank."""
    done = run("two_hosts", tmp_path, "mpirun", "--host", "first:1,second:1", "-n", "2", PROGRAM, "run", SMALL, *DIRECT)
    assert done.returncode == 0, done.stderr
    assert datasets(tmp_path / "small.h5") == alone


def test_a_stop_on_one_of_two_hosts_reaches_the_other(tmp_path):
    """The request reaches rank 1 alone: all stop with status 75 and finished work saved."""
    stop = 'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then (sleep 4; kill -USR1 $$) & fi; exec "$@"'
    words = [PROGRAM, "run", SMALL, *DIRECT, "--set", "basin.theta.count=3000", "--set", "basin.velocity.count=3000"]
    done = run("two_hosts", tmp_path, "mpirun", "--host", "first:1,second:1", "-n", "2", "bash", "-c", stop, "stopped", *words)
    assert done.returncode == 75 and "stopped by SIGUSR1" in done.stderr, done.stderr
    assert (tmp_path / "small.h5.checkpoint").exists() and not (tmp_path / "small.h5").exists()


def test_a_batch_job(tmp_path, alone):
    """The script of README.md, with the launcher that Slurm itself has."""
    (tmp_path / "job.sh").write_text("#!/bin/bash\n#SBATCH --ntasks=2\n#SBATCH --overcommit\n#SBATCH --output=out\n"
                                     f"srun --mpi=pmix --overcommit {PROGRAM} run {SMALL} {' '.join(DIRECT)} --resume\n")
    done = run("one_node_slurm", tmp_path, "sbatch", "--wait", "job.sh")
    said = (tmp_path / "out").read_text() if (tmp_path / "out").exists() else done.stderr
    assert done.returncode == 0, said
    assert datasets(tmp_path / "small.h5") == alone and said.count("written to small.h5") == 1, said
