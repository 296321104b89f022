"""Runs that are stopped again and again come to their end, with the same bytes: everything that takes longer than
seconds is kept."""

from conftest import datasets, run_until_saved

# Orbits take thousands of periods to settle: the search for attractors is nearly all of the work. (test_sweep.py stops
# a sweep.)
SCENE = """\
pendulum: {quality_factor: 300, drive_frequency: 8, drive_amplitude: 0.3}
basin:
  theta: {count: 6}
  velocity: {min: -0.5, max: 0.5, count: 6}
  icm: {theta: 100, velocity: 100}
  method: direct
  max_periods: 12000
  attractors: {starts: 64}
"""
STOPS = 3


def test_a_run_that_is_stopped_again_and_again_ends(kapitza, tmp_path):
    """Stopped as soon as something more is saved, each time on other ranks, then left to end."""
    (tmp_path / "s.yaml").write_text(SCENE)
    kapitza("run", "s.yaml", "-o", "undisturbed.h5", ranks=2, folder=tmp_path)
    for ranks in range(1, STOPS + 1):
        run_until_saved(kapitza, "s.yaml", "--resume", file="s.h5", folder=tmp_path, ranks=ranks)
    kapitza("run", "s.yaml", "--resume", ranks=2, folder=tmp_path)
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "undisturbed.h5")
    assert not (tmp_path / "s.h5.checkpoint").exists()
