"""Windows whose cells are small: the error of a drive period is held against a cell, and the labels against quad precision."""

import json
import re

import h5py
import numpy as np
import pytest
import reference_check
from conftest import datasets
from kapitza import Result
from kapitza.plots.plane import Plane

THETA, VELOCITY = -2.3671728704614576, 17.0
PENDULUM = {"k": 0.1, "damping": 0.1, "m": 0.4}
SMALL = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300}


def scene(folder, half, count, method, pendulum=PENDULUM, centre=(THETA, VELOCITY), numerics=None):
    """Writes a window of count x count cells, half wide to either side of its centre."""
    axes = {name: {"min": middle - half, "max": middle + half, "count": count}
            for name, middle in zip(("theta", "velocity"), centre, strict=True)}
    parts = {"pendulum": pendulum, "basin": {**axes, "method": method}, "numerics": {"scheme": "split6"} | (numerics or {})}
    (folder / "zoom.yaml").write_text(json.dumps(parts))
    return "zoom.yaml"


def test_labels_of_a_zoom_are_right(kapitza, tmp_path):
    """With the scheme's own 24 steps, off by 500 cells a period, 55 % of these labels are wrong."""
    done = kapitza("run", scene(tmp_path, 1e-7, 30, "direct"), folder=tmp_path)
    assert "164 steps per drive period (its default is 24)" in done.stdout and "warning: at speeds" not in done.stdout
    comparison, _ = reference_check.check_file(tmp_path / "zoom.h5", 40, 1, 2, 4000)
    assert comparison["wrong"] <= 3 and comparison["unsettled"] == 0
    with h5py.File(tmp_path / "zoom.h5") as file:
        assert file["basin"].attrs["steps_per_period"] == 164
        assert file["basin"].attrs["step_error"] < 0.01 * 2e-7 / 30
        (tmp_path / "again.yaml").write_text(file.attrs["scene_resolved"])
    kapitza("run", "again.yaml", folder=tmp_path)
    assert datasets(tmp_path / "zoom.h5") == datasets(tmp_path / "again.h5")


@pytest.mark.extensive
def test_a_table_that_is_off_by_cells_is_refused(kapitza, tmp_path):
    done = kapitza("run", scene(tmp_path, 1e-7, 30, "icm"), "--set", "basin.icm={theta: 800, velocity: 800}", folder=tmp_path, status=2)
    error = r"--set basin.icm=\S.*: basin.icm: the map table has an error of \S+ rad a period, but a cell is 6.7e-09 wide; use "
    assert re.search(error + "method direct, or some [0-9]+00 nodes an axis", done.stderr), done.stderr
    assert not (tmp_path / "zoom.h5").exists()


@pytest.mark.parametrize("command", ["run", "check"])
def test_steps_that_are_given_and_too_few_are_refused(kapitza, tmp_path, command):
    path = scene(tmp_path, 1e-7, 30, "direct", numerics={"steps_per_period": 48})
    done = kapitza(command, path, folder=tmp_path, status=2)
    assert "numerics.steps_per_period: with numerics.steps_per_period = 48 of split6" in done.stderr
    assert "where a cell is 6.7e-09 wide; 164 steps or more" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["zoom.yaml"]


def test_steps_between_are_warned_of(kapitza, tmp_path):
    path = scene(tmp_path, 1e-5, 10, "direct", numerics={"steps_per_period": 48})
    done = kapitza("run", path, folder=tmp_path)
    assert "warning: at speeds from 8.5 to 17 the error of one drive period is up to" in done.stdout and "64 steps or more" in done.stdout


@pytest.mark.parametrize("half, pendulum, centre", [(1e-10, SMALL, (0.7, 1.42)), (1e-12, PENDULUM, (THETA, VELOCITY))])
def test_cells_that_rounding_blurs_are_refused(kapitza, tmp_path, half, pendulum, centre):
    done = kapitza("check", scene(tmp_path, half, 30 if half < 1e-11 else 100, "direct", pendulum, centre), folder=tmp_path, status=2)
    assert "basin.velocity" in done.stderr and re.search("not even [0-9]+ steps are enough", done.stderr)
    assert "wider cells, or basin.method exact" in done.stderr


