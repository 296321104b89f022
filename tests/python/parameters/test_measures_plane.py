"""Measures along a line and over a plane: points against single runs, attractors from point to point, ranks and
stops."""

import numpy as np
import pytest
from conftest import datasets, refused_scene, run_scene, stopped_and_resumed

PENDULUM = {"k": 0.05, "damping": 0.2, "m": 0.3}
X, Y = {"parameter": "m", "min": 0.2, "max": 0.6, "count": 6}, {"parameter": "damping", "min": 0.1, "max": 0.3,
                                                                "count": 3}
WORDS = ["share", "entropy", "return_time", "reactivity", "integrity_factor"]
KEYS = {"velocity": {"min": -2, "max": 2}, "starts": 192, "cells": 32}


@pytest.fixture(scope="module")
def plane(kapitza, tmp_path_factory):
    scene = {"pendulum": PENDULUM, "sweep": KEYS | {"x": X, "y": Y, "measure": [*WORDS, "ends"],
                                                    "ends": {"theta": [3.0]}}}
    return run_scene(kapitza, tmp_path_factory.mktemp("plane"), scene)[0]


def test_a_point_is_a_pendulum_of_its_own(plane, kapitza, tmp_path):
    """The same attractors with the same numbers as the study measures has them for that pendulum."""
    group = plane.group("plane")
    for column, row in ((0, 2), (4, 1)):
        point = group.isel(x=column, y=row)
        pendulum = PENDULUM | {"m": float(point["x"]), "damping": float(point["y"])}
        single = run_scene(kapitza, tmp_path, {"pendulum": pendulum, "measures": KEYS | {"names": WORDS}})[0].measures
        there = point.isel(attractor=np.isfinite(point["return_time"].values))
        assert sorted(map(str, there["name"].values)) == sorted(single["name"])
        for name in single["name"]:
            mine, other = there.isel(attractor=there["name"].values == name), single[single["name"] == name]
            for word in set(WORDS) - {"entropy"}:
                assert np.sort(mine[word].values) == pytest.approx(np.sort(other[word].values), abs=0.005,
                                                                   rel=1e-6), (name, word)
        assert float(point["entropy"]) == pytest.approx(single["entropy"].iloc[0], abs=0.005)


def test_attractors_are_the_same_from_point_to_point(plane):
    """Shares of a point add up to 1; down and inverted are one attractor each; the ends of the same file say where each
    attracts."""
    group = plane.group("plane")
    assert np.allclose(group["share"].sum("attractor"), 1, atol=0.01)
    names = [str(name) for name in group["name"].values]
    assert names.count("inverted") == 1 and names.count("down") == 1
    assert (group["points"].values == np.isfinite(group["share"].values).sum(axis=(1, 2))).all()
    inverted = group.isel(attractor=names.index("inverted"))
    ends = (group["end_centre"].isel(start=0) == 1) & (group["end_period"].isel(start=0) == 1)
    assert (np.isfinite(inverted["return_time"].values) | ~ends.values).all() and ends.any()
    assert (inverted["reactivity"].diff("x") != 0).any()


def test_a_line_is_a_row_of_the_plane(plane, kapitza, tmp_path):
    scene = {"pendulum": PENDULUM | {"damping": 0.2}, "sweep": KEYS | X | {"measure": WORDS}}
    line, row = run_scene(kapitza, tmp_path, scene, ranks=3)[0].group("line"), plane.group("plane").isel(y=1)
    assert line.attrs["parameter"] == "m" and np.array_equal(line["value"], row["x"])
    for name in ("inverted", "down"):
        mine, other = (data.isel(attractor=[str(one) for one in data["name"].values].index(name))
                       for data in (line, row))
        for word in ("share", "share_low", "share_high", "integrity_factor"):
            assert np.allclose(mine[word], other[word], atol=0.005, equal_nan=True), (name, word)
    assert np.allclose(line["entropy"], row["entropy"], atol=0.005)


def test_any_number_of_ranks_and_a_stop(plane, kapitza, tmp_path):
    scene = plane.path.with_suffix(".yaml")
    kapitza("run", scene, "-o", "again.h5", ranks=3, folder=tmp_path)
    assert datasets(tmp_path / "again.h5") == datasets(plane.path)
    assert datasets(stopped_and_resumed(kapitza, tmp_path, scene.read_text(), ranks=2).path) == datasets(plane.path)


def test_smallest_shocks_over_a_plane(kapitza, tmp_path):
    """The same on three ranks as on one; a point is the table of its pendulum, whose labels are decided."""
    x, y = X | {"count": 2}, Y | {"count": 2}
    keys = {"velocity": KEYS["velocity"], "starts": 64, "shock_tolerance": 0.02}
    scene = {"pendulum": PENDULUM, "sweep": keys | {"x": x, "y": y, "measure": ["shock"]}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    assert datasets(run_scene(kapitza, tmp_path, scene, ranks=3, name="three")[0].path) == datasets(result.path)
    point = result.group("plane").isel(x=1, y=1)
    pendulum = PENDULUM | {"m": float(point["x"]), "damping": float(point["y"])}
    alone = {"pendulum": pendulum, "measures": keys | {"names": ["shock"]}}
    single = run_scene(kapitza, tmp_path, alone, name="single")[0].measures["shock"]
    there = point["shock"].values[np.isfinite(point["shock"].values)]
    assert np.sort(there) == pytest.approx(np.sort(single[np.isfinite(single)]),
                                           rel=1e-6) and point.attrs["shock_tolerance"] == 0.02


@pytest.mark.parametrize(("changes", "words"), [
    ({"measure": ["intermingled_with"]}, "sweep.measure: intermingled_with is for one pendulum"),
    ({"measure": ["harmless"], "sizes": [0.1, 0.2]}, "sweep.sizes: a sweep takes one size"),
    ({"measure": ["share"], "parameter": "m"}, "contradicts"),
])
def test_wrong_planes_of_measures_are_refused(kapitza, tmp_path, changes, words):
    assert words in refused_scene(kapitza, tmp_path, {"pendulum": PENDULUM, "sweep": KEYS | {"x": X, "y": Y} | changes})
