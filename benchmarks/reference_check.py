#!/usr/bin/env python3
"""Compares the labels of a basin file with quad precision: the share of wrong ones among random cells, with its 95 %
interval.

    benchmarks/reference_check.py blackburn-fig12.h5 --cells 1000 --seed 7
    benchmarks/reference_check.py proof-fig13.h5 --cells 4000 --evidence 10

Every sampled cell is followed by build/benchmarks/reference_label to an attractor of the file's catalogue. Unsettled
cells are wrong. A cell whose true orbit comes to none of the periodic attractors belongs to the chaotic ones; without
any it is wrong.
"""

import argparse
import json
import math
import subprocess
import sys
from decimal import Decimal, getcontext
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

from kapitza import BadFile, Result  # noqa: E402
from kapitza.exit_status import run_script  # noqa: E402

REFERENCE_LABEL = ROOT / "build" / "benchmarks" / "reference_label"
NONE = -1
DEGREE = Decimal("0.0174532925199432957692369076848861271344")


def wilson(wrong, n, z=1.959963984540054):
    """The 95 % interval of a share seen `wrong` times in n."""
    centre = (wrong + z * z / 2) / (n + z * z)
    half = z / (n + z * z) * math.sqrt(wrong * (n - wrong) / n + z * z / 4)
    return max(0.0, centre - half), min(1.0, centre + half)


class Catalogue:
    """A pendulum and the strobe points of its attractors, as text for reference_label and for the textbook programs."""

    def __init__(self, result):
        self.pendulum = [result.pendulum.get(name, 0.0) for name in ("k", "beta", "m", "torque", "torque_amplitude")]
        with h5py.File(result.path) as file:
            drive = file["pendulum"]
            parts = [drive[name][:] for name in ("vertical", "horizontal") if name in drive]
        self.harmonics = np.hstack([*parts,
                                    np.zeros((len(parts[0]), 4 - 2 * len(parts)))]) if parts else np.zeros((0, 4))
        group = result.group("attractors")
        self.period = group["period"].values
        self.theta, self.velocity = group["strobe_theta"].values, group["strobe_velocity"].values
        self.periodic = np.flatnonzero(self.period > 0)
        self.chaotic = np.flatnonzero(self.period == 0)

    def text(self, max_periods):
        """Pendulum, longest run, and one line per periodic attractor."""
        lines = [" ".join(map(repr, map(float, self.pendulum))) + f" {len(self.harmonics)}",
                 *(" ".join(map(repr, row)) for row in self.harmonics.tolist()), f"{max_periods} {len(self.periodic)}"]
        for attractor in self.periodic:
            points = np.stack([self.theta[attractor], self.velocity[attractor]], axis=1)[: self.period[attractor]]
            lines.append(f"{self.period[attractor]} " + " ".join(map(repr, points.ravel().tolist())))
        return "\n".join(lines) + "\n"

    def ids(self, numbers):
        """Attractor ids of the numbers that count the periodic attractors alone; NONE stays."""
        return np.where(numbers < 0, NONE, self.periodic[np.maximum(numbers, 0)]) if len(self.periodic) else numbers


def states_text(theta, velocity):
    """A line per state, every digit of it: doubles are exact numbers too."""
    return "".join(f"{Decimal(a)} {Decimal(b)}\n" for a, b in zip(theta.tolist(), velocity.tolist(), strict=True))


def centres(basin, name):
    """The cell centres of an axis: doubles, or decimal numbers of 60 digits where the window was given by its
    centre."""
    if f"{name}_offset" not in basin:
        return basin[name].values
    getcontext().prec = 60
    centre, width = (DEGREE * Decimal(text.removesuffix(" deg")) if text.endswith(" deg") else Decimal(text)
                     for text in (basin.attrs[f"{name}_centre"], basin.attrs[f"{name}_width"]))
    return np.array([centre + width * Decimal(offset) for offset in basin[f"{name}_offset"].values.tolist()])


