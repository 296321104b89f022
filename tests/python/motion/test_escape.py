"""The study escape: barriers at Blackburn's pendulum, islands, mirror images, ranks, what is refused."""

import re
import sys

import numpy as np
import pytest
from conftest import ROOT, datasets, plot, refused_scene, run_scene, stopped_and_resumed, with_extensive
from kapitza import Pendulum, SceneError

SCENE = {"pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3},
         "attractors": {"velocity": {"min": -2, "max": 2}},
         "saddles": {"velocity": {"min": -2, "max": 2}, "max_period": 2}, "escape": {"starts": 8}}
# epsilon, action of the least torque from inverted to this saddle, its name; the last ones take minutes.
BARRIERS = [(0.2, 0.0031059836, "unstable wide 1-nodding"), (0.25, 0.0071216163, "unstable wide 1-nodding")]
MORE_BARRIERS = [(0.15, 0.00035979758, "unstable inverted"), (0.3, 0.0100714374, "unstable wide 1-nodding"),
                 (0.35, 0.0084429662, "unstable inverted 6-nodding"),
                 (0.4, 0.0043563495, "unstable inverted 4-nodding"),
                 (0.45, 0.0040390822, "unstable inverted 4-nodding")]


WITH_COUNT = {"temperatures": [0.005], "walkers": 20, "max_periods": 2000}


def at(epsilon, max_period=2, **escape):
    return {**SCENE, "pendulum": {**SCENE["pendulum"], "drive_amplitude": epsilon},
            "saddles": {**SCENE["saddles"], "max_period": max_period}, "escape": {**SCENE["escape"], **escape}}


def named(result, group, name):
    return [i for i, text in enumerate(result.group(group)["name"].values) if text == name]


@pytest.mark.parametrize(("epsilon", "barrier", "name"), with_extensive(BARRIERS, MORE_BARRIERS))
def test_barriers_of_the_inverted_state(kapitza, tmp_path, epsilon, barrier, name):
    """Each to 1e-8 for its saddle; beyond the saddle lies another basin, but that of n-noddings inside the well meets
    its own again."""
    scene = at(epsilon, 6 if epsilon > 0.3 else 2, starts=40)
    found, _ = run_scene(kapitza, tmp_path, {name: scene[name] for name in ("pendulum", "attractors")},
                         name="attractors")
    inverted = named(found, "attractors", "inverted")[0]
    scene["escape"]["from"] = [inverted]
    result, _ = run_scene(kapitza, tmp_path, scene, ranks=2)
    escape = result.group("escape")
    rows = [i for i in range(escape.sizes["route"]) if escape["from"].values[i] == inverted and
            escape["saddle"].values[i] in named(result, "saddles", name) and escape["is_gate"].values[i]]
    assert rows and min(abs(escape["barrier"].values[i] / barrier - 1) for i in rows) < 1e-8 + 5e-11 / barrier
    best = min(rows, key=lambda i: escape["barrier"].values[i])
    assert escape["before"].values[best] == inverted and (epsilon > 0.3 or escape["into"].values[best] != inverted)


@pytest.fixture(scope="module")
def fig12(kapitza, tmp_path_factory):
    return run_scene(kapitza, tmp_path_factory.mktemp("escape"), at(0.25, **WITH_COUNT))


def test_a_path_obeys_the_equation_and_costs_its_action(fig12):
    """The torque of the file, put into the pendulum's equation by differences, leads along the path; its square gives
    the barrier."""
    result, summary = fig12
    escape = result.group("escape")
    inverted = named(result, "attractors", "inverted")[0]
    way = int(escape["way_out"].values[inverted])
    here = escape["path"].values == way
    time, theta, velocity, torque = (escape[name].values[here] for name in ("time", "theta", "velocity", "torque"))
    t = 2 * np.pi * time
    h = t[1] - t[0]
    k, beta, m = 1 / 121, 1 / 55, 0.25
    slope = (velocity[:-4] - 8 * velocity[1:-3] + 8 * velocity[3:-1] - velocity[4:]) / (12 * h)
    inside = slice(2, -2)
    u = slope + beta * velocity[inside] + (k - m * np.cos(t[inside])) * np.sin(theta[inside])
    assert np.abs(u - torque[inside]).max() < 0.02 * np.abs(torque).max()
    assert h * (torque**2).sum() / (4 * beta) == pytest.approx(escape["barrier_out"].values[inverted], rel=1e-3)
    assert escape["largest_torque"].values[way] == pytest.approx(np.abs(torque).max(), rel=1e-9)
    assert "Ways out" in summary


