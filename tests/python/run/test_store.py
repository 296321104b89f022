"""The result file keeps its contract: netCDF-4 tools open it, everything is named, sized, and says its unit."""

import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from conftest import PROGRAM
from kapitza import Result, layout


@pytest.fixture(scope="module")
def file(small_result):
    with h5py.File(small_result) as opened:
        yield opened


def every_dataset(file):
    found = []
    file.visititems(lambda name, item: found.append(item) if isinstance(item, h5py.Dataset) else None)
    return found


def test_every_group_opens_with_xarray(small_result):
    for name in Result(small_result).groups:
        with xarray.open_dataset(small_result, group=name, engine="h5netcdf") as dataset:
            dataset.load()


def test_every_variable_says_what_it_is_in_which_unit(file):
    for item in every_dataset(file):
        assert {"units", "long_name"} <= item.attrs.keys(), item.name
        assert str(item.attrs["long_name"]).strip(), item.name


def test_every_dimension_has_a_named_scale(file):
    for item in every_dataset(file):
        if item.is_scale:
            continue
        for axis in range(item.ndim):
            scales = list(item.dims[axis].values())
            assert len(scales) == 1 and scales[0].parent == item.parent, f"{item.name} axis {axis}"


def test_the_layout_of_the_package_is_that_of_the_program():
    """Made by: build/kapitza keys --layout > python/kapitza/layout.jsonl"""
    done = subprocess.run([PROGRAM, "keys", "--layout"], capture_output=True, text=True, check=True)
    assert done.stdout == Path(layout.__file__).with_name("layout.jsonl").read_text()


def test_the_file_is_as_the_layout_says(file):
    """Types, dimensions, units and names of all datasets."""
    known = 0
    for item in every_dataset(file):
        row = layout.VARIABLES.get(tuple(item.name.strip("/").split("/")))
        if row is None:
            continue
        known += 1
        kind = h5py.check_string_dtype(item.dtype)
        found = "text" if kind and (kind.encoding, kind.length) == ("utf-8", None) else item.dtype.name
        assert found == row["type"], item.name
        assert item.attrs["long_name"] == row["long_name"] and (row["units"][0] == "@"
                                                                or item.attrs["units"] == row["units"]), item.name
        assert len(item.shape) == len(row["dimensions"]), item.name
    assert known > 20


def test_codes_are_explained_and_labels_have_no_fill_value(file):
    for name in ("basin/evidence", "attractors/centre"):
        attributes = file[name].attrs
        assert len(attributes["flag_values"]) == len(str(attributes["flag_meanings"]).split()), name
    assert all("_FillValue" not in item.attrs for item in every_dataset(file) if item.dtype.kind in "iu")


def test_nothing_is_left_beside_the_file(small_result):
    assert [path.name for path in small_result.parent.iterdir()] == ["small.h5"]


def test_cells_lie_where_the_contract_says(file):
    low, high, count = -2.0, 2.0, 100
    i = np.arange(count)
    assert np.array_equal(file["basin/velocity"][:], (2 * i + 1 - count) * ((high - low) / (2 * count)) + (low + high)
                          / 2)
    theta = file["basin/theta"][:]
    assert np.array_equal(theta, -theta[::-1]) and np.allclose(np.diff(theta), 2 * np.pi / count)


def test_shares_and_labels_agree(small_result):
    result = Result(small_result)
    attractors, labels = result.group("attractors"), result.group("basin")["attractor"].values
    shares = [np.mean(labels == index) for index in range(attractors.sizes["attractor"])]
    assert labels.min() >= -1 and labels.max() < len(shares)
    assert np.allclose(attractors["fraction"], shares, rtol=0, atol=1e-15)


def test_evidence_and_settling_time_agree_with_the_labels(small_result):
    basin = Result(small_result).group("basin")
    unsettled = basin["attractor"].values < 0
    assert np.array_equal(unsettled, basin["evidence"].values == 0)
    assert np.array_equal(basin["evidence"].values == 1, basin["settling_time"].values == 0)
    assert np.all(basin["settling_time"].values[unsettled] == basin.attrs["max_periods"])


