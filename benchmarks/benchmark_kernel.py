"""Nanoseconds of one drive period of one trajectory, on one core: this program's kernel against other integrators, each
at its own error, and against the arithmetic that the core can do.

build/benchmarks/kernel times the kernel (split6 with 24 steps, and the processed splitting at five tolerances) and
GSL's rk8pd. heyoka and numbalsoda (dop853) are timed where they are installed (pip) and skipped by name where not.
Errors are those of one period of 64 starts with speeds up to 2, against quad precision; times are processor time,
without compiling."""

import argparse
import importlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
HARNESS = ROOT / "build" / "benchmarks" / "kernel"
TURN = 2 * np.pi
TOLERANCES = [1e-4, 1e-7, 1e-10, 1e-12]
# name: k, beta, m
PENDULUMS = {"Fig. 12": (1 / 121, 1 / 55, 0.3), "epsilon = 0.46": (1 / 121, 1 / 55, 0.46), "m = 1.5": (0.1, 0.1, 1.5)}


def heyoka_rows(module, pendulum, tolerance):
    """How to follow states (theta, velocity) through periods with heyoka's Taylor series in batches."""
    k, beta, m = pendulum
    theta, velocity = module.make_vars("theta", "velocity")
    motion = [(theta, velocity), (velocity, -beta * velocity - (k - m * module.cos(module.time)) * module.sin(theta))]
    batch = module.recommended_simd_size()
    solver = module.taylor_adaptive_batch(motion, np.zeros((2, batch)), tol=tolerance)

    def follow(states, periods):
        images = np.empty_like(states)
        for first in range(0, len(states) - batch + 1, batch):
            solver.set_time(0.0)
            solver.state[:] = states[first : first + batch].T
            solver.propagate_until(np.full(batch, TURN * periods))
            images[first : first + batch] = solver.state.T
        return images

    return follow


def numbalsoda_rows(module, pendulum, tolerance):
    """The same with the compiled dop853 of numbalsoda, called from compiled code."""
    import numba

    k, beta, m = pendulum

    @numba.cfunc(module.lsoda_sig)
    def motion(t, y, rate, _):
        rate[0] = y[1]
        rate[1] = -beta * y[1] - (k - m * np.cos(t)) * np.sin(y[0])

    address, dop853 = motion.address, module.dop853

    @numba.njit
    def follow(states, periods):
        images = np.empty_like(states)
        times = np.array([0.0, TURN * periods])
        for i in range(len(states)):
            path, _ = dop853(address, states[i], times, rtol=tolerance, atol=tolerance)
            images[i] = path[-1]
        return images

    return follow


OTHERS = {"heyoka": heyoka_rows, "numbalsoda": numbalsoda_rows}


def harness_rows(pendulum, states, periods, core):
    """Peak (fused multiply-adds a nanosecond), the starts with their images, and the rows of the compiled
    integrators."""
    command = ["taskset", "-c", str(core), str(HARNESS), *map(repr, pendulum), str(states), str(periods)]
    lines = [line.split() for line in subprocess.run(command, check=True, text=True,
                                                     capture_output=True).stdout.splitlines()]
    rows = []
    for words in lines:
        if words[0] != "row":
            continue
        tolerance, ns, error, operations = map(float, words[2:])
        rows.append({"name": words[1], "tolerance": tolerance, "ns": ns, "error": error, "operations": int(operations)})
    probes = np.array([words[1:] for words in lines if words[0] == "state"], dtype=float)
    return float(lines[0][1]), probes, rows


def other_row(name, follow, tolerance, probes, periods):
    """The row of a Python integrator: its error on the probes, its time on the same states."""
    difference = follow(probes[:, :2].copy(), 1) - probes[:, 2:]
    error = np.max(np.hypot((difference[:, 0] + np.pi) % TURN - np.pi, difference[:, 1]))
    taken = []
    for _ in range(3):
        start = time.process_time()
        follow(probes[:, :2].copy(), periods)
        taken.append(time.process_time() - start)
    return {"name": name, "tolerance": tolerance, "ns": 1e9 * min(taken) / len(probes) / periods, "error": float(error),
            "operations": 0}


def installed():
    """The other integrators that there are."""
    found = {}
    for name, make in OTHERS.items():
        try:
            found[name] = (make, importlib.import_module(name))
        except ImportError:
            print(f"benchmark: {name} is not installed: skipped", file=sys.stderr)
    return found


def measure(arguments):
    """Rows of every pendulum."""
    os.sched_setaffinity(0, {arguments.core})
    others, rows = installed(), []
    for title, pendulum in PENDULUMS.items():
        peak, probes, own = harness_rows(pendulum, arguments.states, arguments.periods, arguments.core)
        for name, (make, module) in others.items():
            own += [other_row(name, make(module, pendulum, tolerance), tolerance, probes, arguments.periods)
                    for tolerance in TOLERANCES]
        for row in own:
            share = row["operations"] / row["ns"] / peak if row["operations"] else None
            rows.append({"pendulum": title, **row, "share_of_peak": share,
                         "times_slower": row["ns"] / rival_ns(row, own)})
    return rows


def rival_ns(row, rows):
    """Nanoseconds of the fastest processed splitting that errs no more than this row does; NaN where none is as
    exact."""
    return min((other["ns"] for other in rows if other["name"] == "processed" and other["error"] <= row["error"]),
               default=np.nan)


def table(rows):
    yield (f"{'pendulum':16} {'integrator':14} {'tolerance':>9} {'ns a period':>12} {'error':>9} {'of peak':>8} "
           f"{'/ processed':>12}")
    for row in rows:
        share = f"{100 * row['share_of_peak']:6.0f} %" if row["share_of_peak"] else ""
        tolerance = f"{row['tolerance']:.0e}" if row["tolerance"] else ""
        yield (f"{row['pendulum']:16} {row['name']:14} {tolerance:>9} {row['ns']:12.1f} {row['error']:9.1e} {share:>8}"
               f" {row['times_slower']:12.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=4096, help="of the kernel (default: 4096)")
    parser.add_argument("--periods", type=int, default=200, help="followed at a time (default: 200)")
    parser.add_argument("--core", type=int, default=max(os.sched_getaffinity(0)), help="the core that all run on")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rows = measure(arguments)
    print(json.dumps(rows, indent=1) if arguments.json else "\n".join(table(rows)))


if __name__ == "__main__":
    main()