def test_pictures_and_what_they_refuse(fig12, tmp_path):
    path = fig12[0].path
    assert plot("escape", path, "--attractor", "inverted", "-o", tmp_path / "way.png", "--dpi", "60").returncode == 0
    refused = plot("escape", path, "--view", "barrier", "-o", tmp_path / "no.png").stderr
    assert "escape.x and escape.y give them" in refused
    assert "escape.into_every_basin gives the others" in plot("escape", path, "--into", "down", "-o",
                                                              tmp_path / "no.png").stderr
    assert "has no attractor nodding" in plot("escape", path, "--attractor", "nodding", "-o",
                                              tmp_path / "no.png").stderr


def test_ways_out_of_a_pendulum_in_this_process(fig12):
    """Pendulum.ways_out has the numbers of the file; what was not asked for is refused."""
    pendulum = Pendulum(quality_factor=5, drive_frequency=11, drive_amplitude=0.25)
    ways = pendulum.ways_out(max_period=2, starts=8)
    escape = fig12[0].group("escape")
    inverted = ways.barriers.loc["inverted"]
    assert inverted["barrier"] == escape["barrier_out"].values[named(fig12[0], "attractors", "inverted")[0]]
    path, row = ways.path(int(inverted["route"])), ways.table.loc[int(inverted["route"])]
    assert path.attrs["action"] == row["barrier"] == inverted["barrier"] and row["from"] == "inverted"
    assert np.abs(path["torque"]).max() == pytest.approx(row["largest_torque"], rel=1e-9)
    assert ways.plot("inverted", no_title=True).axes[1].get_ylabel() == "torque (I ω²)"
    with pytest.raises(ValueError, match="into_every_basin=True"):
        ways.matrix  # noqa: B018
    with pytest.raises(ValueError, match="give temperatures"):
        ways.lives  # noqa: B018
    with pytest.raises(SceneError, match="escape.starts"):
        pendulum.ways_out(starts=0)


def test_counted_lives_are_those_of_the_barrier(fig12, kapitza, tmp_path):
    """Lives end as their barrier says: the slope of ln(life) over 1/T lies between R - T and R, within the error of the
    count."""
    inverted = named(fig12[0], "attractors", "inverted")[0]
    counted = at(0.2, starts=2, temperatures=[0.001, 0.0015], walkers=256, **{"from": [inverted]})
    escape = run_scene(kapitza, tmp_path, counted, ranks=2)[0].group("escape")
    life, low, high = (escape[name].values[inverted] for name in ("life", "life_low", "life_high"))
    assert np.all(escape["life_ended"].values[inverted] == 256) and np.all((low < life) & (life < high))
    slope = np.log(life[0] / life[1]) / (1 / 0.001 - 1 / 0.0015)
    error = np.hypot(*(np.log(high / low) / 4)) / (1 / 0.001 - 1 / 0.0015)
    assert 0.0031 - 0.0015 - 4 * error < slope < 0.0031 + 4 * error
    assert np.isnan(np.delete(escape["life"].values, inverted, axis=0)).all()


def test_the_bytes_do_not_depend_on_the_ranks(fig12, kapitza, tmp_path):
    result, _ = fig12
    assert datasets(stopped_and_resumed(kapitza, tmp_path, at(0.25, **WITH_COUNT),
                                        ranks=3).path) == datasets(result.path)


def along(low, high, count, name="x", parameter="drive_amplitude"):
    return {name: {"parameter": parameter, "min": low, "max": high, "count": count}}


def over(kapitza, tmp_path, epsilon, axes, ranks=1, max_period=2, **escape):
    """The line or the plane of the inverted state's barrier."""
    scene = at(epsilon, max_period, **escape, **axes)
    found, _ = run_scene(kapitza, tmp_path, {name: scene[name] for name in ("pendulum", "attractors")},
                         name="attractors")
    inverted = named(found, "attractors", "inverted")[0]
    scene["escape"]["from"] = [inverted]
    result, summary = run_scene(kapitza, tmp_path, scene, ranks=ranks)
    return result, inverted, summary


def test_a_barrier_is_continued_along_a_key(kapitza, tmp_path):
    """Values of single searches; the slope that comes with the path is the difference of actions to 1e-6."""
    result, inverted, summary = over(kapitza, tmp_path, 0.25, along(0.2, 0.25, 6), search_every=3,
                                     starts=24)
    escape = result.group("escape")
    barrier = escape["line_barrier"].values[inverted]
    for i, value in ((0, BARRIERS[0][1]), (5, BARRIERS[1][1])):
        assert barrier[i] == pytest.approx(value, rel=3e-8)
    assert "at 6 of 6 places; largest at drive_amplitude = 0.25" in summary
    assert np.isnan(np.delete(escape["line_barrier"].values, inverted, axis=0)).all()
    drawn = result.plot("escape", view="barrier", no_title=True).axes[0]
    assert [line.get_label() for line in drawn.lines] == ["least action found", "averaged potential, (12)"]
    close, inverted, _ = over(kapitza, tmp_path, 0.25, along(0.2499, 0.2501, 3))
    escape = close.group("escape")
    difference = np.diff(escape["line_barrier"].values[inverted][[0, 2]])[0] / 0.0002
    assert escape["line_barrier_by_x"].values[inverted][1] == pytest.approx(difference, abs=1e-6)


