"""Time per cell and share of wrong labels of this program and of textbook RK4, from one run on one core.

The textbook programs (benchmarks/) label a random subset of the scene's cells and are told the attractors; only their
labelling is timed. This program labels the whole scene; its time is that of the whole command: start, discovery, table,
cells, file. The marginal cost of a cell is what a finer grid of the same window (--fine) takes longer than the scene's,
per cell that it has more: all that a run does once falls out. The programs are run alternately, so changes of the
machine's speed affect all; ratios are taken within each round."""

import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

import reference_check  # noqa: E402
from kapitza import BadFile, Result  # noqa: E402
from kapitza.exit_status import run_script  # noqa: E402

PROGRAM = ROOT / "build" / "kapitza"
LABEL_CACHE = ROOT / "results" / "benchmark-truth"
TWIN = "RK4-100, SIMD twin"
# name | program in build/benchmarks | cells timed
TEXTBOOK = [("RK4-100, textbook", "textbook", 2000), (TWIN, "twin", 100_000)]
# name: scene keys. First the defaults, then the cheapest settings that are no worse than the twin, then the ICM of
# 1992.
OURS = [
    "direct: basin.method=direct",
    "ICM: basin.method=icm",
    "direct, 1e-7: basin.method=direct numerics.tolerance=1e-7",
    "ICM, 700 nodes: basin.method=icm basin.icm.theta=700 basin.icm.velocity=700",
    "ICM, linear: basin.method=icm basin.icm.interpolation=linear",
]
MARGINAL = ["direct", "ICM"]  # of these
UNKNOWN = -2  # an attractor that the reference catalogue lacks


def pinned(command, core, **options):
    """Runs a command on one core; its output and its processor seconds: other processes do not count."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["taskset", "-c", str(core), *map(str, command)], check=False, text=True, capture_output=True,
                          **options)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    if done.returncode:
        raise BadFile(f"{' '.join(map(str, command))}: {done.stderr.strip() or f'status {done.returncode}'}")
    return done.stdout, seconds


def textbook_run(program, catalogue, theta, velocity, core):
    """Labels (attractor ids) and seconds a cell."""
    text = catalogue.text(2000) + reference_check.states_text(theta, velocity)
    output, _ = pinned([ROOT / "build" / "benchmarks" / program], core, input=text)
    head, labels = output.split("\n", 1)
    return catalogue.ids(np.array(labels.split(), dtype=np.int64)), float(head.split()[0]) / len(theta)


class Ours:
    """One setting of this program on the scene."""

    def __init__(self, setting, scene, folder):
        self.name, _, keys = setting.partition(":")
        self.command = [PROGRAM, "run", scene, "--force", "--progress", "never"]
        self.command += [word for key in keys.split() for word in ("--set", key)]
        self.file = Path(folder) / (self.name.replace(" ", "-").replace(",", "") + ".h5")

    def seconds_per_cell(self, core):
        _, seconds = pinned([*self.command, "-o", self.file], core)
        return seconds / Result(self.file).group("basin")["attractor"].size

    def marginal_seconds(self, core, fine):
        """Seconds a cell that a grid of fine x fine cells takes beyond the scene's own."""
        finer = Ours(f"{self.name} fine: basin.theta.count={fine} basin.velocity.count={fine}", None, self.file.parent)
        finer.command = self.command + finer.command[finer.command.index("--set"):]
        seconds, cells = [], []
        for setting in (self, finer):
            seconds.append(pinned([*setting.command, "-o", setting.file], core)[1])
            cells.append(Result(setting.file).group("basin")["attractor"].size)
        finer.file.unlink()
        if cells[1] <= cells[0]:
            raise BadFile(f"--fine {fine}: the scene's own grid is not coarser")
        return (seconds[1] - seconds[0]) / (cells[1] - cells[0])

    def labels(self, cells, reference):
        """Labels of some cells in the ids of the reference catalogue."""
        result = Result(self.file)
        numbers = result.group("basin")["attractor"].values[cells].astype(np.int64)
        return translation(reference_check.Catalogue(result), reference)[numbers]


def translation(catalogue, reference):
    """Reference ids by a catalogue's own ids; the last entry is for -1. The same attractor = same period, same strobe
    point."""
    ids = np.full(len(catalogue.period) + 1, UNKNOWN)
    ids[-1] = reference_check.NONE
    for index in catalogue.periodic:
        gap = np.hypot(np.sin((reference.theta[:, 0] - catalogue.theta[index, 0]) / 2),
                       reference.velocity[:, 0] - catalogue.velocity[index, 0])
        same = np.flatnonzero((reference.period == catalogue.period[index]) & (gap < 1e-6))
        ids[index] = same[0] if len(same) else UNKNOWN
    if len(reference.chaotic):
        ids[catalogue.chaotic] = reference.chaotic[0]
    return ids


def cached_labels(catalogue, theta, velocity):
    """True labels; those of an earlier run where everything is the same."""
    key = hashlib.sha256((catalogue.text(4000) + reference_check.states_text(theta,
                                                                             velocity)).encode()).hexdigest()[:16]
    path = LABEL_CACHE / f"{key}.npy"
    if not path.exists():
        labels = reference_check.reference_labels(catalogue, theta, velocity, processes=os.cpu_count())
        path.parent.mkdir(parents=True, exist_ok=True)
        np.save(path, labels)
    return np.load(path)


