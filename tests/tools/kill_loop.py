"""Kills a program with a checkpoint at random moments, resumes it at once, and compares its result with an undisturbed
one.

    kill_loop.py [--rounds N] [--seed S] [--ranks 1,2,3,4] FOLDER PROGRAM [WORD...]

A word OUT stands for the result file; --resume is added from the second start on. Example:
    kill_loop.py --rounds 30 /tmp/kills build/kapitza run scenes/small.yaml -o OUT.h5

Each round starts the program on a random number of ranks, ends it by a random knock (SIGKILL of mpirun, of one rank or
of all; SIGTERM, SIGINT or SIGUSR1 to mpirun) until it has been knocked a few times, and lets the last start finish. A
start that hangs (unless a kill came before the program began), a result that differs, a checkpoint that stays, or work
done twice beyond the tiles in flight is a failure.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from mpi_settings import MPI_SETTINGS

HANG = 90  # s
KNOCKS = ["kill mpirun", "kill a rank", "kill all", "SIGTERM", "SIGINT", "SIGUSR1"]
STOPPED, REFUSED = 75, 2
# Statuses after SIGUSR1: the stop was heard; or the signal came to mpirun, or to a rank, before it listened.
ENDINGS = (STOPPED, -signal.SIGUSR1, 128 + signal.SIGUSR1, 1)


class Failure(Exception):
    """What a round found."""


def start(words, ranks):
    launcher = ["mpirun", "-n", str(ranks)]
    return subprocess.Popen(launcher + words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
                            text=True, env=os.environ | MPI_SETTINGS)


def children(parent):
    """Processes started by `parent`, at any depth."""
    parents = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parents[int(entry.name)] = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except (OSError, IndexError):
                continue
    found = {parent}
    while grown := {child for child, above in parents.items() if above in found} - found:
        found |= grown
    return sorted(found - {parent})


def send(process, number):
    try:
        os.kill(process, number)
    except ProcessLookupError:
        pass


def knock(process, kind):
    """Knocks at a running mpirun; the ranks that were there."""
    ranks = children(process.pid)
    if kind == "kill a rank" and ranks:
        send(random.choice(ranks), signal.SIGKILL)
    elif kind == "kill all":
        for victim in [process.pid, *ranks]:
            send(victim, signal.SIGKILL)
    elif kind == "kill mpirun":
        send(process.pid, signal.SIGKILL)
    elif kind.startswith("SIG"):
        send(process.pid, getattr(signal, kind))
    return ranks


def finish(process, what):
    try:
        text, _ = process.communicate(timeout=HANG)
    except subprocess.TimeoutExpired:
        for victim in [process.pid, *children(process.pid)]:
            send(victim, signal.SIGKILL)
        raise Failure(f"{what} hangs") from None
    return process.returncode, text


def outputs(folder, words):
    """The words of the command with OUT replaced, and the result file."""
    named = [word.replace("OUT", str(folder / "out")) for word in words]
    result = next(Path(word) for word, raw in zip(named, words, strict=True) if "OUT" in raw)
    return named, result


def datasets(path):
    """What must be the same in every run: every dataset of an HDF5 file, else the bytes."""
    if path.suffix != ".h5":
        return {"bytes": path.read_bytes()}
    import h5py

    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item[()].tolist() if item.dtype == object else item[()].tobytes()  # object: text

    with h5py.File(path, "r") as file:
        file.visititems(keep)
    return found


def one_round(folder, words, expected, longest, all_ranks):
    """Knocks until the program gets through; returns the knocks."""
    named, result = outputs(folder, words)
    done, most = [], random.randint(1, 4)
    while True:
        ranks = random.choice(all_ranks)
        process = start(named + (["--resume"] if done else []), ranks)
        what = f"{' + '.join(done) or 'the first start'}, then {ranks} ranks"
        kind, there = None, []
        if len(done) < most:
            time.sleep(random.uniform(0.05, longest))
            kind = random.choice(KNOCKS)
            what += f", {kind}"
            there = knock(process, kind)
        try:
            code, text = finish(process, what)
        except Failure:
            if not (kind or "").startswith("kill") or list(folder.glob("*.checkpoint")):
                raise
            code, text = None, ""  # the program had not begun: MPI's own start may wait for a launcher that was killed
            for orphan in there:
                send(orphan, signal.SIGKILL)
        if code == 0 and result.exists():
            break
        if kind is None or code == REFUSED or (kind == "SIGUSR1" and code not in ENDINGS):
            raise Failure(f"{what}: status {code}\n{text}")
        done.append(kind)
    check(folder, result, expected, len(done) * max(all_ranks), what)
    return done


def differing(found, expected):
    return sorted(name for name in {*found, *expected} if found.get(name) != expected.get(name))


def check(folder, result, expected, in_flight, what):
    if datasets(result) != expected:
        raise Failure(f"{what}: another result: {differing(datasets(result), expected)}")
    for _ in range(50):  # orphans that were late may still be ending
        left = [str(path) for path in folder.glob("*.checkpoint")]
        if not left:
            break
        time.sleep(0.1)
    if left:
        raise Failure(f"{what}: {left} stays")
    log = Path(f"{result}.log")
    once = ONCE.get("tiles")
    if log.exists() and once and log.stat().st_size > once + in_flight:
        raise Failure(
            f"{what}: {log.stat().st_size} tiles were begun where {once} are needed and {in_flight} were in flight")


ONCE = {}  # tiles of an undisturbed run, where the program tells


def undisturbed(folder, words):
    """The expected result and how long it takes on the fewest ranks."""
    folder.mkdir()
    named, result = outputs(folder, words)
    begun = time.monotonic()
    code, text = finish(start(named, 1), "the undisturbed run")
    if code != 0:
        raise Failure(f"the undisturbed run: status {code}\n{text}")
    log = Path(f"{result}.log")
    if log.exists():
        ONCE["tiles"] = log.stat().st_size
    return datasets(result), time.monotonic() - begun


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--seed", type=int, default=None, help="default: from the clock, printed")
    parser.add_argument("--ranks", default="1,2,3,4")
    parser.add_argument("folder", type=Path)
    parser.add_argument("words", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else int(time.time())
    random.seed(seed)
    ranks = [int(word) for word in options.ranks.split(",")]
    if options.folder.exists():
        parser.error(f"{options.folder} is there; a new folder")
    options.folder.mkdir(parents=True)
    counts = dict.fromkeys(KNOCKS, 0)
    try:
        expected, seconds = undisturbed(options.folder / "undisturbed", options.words)
        for number in range(options.rounds):
            folder = options.folder / str(number)
            folder.mkdir()
            for kind in one_round(folder, options.words, expected, seconds, ranks):
                counts[kind] += 1
    except Failure as failure:
        sys.exit(f"seed {seed}: {failure}")
    print(f"seed {seed}: {options.rounds} rounds, {sum(counts.values())} knocks, nothing lost:", counts)


if __name__ == "__main__":
    main()
