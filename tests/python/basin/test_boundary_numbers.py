"""Numbers of basin boundaries and lifetimes: a smooth scene, a deep one, ranks, a chaotic transient of known
lifetime."""

import numpy as np
import pytest
from conftest import datasets, refused_scene, run_scene

# A point at rest on the edge of the basin of Fig. 11's inverted state, found by bisection with the command where.
EDGE = "2.332871765266180303048402854174"
FIGURE = {"quality_factor": 5, "drive_frequency": 11}


def scene(amplitude, count=256, pairs=4000):
    axis = {"min": -2, "max": 2, "count": count}
    return {"pendulum": {**FIGURE, "drive_amplitude": amplitude},
            "basin": {"theta": {"min": -3.1, "max": 3.1, "count": count}, "velocity": axis,
                      "boundary": {"pairs": pairs}}}


def test_a_smooth_boundary(kapitza, tmp_path):
    """About the inverted state at Fig. 11 a few curves are the whole boundary: exponent and dimension 1."""
    window = scene(0.15, pairs=20000)
    window["basin"] |= {"theta": {"min": 2.2, "max": 4.08, "count": 256},
                        "velocity": {"min": -0.1, "max": 0.1, "count": 256}}
    result, summary = run_scene(kapitza, tmp_path, window)
    group = result.group("boundary")
    assert "boundary: uncertainty exponent" in summary and "box-counting dimension" in summary
    assert group.attrs["uncertainty_exponent_low"] < 1 < group.attrs["uncertainty_exponent_high"]
    assert group["dimension"].values[:4] == pytest.approx(1, abs=0.05)


def test_distances_below_the_last_place_of_a_double(kapitza, tmp_path):
    """Across a window of 1e-18 the edge of the inverted state's basin is one straight line through its middle, nearly
    along a side: half of the pairs that are farther apart lie on two sides, of nearer ones 2/pi times their distance
    over the width."""
    width = 1e-18
    deep = scene(0.15)
    axes = {name: {"centre": centre, "width": str(width), "count": 2} for name,
            centre in (("theta", EDGE), ("velocity", 0))}
    deep["basin"] = {**axes, "method": "exact", "attractors": {"starts": 512},
                     "boundary": {"pairs": 100, "decades": 18}}
    group = run_scene(kapitza, tmp_path, deep)[0].group("boundary")
    distance, low, high = (group[name].values for name in ("distance", "uncertain_low", "uncertain_high"))
    known = np.where(distance > width, 0.5, 2 / np.pi * distance / width)
    apart = (distance > 10.5 * width) | (distance < 0.9 * width)
    assert len(distance) == 19 and distance[-1] == pytest.approx(1e-20)
    assert np.all((low < known)[apart] & (known < high)[apart])
    assert group["slope_low"].values[-2] < 1 < group["slope_high"].values[-2]


def test_doubles_and_more_digits_count_alike(kapitza, tmp_path):
    """The boundary of the pendulum of C. Grebogi, E. Ott and J. A. Yorke: one power law from distances in doubles to
    nearer ones."""
    window = {"theta": {"count": 40}, "velocity": {"min": -2, "max": 4, "count": 40},
              "boundary": {"pairs": 1500, "decades": 12}}
    forced = {"k": 1, "damping": 0.1, "m": 0, "torque_amplitude": 2.1}
    group = run_scene(kapitza, tmp_path, {"pendulum": forced, "basin": window})[0].group("boundary")
    share, low, high = (group[f"uncertain_{name}"].values for name in ("share", "low", "high"))
    exponent, level = np.polyfit(np.log(group["distance"].values[:11]), np.log(share[:11]), 1)
    foreseen = np.exp(level + exponent * np.log(group["distance"].values[11:]))
    assert abs(exponent - 0.0558) < 0.01 and np.all((0.9 * low[11:] < foreseen) & (foreseen < 1.1 * high[11:]))


@pytest.mark.parametrize("keys, message", [
    (["method=direct", "boundary.decades=11"], "basin.boundary.decades: 11 go down to 1e-13 rad"),
    (["boundary.farthest=1e-24"], "it must be 1e-23 at least, or farthest at most the width of a window whose cells")])
def test_pairs_too_near_for_their_numbers(kapitza, tmp_path, keys, message):
    settings = [word for key in keys for word in ("--set", f"basin.{key}")]
    assert message in refused_scene(kapitza, tmp_path, scene(0.15), *settings, command="check")


def test_any_number_of_ranks(kapitza, tmp_path):
    one, three = (run_scene(kapitza, tmp_path, scene(0.47, 48, 200), ranks=ranks, name=f"{ranks}")[0]
                  for ranks in (1, 3))
    assert datasets(one.path) == datasets(three.path)


@pytest.mark.extensive
def test_lifetimes_of_a_basin_and_of_a_sweep(kapitza, tmp_path):
    """The tail of the settling times; the same from the starts of a sweep, within the intervals."""
    basin = run_scene(kapitza, tmp_path, scene(0.47))[0].group("basin")
    times = basin["settling_time"].values.astype(float)
    after = basin.attrs["lifetime_after"]
    tail = times[times > after] - after
    assert basin.attrs["lifetime"] == pytest.approx(tail.mean(), rel=0.02)
    assert basin.attrs["lifetime_low"] < basin.attrs["lifetime"] < basin.attrs["lifetime_high"]
    sweep = {"parameter": "drive_amplitude", "min": 0.47, "max": 0.471, "count": 2, "measure": ["lifetime"],
             "starts": 1024}
    table = run_scene(kapitza, tmp_path,
                      {"pendulum": {**FIGURE, "drive_amplitude": 0.3}, "sweep": sweep})[0].group("sweep").isel(value=0)
    assert float(table["lifetime_low"]) < basin.attrs["lifetime_high"] * 1.5
    assert float(table["lifetime_low"]) < float(table["lifetime"]) < float(table["lifetime_high"])


def test_cells_that_stay_open_are_put_in_words(kapitza, tmp_path):
    """Most motions at k = 0.25, beta = 0.05, m = 0.465 are long chaotic transients: 2000 periods show that few of them
    end."""
    chaos = {"pendulum": {"k": 0.25, "damping": 0.05, "m": 0.465},
             "basin": {"theta": {"count": 24}, "velocity": {"min": -1, "max": 1, "count": 12}, "max_periods": 2000,
                       "attractors": {"starts": 64, "max_period": 4}}}
    result, summary = run_scene(kapitza, tmp_path, chaos)
    open_cells = int((result.group("basin")["attractor"].values < 0).sum())
    assert (open_cells > 0) == ("transients: " in summary)
    if open_cells > 20:
        assert result.group("basin").attrs["lifetime_low"] > 100