def spread(values):
    return {"median": float(np.median(values)), "min": float(np.min(values)), "max": float(np.max(values))}


def rounds_of(arguments, ours, catalogue, states):
    """Seconds a cell of everyone, by name, one value a round."""
    seconds = {name: [] for name in [row[0] for row in TEXTBOOK] + [setting.name for setting in ours]}
    for number in range(arguments.rounds):
        print(f"benchmark: round {number + 1} of {arguments.rounds}", file=sys.stderr, flush=True)
        for name, program, count in TEXTBOOK:
            seconds[name].append(textbook_run(program, catalogue, *states(count, number + 1), arguments.core)[1])
        for setting in ours:
            seconds[setting.name].append(setting.seconds_per_cell(arguments.core))
    return seconds


def marginal_of(arguments, ours, catalogue, states):
    """Microseconds a further cell of this program, and how often these go into the twin's microseconds, one value a
    round."""
    rows = {setting.name: ([], []) for setting in ours if setting.name in MARGINAL}
    for _ in range(arguments.rounds if arguments.fine else 0):
        twin = textbook_run("twin", catalogue, *states(TEXTBOOK[1][2], 1), arguments.core)[1]
        for setting in ours:
            if setting.name in rows:
                taken, ratio = rows[setting.name]
                taken.append(1e6 * setting.marginal_seconds(arguments.core, arguments.fine))
                ratio.append(1e6 * twin / taken[-1])
    return [{"name": name, "microseconds_per_cell": spread(taken), "times_faster_than_twin": spread(ratio)}
            for name, (taken, ratio) in rows.items() if taken]


def measure(arguments, folder):
    """One row per contestant: time a cell, ratio to the twin, wrong labels; and rows of marginal costs."""
    ours = [Ours(setting, arguments.scene, folder) for setting in OURS + arguments.try_]
    for setting in ours:  # once unmeasured: files come into memory, `accuracy` computes its reference labels
        setting.seconds_per_cell(arguments.core)
    result = Result(ours[0].file)
    basin, catalogue = result.group("basin"), reference_check.Catalogue(result)

    def states(count, seed):
        row, column = reference_check.sample_cells(basin["attractor"].shape, count, seed)
        return basin["theta"].values[column], basin["velocity"].values[row]

    seconds = rounds_of(arguments, ours, catalogue, states)
    marginal = marginal_of(arguments, ours, catalogue, states)
    print(f"benchmark: the true_labels of {arguments.cells} cells", file=sys.stderr, flush=True)
    compared, cells = states(arguments.cells, 0), reference_check.sample_cells(basin["attractor"].shape,
                                                                               arguments.cells, 0)
    true_labels = cached_labels(catalogue, *compared)
    labels = {name: textbook_run(program, catalogue, *compared, arguments.core)[0] for name, program, _ in TEXTBOOK}
    labels |= {setting.name: setting.labels(cells, catalogue) for setting in ours}
    return rows_of(seconds, lambda name: reference_check.compare(labels[name], true_labels, catalogue)), marginal


def rows_of(seconds, counts):
    """The table's rows from the seconds a cell of every round, by name, and the counts of wrong labels by name."""
    rows = []
    for name, taken in seconds.items():
        ratio = np.array(seconds[TWIN]) / np.array(taken)
        rows.append({"name": name, "microseconds_per_cell": spread(1e6 * np.array(taken)),
                     "times_faster_than_twin": spread(ratio)}
                    | counts(name))
    return rows


def table(rows):
    yield f"{'':32} {'us per cell':>24} {'times the twin':>24} {'wrong of ' + str(rows[0]['cells']):>14} {'95 %':>20}"
    for row in rows:
        time_, ratio = row["microseconds_per_cell"], row["times_faster_than_twin"]
        yield (f"{row['name']:32} {time_['median']:9.3f} ({time_['min']:.3f} .. {time_['max']:.3f})"
               f" {ratio['median']:9.2f} ({ratio['min']:.2f} .. {ratio['max']:.2f})"
               f" {row['wrong']:6d} {100 * row['low']:9.2f} .. {100 * row['high']:.2f} %")


def marginal_table(rows):
    yield f"{'one cell more':32} {'us per cell':>24} {'times the twin':>24}"
    for row in rows:
        time_, ratio = row["microseconds_per_cell"], row["times_faster_than_twin"]
        yield (f"{row['name']:32} {time_['median']:9.3f} ({time_['min']:.3f} .. {time_['max']:.3f})"
               f" {ratio['median']:9.2f} ({ratio['min']:.2f} .. {ratio['max']:.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", type=Path, default=ROOT / "scenes" / "blackburn-fig12.yaml")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--cells", type=int, default=8000, help="cells compared with quad precision")
    parser.add_argument("--fine", type=int, default=4000,
                        help="cells an axis of the finer grid; 0 = no marginal cost (default: 4000)")
    parser.add_argument("--core", type=int, default=max(os.sched_getaffinity(0)), help="the core that all run on")
    parser.add_argument("--try", dest="try_", action="append", default=[], metavar="'NAME: KEY=VALUE ...'",
                        help="one more setting of this program")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows, marginal = measure(arguments, folder)
    lines = [*table(rows), *(marginal_table(marginal) if marginal else [])]
    print(json.dumps({"cells": rows, "marginal": marginal}, indent=1) if arguments.json else "\n".join(lines))


if __name__ == "__main__":
    run_script(main)
