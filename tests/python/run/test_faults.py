"""Failures of the whole program's environment: disks that fill or vanish, damaged checkpoints, memory that runs out,
ranks that sleep or outnumber their tiles, kills. docs/validation/extremes.md says what is promised;
tests/tools/kill_loop.py is the long version."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import pytest
from conftest import PROGRAM, ROOT, datasets, launched, saved_bytes, wait_for, with_extensive

SMALL = ROOT / "scenes" / "small.yaml"
SLOW = ["--set", "basin.method=direct", "--set", "basin.theta.count=200", "--set", "basin.velocity.count=200",
        "--set", "numerics.steps_per_period=96", "--set", "basin.attractors.starts=64"]
FEW = ["--set", "basin.theta.count=9", "--set", "basin.velocity.count=9", "--set", "basin.attractors.starts=64"]


def start(*words, folder, ranks=2):
    launcher = ["mpirun", "-n", str(ranks)] if ranks else []
    return subprocess.Popen([*launcher, str(PROGRAM), *map(str, words)], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def grown(checkpoint, beyond=5000):
    return saved_bytes(checkpoint) > beyond


@pytest.fixture(scope="module")
def undisturbed(kapitza, tmp_path_factory):
    """The datasets of the slow scene on one rank."""
    folder = tmp_path_factory.mktemp("undisturbed")
    kapitza("run", SMALL, *SLOW, folder=folder)
    return datasets(folder / "small.h5")


@pytest.fixture
def disk(tmp_path):
    """disk(options) -> a folder on a file system of its own, unmounted at the end."""
    mounted = []

    def mount(options):
        folder = tmp_path / "disk"
        folder.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder],
                          capture_output=True).returncode != 0:
            pytest.skip("mounting needs more rights than this user has")
        mounted.append(folder)
        return folder

    yield mount
    for folder in mounted:
        subprocess.run(["umount", "-l", folder], check=True)


def test_a_read_only_disk_is_known_beforehand(disk):
    folder = disk("size=1m")
    subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    process = start("run", SMALL, folder=folder)
    _, errors = process.communicate()
    assert process.returncode == 2 and "Read-only file system" in errors and errors.count("\n") == 1


@pytest.mark.parametrize("kilobytes", [64, 200])
def test_a_full_disk_fails_clearly_and_leaves_no_half_file(disk, kilobytes):
    folder = disk(f"size={kilobytes}k")
    process = start("run", SMALL, *SLOW, "--set", "basin.theta.count=300", folder=folder)
    _, errors = process.communicate()
    assert process.returncode == 1 and "No space left" in errors and errors.count("\n") == 1, errors
    assert {path.name for path in folder.iterdir()} <= {"small.h5.checkpoint"}


def test_a_disk_that_was_full_is_resumed_once_there_is_room(disk, undisturbed):
    folder = disk("size=100k")
    process = start("run", SMALL, *SLOW, folder=folder)
    process.communicate()
    assert process.returncode == 1
    subprocess.run(["mount", "-o", "remount,size=20m", folder], check=True)
    process = start("run", SMALL, *SLOW, "--resume", folder=folder, ranks=3)
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    assert datasets(folder / "small.h5") == undisturbed and [path.name for path in folder.iterdir()] == ["small.h5"]


@pytest.mark.parametrize("victim", ["small.h5.checkpoint", "small.h5.part"])
def test_files_removed_under_the_run(tmp_path, undisturbed, victim):
    """A complete result or a clear failure: never a partial file, never a different result."""
    process = start("run", SMALL, *SLOW, folder=tmp_path)
    wait_for(lambda: grown(tmp_path / "small.h5.checkpoint"))
    (tmp_path / victim).unlink()
    _, errors = process.communicate()
    if process.returncode == 0:
        assert datasets(tmp_path / "small.h5") == undisturbed
    else:
        assert process.returncode == 1 and errors.count("\n") == 1 and not (tmp_path / "small.h5").exists(), errors


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """The checkpoint of a run that SIGUSR1 stopped amid its cells."""
    folder = tmp_path_factory.mktemp("stopped")
    process = start("run", SMALL, *SLOW, folder=folder)
    wait_for(lambda: grown(folder / "small.h5.checkpoint"))
    process.send_signal(signal.SIGUSR1)
    _, errors = process.communicate()
    assert process.returncode == 75 and errors.count("\n") == 1, errors
    return (folder / "small.h5.checkpoint").read_bytes()


@pytest.mark.parametrize("damage", ["half", "one byte less", "head alone", "empty", "noise at the end", *range(3)])
def test_damaged_checkpoints_are_never_used(kapitza, tmp_path, undisturbed, stopped, damage):
    """Refused with one line, or what is damaged is done again: the same bytes in the end."""
    data = bytearray(stopped)
    if isinstance(damage, int):
        draw = random.Random(damage)
        for _ in range(3):
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    cut = {"half": len(data) // 2, "one byte less": len(data) - 1, "head alone": 10, "empty": 0}.get(damage, len(data))
    (tmp_path / "small.h5.checkpoint").write_bytes(data[:cut] + (b"\xa5" * 999 if damage == "noise at the end"
                                                                 else b""))
    done = kapitza("run", SMALL, *SLOW, "--resume", ranks=2, folder=tmp_path, status=None)
    if done.returncode == 0:
        assert datasets(tmp_path / "small.h5") == undisturbed
    else:
        assert done.returncode == 2 and "checkpoint" in done.stderr and done.stderr.count("\n") == 1, done.stderr


def test_memory_that_one_rank_may_not_have_ends_all(tmp_path):
    """Rank 1 alone may have little memory: it says so beforehand, and all ranks leave with one line."""
    table = ["--set", "basin.method=icm", "--set", "basin.icm={theta: 9000, velocity: 9000}"]
    limit = 'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then ulimit -v 600000; fi; exec "$@"'
    words = ["mpirun", "-n", "2", "bash", "-c", limit, "limited", str(PROGRAM), "run", str(SMALL), *table]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and "ulimit" in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert not list(tmp_path.iterdir())


LONG = "orbit={start: {theta: 0.5, velocity: 0}, periods: 300000, samples_per_period: 32}"  # a minute in one piece


@pytest.mark.extensive
def test_work_in_one_piece_is_left_where_a_stop_is_asked(tmp_path):
    """No tile ends for a minute: the run is left by the clock, what was finished before stays."""
    reasons = {"SIGUSR1": [], "the time limit": ["--time-limit", "3"]}
    runs = []
    for number, (reason, words) in enumerate(reasons.items()):
        folder = tmp_path / str(number)
        folder.mkdir()
        runs.append((folder, reason, start("run", SMALL, "--set", LONG, *words, folder=folder)))
    wait_for(lambda: grown(tmp_path / "0" / "small.h5.checkpoint"))
    time.sleep(1)
    runs[0][2].send_signal(signal.SIGUSR1)
    for folder, reason, process in runs:
        _, errors = process.communicate()
        assert process.returncode == 75 and errors.count("\n") == 1 and f"stopped by {reason}" in errors, errors
        saved = "finished work is in small.h5.checkpoint" in errors
        assert [path.name for path in folder.iterdir()] == (["small.h5.checkpoint"] if saved else [])
        assert saved or (reason == "the time limit" and "nothing was saved" in errors)  # two seconds of a busy machine


@pytest.mark.parametrize("name", ["SIGUSR2", "SIGXCPU"])
def test_what_batch_systems_send_asks_for_a_stop(tmp_path, name):
    process = start("run", SMALL, *SLOW, folder=tmp_path, ranks=None)
    wait_for(lambda: grown(tmp_path / "small.h5.checkpoint"))
    process.send_signal(getattr(signal, name))
    _, errors = process.communicate()
    assert process.returncode == 75 and f"stopped by {name}" in errors


def test_resume_of_a_complete_file_removes_its_own_checkpoint_alone(kapitza, tmp_path, stopped):
    """The file is complete for one scene; another one, run into it with --force, was stopped."""
    checkpoint = tmp_path / "small.h5.checkpoint"
    kapitza("run", SMALL, *FEW, folder=tmp_path)
    checkpoint.write_bytes(stopped)
    done = kapitza("run", SMALL, *FEW, "--resume", ranks=2, folder=tmp_path)
    assert "already complete" in done.stdout and checkpoint.read_bytes() == stopped
    (tmp_path / "small.h5").unlink()
    kapitza("run", SMALL, *SLOW, "--resume", folder=tmp_path)
    checkpoint.write_bytes(stopped)
    kapitza("run", SMALL, *SLOW, "--resume", folder=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["small.h5"]


def test_an_error_is_told_before_any_rank_ends(kapitza, tmp_path):
    """mpirun kills the others about a second after one rank has failed; rank 0, which speaks, may be slower than
    that."""
    (tmp_path / "small.h5").touch()
    done = kapitza("run", SMALL, folder=tmp_path, launcher=launched(2, "slow_end", REST=3), status=2)
    assert done.stderr.startswith("kapitza: error: small.h5: exists") and done.stderr.count("\n") == 1


def test_ranks_in_different_folders(tmp_path):
    for name in "ab":
        (tmp_path / name).mkdir()
    one, other = (["-n", "1", "-wdir", tmp_path / name, PROGRAM, "run", SMALL] for name in "ab")
    words = ["mpirun", *one, ":", *other]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    assert done.returncode == 2 and "cannot be opened by every rank" in done.stderr, done.stderr
    assert not list(tmp_path.glob("*/*"))


@pytest.mark.parametrize("how", ["a file appears", "the folder is removed", "the folder is renamed"])
def test_the_folder_changes_under_the_run(tmp_path, how):
    folder = tmp_path / "folder"
    folder.mkdir()
    process = start("run", SMALL, *SLOW, "-o", "folder/small.h5", folder=tmp_path)
    wait_for(lambda: grown(folder / "small.h5.checkpoint"))
    if how == "a file appears":
        (folder / "small.h5").write_text("mine")
    elif how == "the folder is removed":
        shutil.rmtree(folder)
    else:
        folder.rename(tmp_path / "elsewhere")
    _, errors = process.communicate()
    assert process.returncode == 1 and errors.startswith("kapitza: error: folder/small.h5") and errors.count(
        "\n") == 1, errors
    if how == "a file appears":
        assert (folder / "small.h5").read_text() == "mine" and (folder / "small.h5.checkpoint").exists()
    elif how == "the folder is renamed":
        assert (tmp_path / "elsewhere" / "small.h5.checkpoint").exists() and not list(tmp_path.rglob("small.h5"))


def test_two_runs_into_one_file(tmp_path, undisturbed):
    """The second waits for the first, and overwrites nothing: the same scene is done already, another one is
    refused."""
    first = start("run", SMALL, *SLOW, folder=tmp_path)
    wait_for(lambda: grown(tmp_path / "small.h5.checkpoint"))
    same = start("run", SMALL, *SLOW, "--resume", folder=tmp_path, ranks=None)
    other = start("run", SMALL, *FEW, "--resume", folder=tmp_path, ranks=None)
    (said, _), (_, errors) = same.communicate(), other.communicate()
    assert first.wait() == 0 and same.returncode == 0 and "already complete" in said
    assert other.returncode == 2 and errors.count("\n") == 1, errors
    assert datasets(tmp_path / "small.h5") == undisturbed


@pytest.mark.parametrize("closed, status", [(">&-", 1), ("2>&-", 0), ("<&- >&- 2>&-", 1), (">/dev/full", 1),
                                            ("2>&1 | true", 0)])
def test_streams_that_are_closed_or_full(kapitza, tmp_path, undisturbed, closed, status):
    """What is printed never lands in a file of the run, and nobody who reads the progress is no reason to stop."""
    words = " ".join(map(repr, map(str, [PROGRAM, "run", SMALL, "--progress", "always", *SLOW])))
    done = subprocess.run(["bash", "-c", f"{words} {closed}"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    assert datasets(tmp_path / "small.h5") == undisturbed and [path.name for path in tmp_path.iterdir()] == ["small.h5"]


def test_the_environment_changes_no_byte(tmp_path, undisturbed):
    """Memory filled with noise, a decimal comma, other people's settings."""
    noise = {"MALLOC_PERTURB_": "170", "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8", "TZ": "Asia/Kolkata",
             "OMP_NUM_THREADS": "7",
             "GFORTRAN_UNBUFFERED_ALL": "1", "HDF5_USE_FILE_LOCKING": "FALSE", "POSIXLY_CORRECT": "1"}
    words = [str(PROGRAM), "run", *SLOW, str(SMALL)]
    done = subprocess.run(words, cwd=tmp_path, env=os.environ | noise, capture_output=True, text=True)
    assert done.returncode == 0 and datasets(tmp_path / "small.h5") == undisturbed, done.stderr


