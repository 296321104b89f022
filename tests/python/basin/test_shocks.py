"""Smallest shocks: against brute force on grids, ranks, sweeps."""

import re

import numpy as np
import pytest
from conftest import EXTENSIVE, datasets, run_scene

FIG11 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.15}
SCALE = 0.5


@pytest.fixture(scope="module")
def fig11(kapitza, tmp_path_factory):
    """Shocks at Fig. 11."""
    folder = tmp_path_factory.mktemp("shocks")
    scene = {"pendulum": FIG11, "basin": {"theta": {"count": 60}, "velocity": {"min": -2, "max": 2, "count": 60},
                                          "shocks": {"scale": SCALE, "sizes": [0.05, 0.5]}}}
    return *run_scene(kapitza, folder, scene), folder / "s.h5"


def grid(kapitza, folder, pendulum, middle, reach, count):
    """(other labels than at the grid's middle?, theta, velocity) around a point."""
    window = {"theta": {"min": middle[0] - reach[0], "max": middle[0] + reach[0], "count": count},
              "velocity": {"min": middle[1] - reach[1], "max": middle[1] + reach[1], "count": count}}
    result, _ = run_scene(kapitza, folder, {"pendulum": pendulum, "basin": window})
    cells, attractors = result.group("basin"), result.group("attractors")
    return cells["attractor"].values, *np.meshgrid(cells["theta"].values, cells["velocity"].values), attractors


def wrapped(angle):
    return angle - 2 * np.pi * np.rint(angle / (2 * np.pi))


def check_against_grids(kapitza, folder, pendulum, shocks, row):
    """No cell nearer than the shock leaves the basin on a grid of the whole neighbourhood, and on a fine grid about the
    shock's end the nearest that does is as far as the shock, to 1e-6."""
    point = np.array([shocks["strobe_theta"].values[row], shocks["strobe_velocity"].values[row]])
    shock = np.array([shocks["shock_theta"].values[row], shocks["shock_velocity"].values[row]])
    size = float(shocks["shock_size"].values[row])
    assert np.hypot(shock[0], shock[1] / SCALE) == pytest.approx(size, rel=1e-12)

    def nearest(middle, reach, count):
        label, theta, velocity, attractors = grid(kapitza, folder, pendulum, middle, reach, count)
        own = [i for i in range(attractors.sizes["attractor"])
               if np.nanmin(np.hypot(wrapped(attractors["strobe_theta"].values[i] - point[0]),
                                     attractors["strobe_velocity"].values[i] - point[1])) < 1e-8]
        distance = np.hypot(wrapped(theta - point[0]), (velocity - point[1]) / SCALE)
        return distance[label != own[0]].min(initial=np.inf) if own else np.inf

    assert nearest(point, (1.02 * size, 1.02 * size * SCALE), 401) > size * (1 - 1e-9)
    fine = 2e-6
    assert nearest(point + shock, (fine, fine * SCALE), 41) == pytest.approx(size, abs=fine / 20)


@pytest.mark.extensive
def test_no_shorter_shock_leaves_the_basin(fig11, kapitza, tmp_path):
    result, _, _ = fig11
    shocks = result.group("shocks")
    rest = [int(row)
            for row in np.flatnonzero(np.isfinite(shocks["shock_size"].values) & (shocks["phase"].values == 0))]
    for row in rest if EXTENSIVE else rest[:1]:
        check_against_grids(kapitza, tmp_path, FIG11, shocks, row)


