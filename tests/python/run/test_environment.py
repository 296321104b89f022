"""What a user's shell, batch system and control groups leave to the program: limits, ignored signals, variables."""

import fcntl
import os
import resource
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT
from kapitza.program import command

SMALL = ROOT / "scenes" / "small.yaml"
FEW = ["--set", "basin.theta.count=9", "--set", "basin.velocity.count=9", "--set",
       "basin.icm={theta: 40, velocity: 40}"]
def run(words, folder, **more):
    """A run to its end."""
    return subprocess.run(list(map(str, words)), cwd=folder, capture_output=True, text=True, **more)


@pytest.mark.parametrize("method", ["icm", "exact"])
def test_a_small_stack_is_enough(tmp_path, method):
    words = [PROGRAM, "run", SMALL, *FEW, "--set", f"basin.method={method}"]
    done = run(["bash", "-c", 'ulimit -s 512; exec "$@"', "limited", *words], tmp_path)
    assert done.returncode == 0, done.stderr


def test_a_stack_that_is_too_small_is_refused(tmp_path):
    done = run(["bash", "-c", 'ulimit -s 500; exec mpirun -n 2 "$@"', "limited", PROGRAM, "run", SMALL, *FEW], tmp_path)
    assert done.returncode == 2 and "ulimit -s 512" in done.stderr and done.stderr.count(
        "kapitza: error") == 1, done.stderr
    assert not list(tmp_path.iterdir())


# Mpirun itself needs more than a rank
@pytest.mark.parametrize("launcher, most", [([], 8), (["mpirun", "-n", "2"], 18)])
def test_few_descriptors_are_refused(tmp_path, launcher, most):
    words = [*launcher, "bash", "-c", f'ulimit -n {most}; exec "$@"', "limited", PROGRAM, "run", SMALL, *FEW]
    done = run(words, tmp_path)
    assert done.returncode == 2 and "ulimit -n 32" in done.stderr and done.stderr.count(
        "kapitza: error") == 1, done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("words", [[], ["rum"], ["run"], ["--nonsense"], ["--help"], ["run", "--help"], ["--version"],
                                   ["--completion", "bash"], ["--manual"], ["keys"]])
def test_ranks_that_are_asked_for_different_things_end(tmp_path, words):
    """A rank that only answered would leave the one that runs waiting for it in MPI_Init, and one that was refused said
    nothing."""
    done = run(["mpirun", "-n", "1", PROGRAM, "run", SMALL, *FEW, ":", "-n", "1", PROGRAM, *words], tmp_path)
    assert done.returncode == 2 and done.stderr.count("another command line") == 1 and not list(
        tmp_path.iterdir()), done.stderr
    if words == ["keys"]:
        done = run(["mpirun", "-n", "2", PROGRAM, *words], tmp_path)
        assert done.returncode == 0 and done.stdout.startswith("# ") and done.stdout.count("`basin.max_periods`") == 1


@pytest.mark.parametrize("words", [["run", SMALL, *FEW, "-o", "x.h5"], ["check", SMALL]])
def test_processes_of_a_launcher_that_the_mpi_does_not_know_are_refused(tmp_path, words):
    """Each would be a run of its own. One process of such a job, and one that was started by hand, are runs of one
    rank."""
    for rank, said in (("0", 1), ("1", 0)):
        done = run([PROGRAM, *words], tmp_path, env=os.environ | {"PMI_RANK": rank, "PMI_SIZE": "2"})
        assert done.returncode == 2 and done.stderr.count(
            "a launcher of another MPI started 2 processes") == said, done.stderr
    assert not list(tmp_path.iterdir())
    assert run([PROGRAM, *words], tmp_path, env=os.environ | {"PMI_RANK": "0", "PMI_SIZE": "1"}).returncode == 0


@pytest.mark.parametrize("name", ["/dev/zero", "pipe", "."])
def test_the_explorer_is_opened_with_a_file_alone(tmp_path, name):
    os.mkfifo(tmp_path / "pipe")
    done = run([PROGRAM, "view", name, "--no-browser"], tmp_path)
    assert done.returncode == 2 and "give the name of a scene file" in done.stderr, done.stderr


@pytest.mark.parametrize("command", ["run", "check", "where", "view"])
def test_an_empty_name_is_refused(tmp_path, command):
    done = run([PROGRAM, command, "", *["0", "0"] * (command == "where")], tmp_path)
    assert done.returncode == 2 and f"{command}: the name of SCENE is empty" in done.stderr, done.stderr


def test_a_command_that_is_gone_names_what_replaces_it(tmp_path):
    done = run([PROGRAM, "serve", SMALL], tmp_path)
    page = "docs/howto/other-languages.md"
    assert done.returncode == 2 and page in done.stderr and (ROOT / page).exists()


