"""The study measures: one table of numbers about attractors and basins, against other studies and known answers; ranks;
refusals."""

import math

import numpy as np
import pytest
from conftest import datasets, flown, refused_scene, run_scene, stopped_and_resumed
from kapitza.style import parameters_text

FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
WINDOW = {"velocity": {"min": -2, "max": 2}}
CHEAP = ["share", "weighted_share", "share_within", "settling_mean", "settling_median", "settling_largest",
         "return_time", "reactivity",
         "amplification", "integrity_local", "integrity_global", "integrity_factor", "entropy", "boundary_entropy",
         "uncertainty_exponent",
         "boundary_dimension", "intermingledness", "intermingled_with", "shared_boundary", "wada_on_grid"]


@pytest.fixture(scope="module")
def fig12(kapitza, tmp_path_factory):
    """All measures of Fig. 12 but shocks, and its basin beside them."""
    scene = {"pendulum": FIG12, "basin": {"theta": {"count": 128}, "velocity": WINDOW["velocity"] | {"count": 128}},
             "measures": WINDOW | {"names": CHEAP, "starts": 2048, "cells": 128, "within": 40,
                                   "weight": {"theta": "170 deg", "theta_spread": "3 deg", "velocity_spread": 0.001}}}
    return run_scene(kapitza, tmp_path_factory.mktemp("measures"), scene)[0]


def test_the_table_agrees_with_the_basin(fig12):
    """Shares, entropies and areas are those of the cells."""
    table, basin = fig12.measures, fig12.attractors
    fraction = basin.groupby("name")["fraction"].sum()
    for name, rows in table.groupby("name"):
        assert abs(rows["share"].sum() - fraction.get(name, 0)) < 0.02, name
        assert rows["integrity_global"].sum() == pytest.approx(fraction.get(name, 0) * 8 * math.pi, abs=1e-9), name
    assert ((table["share_low"] <= table["share"]) & (table["share"] <= table["share_high"])).all()
    assert (table["share_within"] <= table["share"]).all() and (table["share_within"] < table["share"]).any()
    seen = table[table["share"] > 0]
    assert (seen["settling_median"] <= seen["settling_largest"]).all() and len(seen) >= 5
    assert table["entropy"].iloc[0] == pytest.approx(fig12.basin_entropy()[0], rel=1e-12)
    assert table["boundary_entropy"].iloc[0] == pytest.approx(fig12.basin_entropy()[1], rel=1e-12)
    assert table["wada_on_grid"].iloc[0] == 0


def test_near_the_attractor(fig12):
    """Complex multipliers have the modulus exp(-pi beta n); mirror images grow alike; any later strobe includes the
    next one."""
    table, beta = fig12.measures, fig12.pendulum["beta"]
    complex_pairs = np.array([abs(row[0].imag) > 0 for row in fig12.attractors["multipliers"]])
    if len(table) == len(complex_pairs):
        assert np.allclose(table["return_time"][complex_pairs], 1 / (math.pi * beta), rtol=1e-9)
    rotations = table[table["name"].isin(["rotation +1/1", "rotation -1/1"])]
    assert len(rotations) == 2 and np.ptp(rotations["reactivity"]) < 1e-9
    assert (table["amplification"] >= np.maximum(1, table["reactivity"]) * (1 - 1e-12)).all()


def test_weighted_shares_are_those_of_random_releases(fig12):
    """170 +- 3 degrees: the pendulum stands, as fresh random starts say too."""
    table = fig12.measures
    stands = table[table["name"].str.startswith("inverted")]["weighted_share"].sum()
    chances = fig12.probability("170 deg", 0, ("3 deg", 0.001), starts=300)
    assert stands == pytest.approx(chances[chances["name"].str.startswith("inverted")]["probability"].sum(), abs=0.05)
    assert table["weighted_share"].sum() == pytest.approx(1, abs=1e-12)