def test_shocks_are_mirrored_and_agree_with_each_other(fig11):
    result, summary, _ = fig11
    shocks, attractors = result.group("shocks"), result.group("attractors")
    size, angle, kick = (shocks[name].values for name in ("shock_size", "angle", "kick"))
    assert np.all(size <= np.fmin(np.abs(angle), np.abs(kick) / SCALE) * (1 + 1e-9)) and np.all(size > 0)
    assert np.all(shocks["shock_end"].values != shocks["attractor"].values)
    mirror = attractors["mirror"].values[shocks["attractor"].values]
    for row in range(shocks.sizes["point"]):
        beside = np.flatnonzero(shocks["attractor"].values == mirror[row])
        assert np.min(np.abs(size[beside] - size[row])) < 1e-9 * size[row]
    harmless = shocks["harmless"].values
    assert np.all(harmless[size > 0.05][:, 0] == 1) and np.all(harmless >= 0) and np.all(harmless <= 1)
    assert np.all(harmless[size < 0.5][:, 1] < 1)
    assert "smallest shocks that leave the basin" in summary


@pytest.mark.extensive
def test_a_laboratory_reads_kicks_in_rad_per_second(kapitza, tmp_path):
    scene = {"pendulum": {"length": "20 cm", "frequency": "12.26 Hz", "amplitude": "3 cm", "quality_factor": 5},
             "basin": {"theta": {"count": 20}, "velocity": {"min": -2, "max": 2, "count": 20},
                       "shocks": {"sizes": [0.1]}}}
    result, summary = run_scene(kapitza, tmp_path, scene)
    kicks = np.abs(result.group("shocks", si=True)["kick"].values)
    said = re.findall(r"^ +\d+ +\S+ -> \d+ +([\d.]+) -> ", summary.split("velocity, rad/s")[1], re.MULTILINE)
    assert said and [float(one) for one in said] == pytest.approx([
        kicks[result.group("shocks")["attractor"] == row].min() for row in
                                                                   dict.fromkeys(result.group(
                                                                       "shocks")["attractor"].values)], abs=2e-8)


def test_a_thin_tongue_before_the_boundary(kapitza, tmp_path):
    """Kicks of 0.441610 and 0.441626 end in rotations; boundaries behind those tongues, at 0.44498203 and 0.44176152,
    were told instead."""
    scene = {"pendulum": {"k": 0.15, "damping": 0.07, "m": 0.25},
             "basin": {"theta": {"count": 40}, "velocity": {"min": -2, "max": 2, "count": 40}, "method": "direct",
                       "shocks": {"scale": SCALE}}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    shocks, attractors = result.group("shocks"), result.group("attractors")
    names = attractors["name"].values
    row = int(np.argmin(np.hypot(shocks["strobe_theta"].values - 0.11200798,
                                 shocks["strobe_velocity"].values - 0.33217060)))
    assert abs(shocks["kick"].values[row]) == pytest.approx(0.441608, abs=1e-6)
    assert names[shocks["kick_end"].values[row]].startswith("rotation")


@pytest.mark.extensive
def test_any_number_of_ranks(fig11, kapitza, tmp_path):
    _, _, path = fig11
    kapitza("run", path.with_suffix(".yaml"), "-o", "again.h5", ranks=3, folder=tmp_path)
    assert datasets(tmp_path / "again.h5") == datasets(path)


@pytest.mark.extensive
def test_a_sweep_has_the_same_shocks(fig11, kapitza, tmp_path):
    """At the value of Fig. 11 the smallest over the strobe points of each attractor."""
    shocks, attractors = fig11[0].group("shocks"), fig11[0].group("attractors")
    sweep = {"parameter": "drive_amplitude", "min": 0.15, "max": 0.151, "count": 2, "measure": ["resilience"],
             "starts": 512, "shock_scale": SCALE}
    table = run_scene(kapitza, tmp_path, {"pendulum": FIG11, "sweep": sweep})[0].group("sweep").isel(value=0)
    for branch in range(table.sizes["branch"]):
        rows = np.flatnonzero(attractors["name"].values == table["branch_name"].values[branch])
        mine = float(table["shock_size"].values[branch])
        least = [shocks["shock_size"].values[shocks["attractor"].values == row].min() for row in rows]
        assert np.min(np.abs(np.array(least) - mine)) < 1e-8
