"""basin.proof: starts in proved regions are marked, their labels are the proved ones, whoever worked on them."""

import h5py
import numpy as np
from conftest import datasets

# One attractor, and a saddle whose stable manifold is all that cannot be proved to end there.
SCENE = """\
pendulum: {k: 0.05, damping: 0.4, m: 0.1}
basin:
  theta: {count: 40}
  velocity: {min: -1.5, max: 1.5, count: 31}
  proof: true
  attractors: {starts: 256}
"""
PROVED = 6


def test_proved_cells_are_marked_by_any_number_of_ranks(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE)
    done = kapitza("run", "s.yaml", "--timings", folder=tmp_path)
    assert "% of the window lies in trapping regions that are proved\n" in done.stdout and "refuted" not in done.stdout
    assert "proved ellipses" in done.stdout + done.stderr
    with h5py.File(tmp_path / "s.h5") as file:
        basin = file["basin"]
        evidence, share = basin["evidence"][:], basin.attrs["proved_share"]
        assert 0.98 < share < 1 and share == np.mean(evidence == PROVED) and basin.attrs["refuted"] == 0
        assert not basin["attractor"][:].any()
    for ranks in (2, 3):
        kapitza("run", "s.yaml", "-o", f"{ranks}.h5", ranks=ranks, folder=tmp_path)
        assert datasets(tmp_path / f"{ranks}.h5") == datasets(tmp_path / "s.h5")


def test_labels_that_the_proof_refutes_are_replaced_and_counted(kapitza, tmp_path):
    """Three periods are too few for many orbits."""
    (tmp_path / "s.yaml").write_text(SCENE)
    kapitza("run", "s.yaml", "-o", "without.h5", "--set", "basin.proof=false", "--set", "basin.max_periods=3", folder=tmp_path)
    done = kapitza("run", "s.yaml", "--set", "basin.max_periods=3", folder=tmp_path)
    with h5py.File(tmp_path / "s.h5") as file, h5py.File(tmp_path / "without.h5") as without:
        former, proved = without["basin/attractor"][:], file["basin/evidence"][:] == PROVED
        refuted = np.count_nonzero(proved & (former == -1))
        assert refuted > 0 and file["basin"].attrs["refuted"] == refuted
        assert np.array_equal(file["basin/attractor"][:], np.where(proved, 0, former))
        assert "proved_share" not in without["basin"].attrs and without["basin/evidence"][:].max() < PROVED
    assert f"warning: {refuted} cells there had another label, or none" in done.stdout


def test_windows_that_are_too_fast_for_a_proof_are_refused(kapitza, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE.replace("1.5", "5000"))
    for command in ("run", "check"):
        done = kapitza(command, "s.yaml", "--set", "numerics.scheme=split6", folder=tmp_path, status=2)
        assert "basin.proof: speeds of 5e+03 rad per drive radian are too fast for a proof" in done.stderr
    assert not (tmp_path / "s.h5").exists()
