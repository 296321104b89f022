"""The benchmark's fairness: the two textbook programs label alike and well, and labels of two files are compared
rightly."""

import subprocess

import benchmark
import benchmark_kernel
import numpy as np
import pytest
import reference_check
from conftest import ROOT, write_result

POINTS = [[[0.0, 0.0]], [[3.0, 1.1]], [[-3.0, -1.1]], [[0.1, 0.3], [0.2, -0.4]]]
ROWS = [{"period": len(points), "winding": round(points[0][1]) if len(points) == 1 else 0,
         "centre": 2 if abs(points[0][1]) > 1 else 0, "points": np.array(points)} for points in POINTS]


def catalogue_of(path, rows):
    write_result(path, rows, np.zeros(1), np.zeros(1), np.zeros((1, 1), dtype=int), np.zeros((1, 1)))
    return reference_check.Catalogue(reference_check.Result(path))


def test_labels_are_translated_between_catalogues(tmp_path):
    order = [2, 0, 3, 1]
    reference = catalogue_of(tmp_path / "a.h5", ROWS)
    ids = benchmark.translation(catalogue_of(tmp_path / "b.h5", [ROWS[i] for i in order]), reference)
    assert ids.tolist() == [*order, reference_check.NONE]
    assert ids[np.array([-1, 0])].tolist() == [reference_check.NONE, 2]
    fewer = catalogue_of(tmp_path / "c.h5", ROWS[:3])
    assert benchmark.translation(reference, fewer).tolist() == [0, 1, 2, benchmark.UNKNOWN, reference_check.NONE]


def test_ratios_are_of_one_round():
    rows = benchmark.rows_of({benchmark.TWIN: [4e-6, 40e-6], "direct": [1e-6, 10e-6]}, lambda name: {"wrong": 0})
    assert [row["times_faster_than_twin"]["median"] for row in rows] == pytest.approx([1, 4])
    assert rows[1]["microseconds_per_cell"] == pytest.approx({"median": 5.5, "min": 1, "max": 10})


@pytest.fixture(scope="module")
def built():
    """The textbook programs, which the default build leaves out."""
    if not (ROOT / "build" / "build.ninja").exists():
        pytest.skip("build/ is not configured")
    subprocess.run(["cmake", "--build", "build", "--target", "benchmark"], cwd=ROOT, check=True, capture_output=True)


@pytest.mark.extensive
def test_textbook_programs_agree_with_the_truth(built, tmp_path, fig12_attractors):
    fig12_catalogue = catalogue_of(tmp_path / "fig12.h5", fig12_attractors)
    generator = np.random.default_rng(1)
    theta, velocity = generator.uniform(-np.pi, np.pi, 60), generator.uniform(-2, 2, 60)
    core = min(benchmark.os.sched_getaffinity(0))
    scalar, lanes = (benchmark.textbook_run(name, fig12_catalogue, theta, velocity, core)[0]
                     for name in ("textbook", "twin"))
    true_labels = reference_check.reference_labels(fig12_catalogue, theta, velocity)
    assert np.count_nonzero(scalar != lanes) <= 1
    assert np.count_nonzero(lanes != true_labels) <= 3
    assert len(np.unique(true_labels)) >= 4 and (true_labels >= 0).all()


@pytest.mark.extensive
def test_kernel_rows_keep_their_tolerance(built):
    """The harness of scripts/benchmark kernel, few states: every processed row errs less than it was asked to, and less
    than others."""
    core = min(benchmark.os.sched_getaffinity(0))
    peak, probes, rows = benchmark_kernel.harness_rows(benchmark_kernel.PENDULUMS["epsilon = 0.46"], 64, 2, core)
    assert peak > 0.1 and probes.shape == (64, 4)
    processed = [row for row in rows if row["name"] == "processed"]
    assert [row["tolerance"] for row in processed] == [1e-4, 1e-7, 1e-10, 3e-10, 1e-12]
    assert all(0 < row["error"] <= row["tolerance"] and row["ns"] > 0 and row["operations"] > 0 for row in processed)
    assert {row["name"] for row in rows} == {"split6-24", "processed", "GSL-rk8pd"}
    split6 = next(row for row in rows if row["name"] == "split6-24")
    assert split6["error"] < 1e-8
    assert benchmark_kernel.rival_ns(split6, rows) == min(row["ns"] for row in processed
                                                          if row["error"] <= split6["error"])


def test_an_integrator_that_errs_is_seen_to_err():
    probes = np.zeros((64, 4))
    probes[:, 2:] = [np.pi, 0.5]
    row = benchmark_kernel.other_row("wrong", lambda states, periods: states + [-np.pi + 0.03, 0.54], 1e-6, probes, 1)
    assert row["error"] == pytest.approx(0.05)
