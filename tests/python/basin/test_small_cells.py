"""Windows whose cells are small: the error of a drive period is held against a cell, and the labels against quad
precision."""

import re

import numpy as np
import pytest
import reference_check
from conftest import datasets, refused_scene, run_scene, settings
from kapitza import Result
from kapitza.plots.window_axes import Plane

THETA, VELOCITY = -2.3671728704614576, 17.0
PENDULUM = {"k": 0.1, "damping": 0.1, "m": 0.4}
SMALL = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300}


def scene(half, count, method, pendulum=PENDULUM, centre=(THETA, VELOCITY), numerics=None):
    """A window of count x count cells, half wide to either side of its centre."""
    axes = {name: {"min": middle - half, "max": middle + half, "count": count}
            for name, middle in zip(("theta", "velocity"), centre, strict=True)}
    return {"pendulum": pendulum, "basin": {**axes, "method": method},
            "numerics": {"scheme": "split6"} | (numerics or {})}


def test_labels_of_a_zoom_are_right(kapitza, tmp_path):
    """With the scheme's own 24 steps, off by 500 cells a period, 55 % of these labels are wrong."""
    result, said = run_scene(kapitza, tmp_path, scene(1e-7, 30, "direct"))
    assert "164 steps per drive period (its default is 24)" in said and "warning: at speeds" not in said
    comparison, _ = reference_check.check_file(result.path, 40, 1, 2, 4000)
    assert comparison["wrong"] <= 3 and comparison["unsettled"] == 0
    attributes = result.group("basin").attrs
    assert attributes["steps_per_period"] == 164 and attributes["step_error"] < 0.01 * 2e-7 / 30


@pytest.mark.extensive
def test_a_table_that_is_off_by_cells_is_refused(kapitza, tmp_path):
    said = refused_scene(kapitza, tmp_path, scene(1e-7, 30, "icm"), "--set", "basin.icm={theta: 800, velocity: 800}")
    error = (r"--set basin.icm=\S.*: basin.icm: the map table has an error of \S+ rad a period, but a cell is 6.7e-09 "
             r"wide; use ")
    assert re.search(error + "method direct, or some [0-9]+00 nodes an axis", said), said


@pytest.mark.parametrize("command", ["run", "check"])
def test_steps_that_are_given_and_too_few_are_refused(kapitza, tmp_path, command):
    said = refused_scene(kapitza, tmp_path, scene(1e-7, 30, "direct", numerics={"steps_per_period": 48}),
                         command=command)
    assert "numerics.steps_per_period: with numerics.steps_per_period = 48 of split6" in said
    assert "where a cell is 6.7e-09 wide; 164 steps or more" in said


def test_steps_between_are_warned_of(kapitza, tmp_path):
    _, said = run_scene(kapitza, tmp_path, scene(1e-5, 10, "direct", numerics={"steps_per_period": 48}))
    assert "warning: at speeds from 8.5 to 17 the error of one drive period is up to" in said
    assert "64 steps or more" in said


@pytest.mark.parametrize("half, pendulum, centre", [(1e-10, SMALL, (0.7, 1.42)), (1e-12, PENDULUM, (THETA, VELOCITY))])
def test_cells_that_rounding_blurs_are_refused(kapitza, tmp_path, half, pendulum, centre):
    window = scene(half, 30 if half < 1e-11 else 100, "direct", pendulum, centre)
    said = refused_scene(kapitza, tmp_path, window, command="check")
    assert "basin.velocity" in said and re.search("not even [0-9]+ steps are enough", said)
    assert "wider cells, or basin.method exact" in said


def test_unsettled_cells_are_no_basin(kapitza, tmp_path):
    """They are left out of the measures, and that is said; where they are most cells, so are the measures."""
    grid = ("basin={theta: {count: 100}, velocity: {min: -2, max: 2, count: 100}, method: direct, icm: {theta: 250, "
            "velocity: 250}}")
    rows = ((5, 100, 256, "Both leave unsettled cells out.", True),
            (5000, 8, 8, "because most cells did not settle", False))
    for quality, periods, starts, said, finite in rows:
        options = settings(grid, f"basin.max_periods={periods}", f"basin.attractors.starts={starts}")
        result, text = run_scene(kapitza, tmp_path, {"pendulum": SMALL | {"quality_factor": quality}}, *options)
        assert said in text
        attributes, unsettled = result.group("basin").attrs, (result.group("basin")["attractor"].values < 0).mean()
        assert 0 < unsettled < 0.5 if finite else unsettled > 0.5
        for name in ("basin_entropy", "boundary_basin_entropy", "uncertainty_exponent", "uncertainty_exponent_nearest"):
            assert np.isfinite(attributes[name]) == finite, name


