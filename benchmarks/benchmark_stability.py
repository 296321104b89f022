"""A 2000 x 2000 stability chart by this program on two ranks, against scipy's solve_ivp per point on two cores.

scipy (DOP853) takes a random subset of the chart's points; its time is extrapolated to the chart and halved, as if two
processes shared the work without loss. This program's time is that of the whole command: start, chart, file. Errors of
both are those of the largest multiplier against Taylor series in 30 digits, on the same points."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

from kapitza import BadFile, Result  # noqa: E402
from kapitza.exit_status import run_script  # noqa: E402

PROGRAM = ROOT / "build" / "kapitza"
SCENE = """\
pendulum: {{k: 0, damping: 0, m: 0.5}}
stability:
  k: {{min: -1, max: 4, count: {count}}}
  m: {{min: 0, max: 4, count: {count}}}
  damping: {damping}
"""
TURN = 2 * np.pi


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=2000, help="points along each axis (default: 2000)")
    parser.add_argument("--points", type=int, default=200, help="points that scipy takes (default: 200)")
    parser.add_argument("--exact", type=int, default=40, help="of these, compared with 30 digits (default: 40)")
    parser.add_argument("--rounds", type=int, default=3, help="repeats; the median counts (default: 3)")
    parser.add_argument("--damping", type=float, default=0.05)
    parser.add_argument("--tolerance", type=float, default=1e-12, help="of scipy, relative (default: 1e-12)")
    parser.add_argument("--json", action="store_true")
    return parser.parse_args()


def chart_run(arguments, folder):
    """The chart and the seconds of the whole command on two ranks."""
    scene = folder / "chart.yaml"
    scene.write_text(SCENE.format(count=arguments.count, damping=arguments.damping))
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    start = time.perf_counter()
    done = subprocess.run(["mpirun", "--oversubscribe", "-n", "2", PROGRAM, "run", scene.name, "--force", "--progress",
                           "never"],
                          cwd=folder, env=environment, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if done.returncode:
        raise BadFile(f"kapitza run: {done.stderr.strip()}")
    return Result(folder / "chart.h5").group("stability"), seconds


def scipy_multiplier(k, m, beta, tolerance):
    """The largest |multiplier| by two solutions over one period."""
    def motion(t, u):
        stiffness = k - m * np.cos(t)
        return [u[1], -beta * u[1] - stiffness * u[0], u[3], -beta * u[3] - stiffness * u[2]]

    end = solve_ivp(motion, (0, TURN), [1, 0, 0, 1], method="DOP853", rtol=tolerance, atol=tolerance).y[:, -1]
    return np.abs(np.linalg.eigvals([[end[0], end[2]], [end[1], end[3]]])).max()


def true_multiplier(k, m, beta, steps=8, order=48):
    """The same in 30 digits: Taylor series of u from step to step."""
    with mpmath.workdps(30):
        k, m, beta, h = mpmath.mpf(k), mpmath.mpf(m), mpmath.mpf(beta), 2 * mpmath.pi / steps
        columns = []
        for start in ((1, 0), (0, 1)):
            u, v = map(mpmath.mpf, start)
            for step in range(steps):
                u, v = taylor_step(k, m, beta, step * h, h, u, v, order)
            columns.append((u, v))
        (a, c), (b, d) = columns
        half, determinant = (a + d) / 2, a * d - b * c
        return max(abs(half + mpmath.sqrt(half**2 - determinant)), abs(half - mpmath.sqrt(half**2 - determinant)))


def taylor_step(k, m, beta, t, h, u, v, order):
    cosine = [mpmath.cos(t + j * mpmath.pi / 2) / mpmath.factorial(j) for j in range(order)]
    series = [u, v]
    for n in range(order):
        forced = sum(cosine[j] * series[n - j] for j in range(n + 1))
        series.append((m * forced - k * series[n] - beta * (n + 1) * series[n + 1]) / ((n + 1) * (n + 2)))
    return (mpmath.polyval(series[::-1], h), mpmath.polyval([n * c for n, c in enumerate(series)][:0:-1], h))


def measure(arguments, folder):
    chart, _ = chart_run(arguments, folder)
    ours = sorted(chart_run(arguments, folder)[1] for _ in range(arguments.rounds))[arguments.rounds // 2]
    random = np.random.default_rng(4)
    rows, columns = random.integers(0, arguments.count, (2, arguments.points))
    k, m = chart["k"].values[columns], chart["m"].values[rows]
    start = time.perf_counter()
    theirs = [scipy_multiplier(*point, arguments.damping, arguments.tolerance) for point in zip(k, m, strict=True)]
    per_point = (time.perf_counter() - start) / arguments.points
    some = range(min(arguments.exact, arguments.points))
    exact = np.array([float(true_multiplier(k[i], m[i], arguments.damping)) for i in some])
    growth = chart["log_multiplier"].values[rows, columns]
    whole = per_point * arguments.count**2 / 2
    return {"points": arguments.count**2, "seconds": ours, "scipy_seconds_per_point": per_point,
            "scipy_seconds_two_cores": whole, "ratio": whole / ours,
            "largest_error": float(np.abs(np.exp(growth[: len(exact)]) / exact - 1).max()),
            "scipy_largest_error": float(np.abs(np.array(theirs)[: len(exact)] / exact - 1).max())}


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory() as folder:
        figures = measure(arguments, Path(folder))
    if arguments.json:
        print(json.dumps(figures))
        return
    print(f"stability chart of {arguments.count} x {arguments.count} points, beta = {arguments.damping:g}")
    print(f"  kapitza, two ranks, whole command      {figures['seconds']:10.2f} s   largest error "
          f"{figures['largest_error']:.1e}")
    print(f"  scipy DOP853, two cores, extrapolated  {figures['scipy_seconds_two_cores']:10.0f} s   largest error "
          f"{figures['scipy_largest_error']:.1e}   ({1e3 * figures['scipy_seconds_per_point']:.1f} ms a point)")
    print(f"  ratio {figures['ratio']:.0f}")


if __name__ == "__main__":
    run_script(main)