def test_shocks_are_those_of_the_basin(kapitza, tmp_path):
    """And the circle about the strobe point in the picture has the radius of the smallest shock, to a cell."""
    pendulum = {"k": 0.05, "damping": 0.3, "m": 0.4}
    scene = {"pendulum": pendulum,
             "basin": {"theta": {"count": 24}, "velocity": WINDOW["velocity"] | {"count": 24},
                       "shocks": {"sizes": [0.3]}},
             "measures": WINDOW | {"names": ["shock_angle", "shock_velocity", "shock", "harmless", "integrity_local"],
                                   "cells": 256}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    table, shocks = result.measures, result.group("shocks")
    for name in table["name"]:
        points = shocks.isel(point=[int(one) in result.ids(name) for one in shocks["attractor"]])
        row = table[table["name"] == name].iloc[0]
        assert row["shock"] == pytest.approx(float(points["shock_size"].min()), rel=1e-9)
        assert row["shock_angle"] == pytest.approx(float(abs(points["angle"]).min()), rel=1e-9, nan_ok=True)
        assert row["harmless"] == pytest.approx([float(points["harmless"].mean())], abs=1e-12)
        assert row["integrity_local"] == pytest.approx(row["shock"], abs=2 * math.pi / 256)
    alone = {"pendulum": pendulum, "measures": WINDOW | {"names": ["shock"], "shock_tolerance": 0.004}}
    one, three = (run_scene(kapitza, tmp_path, alone, ranks=ranks, name=str(ranks))[0] for ranks in (1, 3))
    assert datasets(one.path) == datasets(three.path)
    alone = one.measures
    assert list(alone["name"]) == list(table["name"]) and np.allclose(alone["shock"], table["shock"], rtol=0.004)


def test_any_number_of_ranks_and_a_stop(kapitza, tmp_path):
    names = ["share", "settling_mean", "entropy", "reactivity"]
    scene = {"pendulum": FIG12 | {"quality_factor": 20},
             "measures": WINDOW | {"names": names, "starts": 600, "cells": 48}}
    stopped = stopped_and_resumed(kapitza, tmp_path, scene, ranks=3)
    assert datasets(stopped.path) == datasets(run_scene(kapitza, tmp_path, scene, ranks=2)[0].path)


@pytest.mark.parametrize(("changes", "words"), [
    ({"names": ["share", "stare"]}, "measures.names"),
    ({"names": ["weighted_share"]}, "measures.weight: is missing, which weighted_share needs"),
    ({"names": ["share_within"]}, "measures.within: is missing, which share_within needs"),
    ({"names": ["harmless"], "sizes": [0.3, 0.1]}, "measures.sizes: has a size that is not above the one before it"),
    ({"names": ["share"], "damping": 0}, "measures: needs damping"),
])
def test_wrong_options_of_measures_are_refused(kapitza, tmp_path, changes, words):
    pendulum = {"k": 0.05, "damping": changes.pop("damping", 0.1), "m": 0.3}
    assert words in refused_scene(kapitza, tmp_path, {"pendulum": pendulum, "measures": WINDOW | changes})


def test_boundaries_of_the_whole_picture(kapitza, tmp_path):
    """Boxes, slopes and largest circles, found again from the labels of the basin: 80 cells end within the largest
    boxes."""
    window = {"theta": {"min": -1, "max": 3.5}, "velocity": {"min": -1.5, "max": 1.2}}
    names = ["shared_boundary", "wada_on_grid", "uncertainty_exponent", "boundary_dimension", "integrity_factor"]
    scene = {"pendulum": {"k": 0.03, "damping": 0.1, "m": 0.45, "tilt": 0.2},
             "measures": window | {"names": names, "cells": 80, "starts": 256},
             "basin": {axis: limits | {"count": 80} for axis, limits in window.items()}}
    result, summary = run_scene(kapitza, tmp_path, scene)
    table, ids = result.measures, result.group("basin")["attractor"].values
    boxes = [set(ids[row:row + 16, left:left + 16].ravel()) for row in range(0, 80, 16) for left in range(0, 80, 16)]
    mixed = [box for box in boxes if len(box) > 1]
    shared = [sum(one in box for box in mixed) / len(mixed) for one in range(4)]
    assert list(table["shared_boundary"]) == shared == [1, 0.95, 0.3, 0.45]
    assert table["wada_on_grid"].iloc[0] == 0
    across, up = 4.5 / 80, 2.7 / 80
    for one, row in table.iterrows():
        side = ids == one
        shares = [np.mean((side[:, d:-d] != side[:, :-2 * d]) | (side[:, d:-d] != side[:, 2 * d:])) for d in (1, 2, 4)]
        slope = np.polyfit(np.log([1, 2, 4]), np.log(shares), 1)[0]
        assert row["uncertainty_exponent"] == pytest.approx(slope, rel=1e-9)
        foreign, largest = np.argwhere(~side), 0
        for cell in np.argwhere(side):
            edge = np.minimum(cell, 79 - cell) + 0.5
            clear = np.hypot(*((foreign - cell) * [up, across]).T).min() - up / 2
            largest = max(largest, min(clear, edge[0] * up, edge[1] * across))
        assert row["integrity_factor"] == pytest.approx(largest, rel=1e-9)
    outside = [one for one, value in enumerate(table["boundary_dimension"]) if not 1 <= value <= 2]
    assert len(outside) > 0 and all(f"boundary_dimension of {one} is outside of 1 to 2" in summary for one in outside)
    assert summary.count("is outside of 1 to 2") == len(outside)


FORCED = {"velocity": {"min": -3, "max": 3}, "starts": 64, "cells": 48, "method": "direct"}


def forced(torque, k=1, damping=0.2):
    return {"k": k, "damping": damping, "m": 0, "torque_amplitude": torque}


def test_wada_basins_of_the_forced_pendulum(kapitza, tmp_path):
    """Nusse and Yorke's case, theta'' + .2 theta' + sin theta = 1.66 cos t: three fractal basins in nearly every box of
    the boundary."""
    names = ["share", "boundary_entropy", "shared_boundary", "uncertainty_exponent"]
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": forced(1.66), "measures": FORCED | {"names": names}})
    assert parameters_text(result.pendulum) == "Q = 5,  $\\Omega$ = 1,  torque amplitude = 1.66"
    table = result.measures
    assert len(table) == 3 and table["share"].min() > 0.15
    assert table["boundary_entropy"].iloc[0] > math.log(2)
    assert table["shared_boundary"].min() > 0.95 and table["uncertainty_exponent"].max() < 0.5


def test_long_transients_end_on_two_cycles(kapitza, tmp_path):
    """theta'' + .2 theta' + sin theta = 15/11 cos t/2: two basins; scipy closes their cycles in the original
    equation."""
    names = ["share", "return_time"]
    scene = {"pendulum": forced(60 / 11, k=4, damping=0.4), "measures": FORCED | {"names": names}}
    table = run_scene(kapitza, tmp_path, scene)[0].measures
    assert list(table["period"]) == [3, 3] and table["share"].min() > 0.3 and table["share"].sum() > 0.85
    start = np.array([table["theta"], table["velocity"]])
    end = flown(lambda t, y: np.concatenate([y[2:], -0.4 * y[2:] - 4 * np.sin(y[:2]) + 60 / 11 * np.cos(t)]), 6 * np.pi,
                start.ravel(), 1e-11).reshape(2, 2)
    assert np.abs(np.exp(1j * end[0]) - np.exp(1j * start[0])).max() < 1e-7 and np.abs(end[1] - start[1]).max() < 1e-7


@pytest.mark.extensive
def test_rounded_the_drive_has_a_chaotic_attractor(kapitza, tmp_path):
    """F = 1.3636 is no 15/11: nothing settles."""
    scene = {"pendulum": forced(5.4544, k=4, damping=0.4), "measures": FORCED | {"names": ["share"]}}
    table = run_scene(kapitza, tmp_path, scene)[0].measures
    assert list(table["period"]) == [0] and table["share"].iloc[0] > 0.99