def test_the_catalogue_is_in_order(small_result):
    """Sorted by centre, period (0 last), |winding|/period, + before -, then the first strobe point."""
    table = Result(small_result).group("attractors")
    period, winding = table["period"].values, table["winding"].values
    keys = list(zip(table["centre"].values, np.where(period == 0, 10**6, period),
                    np.abs(winding) / np.maximum(period, 1),
                    -np.sign(winding), table["strobe_velocity"].values[:, 0].round(9),
                    table["strobe_theta"].values[:, 0].round(9), strict=True))
    assert keys == sorted(keys)


def test_strobe_points_are_listed_as_promised(small_result):
    table = Result(small_result).group("attractors")
    for row in range(table.sizes["attractor"]):
        theta, velocity = table["strobe_theta"].values[row], table["strobe_velocity"].values[row]
        period = int(table["period"].values[row])
        assert np.all(np.isfinite(theta[:period])) and np.all(np.isnan(theta[period:]))
        assert np.all(np.isnan(velocity[period:]))
        assert np.all((theta[:period] >= -np.pi) & (theta[:period] < np.pi))
        assert not np.any((theta[:period] == 0) & np.signbit(theta[:period])), "a negative zero"
        assert velocity[0] == velocity[:period].min()


def test_mirror_images_are_mutual(small_result):
    table = Result(small_result).group("attractors")
    mirror, ids = table["mirror"].values, np.arange(table.sizes["attractor"])
    assert np.array_equal(mirror[mirror], ids)
    assert np.array_equal(mirror == ids, table["symmetric"].values == 1)
    assert np.array_equal(table["winding"].values[mirror], -table["winding"].values)


MANY = """pendulum: {mass: 1, radius: 1, inertia: 1, friction: 0.5, gravity: 1,
           pivot_amplitude: 0.3, pivot_frequency: 11}
attractors: {velocity: {min: -1, max: 1}, starts: 64}
orbit: {start: {theta: 3, velocity: 0}, periods: 8}
stability: {k: {min: -1, max: 1, count: 3}, m: {min: 0, max: 1, count: 3}, curves: [exact_1], damping: 0.1}
potential: {drive_amplitudes: [0.3], theta: {count: 5}}
sweep: {parameter: friction, min: 0.4, max: 0.5, count: 2, measure: [attractors, strobe], starts: 64, samples: 4}
"""


@pytest.fixture(scope="module")
def variables(kapitza, small_result, tmp_path_factory):
    """Name, units and long name of every variable of two results with all studies but the slow ones."""
    folder = tmp_path_factory.mktemp("many")
    (folder / "many.yaml").write_text(MANY)
    kapitza("run", "many.yaml", folder=folder)
    found = []
    for path in (small_result, folder / "many.h5"):
        with h5py.File(path) as opened:
            found += [(item.name, str(item.attrs["units"]), str(item.attrs["long_name"]))
                      for item in every_dataset(opened)]
    return found


def test_udunits_knows_every_unit(variables):
    """What CF asks of the attribute units; words for people are in long_name."""
    if not shutil.which("udunits2"):
        pytest.skip("udunits2 is not installed: the units of the file are not checked with it")
    units = {unit for _, unit, _ in variables}
    assert {"1", "rad", "kg m2 s-1"} <= units
    for unit in units:
        done = subprocess.run(["udunits2", "-H", unit, "-W", ""], capture_output=True, text=True)
        assert done.returncode == 0 and "Don't recognize" not in done.stderr, unit


def test_long_names_say_what_one_is(variables):
    names = {name: long_name for name, _, long_name in variables}
    assert names["/basin/velocity"] == "angular velocity of the cell centre, in rad per drive radian"
    assert names["/orbit/time"].endswith(", in drive radians")
    assert names["/attractors/period"].endswith(", in drive periods")
    assert not any("|" in text for row in variables for text in row[1:2])