def test_a_reader_of_the_old_result_is_not_disturbed(kapitza, tmp_path):
    kapitza("run", SMALL, *FEW, folder=tmp_path)
    with h5py.File(tmp_path / "small.h5") as old:
        kapitza("run", SMALL, *FEW, "--force", "--set", "basin.theta.count=7", folder=tmp_path)
        assert old["basin/attractor"].shape == (9, 9)
    with h5py.File(tmp_path / "small.h5") as new:
        assert new["basin/attractor"].shape == (9, 7)


@pytest.mark.parametrize("ranks", with_extensive([7], [5]))
def test_odd_counts_of_ranks_and_more_ranks_than_tiles(kapitza, tmp_path, undisturbed, ranks):
    kapitza("run", SMALL, *SLOW, ranks=ranks, folder=tmp_path)
    assert datasets(tmp_path / "small.h5") == undisturbed


def test_kills_lose_nothing(tmp_path):
    """A few rounds of the kill loop on the whole program."""
    loop = ROOT / "tests" / "tools" / "kill_loop.py"
    words = [sys.executable, loop, "--rounds", "2", tmp_path / "kills", PROGRAM, "run", SMALL, "-o", "OUT.h5", *SLOW]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    assert done.returncode == 0 and "nothing lost" in done.stdout, done.stdout + done.stderr


def ranks_of(process):
    """The process ids of the program's ranks below an mpirun."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children if Path(f"/proc/{child}/comm").read_text().strip() == "kapitza"]


def test_a_sleeping_rank_delays_but_spoils_nothing(tmp_path, undisturbed):
    process = start("run", SMALL, *SLOW, folder=tmp_path, ranks=3)
    wait_for(lambda: grown(tmp_path / "small.h5.checkpoint"))
    sleeper = ranks_of(process)[-1]
    for _ in range(5):
        try:
            os.kill(sleeper, signal.SIGSTOP)
            time.sleep(0.2)
            os.kill(sleeper, signal.SIGCONT)
        except ProcessLookupError:
            break
        time.sleep(0.02)
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    assert datasets(tmp_path / "small.h5") == undisturbed
