#!/usr/bin/env python3
"""Compares an atlas with the attractors that many starts end on, at random points of its plane.

    scripts/benchmark atlas_points atlas-blackburn.h5                    100 points, 32,768 starts each
    scripts/benchmark atlas_points atlas-blackburn.h5 --points 20 --first 80 --processes 2
    scripts/benchmark atlas_points atlas-blackburn.h5 --points 10 --births      all cycles followed to their births

A point disagrees where an attractor of up to `max_period` periods was found that the list lacks (missing), or where a
motion of the list cannot be solved for (unsolved). Motions that exist and that no start reached are counted apart:
their basins are small. A point whose list the file itself says is not known is told too.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections import Counter
from functools import cache
from multiprocessing import Pool
from pathlib import Path

import h5py
import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza import Result, SceneError  # noqa: E402

REST, SYMMETRIC, OTHER = "rest", "symmetric", "other"
# Keys under which no mirror image is a motion at the same time
SHAKEN_ASIDE = {"tilt", "ellipse", "horizontal", "torque_amplitude"}


def point_of(edges, number):
    """The values of both keys at a point of the sequence that seeds 1, 2, .. give."""
    shares = np.random.default_rng(1000 + number).random(2)
    return [float(low + share * (high - low)) for share, (low, high) in zip(shares, edges, strict=True)]


def class_of(row, mirrored, later):
    """What the classes of both sides have in common: a symmetric cycle without its centre, which both define in their
    own way."""
    period, winding = int(row["period"]), int(row["winding"])
    if row["symmetric"] and mirrored and not later:
        return (REST, 1, str(row["centre"])) if period == 1 else (SYMMETRIC, period, "")
    return (OTHER, period, str(abs(winding) if mirrored else winding))


def told(result, x, y, mirrored, later):
    """The classes of the list and how many each has; how many motions could not be solved for. later: images run half a
    period later; both count, and no class is symmetric, as `attractors` says another thing by that word."""
    table = result.motions(x, y)
    unsolved = sum(not len(values) for values in table["multipliers"])
    classes = Counter()
    for _, row in table.iterrows():
        classes[class_of(row, mirrored, later)] += row["images"] if later else 1
    return classes, unsolved


def found(scene, starts, longest, mirrored, later, program):
    """The classes of the attractors that starts end on; two mirror images are one."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "a.yaml").write_text(json.dumps(scene | {"attractors": {
            "velocity": {"min": -2.5, "max": 2.5}, "starts": starts, "max_period": longest}}))
        subprocess.run([program, "run", "a.yaml"], cwd=folder, check=True, capture_output=True)
        with h5py.File(Path(folder) / "a.h5") as file:
            columns = [file["attractors"][name][:].tolist() for name in ("period", "winding", "symmetric", "centre")]
    centres = {0: "down", 1: "inverted"}
    rows = [{"period": period, "winding": winding, "symmetric": symmetric, "centre": centres.get(centre, "")}
            for period, winding, symmetric, centre in zip(*columns, strict=True) if 0 < period <= longest]
    counts = Counter(class_of(row, mirrored, later) for row in rows)
    return Counter({kind: (n + 1) // 2 if mirrored and not later and kind[0] == OTHER else n for kind,
                    n in counts.items()})


@cache
def opened(path):
    """The atlas, the attributes of its group, its edges and its pendulum: once in each process."""
    result = Result(path)
    group = result.group("atlas")
    edges = []
    for cells in ("column", "row"):
        values = group[cells].values
        half = (values[1] - values[0]) / 2
        edges.append((values[0] - half, values[-1] + half))
    return result, dict(group.attrs), edges, dict(yaml.safe_load(result.scene)["pendulum"])


def compare(path, number, starts, program):
    """A line about a point, and what is wrong there: (text, missing, unsolved, not reached, known)."""
    result, attributes, edges, pendulum = opened(path)
    mirrored, longest = bool(attributes["mirrored"]), int(attributes["max_period"])
    later = mirrored and not SHAKEN_ASIDE.isdisjoint(pendulum)
    x, y = point_of(edges, number)
    scene = {"pendulum": pendulum | {attributes["x_parameter"]: x, attributes["y_parameter"]: y}}
    try:
        listed, unsolved = told(result, x, y, mirrored, later)
    except SceneError as error:
        return f"{number}: {x:.9g} {y:.9g} {error}", 0, 0, 0, False
    seen = found(scene, starts, longest, mirrored, later, program)
    missing, more = seen - listed, listed - seen
    text = f"{number}: {x:.9g} {y:.9g} missing {dict(missing)}, unsolved {unsolved}, told and not reached {dict(more)}"
    return text, sum(missing.values()), unsolved, sum(more.values()), True