def reference_labels(catalogue, theta, velocity, max_periods=4000, processes=2):
    """True attractor ids of states (NONE: captured by no periodic attractor), by `processes` copies of
    reference_label."""
    head = catalogue.text(max_periods)
    parts = np.array_split(np.arange(len(theta)), processes)
    running = [subprocess.Popen([REFERENCE_LABEL], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
               for _ in parts]
    for process, part in zip(running, parts, strict=True):
        process.stdin.write(head + states_text(theta[part], velocity[part]))
        process.stdin.close()
    answers = [np.loadtxt(process.stdout, dtype=np.int64, ndmin=2) for process in running]
    if any(process.wait() for process in running):
        raise BadFile(f"{REFERENCE_LABEL.name} failed")
    return catalogue.ids(np.concatenate([answer.reshape(-1, 2)[:, 0] for answer in answers]))


def sample_cells(shape, count, seed):
    """Rows and columns of `count` different random cells (of all cells, where there are fewer)."""
    total = shape[0] * shape[1]
    return np.unravel_index(np.random.default_rng(seed).choice(total, min(count, total), replace=False), shape)


def compare(labels, true_labels, catalogue):
    """Counts of the labels that differ from the true ones."""
    homeless = (true_labels == NONE) & (len(catalogue.chaotic) == 0)
    right = np.where(true_labels == NONE, np.isin(labels, catalogue.chaotic), labels == true_labels)
    wrong, n = int(np.count_nonzero(~right)), len(labels)
    low, high = wilson(wrong, n)
    return {"cells": n, "wrong": wrong, "share": wrong / n, "low": low, "high": high,
            "unsettled": int(np.count_nonzero(labels == NONE)), "homeless": int(np.count_nonzero(homeless))}


def check_file(path, count, seed, processes, max_periods, evidence=None):
    """The counts of a result file, and the cells compared: of the given codes of evidence, where some are given."""
    result = Result(path)
    basin, catalogue = result.group("basin"), Catalogue(result)
    if not catalogue.pendulum[1] > 0:
        raise BadFile(f"{path}: undamped, there is nothing to compare")
    row, column = sample_cells(basin["attractor"].shape, count, seed)
    if evidence:
        row, column = np.nonzero(np.isin(basin["evidence"].values, evidence))
        chosen = sample_cells((1, len(row)), count, seed)[1]
        row, column = row[chosen], column[chosen]
    theta, velocity = centres(basin, "theta")[column], centres(basin, "velocity")[row]
    labels = basin["attractor"].values[row, column].astype(np.int64)
    true_labels = reference_labels(catalogue, theta, velocity, max_periods, processes)
    counts = compare(labels, true_labels, catalogue) | {"file": str(path), "method": basin.attrs.get("method", ""),
                                                        "seed": seed}
    return counts, (theta, velocity, labels, true_labels)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--cells", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--evidence", type=int, nargs="+", metavar="CODE",
                        help="compare cells of this evidence only (6 10: proved)")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--max-periods", type=int, default=4000, help="how long a true orbit is followed")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--list", action="store_true", help="also print every wrong cell")
    arguments = parser.parse_args()
    counts, cells = check_file(arguments.file, arguments.cells, arguments.seed, arguments.processes,
                               arguments.max_periods, arguments.evidence)
    if arguments.json:
        print(json.dumps(counts))
    else:
        print("{file}: {method}: {wrong} of {cells} cells wrong, {0:.3f} % (95 %: {1:.3f} .. {2:.3f} %); {unsettled} "
              "unsettled, "
              "{homeless} come to no attractor of the file".format(*(100 * counts[key]
                                                                     for key in ("share", "low", "high")),
                                                                 **counts))
    if arguments.list:
        for theta, velocity, label, true_labels in zip(*(part.tolist() for part in cells), strict=True):
            if label != true_labels:
                print(f"  theta {theta!r} velocity {velocity!r} labelled {label}, truly {true_labels}")


if __name__ == "__main__":
    run_script(main)
