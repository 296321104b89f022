"""Runs that are stopped again and again come to their end, with the same bytes: everything that takes longer than seconds is kept."""

import os
import time

import pytest
from conftest import datasets

SCENES = {
    # orbits take thousands of periods to settle: the search for attractors is nearly all of the work
    "weak damping": """\
pendulum: {quality_factor: 1000, drive_frequency: 8, drive_amplitude: 0.3}
basin:
  theta: {count: 6}
  velocity: {min: -0.5, max: 0.5, count: 6}
  icm: {theta: 100, velocity: 100}
  method: direct
  max_periods: 40000
  attractors: {starts: 64}
""",
    "frequencies": """\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.5}
sweep:
  parameter: drive_frequency
  min: 9
  max: 13
  count: 9
  starts: 64
  transient: 4000
  measure: [attractors, flutter_amplitude, strobe]
""",
    # a value of the sweep takes nearly as long as the limit
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
SHARE, MOST = 0.4, 60  # of the time of the undisturbed run, longer with every stop; starts of the program


@pytest.mark.parametrize("name", SCENES if os.environ.get("KAPITZA_EXTENSIVE") else list(SCENES)[:2])
def test_a_run_that_is_stopped_again_and_again_ends(kapitza, tmp_path, name):
    (tmp_path / "s.yaml").write_text(SCENES[name])
    begun = time.monotonic()
    kapitza("run", "s.yaml", "-o", "undisturbed.h5", ranks=2, folder=tmp_path)
    limit = SHARE * (time.monotonic() - begun)
    stops, saved = 0, []
    for ranks in [1, 2, 3] * (MOST // 3):
        done = kapitza("run", "s.yaml", "--resume", "--time-limit", f"{limit:.3f}", ranks=ranks, folder=tmp_path, status=None)
        if done.returncode != 75:
            break
        stops += 1
        limit *= 1.1
        saved.append("finished work is in s.h5.checkpoint" in done.stderr)
        assert saved[-1] == (tmp_path / "s.h5.checkpoint").exists() == ("nothing was saved" not in done.stderr), done.stderr
    assert done.returncode == 0 and stops > 0 and any(saved), (stops, done.stderr)
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "undisturbed.h5")
    assert not (tmp_path / "s.h5.checkpoint").exists()