def test_the_exponent_has_its_distances(small_result):
    attributes, cell = Result(small_result).group("basin").attrs, 2 * np.pi / 100
    assert attributes["uncertainty_exponent_nearest"] == pytest.approx(cell)
    assert attributes["uncertainty_exponent_farthest"] == pytest.approx(4 * cell)


# Points of boundaries that windows shrink upon: of the zooms above, and of Fig. 12 of the paper at v = 1.42.
BOUNDARY = "-2.36717282205514094284618936441679792892500699963420629501343"


def deep(width, count):
    """A window of count x count cells upon BOUNDARY."""
    basin = {name: {"centre": centre, "width": width, "count": count} for name,
             centre in (("theta", BOUNDARY), ("velocity", "17"))}
    return {"pendulum": PENDULUM, "basin": basin | {"method": "exact"}}


@pytest.mark.extensive
def test_a_deep_window_in_its_file(kapitza, tmp_path):
    """Offsets that tell the cells apart, the centre as it was written, a scene that gives the same file again, a
    picture with axes."""
    result, _ = run_scene(kapitza, tmp_path, deep("1e-18", 6))
    basin = result.group("basin")
    assert np.all(np.diff(basin["theta"].values) == 0)
    assert np.array_equal(basin["theta_offset"].values,
                          (2 * np.arange(6) - 5) / 12) and "units" in basin["theta_offset"].attrs
    assert basin.attrs["theta_centre"] == BOUNDARY and basin.attrs["velocity_centre"] == "17"
    assert basin.attrs["theta_width"] == basin.attrs["velocity_width"] == "1e-18"
    again, _ = run_scene(kapitza, tmp_path, result.attributes["scene_resolved"], name="again")
    assert datasets(result.path) == datasets(again.path)
    plane = Plane(basin, "down")
    assert plane.theta_range == pytest.approx((-0.5, 0.5)) and plane.centres == {"theta": BOUNDARY, "velocity": "17"}
    assert plane.place == "θ ≈ −2.36717282205…, dθ/d(ωt) ≈ 17"
    assert plane.inside(np.array([0.0]), np.array([0.0]))[0].size == 0


@pytest.mark.parametrize("theta, velocity, several", [
    ("centre: 0.1, width: 1e-20", "centre: 0.2, width: 1e-20", False),  # inside a basin
    ("centre: 0, width: 1e-100", "centre: 0, width: 1e-100", False),  # at an equilibrium
    ("centre: 180 deg, width: 1e-30", "centre: 0, width: 1e-30", True),  # on a saddle, its own mirror image
    (f"centre: {BOUNDARY}, width: 1e-20", "centre: 17, width: 1e-6", True),  # two scales
    (f"centre: {BOUNDARY}, width: 1e-100", "min: 16.5, max: 17.5", True),
], ids=["inside", "equilibrium", "saddle", "scales", "edges"])
def test_windows_of_all_kinds(kapitza, tmp_path, theta, velocity, several):
    window = (f"basin={{theta: {{{theta}, count: 12}}, velocity: {{{velocity}, count: 12}}, method: exact, "
              f"attractors: {{starts: 512}}}}")
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": PENDULUM}, "--set", window)
    basin, mirror = result.group("basin"), result.group("attractors")["mirror"].values
    labels = basin["attractor"].values
    assert (labels >= 0).all() and (len(np.unique(labels)) > 1) == several and basin.attrs["undecided"] == 0
    if "180" in theta:
        assert np.array_equal(mirror[labels], labels[::-1, ::-1])


@pytest.mark.parametrize("setting, said", [("basin.max_periods=20", "The 16 that have not settled"),
                                           ("pendulum.damping=0", "without damping there are no attractors")],
                         ids=["late", "undamped"])
def test_a_reference_that_never_settles(kapitza, tmp_path, setting, said):
    result, text = run_scene(kapitza, tmp_path, deep("1e-100", 4), "--set", setting)
    assert (result.group("basin")["attractor"].values == -1).all() and said in text
