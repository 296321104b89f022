"""Ends over a plane, a measure of sweeps: ends against single runs and the linear theory, starts that cannot settle,
ranks, pictures."""

import json

import numpy as np
import pytest
from conftest import EXTENSIVE, datasets, plot, run_scene, stopped_and_resumed

STARTS = [0.3, 2.9, np.pi]
CYCLE, CHAOTIC, NOT_SETTLED, NO_PENDULUM = range(4)
SCENE = {"pendulum": {"k": 0.05, "damping": 0.1, "m": 0},
         "sweep": {"x": {"parameter": "m", "min": 0, "max": 0.72, "count": 13},
                   "y": {"parameter": "damping", "min": 0, "max": 0.3, "count": 5},
                   "measure": ["ends"], "ends": {"theta": STARTS, "max_period": 8}}}


@pytest.fixture(scope="module")
def chart(kapitza, tmp_path_factory):
    """The group of the scene above, the summary and the file."""
    result, summary = run_scene(kapitza, tmp_path_factory.mktemp("chart"), SCENE)
    return result.group("plane"), summary, result.path


def test_ends_are_those_of_single_runs(chart, kapitza, tmp_path):
    """Period and winding as `where` has them, wherever double precision decides."""
    group, _, _ = chart
    decided = 0
    for column, row, place in ((2, 1, 0), (4, 4, 1), (6, 2, 1), (8, 1, 1), (9, 3, 0), (10, 4, 0), (11, 1, 0),
                               (12, 2, 1)):
        point = group.isel(x=column, y=row, start=place)
        pendulum = {"k": 0.05, "damping": float(point["y"]), "m": float(point["x"])}
        (tmp_path / "w.yaml").write_text(json.dumps({"pendulum": pendulum,
                                                     "attractors": {"velocity": {"min": -2, "max": 2}, "starts": 256}}))
        end = json.loads(kapitza("where", "w.yaml", STARTS[place], 0, "--json", folder=tmp_path).stdout)
        if not end["decided"] or end["period"] == 0 or end["period"] > 8:
            continue
        decided += 1
        assert (int(point["end"]), int(point["end_period"]),
                int(point["end_winding"])) == (CYCLE, end["period"], end["winding"]), pendulum
    assert decided >= 6


def test_what_cannot_settle_is_told(chart):
    """No damping: no end; a start on the inverted rest: it ends there where that attracts, and nowhere where it does
    not."""
    group, summary, _ = chart
    assert (group["end"].isel(y=0) == NO_PENDULUM).all() and np.isnan(group["exponent"].isel(y=0)).all()
    resting = group.isel(start=2, y=slice(1, None))
    attracts = resting["end"] == CYCLE
    assert (resting["end_centre"].values[attracts] == 1).all() and (resting["exponent"].values[attracts] < 0).all()
    assert (resting["end"].values[~attracts] == NOT_SETTLED).all() and (resting["exponent"].values[~attracts] > 0).all()
    assert attracts.any() and not attracts.all() and not attracts.isel(x=0).any()
    assert "no damped pendulum 20.00 %" in summary


def test_any_number_of_ranks_a_stop_and_every_view(chart, kapitza, tmp_path):
    _, _, path = chart
    kapitza("run", path.with_suffix(".yaml"), "-o", "again.h5", ranks=3, folder=tmp_path)
    assert datasets(tmp_path / "again.h5") == datasets(path)
    assert datasets(stopped_and_resumed(kapitza, tmp_path, SCENE, ranks=3).path) == datasets(path)
    for view in ("ends", "exponent", "settling") if EXTENSIVE else ("ends",):
        done = plot("plane", path, "-o", tmp_path / f"{view}.png", "--view", view, "--dpi", 40)
        assert done.returncode == 0 and (tmp_path / f"{view}.png").stat().st_size > 4000, done.stderr