def test_unsettled_cells_are_no_basin(kapitza, tmp_path):
    """They are left out of the measures, and that is said; where they are most cells, so are the measures."""
    grid = "basin={theta: {count: 100}, velocity: {min: -2, max: 2, count: 100}, method: direct, icm: {theta: 250, velocity: 250}}"
    (tmp_path / "x.yaml").write_text(json.dumps({"pendulum": SMALL}))
    for damping, said, finite in ((5, "Both leave unsettled cells out.", True), (5000, "because most cells did not settle", False)):
        done = kapitza("run", "x.yaml", "--set", grid, "--set", f"basin.max_periods={8 if damping > 5 else 100}",
                       "--set", f"pendulum.quality_factor={damping}", "--set", f"basin.attractors.starts={8 if damping > 5 else 256}",
                       "--force", folder=tmp_path)
        assert said in done.stdout
        with h5py.File(tmp_path / "x.h5") as file:
            attributes, unsettled = dict(file["basin"].attrs), (file["basin/attractor"][:] < 0).mean()
        assert 0 < unsettled < 0.5 if finite else unsettled > 0.5
        for name in ("basin_entropy", "boundary_basin_entropy", "uncertainty_exponent", "uncertainty_exponent_nearest"):
            assert np.isfinite(attributes[name]) == finite, name


def test_the_exponent_has_its_distances(small_result):
    with h5py.File(small_result) as file:
        attributes = file["basin"].attrs
        cell = 2 * np.pi / 100
        assert attributes["uncertainty_exponent_nearest"] == pytest.approx(cell)
        assert attributes["uncertainty_exponent_farthest"] == pytest.approx(4 * cell)


# Points of boundaries that windows shrink upon: of the zooms above, and of Fig. 12 of the paper at v = 1.42.
BOUNDARY = "-2.36717282205514094284618936441679792892500699963420629501343"


def deep(folder, theta, velocity, width, count, pendulum=PENDULUM):
    """Writes a window of count x count cells by its centre and width."""
    basin = {name: {"centre": centre, "width": width, "count": count} for name, centre in (("theta", theta), ("velocity", velocity))}
    (folder / "deep.yaml").write_text(json.dumps({"pendulum": pendulum, "basin": basin | {"method": "exact"}}))
    return "deep.yaml"


@pytest.mark.extensive
def test_a_deep_window_in_its_file(kapitza, tmp_path):
    """Offsets that tell the cells apart, the centre as it was written, a scene that gives the same file again, a picture with axes."""
    path = deep(tmp_path, BOUNDARY, "17", "1e-18", 6)
    kapitza("run", path, folder=tmp_path)
    basin = Result(tmp_path / "deep.h5").group("basin")
    assert np.all(np.diff(basin["theta"].values) == 0)
    assert np.array_equal(basin["theta_offset"].values, (2 * np.arange(6) - 5) / 12) and "units" in basin["theta_offset"].attrs
    assert basin.attrs["theta_centre"] == BOUNDARY and basin.attrs["velocity_centre"] == "17"
    assert basin.attrs["theta_width"] == basin.attrs["velocity_width"] == "1e-18"
    with h5py.File(tmp_path / "deep.h5") as file:
        (tmp_path / "again.yaml").write_text(file.attrs["scene_resolved"])
    kapitza("run", "again.yaml", folder=tmp_path)
    assert datasets(tmp_path / "deep.h5") == datasets(tmp_path / "again.h5")
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
    (tmp_path / "x.yaml").write_text(json.dumps({"pendulum": PENDULUM}))
    window = f"basin={{theta: {{{theta}, count: 12}}, velocity: {{{velocity}, count: 12}}, method: exact, attractors: {{starts: 512}}}}"
    kapitza("run", "x.yaml", "--set", window, folder=tmp_path)
    with h5py.File(tmp_path / "x.h5") as file:
        labels, mirror = file["basin/attractor"][:], file["attractors/mirror"][:]
        assert (labels >= 0).all() and (len(np.unique(labels)) > 1) == several and file["basin"].attrs["undecided"] == 0
        if "180" in theta:
            assert np.array_equal(mirror[labels], labels[::-1, ::-1])


@pytest.mark.parametrize("settings, said", [(["basin.max_periods=20"], "The 16 that have not settled"),
                                            (["pendulum.damping=0"], "without damping there are no attractors")], ids=["late", "undamped"])
def test_a_reference_that_never_settles(kapitza, tmp_path, settings, said):
    words = [word for setting in settings for word in ("--set", setting)]
    done = kapitza("run", deep(tmp_path, BOUNDARY, "17", "1e-100", 4), *words, folder=tmp_path)
    with h5py.File(tmp_path / "deep.h5") as file:
        assert (file["basin/attractor"][:] == -1).all() and said in done.stdout