def test_the_bytes_of_a_plane_do_not_depend_on_the_ranks(kapitza, tmp_path):
    axes = {**along(0.24, 0.25, 4), **along(4.8, 5.2, 3, "y", "quality_factor")}
    result, inverted, _ = over(kapitza, tmp_path, 0.25, axes, ranks=2, search_every=2)
    scene = at(0.25, **axes, search_every=2, **{"from": [inverted]})
    other = stopped_and_resumed(kapitza, tmp_path, scene, ranks=3)
    assert datasets(other.path) == datasets(result.path)
    escape = result.group("escape")
    plane = result.plot("escape", view="barrier", no_title=True)
    assert plane.axes[0].get_ylabel() == "quality factor Q"
    barrier = escape["plane_barrier"].values[inverted]
    assert barrier.shape == (3, 4) and np.all(np.diff(barrier, axis=1) > 0)
    middle = escape["plane_barrier_by_y"].values[inverted][1, 2]
    assert middle == pytest.approx((barrier[2, 2] - barrier[0, 2]) / 0.4, rel=0.02)


@pytest.mark.extensive
def test_the_barrier_has_two_humps(kapitza, tmp_path):
    """A stronger drive does not raise the barrier for ever; continuation finds lower paths than single searches."""
    axes = along(0.26, 0.44, 37)
    result, inverted, _ = over(kapitza, tmp_path, 0.3, axes, ranks=2, search_every=6, starts=24)
    escape = result.group("escape")
    x, barrier = escape["x"].values, escape["line_barrier"].values[inverted]
    first, second = x < 0.35, x > 0.39
    assert x[first][np.argmax(barrier[first])] == pytest.approx(0.315, abs=0.006)
    assert barrier[first].max() == pytest.approx(0.009946, rel=1e-3)
    assert x[second][np.argmax(barrier[second])] == pytest.approx(0.425, abs=0.006)
    assert barrier[second].max() == pytest.approx(0.00506, rel=0.03)


def test_the_barrier_near_a_pitchfork_is_a_square(kapitza, tmp_path):
    """The inverted state is born in a pitchfork: the root of its barrier is a straight line that ends at the drive
    where the state loses its stability."""
    result, inverted, _ = over(kapitza, tmp_path, 0.132, along(0.1305, 0.1335, 5), max_period=1)
    escape = result.group("escape")
    x, barrier = escape["x"].values, escape["line_barrier"].values[inverted]
    birth = [root for root in np.roots(np.polyfit(x, np.sqrt(barrier), 2)) if root < x[0]][0]
    power = np.polyfit(np.log(x - birth), np.log(barrier), 1)[0]
    assert power == pytest.approx(2, abs=0.05)
    for side, stable in ((-5e-5, False), (5e-5, True)):
        cycle = Pendulum(quality_factor=5, drive_frequency=11, drive_amplitude=birth + side).cycle("180 deg", 0)
        assert (np.abs(cycle["multiplier_re"].values + 1j * cycle["multiplier_im"].values).max() < 1) == stable


def test_the_page_s_way_to_make_it_stand():
    """The example of docs/explanation/ways-out.md runs; its torque in N m is that of the table, beside gravity's."""
    text = (ROOT / "docs/explanation/ways-out.md").read_text()
    names = {"kapitza": sys.modules["kapitza"]}
    exec(next(block for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "20 cm" in block), names)
    ways, route = names["ways"], names["route"]
    row, gravity = ways.table.loc[route], 0.1 * 0.2 * 9.80665
    assert np.abs(names["curve"]).max() == pytest.approx(row["largest_torque_Nm"], rel=1e-9)
    k = names["pendulum"].parameters["k"]
    assert row["largest_torque_Nm"] / gravity == pytest.approx(row["largest_torque"] / k)
    assert row["barrier_J"] > 0 and "barrier_J" in ways.barriers
    assert ways.chains.loc["down", "inverted"] <= ways.matrix.loc["down", "inverted"] == row["barrier"]
    assert ways.plot("down", into="inverted", no_title=True).axes[1].get_ylabel() == "torque (N m)"


def test_incomplete_saddles_and_motions_that_are_no_cycles_are_refused(kapitza, tmp_path):
    narrow = {**SCENE, "saddles": {"theta": {"min": -1, "max": 1}, "velocity": {"min": -0.2, "max": 0.2},
                                   "max_period": 1}}
    assert "of the index sums are not 0" in refused_scene(kapitza, tmp_path, narrow, command="run")
    assert "there is no attractor 99" in refused_scene(kapitza, tmp_path, at(0.25, **{"from": [99]}), command="run")
