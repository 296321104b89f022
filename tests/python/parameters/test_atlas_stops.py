"""An atlas that is stopped in each of its stages, one after the other, and resumed on another number of ranks: the same
bytes."""

import json

import pytest
from conftest import datasets, stopped_in_each_stage, with_extensive
from test_atlas import PENDULUM

STAGES = {"atlas cycles", "atlas births", "atlas branches", "atlas curves", "atlas checks", "atlas motions",
          "atlas shares"}
SMALL = {"pendulum": PENDULUM,
         "atlas": {"x": {"parameter": "drive_frequency", "min": 9, "max": 12},
                   "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.3},
                   "max_period": 1, "seeds": 2, "checks": 2, "points": 16, "shares": 40}}
# Its first round finds curves with wide bands, so that a third one is needed.
LARGER = {"pendulum": PENDULUM,
          "atlas": SMALL["atlas"] | {"y": {"parameter": "drive_amplitude", "min": 0, "max": 0.5}, "max_period": 2,
                                     "checks": 3}}
TILTED = {"pendulum": dict(PENDULUM, tilt="5 deg"),
          "atlas": SMALL["atlas"] | {"y": {"parameter": "drive_amplitude", "min": 0.1, "max": 0.3}}}


@pytest.mark.parametrize(("scene", "others", "rounds", "ranks", "writes"), with_extensive(
    [(SMALL, set(), 2, [None], [1, 0])],
    [(LARGER, set(), 3, [1, 2, 3, 7, 2], [1, 0]), (TILTED, {"atlas reference"}, 2, [7, 3, 1, 2, 3], [1, *99 * [0]])]))
def test_a_stop_in_each_stage_changes_no_byte(kapitza, tmp_path, scene, others, rounds, ranks, writes):
    (tmp_path / "s.yaml").write_text(json.dumps(scene))
    kapitza("run", "s.yaml", "-o", "whole.h5", folder=tmp_path)
    found = stopped_in_each_stage(kapitza, "s.yaml", file="s.h5", folder=tmp_path, ranks=ranks, writes=writes)
    assert STAGES | others <= set(found), found
    assert found.count("atlas cycles") >= 1 + rounds  # a census before the rounds, and in each
    assert datasets(tmp_path / "s.h5") == datasets(tmp_path / "whole.h5")
    assert not (tmp_path / "s.h5.checkpoint").exists()
