#!/usr/bin/env python3
"""How often the stated errors of a fit hold the truth: synthetic tracks with noise, fitted, and counted.

    scripts/benchmark fit_coverage                  100 tracks of each of two pendulums
    scripts/benchmark fit_coverage --tracks 400     more tracks, for less noise in the count
    scripts/benchmark fit_coverage --driven 40      driven tracks of random pendulums, from the search for the drive on

A line for each number of the model: its share of intervals that hold, with the 95 % interval (Clopper and Pearson) of
this count.
"""

import argparse
import sys
from multiprocessing import Pool
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
from kapitza import fitting

NOISE = 2e-3  # rad
DECAY = {"omega0": 7.0, "offset": 0.02, "theta": 0.9, "velocity": 0.3, "viscous": 0.15}
FRICTION = DECAY | {"quadratic": 0.06, "dry": 0.05}
PENDULUMS = {"viscous": (DECAY, np.linspace(0, 9, 60)),
             "viscous + quadratic + dry": (FRICTION, np.linspace(0, 20, 250))}

DRIVEN = ("omega0", "offset", "theta", "velocity", "viscous", "drive", "phase")


def track(truth, time, seed=1, omega=None):
    """Angles of the equation with noise."""
    exact = fitting.simulated(time, {name: np.array([value]) for name, value in truth.items()}, omega)[0]
    return exact + np.random.default_rng(seed).normal(0, NOISE, time.size)


def driven(seed):
    """Times, numbers and angular frequency of the drive of a random pendulum: 8 or 15 Hz, 12 to 150 samples a
    second."""
    random = np.random.default_rng(1000 + seed)
    omega0, hertz = random.uniform(4, 9), random.choice([8.0, 15.0])
    omega = 2 * np.pi * hertz
    drive = random.uniform(0.15, 1.2) * np.sqrt(2) * omega0 / omega
    samples, seconds = random.choice([12, 25, 60, 150]), random.uniform(6, 10)
    truth = {"omega0": omega0, "offset": random.uniform(-0.05, 0.05), "theta": random.uniform(0.3, 1.2),
             "velocity": random.uniform(-1, 1),
             "viscous": random.uniform(0.03, 0.3), "drive": drive, "phase": random.uniform(-3, 3)}
    return np.arange(0, seconds, 1 / samples), truth, omega


def driven_holds(seed):
    """Whether each number lies within its stated error, and omega0 beyond three of them (`wrong`); or why it is
    refused."""
    time, truth, omega = driven(seed)
    try:
        model = fitting.fit(time, track(truth, time, seed, omega), frequency=omega / (2 * np.pi)).best
    except ValueError as error:
        return str(error)
    missed = {key: abs(model.values[key] - value) / model.errors[key] for key, value in truth.items()}
    return {key: bool(value <= 1) for key, value in missed.items()} | {"wrong": missed["omega0"] > 3}


def holds(name, seed):
    """Whether each number of the track of this seed lies within its stated error."""
    truth, time = PENDULUMS[name]
    model = fitting.fitted("", time, track(truth, time, seed), dict(truth), None)
    return {key: bool(abs(model.values[key] - value) <= model.errors[key]) for key, value in truth.items()}


def counted(name, tracks, processes=1):
    """The number of tracks whose intervals hold, of each number of the model."""
    words = [(name, seed) for seed in range(tracks)]
    if processes == 1:
        held = [holds(*one) for one in words]
    else:
        with Pool(processes) as pool:
            held = pool.starmap(holds, words)
    return {key: sum(one[key] for one in held) for key in PENDULUMS[name][0]}


def main():
    from scipy.stats import beta  # takes a second to load, which tests of fits, users of the rest, need not

    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--tracks", type=int, default=100)
    options.add_argument("--processes", type=int, default=1)
    options.add_argument("--driven", type=int, default=0)
    chosen = options.parse_args()
    if chosen.driven:
        with Pool(chosen.processes) as pool:
            found = pool.map(driven_holds, range(chosen.driven), chunksize=1)
        fits = [one for one in found if isinstance(one, dict)]
        print(f"driven: {chosen.driven} tracks, {len(found) - len(fits)} refused, {sum(one['wrong'] for one in fits)} "
              "in a wrong minimum")
        print("\n".join(f"  refused: {one}" for one in found if isinstance(one, str)))
        for key in DRIVEN:
            print(f"  {key:<10} {sum(one[key] for one in fits)} of {len(fits)}")
        return
    for name in PENDULUMS:
        print(f"{name}: {chosen.tracks} tracks of {PENDULUMS[name][1].size} samples")
        for key, count in counted(name, chosen.tracks, chosen.processes).items():
            low, high = beta.ppf([0.025, 0.975], [count, count + 1], [chosen.tracks - count + 1, chosen.tracks - count])
            print(f"  {key:<10} {100 * count / chosen.tracks:5.1f} %   {100 * low:.1f} to "
                  f"{100 * (1 if np.isnan(high) else high):.1f} %")


if __name__ == "__main__":
    main()
