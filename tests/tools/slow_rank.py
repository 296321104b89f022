"""Measures what a slow rank costs: the last rank runs for a tenth of the time (SIGSTOP, SIGCONT), and the run is timed.

    slow_rank.py [--ranks N] [--share S] [--times T] FOLDER PROGRAM WORD...

A word OUT stands for the result file. Printed: seconds on N - 1 ranks, on N, and on N with the slow one, the median of T runs.
Tiles are drawn, not dealt: the slow rank should cost no more than its own work, so the last figure should lie between the others.
Example: slow_rank.py FOLDER build/kapitza run scenes/small.yaml --set basin.method=direct -o OUT.h5 --force
"""

import argparse
import os
import signal
import statistics
import subprocess
import time
from pathlib import Path

from mpi_settings import MPI_SETTINGS

SLICE = 0.05  # s: stop and go of the slow rank together


def ranks_of(process, program):
    """The ids of the program's processes below an mpirun, in the order of their start."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return sorted(int(child) for child in children if Path(f"/proc/{child}/comm").read_text().strip() == Path(program).name)


def nap(rank, share):
    """Stops a rank for the rest of a slice; False where it has ended."""
    try:
        os.kill(rank, signal.SIGSTOP)
        time.sleep(SLICE * (1 - share))
        os.kill(rank, signal.SIGCONT)
    except ProcessLookupError:
        return False
    time.sleep(SLICE * share)
    return True


def seconds(words, ranks, share=None):
    """Wall time of a run, with the last rank slowed down to `share` of the time."""
    begun = time.monotonic()
    launcher = ["mpirun", "-n", str(ranks)]
    process = subprocess.Popen([*launcher, *words], stdout=subprocess.DEVNULL, env=os.environ | MPI_SETTINGS)
    while share is not None and len(found := ranks_of(process, words[0])) < ranks and process.poll() is None:
        time.sleep(0.01)
    while share is not None and process.poll() is None and nap(found[-1], share):
        pass
    assert process.wait() == 0, words
    return time.monotonic() - begun


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--share", type=float, default=0.1)
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("folder", type=Path)
    parser.add_argument("words", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    words = [word.replace("OUT", str(options.folder / "out")) for word in options.words]
    cases = {f"{options.ranks - 1} ranks": (options.ranks - 1, None), f"{options.ranks} ranks": (options.ranks, None),
             f"{options.ranks} ranks, one at {options.share:.0%}": (options.ranks, options.share)}
    for name, (ranks, share) in cases.items():
        print(f"{name}: {statistics.median(seconds(words, ranks, share) for _ in range(options.times)):.2f} s", flush=True)


if __name__ == "__main__":
    main()
