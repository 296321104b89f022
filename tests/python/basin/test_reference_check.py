"""The check of labels: intervals, sampling, and the counts of a file whose wrong cells are known."""

import json
import subprocess
import sys

import numpy as np
import pytest
import reference_check
from conftest import write_result
from hypothesis import given
from hypothesis import strategies as st
from kapitza import BadFile

NEEDS_TOOL = pytest.mark.skipif(not reference_check.REFERENCE_LABEL.exists(),
                                reason="build/benchmarks/reference_label is not built")


def test_interval_published():
    """Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29."""
    for wrong, n, low, high in [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0, 0.1611),
                                (1, 29, 0.0061, 0.1718)]:
        assert reference_check.wilson(wrong, n) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(1, 40), st.integers(1, 40), st.integers(1, 2000), st.integers(0, 99))
def test_sampled_cells_differ_and_repeat(rows, columns, count, seed):
    row, column = reference_check.sample_cells((rows, columns), count, seed)
    assert len(set(zip(row.tolist(), column.tolist(), strict=True))) == min(count, rows * columns)
    again = reference_check.sample_cells((rows, columns), count, seed)
    assert np.array_equal(row, again[0]) and np.array_equal(column, again[1])


@pytest.fixture
def fig12_file(tmp_path, fig12_attractors):
    """Figure 12's attractors on 6 x 5 cells, and the cells' labels by quad precision."""
    theta, velocity = (2 * np.arange(6) + 1 - 6) * (np.pi / 6), (2 * np.arange(5) + 1 - 5) * (2 / 5)
    path = tmp_path / "fig12.h5"

    def write(labels, rows=fig12_attractors):
        write_result(path, rows, theta, velocity, labels, np.full(labels.shape, 50))
        return path

    write(np.zeros((5, 6), dtype=int))
    catalogue = reference_check.Catalogue(reference_check.Result(path))
    grid = np.meshgrid(theta, velocity)
    true_labels = reference_check.reference_labels(catalogue, grid[0].ravel(), grid[1].ravel())
    return write, true_labels.reshape(5, 6), fig12_attractors


@NEEDS_TOOL
def test_verdict_counts_wrong_and_unsettled_cells(fig12_file):
    write, true_labels, _ = fig12_file
    assert (true_labels >= 0).all() and len(np.unique(true_labels)) >= 4
    labels = true_labels.copy()
    labels[0, 0] = (labels[0, 0] + 1) % 4
    labels[4, 5] = reference_check.NONE
    path = write(labels)
    tool = [sys.executable, reference_check.__file__, str(path), "--cells", "30", "--json"]
    counts = json.loads(subprocess.run(tool, check=True, capture_output=True, text=True).stdout)
    assert (counts["cells"], counts["wrong"], counts["unsettled"], counts["homeless"]) == (30, 2, 1, 0)


@pytest.mark.extensive
@NEEDS_TOOL
def test_attractor_missing_from_the_file_is_noticed(fig12_file):
    write, true_labels, attractors = fig12_file
    last = np.unique(true_labels)[0]
    kept = [row for index, row in enumerate(attractors) if index != last]
    path = write(np.maximum(true_labels - 1, 0), kept)
    counts, _ = reference_check.check_file(path, 30, 1, 2, 300)
    assert counts["homeless"] == np.count_nonzero(true_labels == last) > 0


def test_undamped_file_is_refused(tmp_path):
    path = tmp_path / "undamped.h5"
    attractors = [{"period": 1, "winding": 0, "centre": 0, "points": np.zeros((1, 2))}]
    write_result(path, attractors, np.zeros(1), np.zeros(1), np.full((1, 1), -1), np.zeros((1, 1)),
                 pendulum={"k": 0.1, "beta": 0.0, "m": 0.1})
    with pytest.raises(BadFile, match="undamped"):
        reference_check.check_file(path, 1, 1, 1, 10)