def test_a_second_run_is_told_that_the_first_one_works(tmp_path):
    """Its checkpoint is held: going on from it is no way out."""
    with (tmp_path / "x.h5.checkpoint").open("w+b") as held:
        fcntl.lockf(held, fcntl.LOCK_EX, 2)  # as a run that works holds it
        done = run([PROGRAM, "run", SMALL, *FEW, "-o", "x.h5"], tmp_path)
    assert done.returncode == 2 and "another run works on this result" in done.stderr, done.stderr
    done = run([PROGRAM, "run", SMALL, *FEW, "-o", "x.h5"], tmp_path)
    assert done.returncode == 2 and "use --resume to go on" in done.stderr, done.stderr


# The errors of so many steps are measured at 17 values before the sweep begins, each for many seconds.
SLOW = [PROGRAM, "run", ROOT / "scenes" / "bifurcation.yaml", "--set", "numerics.scheme=split6", "--set",
        "numerics.steps_per_period=100000"]


def test_the_time_limit_is_heard_before_modelling(tmp_path):
    done = run([*SLOW, "--time-limit", "0.3"], tmp_path)
    assert done.returncode == 75 and "time limit" in done.stderr and not list(tmp_path.iterdir()), done.stderr


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGUSR1"])
def test_an_ignored_signal_stays_ignored(tmp_path, name):
    """As below nohup, or after `trap '' INT`."""
    number = getattr(signal, name)
    process = subprocess.Popen([PROGRAM, "run", SMALL, *FEW], cwd=tmp_path, stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(number, signal.SIG_IGN))
    while process.poll() is None:
        process.send_signal(number)
        time.sleep(0.01)
    assert process.wait() == 0 and (tmp_path / "small.h5").exists(), process.stderr.read()


def test_a_batch_systems_variables_invent_no_ranks(tmp_path):
    """A lone process in a job: it speaks, and shares its memory with nobody."""
    job = os.environ | {"SLURM_PROCID": "3", "SLURM_NTASKS_PER_NODE": "100000"}
    done = run([PROGRAM, "run", "missing.yaml"], tmp_path, env=job)
    assert done.returncode == 2 and "missing.yaml" in done.stderr
    done = run([PROGRAM, "run", SMALL, *FEW], tmp_path, env=job)
    assert done.returncode == 0 and "written to small.h5" in done.stdout, done.stderr


def test_memory_for_the_cells_is_divided_among_ranks(tmp_path):
    """Twice what four ranks would have if each held every cell; nothing is run."""
    physical = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    count = min(int((physical / 2 / 0.25) ** 0.5), 10**6)
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY:
        pytest.skip("the address space of this shell is limited")
    words = [PROGRAM, "run", SMALL, "--set", f"basin.theta.count={count}", "--set", f"basin.velocity.count={count}",
             "--set", "numerics.steps_per_period=1", "-o", "x.h5"]
    done = run(["mpirun", "-n", "4", *words], tmp_path)
    assert done.returncode == 2 and "of memory" not in done.stderr, done.stderr


@pytest.fixture
def group():
    """A memory control group of our own: the folder, and its file for a limit."""
    kinds = {"/sys/fs/cgroup/memory": "memory.limit_in_bytes", "/sys/fs/cgroup": "memory.max"}
    for root, name in kinds.items():
        folder = Path(root) / f"kapitza-test-{os.getpid()}"
        try:
            folder.mkdir()
        except OSError:
            continue
        if (folder / name).exists():
            yield folder, folder / name
            folder.rmdir()
            return
        folder.rmdir()
    pytest.skip("making a memory control group needs more rights than this user has")


def test_the_control_group_of_the_process_counts(tmp_path, group):
    folder, limit = group
    limit.write_text("70000000")
    words = ["bash", "-c", f'echo $$ > {folder}/cgroup.procs && exec "$@"', "grouped", PROGRAM, "check", SMALL]
    assert run(words, tmp_path).returncode == 0
    done = run([*words, "--set", "basin.theta.count=20000", "--set", "basin.velocity.count=20000"], tmp_path)
    assert done.returncode == 2 and "70.0 MB" in done.stderr, done.stderr


def test_the_launcher_beside_the_program_is_taken(tmp_path, monkeypatch):
    """It is of the program's own MPI, as in an environment of pip. Another one that a variable names is taken with a
    warning."""
    for name in ("kapitza", "mpiexec", "other"):
        (tmp_path / name).touch(0o755)
    monkeypatch.setenv("KAPITZA", str(tmp_path / "kapitza"))
    monkeypatch.delenv("KAPITZA_MPIRUN", raising=False)
    assert command(["check"], ranks=2) == [str(tmp_path / "mpiexec"), "-n", "2", str(tmp_path / "kapitza"), "check"]
    monkeypatch.setenv("KAPITZA_MPIRUN", str(tmp_path / "other"))
    with pytest.warns(UserWarning, match="the launcher of this program's own MPI is .*mpiexec"):
        assert command(["check"], ranks=2)[0] == str(tmp_path / "other")
    monkeypatch.setenv("KAPITZA_MPIRUN", str(tmp_path / "mpiexec"))
    assert command(["check"], ranks=2)[0] == str(tmp_path / "mpiexec")
    (tmp_path / "mpiexec").unlink()
    monkeypatch.setenv("KAPITZA_MPIRUN", "srun")
    assert command(["check"], ranks=2)[0] == "srun"