def unstable(scene, longest, program, folder):
    """Its unstable cycles, of mirror images one, a line each: period, strobe points; whether the index sums say that
    none is missing."""
    (folder / "s.yaml").write_text(json.dumps(scene | {"saddles": {"velocity": {"min": -2.5, "max": 2.5},
                                                                   "max_period": longest}}))
    subprocess.run([program, "run", "s.yaml"], cwd=folder, check=True, capture_output=True)
    with h5py.File(folder / "s.h5") as file:
        group = file["saddles"]
        period, theta, velocity, mirror = (group[name][:] for name in ("period", "strobe_theta", "strobe_velocity",
                                                                       "mirror"))
        complete = not group["index_sum"][:].any()
    cycles = [f"{n} " + " ".join(f"{a:.17g} {v:.17g}" for a, v in zip(theta[i, :n], velocity[i, :n], strict=True))
              for i, n in enumerate(period) if mirror[i] < 0 or mirror[i] >= i]
    return cycles, complete


def trace_births(path, number, program):
    """A line about a point: its unstable cycles, how many meet a curve, and the bands of the curves that the atlas
    lacks."""
    _, attributes, edges, pendulum = opened(path)
    x, y = point_of(edges, number)
    with tempfile.TemporaryDirectory() as folder:
        scene = {"pendulum": pendulum | {attributes["x_parameter"]: x, attributes["y_parameter"]: y}}
        cycles, complete = unstable(scene, int(attributes["max_period"]), program, Path(folder))
    done = subprocess.run([Path(program).parent / "benchmarks" / "births", path, f"{x:.17g}", f"{y:.17g}"],
                          input="\n".join(cycles), text=True, capture_output=True, check=True)
    *lacking, last = done.stdout.splitlines()
    _, n, followed, met, known, thin = last.split()
    bands = sorted((float(line.split()[-1]) for line in lacking), reverse=True)
    counts = " ".join(f"{sum(band >= least for band in bands)}" for least in (1e-3, 1e-4, 1e-5))
    return (f"{number}: {x:.9g} {y:.9g} cycles {n}{'' if complete else ' (index sums not 0)'}, followed {followed}, "
            f"met a curve {met}, "
            f"a known one {known}, an unknown one of a band below 1e-5 {thin}; lacking curves with bands above 1e-3, "
            f"1e-4, 1e-5: {counts}; "
            f"widest {bands[0] if bands else 0:.1e}")


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("file")
    options.add_argument("--points", type=int, default=100)
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--starts", type=int, default=32768)
    options.add_argument("--processes", type=int, default=1)
    options.add_argument("--program", type=Path, default=ROOT / "build" / "kapitza")
    options.add_argument("--births", action="store_true",
                         help="follow all unstable cycles to their births; needs the target births")
    chosen = options.parse_args()
    if chosen.births:
        for number in range(chosen.first, chosen.first + chosen.points):
            print(trace_births(chosen.file, number, str(chosen.program.resolve())), flush=True)
        return
    words = [(chosen.file, chosen.first + i, chosen.starts, str(chosen.program.resolve()))
             for i in range(chosen.points)]
    totals = Counter()
    with Pool(chosen.processes) as pool:
        for task in [pool.apply_async(compare, one) for one in words]:
            text, missing, unsolved, more, known = task.get()
            totals.update(points=1, missing=missing > 0, unsolved=unsolved > 0, not_reached=more > 0,
                          not_known=not known, disagree=missing > 0 or unsolved > 0 or not known)
            if missing or unsolved or not known:
                print(text, flush=True)
    print(", ".join(f"{name.replace('_', ' ')} {totals[name]}" for name in (
        "points", "disagree", "missing", "unsolved", "not_known", "not_reached")))


if __name__ == "__main__":
    main()
