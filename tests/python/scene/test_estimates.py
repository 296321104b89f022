"""What `kapitza check` estimates, against what runs take: memory of the largest rank, disk of the file and the
checkpoint."""

import json
import re
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, datasets, with_extensive

FIG12 = ROOT / "scenes" / "blackburn-fig12.yaml"
UNITS = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
LARGE = [pytest.param(n, ranks, marks=pytest.mark.extensive) for n in (1000, 8000) for ranks in (1, 4)]


def words(n, method):
    return [FIG12, "--set", f"basin.theta.count={n}", "--set", f"basin.velocity.count={n}", "--set",
            f"basin.method={method}"]


def estimates(kapitza, n, method):
    """Bytes: disk, of each rank, of the first besides, of all together besides."""
    text = kapitza("check", "--all", *words(n, method)).stdout
    disk = re.search(r"([\d.]+) (\w+) on disk", text)
    memory = re.search(r"memory per rank +([\d.]+) (\w+), ([\d.]+) (\w+) more on rank 0, and a share of ([\d.]+) (\w+)",
                       text)
    numbers = [*disk.groups(), *memory.groups()]
    return [float(number) * UNITS[unit] for number, unit in zip(numbers[::2], numbers[1::2], strict=True)]


def number(path, pattern):
    """A number of a file of /proc; 0 where its process has ended."""
    try:
        return int((re.search(pattern, path.read_text()) or [0, 0])[1])
    except OSError:
        return 0


def most(process, folder):
    """The most that the files of a folder take on the disk, and a rank of memory, until mpirun has ended; in bytes."""
    disk = memory = 0
    while process.poll() is None:
        time.sleep(0.02)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        ranks = children.read_text().split() if children.exists() else []
        memory = max([memory, *(1024 * number(Path(f"/proc/{rank}/status"), r"VmHWM:\s+(\d+)") for rank in ranks)])
        files = subprocess.run(["du", "-s", "-B1", folder], capture_output=True, text=True)
        disk = max(disk, int(files.stdout.split()[0]))
    return disk, memory


@pytest.mark.parametrize("n, ranks", [(600, 2), *LARGE])
@pytest.mark.parametrize("method", with_extensive(["icm"], ["direct"]))
def test_estimates_are_near(kapitza, tmp_path, n, ranks, method):
    process = subprocess.Popen(list(map(str, ["mpirun", "-n", ranks, PROGRAM, "run", *words(n, method)])), cwd=tmp_path,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    taken, used = most(process, tmp_path)
    disk, each, first, shared = estimates(kapitza, n, method)
    assert process.returncode == 0
    assert 1 / 1.5 < disk / taken < 1.5, (disk, taken)
    assert 1 / 1.5 < (each + first + shared / ranks) / used < 1.5, (each, first, shared, used)


@pytest.mark.extensive
def test_ten_billion_cells_can_be_checked(kapitza):
    disk, each, first, shared = estimates(kapitza, 100_000, "direct")
    assert "10000000000" in kapitza("check", *words(100_000, "direct")).stdout
    assert each + first < 2e8 and 1e9 < shared < 1e10 and 1e9 < disk < 1e10


@pytest.mark.extensive
def test_many_unsettled_cells_are_labelled_again_in_parts(kapitza, tmp_path):
    """Two starts find two attractors; 1.4 million cells end elsewhere, more than a rank lists at a time. The same bytes
    on three ranks."""
    few = ["--set", "basin.attractors.starts=2", "--set", "basin.max_periods=40"]
    for ranks in (1, 3):
        kapitza("run", *words(2600, "direct"), *few, "-o", f"{ranks}.h5", "--log", f"{ranks}.jsonl", folder=tmp_path,
                ranks=ranks)
        stages = [json.loads(line).get("stage") for line in (tmp_path / f"{ranks}.jsonl").read_text().splitlines()
                  if '"stage", ' in line]
        assert stages.count("cells 1") == 1 and stages.count("cells 2") == 2, stages
    assert datasets(tmp_path / "1.h5") == datasets(tmp_path / "3.h5")
