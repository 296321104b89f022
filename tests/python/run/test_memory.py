"""Memory that runs out in the middle, at any allocation of the program: the right bytes or one line and status 1, never
a hang, a crash, a half file or a lost checkpoint. KAPITZA_EXTENSIVE=1 tries 60 places of each scene instead of a
few."""

import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import EXTENSIVE, PROGRAM, datasets, launched, with_extensive

PLACES = 60 if EXTENSIVE else 2
FOREVER = 10**12
PENDULUM = "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}\n"
BASIN = ("basin: {theta: {count: 24}, velocity: {min: -1, max: 1, count: 24}, icm: {theta: 64, velocity: 64}, method: "
         "icm, "
         "attractors: {starts: 64}}\n")
SCENES = {
    "basin": BASIN + "orbit: {attractor: 0}\n",
    "attractors": "attractors: {velocity: {min: -1, max: 1}, starts: 64}\n",
    "orbit": "orbit: {start: {theta: 0.5, velocity: 0}, transient: 10, periods: 16}\n",
    "stability": "stability: {k: {min: -0.5, max: 1, count: 40}, m: {min: 0, max: 1, count: 40}, curves: [exact_1, "
                 "damped_1], "
                 "subharmonics: [2]}\npotential: {drive_amplitudes: [0.1], theta: {count: 20}}\n",
    "sweep": "sweep: {parameter: drive_amplitude, min: 0.29, max: 0.3, count: 2, velocity: {min: -1, max: 1}, starts: "
             "16, "
             "measure: [attractors, release_angle, strobe]}\n",
    "tradeoff": BASIN.replace("icm: {theta: 64, velocity: 64}, method: icm, ", "")
    + "tradeoff: {samples: 16, settings: [direct-8]}\n",
}
CLOCKS = {"tradeoff/seconds", "tradeoff/seconds_per_million_cells"}


def result(folder):
    return {name: data for name, data in datasets(folder / "x.h5").items() if name not in CLOCKS}


def run(folder, *words, **settings):
    """Two ranks with the malloc that fails on purpose (tests/tools/failing_memory.c)."""
    launcher = launched(2, "failing_memory", **{f"FAIL_{name}": value for name, value in settings.items()})
    return subprocess.run([*launcher, PROGRAM, "run", "scene.yaml", "-o", "x.h5", *words], cwd=folder,
                          capture_output=True, text=True)


def knock(folder, rank, first, count):
    """A run that fails at allocation `first` of a rank; its end, what it left, and the end of the run that resumes
    it."""
    folder.mkdir()
    shutil.copy(folder.parent / "scene.yaml", folder)
    done = run(folder, RANK=rank, FIRST=first, COUNT=count)
    left = {path.name for path in folder.iterdir()}
    return done, left, run(folder, "--resume", FIRST=FOREVER) if "x.h5.checkpoint" in left else done


@pytest.fixture(scope="module")
def pool():
    with ThreadPoolExecutor(4) as threads:  # starting and ending MPI is mostly waiting
        yield threads


@pytest.fixture(scope="module", params=with_extensive(["basin", "sweep"], SCENES))
def knocks(request, tmp_path_factory, pool):
    """(folder of each knock, its future), and the result of an undisturbed run."""
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "scene.yaml").write_text(PENDULUM + SCENES[request.param])
    done = run(folder, TALLY=folder / "tally")
    assert done.returncode == 0, done.stderr
    counts = [int((folder / f"tally{rank}").read_text()) for rank in (0, 1)]
    started = []
    for place in range(PLACES):
        first = 1 + int(counts[place % 2] * ((place + 1) * 0.61803 % 1))
        own = folder / str(place)
        started.append((own, pool.submit(knock, own, place % 2, first, FOREVER if place % 3 == 2 else 1)))
    return started, result(folder)


@pytest.mark.parametrize("place", range(PLACES))
def test_memory_runs_out(knocks, place):
    started, expected = knocks
    folder, future = started[place]
    done, left, last = future.result()
    if done.returncode != 0:  # 0: the other rank drew the tiles
        words = done.stderr
        if "HDF5 cannot be started" in words:  # only what has started can be told to say nothing
            words = re.sub(r"^(HDF5-DIAG: .*|  #\d+: .*| {4}(major|minor): .*)\n", "", words, flags=re.MULTILINE)
        assert done.returncode in (1, 2) and words.startswith("kapitza: error: ") and words.count("\n") == 1, done
        assert "memory" in words and left <= {"scene.yaml", "x.h5.checkpoint", "x.h5.truth"}, (left, done)
    if last.returncode == 0:
        assert result(folder) == expected
    else:
        assert last is done
