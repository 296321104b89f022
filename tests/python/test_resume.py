"""Runs that are stopped again and again come to their end, with the same bytes: everything that takes longer than seconds is kept."""


import pytest
from conftest import EXTENSIVE, datasets, run_until_saved

SCENES = {
    # orbits take thousands of periods to settle: the search for attractors is nearly all of the work
    "weak damping": """\
pendulum: {quality_factor: 300, drive_frequency: 8, drive_amplitude: 0.3}
basin:
  theta: {count: 6}
  velocity: {min: -0.5, max: 0.5, count: 6}
  icm: {theta: 100, velocity: 100}
  method: direct
  max_periods: 12000
  attractors: {starts: 64}
""",
    # a value of the sweep is saved as soon as it is known (test_sweep.py stops one such run in each suite)
    "frequencies": """\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.5}
sweep:
  parameter: drive_frequency
  min: 9
  max: 13
  count: 6
  starts: 64
  transient: 2000
  measure: [attractors, flutter_amplitude, strobe]
""",
    # a value of the sweep takes seconds
    "slow values": """\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}
basin:
  theta: {count: 60}
  velocity: {min: -2, max: 2, count: 60}
  icm: {theta: 100, velocity: 100}
  method: direct
sweep: {parameter: drive_amplitude, min: 0.3, max: 0.31, count: 3, starts: 1024, measure: [basin_fractions]}
""",
}
STOPS = 3


@pytest.mark.parametrize("name", SCENES if EXTENSIVE else list(SCENES)[:1])
def test_a_run_that_is_stopped_again_and_again_ends(kapitza, tmp_path, name):
    """Stopped as soon as something more is saved, each time on other ranks, then left to end."""
    (tmp_path / "s.yaml").write_text(SCENES[name])
    kapitza("run", "s.yaml", "-o", "undisturbed.h5", ranks=2, folder=tmp_path)
    for ranks in range(1, STOPS + 1):
        run_until_saved("s.yaml", "--resume", file="s.h5", folder=tmp_path, ranks=ranks)
    kapitza("run", "s.yaml", "--resume", ranks=2, folder=tmp_path)
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "undisturbed.h5")
    assert not (tmp_path / "s.h5.checkpoint").exists()
