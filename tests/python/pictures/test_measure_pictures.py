"""Pictures of measures: over a plane, of one attractor, in a report."""

import re
import shutil
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import xarray
from conftest import plot, run_scene
from kapitza import Result
from kapitza.plots import plane_measures
from kapitza.plots.plane_measures import atlas_of, draw_curves, of_name
from kapitza.report.page import report
from kapitza.result import BadFile
from matplotlib.figure import Figure

SI = {"length": "20 cm", "decay_time": "5 s", "gravity": "9.81 m/s^2", "frequency": "50 Hz", "amplitude": "15 mm"}
SCENE = {"pendulum": SI, "sweep": {"x": {"parameter": "frequency", "min": "45 Hz", "max": "50 Hz", "count": 3},
                                   "y": {"parameter": "amplitude", "min": "4 mm", "max": "14 mm", "count": 2},
                                   "measure": ["share", "entropy"], "velocity": {"min": -1, "max": 1}, "starts": 64,
                                   "cells": 16}}


@pytest.fixture(scope="module")
def plane(kapitza, tmp_path_factory):
    """A file with shares over a plane of a scene in SI units."""
    return run_scene(kapitza, tmp_path_factory.mktemp("plane"), SCENE)[0].path


def test_a_plane_has_a_panel_for_each_name_and_one_for_a_measure_of_the_pendulum(plane, tmp_path):
    group = Result(plane).group("plane")
    assert plot("plane", plane, "-o", tmp_path / "share.svg").returncode == 0
    text = (tmp_path / "share.svg").read_text()
    assert all(f">{words}<" in text
               for words in ("inverted", "share of the starts of the window that end on the attractor",
                                                  "frequency (Hz)", "amplitude (mm)")), text
    assert np.isnan(group["share"]).any() and "hatched: no value, or the attractor is not seen" in text
    assert plot("plane", plane, "-o", tmp_path / "entropy.svg", "--measure", "entropy").returncode == 0
    text = (tmp_path / "entropy.svg").read_text()
    assert "basin entropy over boxes of 5 x 5 cells" in text and ">inverted<" not in text


@pytest.mark.parametrize("options, words", [
    (["--measure", "shock"], "its plane has no shock; it has share, entropy"),
    (["--attractor", "nobody"], "has no attractor nobody; it has "),
    (["--view", "ends"], "the plane has no ends"),
    (["--view", "ends", "--measure", "share"], "cannot be combined")])
def test_what_a_plane_lacks_is_named(plane, tmp_path, options, words):
    done = plot("plane", plane, "-o", tmp_path / "out.png", *options)
    assert done.returncode != 0 and words in done.stderr and "Traceback" not in done.stderr


def test_attractors_of_one_name_are_added_or_the_smallest_counts():
    values = ("attractor", "y", "x"), [[[1.0, 2, np.nan]], [[3, np.nan, np.nan]], [[9, 9, 9]]]
    group = xarray.Dataset({"share": values, "shock": values})
    for measure, first in (("share", 4), ("shock", 1)):
        together, several = of_name(group, measure, [0, 1])
        assert several and np.array_equal(together, [[first, 2, np.nan]], equal_nan=True)
    assert not of_name(group, "shock", [2])[1]


def test_the_curves_of_an_atlas_of_the_same_pendulum_lie_on_top(monkeypatch):
    """Of both mirror images of the motion of the panel; an atlas of other keys or of another pendulum is refused."""
    atlas = xarray.Dataset({"curve_name": ("curve", ["rotation 1/1: fold", "down: swings grow"]),
                            "curve_first": ("curve", [0, 2]),
                            "curve_points": ("curve", [2, 1]), "x": ("point", [1.0, 2, 3]),
                            "y": ("point", [4.0, 5, 6])},
                           attrs={"x_parameter": "k", "y_parameter": "m"})
    axes = draw_curves(Figure().add_subplot(), atlas, "rotation -1/1")
    line, = axes.lines
    assert np.array_equal(line.get_xydata(), [[1, 4], [2, 5]])

    def held(damping):
        scene = f"pendulum: {{k: 1, m: 2, damping: {damping}}}"
        return SimpleNamespace(path="file.h5", groups=["atlas"], group=lambda name: atlas, scene=scene)
    assert atlas_of(held(0.1), atlas, None).identical(atlas)
    with pytest.raises(BadFile, match=r"its atlas is over k and m, the plane over m and k"):
        atlas_of(held(0.1), atlas.assign_attrs(x_parameter="m", y_parameter="k"), None)
    monkeypatch.setattr(plane_measures, "Result", lambda path: held(0.2))
    with pytest.raises(BadFile, match=r"of another pendulum: damping is 0.2, that of the plane 0.1"):
        atlas_of(held(0.1), atlas, "other.h5")


WORDS = ["share", "return_time", "intermingled_with", "entropy"]


@pytest.fixture(scope="module")
def table(kapitza, tmp_path_factory):
    """A file with a basin and measures, without a title."""
    window = {"velocity": {"min": -2, "max": 2}}
    scene = {"pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3},
             "basin": {"theta": {"count": 24}, "velocity": {**window["velocity"], "count": 24}},
             "measures": {"names": WORDS, "starts": 128, "cells": 16, **window}}
    return run_scene(kapitza, tmp_path_factory.mktemp("table"), scene)[0].path


def test_a_passport_is_one_page_about_an_attractor(table, tmp_path):
    """Its multipliers have the modulus that the damping gives, its table the values of the file."""
    done = plot("passport", table, "--attractor", "rotation +1/1", "-o", tmp_path / "out.svg")
    assert done.returncode == 0, done.stderr
    text, row = (tmp_path / "out.svg").read_text(), Result(table).measures.set_index("name").loc["rotation +1/1"]
    modulus = np.exp(-np.pi * Result(table).pendulum["beta"])
    assert all(f">{words}<" in text for words in ("time (drive periods)", "frequency / drive frequency",
                                                  "real part of the multiplier",
                                                  f"modulus {modulus:.4g}", "angle θ from down (rad)", "return time",
                                                  "entropy",
                                                  f"{row['return_time']:.4g} drive periods", f"{row['entropy']:.4g}"))
    assert "in the file" not in text and "intermingled" not in text


def test_a_passport_says_what_the_file_lacks(plane, table, tmp_path):
    with h5py.File(shutil.copy(table, tmp_path / "less.h5"), "a") as file:
        del file["basin"], file["attractors"]
    assert plot("passport", tmp_path / "less.h5", "--attractor", 0, "-o", tmp_path / "out.svg").returncode == 0
    assert "in the file: no multipliers, no basin" in (tmp_path / "out.svg").read_text()
    for path, words in ((plane, "holds neither attractors nor measures"),
                        (table, "has no attractor nobody; it has 0..")):
        done = plot("passport", path, "--attractor", "nobody", "-o", tmp_path / "no.png")
        assert done.returncode == 1 and words in done.stderr and not (tmp_path / "no.png").exists()


def test_a_report_has_the_table_of_measures_and_the_plane(plane, table, undrawn):
    text, rows = report(Result(table)), Result(table).measures
    assert "<h2>Measures</h2>" in text
    cells = re.search(r"<tr><td>share</td>(.*?)</tr>", text)[1]
    assert [float(cell.split()[0]) for cell in re.findall(r">([^<]+)<", cells)] == pytest.approx(rows["share"].tolist(),
                                                                                                 rel=1e-3)
    assert "Over the plane of two keys." in report(Result(plane))
