"""The five scenes of Blackburn's Figs 11 to 15: the attractors are those of the literature, each once, and truly
closed."""

import json

import numpy as np
import pytest
from conftest import ROOT, strobed
from kapitza import Result

REFERENCE = json.loads((ROOT / "tests" / "literature"
                        / "reference.json").read_text())["blackburn_fig11_15_attractors_Q5_Omega11"]
FIGURES = {11: "0.150", 12: "0.300", 13: "0.460", 14: "0.470", 15: "0.520"}


@pytest.fixture(scope="module", params=FIGURES)
def figure(request, kapitza, tmp_path_factory):
    """(reference attractors, result) of one scene on a small grid."""
    path = tmp_path_factory.mktemp("figures") / f"{request.param}.h5"
    kapitza("run", ROOT / "scenes" / f"blackburn-fig{request.param}.yaml", "--set", "basin.theta.count=50",
            "--set", "basin.velocity.count=50", "-o", path)
    return REFERENCE[FIGURES[request.param]]["attractors"], Result(path)


def around(angle):
    """The angle in [-pi, pi]."""
    return angle - 2 * np.pi * np.rint(angle / (2 * np.pi))


def points_of(table, row):
    period = int(table["period"].values[row])
    return np.column_stack([table["strobe_theta"].values[row, :period], table["strobe_velocity"].values[row, :period]])


def apart(points, others):
    """Largest distance of a cycle from successive points of another (the reference lists at most eight)."""
    turns = [np.roll(points, turn, axis=0)[: len(others)] for turn in range(len(points))]
    return min(max(np.abs(around(turn[:, 0] - others[:, 0])).max(), np.abs(turn[:, 1] - others[:, 1]).max())
               for turn in turns)


def partner(table, known):
    """The row with the reference's period and winding that lies nearest, and its distance."""
    points = np.array(known["strobe_points"], dtype=float)
    rows = np.flatnonzero((table["period"].values == known["period"])
                          & (table["winding"].values == known["winding_total"]))
    assert len(rows) > 0, f"{known['kind']} was not found"
    distances = [apart(points_of(table, row), points) for row in rows]
    return rows[np.argmin(distances)], min(distances)


def test_every_known_attractor_is_found_once(figure):
    known, result = figure
    table = result.group("attractors")
    found = [partner(table, row) for row in known]
    assert max(distance for _, distance in found) < 1e-9
    assert len({row for row, _ in found}) == len(known)


def test_no_attractor_is_listed_twice(figure):
    table = figure[1].group("attractors")
    points = [points_of(table, row) for row in range(table.sizes["attractor"])]
    for row, mine in enumerate(points):
        for other in points[:row]:
            gap = mine[:, None, :] - other[None, :, :]
            assert np.hypot(around(gap[..., 0]), gap[..., 1]).min() > 1e-7


def test_multipliers_are_those_of_the_literature(figure):
    known, result = figure
    table = result.group("attractors")
    for row in known:
        index, _ = partner(table, row)
        mine = table["multiplier_re"].values[index] + 1j * table["multiplier_im"].values[index]
        theirs = [complex(value) for value in row["multipliers"]]
        assert max(min(abs(value - other) for other in theirs) for value in mine) < 1e-7, row["kind"]


def test_every_attractor_attracts_and_closes(figure):
    """Flown once around by an integrator that shares nothing with the program."""
    result = figure[1]
    table = result.group("attractors")
    for row in range(table.sizes["attractor"]):
        period, winding = int(table["period"].values[row]), int(table["winding"].values[row])
        start = points_of(table, row)[0]
        end = strobed(result.pendulum, start, period)[:, 0]
        assert np.abs(end - start - [2 * np.pi * winding, 0]).max() < 1e-9, table["name"].values[row]
        assert np.hypot(table["multiplier_re"].values[row], table["multiplier_im"].values[row]).max() < 1


def test_shares_are_near_those_of_the_literature(figure):
    """2500 cells of |v| < 2 against 1500 random starts of |v| < 3: the large basins agree within a few percent."""
    known, result = figure
    table = result.group("attractors")
    for row in known:
        index, _ = partner(table, row)
        assert abs(float(table["fraction"].values[index]) - row["basin_frac_v3"]) < 0.06, row["kind"]
