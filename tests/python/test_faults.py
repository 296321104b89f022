"""Hard knocks on the whole program: disks that fill or vanish, damaged checkpoints, memory that runs out, ranks that sleep or
outnumber their tiles, kills. docs/reliability.md says what is promised; tests/tools/kill_loop.py is the long version."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, datasets

SMALL = ROOT / "scenes" / "small.yaml"
SLOW = ["--set", "basin.method=direct", "--set", "basin.theta.count=200", "--set", "basin.velocity.count=200",
        "--set", "numerics.steps_per_period=96", "--set", "basin.attractors.starts=64"]
PLOTS = sorted(path.name for path in (ROOT / "scripts").glob("plot_*.py"))


def start(*words, folder, ranks=2):
    launcher = ["mpirun", "-n", str(ranks)] if ranks else []
    return subprocess.Popen([*launcher, str(PROGRAM), *map(str, words)], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def ranks_of(process):
    """The process ids of the program's ranks below an mpirun."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children if Path(f"/proc/{child}/comm").read_text().strip() == "kapitza"]


def wait_for(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.02)


def grown(path, beyond=20000):
    return path.exists() and path.stat().st_size > beyond


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
        if subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], capture_output=True).returncode != 0:
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
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 2 and "Read-only file system" in errors and errors.count("\n") == 1


@pytest.mark.parametrize("kilobytes", [64, 200])
def test_a_full_disk_fails_clearly_and_leaves_no_half_file(disk, kilobytes):
    folder = disk(f"size={kilobytes}k")
    process = start("run", SMALL, *SLOW, "--set", "basin.theta.count=300", folder=folder)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 1 and "No space left" in errors and errors.count("\n") == 1, errors
    assert {path.name for path in folder.iterdir()} <= {"small.h5.checkpoint"}


def test_a_disk_that_was_full_is_resumed_once_there_is_room(disk, undisturbed):
    folder = disk("size=100k")
    process = start("run", SMALL, *SLOW, folder=folder)
    process.communicate(timeout=120)
    assert process.returncode == 1
    subprocess.run(["mount", "-o", "remount,size=20m", folder], check=True)
    process = start("run", SMALL, *SLOW, "--resume", folder=folder, ranks=3)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert datasets(folder / "small.h5") == undisturbed and [path.name for path in folder.iterdir()] == ["small.h5"]


@pytest.mark.parametrize("victim", ["small.h5.checkpoint", "small.h5.part"])
def test_files_removed_under_the_run(tmp_path, undisturbed, victim):
    """Whole results or a clear failure: never a half file, never another result."""
    process = start("run", SMALL, *SLOW, folder=tmp_path)
    wait_for(lambda: grown(tmp_path / "small.h5.checkpoint"))
    (tmp_path / victim).unlink()
    _, errors = process.communicate(timeout=120)
    if process.returncode == 0:
        assert datasets(tmp_path / "small.h5") == undisturbed
    else:
        assert process.returncode == 1 and errors.count("\n") == 1 and not (tmp_path / "small.h5").exists(), errors


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """The checkpoint of a run that SIGUSR1 stopped half way, and how long that took."""
    folder = tmp_path_factory.mktemp("stopped")
    process = start("run", SMALL, *SLOW, folder=folder)
    wait_for(lambda: grown(folder / "small.h5.checkpoint"))
    begun = time.monotonic()
    process.send_signal(signal.SIGUSR1)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 75 and errors.count("\n") == 1, errors
    return (folder / "small.h5.checkpoint").read_bytes(), time.monotonic() - begun


def test_a_stop_request_is_obeyed_within_ten_seconds(stopped):
    assert stopped[1] < 10


@pytest.mark.parametrize("damage", ["half", "one byte less", "head alone", "empty", "noise at the end", *range(3)])
def test_damaged_checkpoints_are_never_used(kapitza, tmp_path, undisturbed, stopped, damage):
    """Refused with one line, or what is damaged is done again: the same bytes in the end."""
    data = bytearray(stopped[0])
    if isinstance(damage, int):
        draw = random.Random(damage)
        for _ in range(3):
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    cut = {"half": len(data) // 2, "one byte less": len(data) - 1, "head alone": 10, "empty": 0}.get(damage, len(data))
    (tmp_path / "small.h5.checkpoint").write_bytes(data[:cut] + (b"\xa5" * 999 if damage == "noise at the end" else b""))
    done = kapitza("run", SMALL, *SLOW, "--resume", ranks=2, folder=tmp_path, status=None)
    if done.returncode == 0:
        assert datasets(tmp_path / "small.h5") == undisturbed
    else:
        assert done.returncode == 2 and "checkpoint" in done.stderr and done.stderr.count("\n") == 1, done.stderr


def test_memory_that_cannot_be_there_is_refused(kapitza, tmp_path):
    counts = ["--set", "basin.theta.count=1000000", "--set", "basin.velocity.count=1000000"]
    done = kapitza("run", SMALL, *counts, ranks=2, folder=tmp_path, status=2)
    assert "TB of memory" in done.stderr and "smaller counts" in done.stderr and not list(tmp_path.iterdir())


def test_memory_that_one_rank_may_not_have_ends_all(tmp_path):
    """Rank 1 alone may have little memory: it says so beforehand, and all ranks leave with one line."""
    table = ["--set", "basin.icm={theta: 4000, velocity: 4000}"]
    limit = 'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then ulimit -v 600000; fi; exec "$@"'
    words = ["mpirun", "-n", "2", "bash", "-c", limit, "limited", str(PROGRAM), "run", str(SMALL), *table]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2 and "ulimit" in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ranks", [5, 7])
def test_odd_counts_of_ranks_and_more_ranks_than_tiles(kapitza, tmp_path, undisturbed, ranks):
    kapitza("run", SMALL, *SLOW, ranks=ranks, folder=tmp_path)
    assert datasets(tmp_path / "small.h5") == undisturbed


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
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert datasets(tmp_path / "small.h5") == undisturbed


def test_kills_lose_nothing(tmp_path):
    """A few rounds of the kill loop on the whole program."""
    loop = ROOT / "tests" / "tools" / "kill_loop.py"
    words = [sys.executable, loop, "--rounds", "2", tmp_path / "kills", PROGRAM, "run", SMALL, "-o", "OUT.h5", *SLOW]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=280)
    assert done.returncode == 0 and "nothing lost" in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("script", PLOTS)
@pytest.mark.parametrize("how", ["empty", "foreign text", "half", "no groups"])
def test_plots_answer_bad_files_with_one_line(small_result, tmp_path, script, how):
    path = tmp_path / "bad.h5"
    data = small_result.read_bytes()
    path.write_bytes({"empty": b"", "foreign text": b"a,b\n1,2\n" * 99, "half": data[: len(data) // 2]}.get(how, data))
    if how == "no groups":
        import h5py

        with h5py.File(path, "r+") as file:
            for group in set(file) - {"pendulum"}:
                del file[group]
    done = subprocess.run([sys.executable, ROOT / "scripts" / script, path, "-o", tmp_path / "x.png"], capture_output=True,
                          text=True, timeout=60)
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "bad.h5" in done.stderr, done.stderr
    assert not (tmp_path / "x.png").exists()
