"""How likely a motion is, and whether measured releases agree: shares against known planes, intervals, names, what is
refused."""

import kapitza
import numpy as np
import pandas
import pytest
from conftest import ROOT, plot, with_extensive
from kapitza.probability import wilson

SMALL = ROOT / "scenes" / "small.yaml"
LAB = {"pendulum": {"length": "20 cm", "frequency": "50 Hz", "amplitude": "8 mm", "quality_factor": 5},
       "basin": {"theta": {"count": 60}, "velocity": {"min": -0.05, "max": 0.05, "count": 40},
                 "attractors": {"starts": 128}}}


@pytest.fixture(scope="module")
def small():
    return kapitza.run(SMALL, set={"basin.theta.count": 100, "basin.velocity.count": 80,
                                   "basin.attractors.starts": 256}, progress=False)


@pytest.fixture(scope="module")
def lab():
    return kapitza.run(LAB, progress=False)


def test_a_start_without_spread_is_its_cell(small):
    table = small.probability(3.1, 0.0, (0, 0))
    assert table["name"].tolist()[0] == small.at(3.1, 0.0)["name"] == "inverted" and table["probability"][0] == 1


@pytest.mark.parametrize("kind", with_extensive(["normal"], ["uniform"]))
def test_weights_of_cells_are_those_of_random_starts(small, kind):
    """By drawing many starts and looking them up in the same map; across the seam of the angle."""
    random = np.random.default_rng(1)
    drawn = random.normal(size=(2, 40_000)) if kind == "normal" else random.uniform(-1, 1, (2, 40_000))
    found = small.at(3.0 + 0.5 * drawn[0], 0.3 * drawn[1])["name"].value_counts(normalize=True)
    table = small.probability(3.0, 0.0, (0.5, 0.3), kind=kind).set_index("name")
    for name in found.index:
        same = table[[str(row).split(" (")[0] == name.split(" (")[0] for row in table.index]]
        assert table.loc[name, "probability"] == pytest.approx(found[name], abs=0.01) and len(same)
    assert table["probability"].sum() == pytest.approx(1, abs=1e-9)
    assert ((table["low"] <= table["probability"]) & (table["probability"] <= table["high"])).all()


def test_a_whole_turn_of_spread_gives_the_shares_of_the_basin(small):
    table = small.probability(0.0, 0.0, (np.pi, 2.0), kind="uniform").set_index("name")["probability"]
    shares = small.basins_fractions()
    assert [table[name] for name in small.names if name in table.index] == pytest.approx(
        [shares[index] for index, name in enumerate(small.names) if name in table.index], abs=1e-9)


def test_fresh_starts_agree_with_the_map(lab):
    """In units of a laboratory; the interval of the map holds the share of starts that are followed, within theirs."""
    of_map = lab.probability("180 deg", "0 rad/s", ("20 deg", "1 rad/s")).set_index("name")
    fresh = lab.probability("180 deg", "0 rad/s", ("20 deg", "1 rad/s"), starts=200, seed=3).set_index("name")
    assert fresh.loc["inverted", "low"] < of_map.loc["inverted", "high"]
    assert fresh.loc["inverted", "high"] > of_map.loc["inverted", "low"]
    assert fresh["probability"].sum() == pytest.approx(1) and of_map.loc["inverted", "probability"] > 0.5
    again = lab.probability("180 deg", "0 rad/s", ("20 deg", "1 rad/s"), starts=200, seed=3).set_index("name")
    assert again.equals(fresh)


def test_what_lies_outside_of_the_window_is_said(lab):
    table = lab.probability(0, "15 rad/s", (0.1, "2 rad/s")).set_index("name")
    assert 0.2 < table.loc["outside the window", "probability"] < 0.5 and table["probability"].sum() == pytest.approx(1)
    for wrong, words in (({"kind": "square"}, "normal or uniform"), ({"starts": -1}, "100000")):
        with pytest.raises(ValueError, match=words):
            lab.probability(0, 0, (0.1, 0.1), **wrong)
    with pytest.raises(ValueError, match="finite"):
        lab.probability(0, 0, (-0.1, 0.1))


def test_intervals_are_wilson_s():
    assert np.array(wilson(7, 20)) == pytest.approx([0.1811918, 0.5671457],
                                                    abs=1e-6) and wilson(0, 9)[0] == 0 and wilson(9, 9)[1] == 1


def test_shares_along_a_sweep_by_name(swept):
    result = kapitza.Result(swept)
    sweep, inverted = result.group("sweep"), result.share("inverted")
    rows = [row for row, name in enumerate(sweep["branch_name"].values) if str(name) == "inverted"]
    assert inverted.dims == ("value",) and np.allclose(inverted,
                                                       np.nan_to_num(sweep["fraction"].values[:, rows]).sum(axis=1))
    assert (result.share("rotating") >= result.share("rotation +1/1") - 1e-12).all()
    enough = sweep["value"].values[inverted.values >= 0.01]
    assert result.largest("inverted", 0.01).value == (enough.max() if enough.size
                                                      else pytest.approx(np.nan, nan_ok=True))
    assert np.isnan(result.largest("inverted", 1.1)).all()


def test_shares_have_the_intervals_of_the_file(swept):
    """Of one branch those of the file; of several Wilson's of their sum."""
    result = kapitza.Result(swept)
    sweep = result.group("sweep")
    for row in np.flatnonzero(sweep["branch_stable"].values):
        name = str(sweep["branch_name"].values[row])
        if list(sweep["branch_name"].values).count(name) == 1:
            there, share = np.isfinite(sweep["fraction"].values[:, row]), result.share(name)
            for edge in ("low", "high"):
                assert share[edge].values[there] == pytest.approx(sweep[f"fraction_{edge}"].values[there, row],
                                                                  abs=1e-12)
    share = result.share("rotating")
    assert (share.low <= share).all() and (share <= share.high).all() and (share.high - share.low < 0.3).all()
    least = float(share.max()) - 1e-9
    value, low, high = result.largest("rotating", least)
    assert value == sweep["value"].values[share.values >= least].max() and (np.isnan(low)
                                                                            or low <= value) and value <= high


def test_shares_of_no_branch(swept):
    result = kapitza.Result(swept)
    with pytest.raises(KeyError, match="the names are"):
        result.share("nobody")


def test_shares_over_a_plane(model):
    result = model({"k": 0.1, "damping": 0.1, "m": 0.4},
                   sweep={"x": {"parameter": "k", "min": 0.05, "max": 0.2, "count": 3},
                          "y": {"parameter": "m", "min": 0.1, "max": 0.6, "count": 4}, "measure": ["ends"],
                          "ends": {"theta": [0.1, 3.0], "velocity": [0]}})
    shares = [result.share(name) for name in ("down", "inverted", "rotating", "neither")]
    assert shares[0].shape == (4, 3) and set(np.unique(shares[0])) <= {0.0, 0.5, 1.0} and float(sum(shares).max()) <= 1
    with pytest.raises(KeyError, match="a plane knows no"):
        result.share("nobody")


RELEASES = pandas.DataFrame({"theta_deg": [178, 190, -3, 100, -175], "velocity_rad_per_s": [0.1, 0.2, 1, 0, 0.0],
                             "end": ["inverted", "inverted", "down", "inverted", "down"]})


def test_measured_releases_beside_the_map(lab, tmp_path):
    found = lab.agree(RELEASES)
    assert found.table["agrees"].tolist() == [True, True, True, False, False] and found.share == 0.6
    assert found.table["name"].tolist() == ["inverted", "inverted", "down", "down", "inverted"]
    assert found.interval[0] < 0.6 < found.interval[1]
    assert "3 of 5 releases agree (60.0 %" in repr(found)
    RELEASES.to_csv(tmp_path / "releases.csv", index=False)
    assert lab.agree(tmp_path / "releases.csv").table.equals(found.table)
    for table, words in ((RELEASES.drop(columns="end"), "column end"),
                         (RELEASES.drop(columns="theta_deg"), "column theta, or theta_deg"),
                         (RELEASES.assign(end="upright"), "no attractor is called 'upright'"),
                         (RELEASES.assign(velocity_rad_per_s=99.0), "outside the window")):
        with pytest.raises(ValueError, match=words):
            lab.agree(table)


@pytest.mark.extensive
def test_measured_points_on_the_picture(lab, tmp_path):
    axes = lab.plot(points=RELEASES, si=True, degrees=True).axes[0]
    marks = {dots.get_gid(): dots.get_offsets() for dots in axes.collections if dots.get_gid()}
    assert sorted(marks["agree"][:, 0]) == pytest.approx([-170, -3, 178])
    assert sorted(marks["differ"][:, 0]) == pytest.approx([-175, 100])
    assert sorted(marks["agree"][:, 1]) == pytest.approx([0.1, 0.2, 1])
    RELEASES.to_csv(tmp_path / "releases.csv", index=False)
    done = plot("basin", lab.path, "-o", tmp_path / "x.png", "--points", tmp_path / "releases.csv", "--si", "--centre",
                "inverted")
    assert done.returncode == 0 and (tmp_path / "x.png").stat().st_size > 4000
    done = plot("basin", lab.path, "-o", tmp_path / "y.png", "--points", tmp_path / "absent.csv")
    assert done.returncode != 0 and "absent.csv" in done.stderr and "Traceback" not in done.stderr
