"""The study atlas: curves against the linear equation and the flutter table, lists against `attractors`, ranks, resumed
runs."""

import itertools
import shutil

import h5py
import numpy as np
import pytest
from conftest import EXTENSIVE, ROOT, datasets, flown, plot, run_scene, with_extensive
from kapitza import Result, SceneError
from kapitza.style import name_text
from serving import Server

PENDULUM = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
SCENE = {"pendulum": PENDULUM,
         "atlas": {"x": {"parameter": "drive_frequency", "min": 3, "max": 30},
                   "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.8},
                   "max_period": 2, "checks": 24, "points": 64}}
FOLD, DOUBLING, BREAKING, SWINGS, LEANS = range(5)


@pytest.fixture(scope="module")
def atlas(kapitza, tmp_path_factory):
    """The file of the scene above, and the summary."""
    folder = tmp_path_factory.mktemp("atlas")
    return *run_scene(kapitza, folder, SCENE), folder / "s.h5"


def curve(group, kind, **named):
    """The points (x, y) of the only curve of a kind."""
    found = [i for i in range(group.sizes["curve"]) if int(group["curve_kind"][i]) == kind
             and all(int(group[f"curve_{name}"][i]) == value for name, value in named.items())]
    assert len(found) == 1
    first, n = int(group["curve_first"][found[0]]), int(group["curve_points"][found[0]])
    return group["x"][first:first + n].values, group["y"][first:first + n].values


def crossing(xs, ys, x):
    """y of a curve where it passes x, by a quintic through the six nearest points."""
    near = np.sort(np.argsort(abs(xs - x))[:6])
    return np.polyval(np.polyfit(xs[near] - x, ys[near], 5), 0)


def test_rest_is_that_of_the_linear_equation(atlas):
    """A multiplier of inverted is -1 on the one curve, and 1 on the other: by an integrator that shares nothing with
    the program."""
    group = atlas[0].group("atlas")
    for kind, multiplier in ((SWINGS, -1), (LEANS, 1)):
        xs, ys = curve(group, kind, centre=1)
        inside = np.flatnonzero((xs > 3) & (xs < 30) & (ys > 0) & (ys < 0.8))
        for i in inside[:: max(1, len(inside) // 6)]:
            k, beta, m = xs[i] ** -2, 1 / (5 * xs[i]), ys[i]
            ends = [flown(lambda t, u, k=k, beta=beta, m=m: [u[1], -beta * u[1] + (k - m * np.cos(t)) * u[0]],
                          2 * np.pi, start, 1e-13)
                    for start in ([1, 0], [0, 1])]
            assert abs(ends[0][0] + ends[1][1] - multiplier * (1 + np.exp(-2 * np.pi * beta))) < 3e-11


def test_rest_is_that_of_the_study_stability(atlas, kapitza, tmp_path):
    """The transition curves of Hill's determinant at the k of points of the atlas."""
    group = atlas[0].group("atlas")
    for kind, centre, name in ((SWINGS, 1, "damped_1"), (LEANS, 1, "damped_0"), (SWINGS, 0, "damped_1")):
        xs, ys = curve(group, kind, centre=centre)
        inside = np.flatnonzero((xs > 5) & (xs < 30) & (ys > 0) & (ys < 0.8))
        for at in inside[np.linspace(0, len(inside) - 1, 17).astype(int)] if EXTENSIVE else inside[7:8]:
            k = (1 if centre == 0 else -1) / xs[at] ** 2
            axes = {"k": {"min": min(k, 2 * k), "max": max(k, 2 * k), "count": 2},
                    "m": {"min": 0, "max": 0.8, "count": 2}}
            result, _ = run_scene(kapitza, tmp_path, {"stability": axes | {"quality_factor": 5, "curves": [name]}})
            found = result.group("stability")[name].values[0 if k > 0 else 1]
            assert abs(found - ys[at]) < 1e-12, (name, xs[at])


def test_flutter_is_that_of_the_studies(atlas):
    """Birth, loss of symmetry, doubling, where the table of docs/validation/studies.md has them."""
    group = atlas[0].group("atlas")
    for omega, birth, broken, doubled in ((7, 0.488875356, 0.577613876, 0.587068),
                                          (11, 0.468190302390, 0.561845642631, 0.571655778),
                                          (20, 0.458316643, 0.554420006, 0.564402)):
        assert abs(crossing(*curve(group, SWINGS, centre=1), omega) - birth) < 1e-6
        assert abs(crossing(*curve(group, BREAKING, centre=1), omega) - broken) < 1e-6
        assert doubled > broken


def test_lists_are_those_of_the_search(atlas, kapitza, tmp_path):
    """The classes and their numbers at single places."""
    group = atlas[0].group("atlas")
    assert int(group.attrs["negative"]) == 0 and int(group.attrs["disagreed"]) == 0
    assert int(group.attrs["checked"]) == 24
    assert int(group.attrs["listed"]) > 48 and int(group.attrs["unsolved"]) == 0
    assert 0 < float(group.attrs["unsolved_high"]) < 0.1
    assert int(group.attrs["open_ends"]) == 0 and not group["curve_open"].values.any()
    for column, row in ((8, 12), (20, 30), (40, 40), (50, 52), (30, 46)):
        here = dict(PENDULUM, drive_frequency=float(group["column"][column]), drive_amplitude=float(group["row"][row]))
        search = {"velocity": {"min": -2.5, "max": 2.5}, "starts": 4096}
        found = run_scene(kapitza, tmp_path, {"pendulum": here, "attractors": search})[0].group("attractors")
        short = (found["period"].values > 0) & (found["period"].values <= 2)
        assert int(short.sum()) == int(group["count"][row, column]), here


def test_a_moving_frame_takes_the_motions_of_its_point(atlas):
    """Flutter that is born on the way is there at once; the attractors of the pendulum before know nothing of it."""
    with Server(ROOT / "scenes" / "blackburn-fig12.yaml") as server:
        def names(epsilon, **keys):
            pendulum = PENDULUM | {"drive_amplitude": epsilon}
            catalogue, frames = server.frame(32, 48, quality="moving", pendulum=pendulum, **keys)
            assert frames or keys
            return catalogue and [row["name"] for row in catalogue["attractors"]]

        def listed(epsilon):
            return {"atlas": str(atlas[2]), "x": 11, "y": epsilon}

        names(0.463)
        assert "flutter" not in names(0.475) and "inverted" in names(0.463, **listed(0.463))
        assert "flutter" in names(0.476, **listed(0.476))
        assert "flutter" in names(0.55, **listed(0.55))
        for keys, message in (({"x": 11, "y": 0.3}, "x: is a point of an atlas"),
                              (listed(0.4), "the atlas has another pendulum there"),
                              (listed(0.4) | {"y": 2}, "lies outside of the atlas"),
                              ({"atlas": str(atlas[2]), "x": 11}, "y: is missing")):
            answer = server.ask("frame", rows=8, columns=8, quality="moving",
                                pendulum=PENDULUM | {"drive_amplitude": 0.41}, **keys)[-1][0]
            assert answer["answer"] == "error" and message in answer["message"]


def test_motions_of_a_point_are_cycles_of_its_pendulum(atlas):
    """At random points the list is that of the raster, and every strobe point returns after its period, with the
    multipliers told: by an integrator that shares nothing with the program."""
    result, group = atlas[0], atlas[0].group("atlas")
    rng = np.random.default_rng(5)
    for column, row in rng.integers(0, 64, (12, 2)):
        omega, epsilon = float(group["column"][column]), float(group["row"][row])
        listed, found = result.motions(omega, epsilon, states=False), result.motions(omega, epsilon)
        assert list(listed["name"]) == list(found["name"])
        assert int(found["images"].sum()) == int(group["count"][row, column])
        k, beta = omega ** -2, 1 / (5 * omega)
        for _, motion in found.iterrows():
            assert len(motion["strobe_theta"]) == motion["period"]
            start = [motion["strobe_theta"][0], motion["strobe_velocity"][0], 1, 0, 0, 1]
            end = flown(lambda t, u, of=(k, beta, epsilon): flow(u, t, *of), 2 * np.pi * motion["period"], start, 1e-12)
            assert abs(end[0] - start[0] - 2 * np.pi * motion["winding"]) < 2e-9 and abs(end[1] - start[1]) < 2e-9
            assert abs(end[2] + end[5] - sum(motion["multipliers"]).real) < 1e-7
            assert max(abs(one) for one in motion["multipliers"]) < 1


def flow(u, t, k, beta, m):
    """The equation of motion, and of two small deviations."""
    force, slope = (k - m * np.cos(t)) * np.sin(u[0]), (k - m * np.cos(t)) * np.cos(u[0])
    return [u[1], -beta * u[1] - force, u[3], -beta * u[3] - slope * u[2], u[5], -beta * u[5] - slope * u[4]]


def test_a_line_has_every_crossing_and_what_repels(atlas):
    """Along a line stable branches are as many as the lists say, and at each fold a branch that repels begins."""
    result, group = atlas[0], atlas[0].group("atlas")
    column = 20
    table = result.line(x=float(group["column"][column]))
    for row in (8, 24, 40, 60):
        value, attracting = float(group["row"][row]), set()
        for _, branch in table.groupby("branch"):
            below = branch["value"].values < value
            for at in np.flatnonzero(below[1:] != below[:-1]):
                if max(branch["multiplier"].values[at:at + 2]) < 1:
                    attracting.add((branch["name"].iloc[0], round(float(branch["height"].iloc[at]), 1)))
        assert {name for name, _ in attracting} == set(result.motions(float(group["column"][column]), value,
                                                                      states=False)["name"])
    assert (table["multiplier"] > 1).any() and abs(table["height"]).max() <= 1
    # Points where stability changes
    upright = result.line(x=11).query("name == 'inverted' and multiplier == 1")["value"].values
    assert len(upright) == 2 and abs(upright[1] - 0.468190302390) < 1e-9
    with pytest.raises(SceneError, match="lies outside of the atlas"):
        result.line(x=99)
    with pytest.raises(SceneError, match="lies outside of the atlas; drive_amplitude is from 0 to 0.8"):
        result.motions(11, 2)


def test_lists_that_are_not_known_are_told_by_nobody(atlas, tmp_path):
    """A file whose folds of rotations have the wrong side: where the count is negative, motions are refused, pages and
    pictures say so."""
    from kapitza.explorer.atlas import packed
    from kapitza.plots.atlas import map_page
    from kapitza.reading import arrays_of

    shutil.copy(atlas[2], tmp_path / "wrong.h5")
    with h5py.File(tmp_path / "wrong.h5", "r+") as file:
        group = file["atlas"]
        for curve in np.flatnonzero((group["curve_kind"][:] == FOLD) & (group["curve_period"][:] == 1)):
            points = slice(group["curve_first"][curve], group["curve_first"][curve] + group["curve_points"][curve])
            for side in ("side_x", "side_y"):
                group[side][points] = -group[side][points]
        group["count"][40:, :], group["list"][40:, :], group["attracting"][:, 40:, :] = -1, -1, 255
    wrong = Result(tmp_path / "wrong.h5")
    with pytest.raises(SceneError, match="the list of motions is not known at 11, 0.3"):
        wrong.motions(11, 0.3)
    assert [None in packed(*arrays_of(result.path, "atlas"))[0]["lists"]
            for result in (wrong, atlas[0])] == [True, False]
    texts = {word: [text.get_text() for text in map_page(result, result.group("atlas"),
                                                         16).axes[0].get_legend().get_texts()]
             for word, result in (("wrong", wrong), ("right", atlas[0]))}
    assert "not known: a curve is missing" in texts["wrong"] and "not known: a curve is missing" not in texts["right"]


def test_a_map_says_what_lives_where(atlas):
    """Amber where inverted attracts, grey where it does not and down does; the roomiest areas have their words."""
    from kapitza.plots.atlas import draw_map
    from kapitza.plots.atlas_labels import LIVING, living
    from matplotlib.figure import Figure

    group = atlas[0].group("atlas")
    names, kinds = [name_text(name) for name in group["class_name"].values], living(group)
    inverted, down = (group["attracting"].values[names.index(name)] > 0 for name in ("inverted", "down"))
    words = list(LIVING)
    assert (inverted == (kinds == words.index("inverted"))).all() and inverted.any()
    assert not (kinds == words.index("down"))[inverted | ~down].any() and (kinds == words.index("down")).any()
    axes = draw_map(Figure().add_subplot(), group)
    told = [text.get_text() for text in axes.texts]
    assert {"inverted", "down"} <= set(told) and len(told) == len(set(told)) <= 4


def test_small_maps_show_where_a_motion_branches_off(atlas):
    """The panel of flutter has the curve on which swings about inverted begin; no other rest gives birth to it."""
    from kapitza.plots.atlas_classes import gives_birth

    group = atlas[0].group("atlas")
    flutter = [name_text(name) for name in group["class_name"].values].index("flutter")
    births = [i for i in range(group.sizes["curve"]) if gives_birth(group, i, flutter)]
    born = [(int(group["curve_kind"][i]), int(group["curve_centre"][i])) for i in births]
    assert born and set(born) == {(SWINGS, 1)}


def test_every_point_belongs_to_its_curve(atlas):
    group = atlas[0].group("atlas")
    first, n = group["curve_first"].values, group["curve_points"].values
    assert first[0] == 0 and (first[1:] == (first + n)[:-1]).all() and first[-1] + n[-1] == group.sizes["point"]
    assert (group["region_share"].values[:-1] >= group["region_share"].values[1:]).all()
    assert int(group["list"].max()) + 1 <= 64 * 64


def test_shares_are_of_attractors_that_the_list_has(kapitza, tmp_path):
    """One rotation beside down and inverted: the shares of all are 1, and no class has one where it does not
    attract."""
    scene = {"pendulum": PENDULUM, "atlas": {"x": {"parameter": "drive_frequency", "min": 8, "max": 12},
                                             "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.4},
                                             "max_period": 1, "checks": 0, "points": 16, "shares": 100}}
    group = run_scene(kapitza, tmp_path, scene)[0].group("atlas")
    shares, other = group["region_fraction"].values, group["region_other"].values
    assert len(shares) > 2 and np.allclose(shares.sum(axis=1) + other,
                                           1) and (other < 0.5).any() and (shares > 0).sum() > 4
    for region in range(len(shares)):
        column = int(np.argmin(abs(group["column"].values - float(group["region_x"][region]))))
        row = int(np.argmin(abs(group["row"].values - float(group["region_y"][region]))))
        assert not (shares[region] > 0)[group["attracting"].values[:, row, column] == 0].any()


@pytest.mark.extensive
def test_the_map_and_the_small_maps_are_drawn(atlas, tmp_path):
    """The map and the small maps."""
    from kapitza.plots import atlas as picture

    for view in picture.VIEWS:
        plot("atlas", atlas[2], "--view", view, "-o", tmp_path / f"{view}.svg")
        assert (tmp_path / f"{view}.svg").stat().st_size > 10000
    (tmp_path / "points.csv").write_text("x,y,label\n11,0.3,mine\n12,0.4,yours\n")
    plot("atlas", atlas[2], "--points", tmp_path / "points.csv", "-o", tmp_path / "points.pdf")
    (tmp_path / "points.csv").write_text("x,y\n11,0.3\n")
    refused = plot("atlas", atlas[2], "--points", tmp_path / "points.csv")
    assert refused.returncode == 1 and "lacks the column label" in refused.stderr


def test_ranks_and_resumed_runs_write_the_same(atlas, kapitza, tmp_path):
    for ranks in (1, 3, 7) if EXTENSIVE else (3,):
        run_scene(kapitza, tmp_path, SCENE, ranks=ranks)
        assert datasets(tmp_path / "s.h5") == datasets(atlas[2])


def test_no_curve_is_missing(kapitza, tmp_path):
    """Butikov's plane: no negative count (a fold begins at a degenerate period doubling), and each curve has its image
    at -k."""
    scene = {"pendulum": {"k": 0.1, "damping": 0.1, "m": 0.5},
             "atlas": {"x": {"parameter": "k", "min": -0.6, "max": 1.6}, "y": {"parameter": "m", "min": 0, "max": 2},
                       "max_period": 4 if EXTENSIVE else 2, "checks": 0, "points": 200 if EXTENSIVE else 64}}
    group = run_scene(kapitza, tmp_path, scene)[0].group("atlas")
    assert int(group.attrs["negative"]) == 0 and int(group.attrs["compared"]) > 750 and int(group.attrs["alone"]) == 0
    curves, pairs = curves_of(group), 0
    for k in np.linspace(0.011, 0.58, 40):
        here, there = crossings(curves, k), crossings(curves, -k)
        for one, other in ((here, there), (there, here)):
            for *kind, m in one:
                assert min(abs(m - y) for *same, y in other if same == kind) < 2e-3, (k, kind, m)
                pairs += 1
    assert pairs > 1500


def test_curves_of_cycles_that_few_starts_reach(kapitza, tmp_path):
    """Two pairs of rotations 1/2 are born in this plane. Attractors at 144 points show one of them."""
    scene = {"pendulum": PENDULUM, "atlas": {"x": {"parameter": "drive_frequency", "min": 9, "max": 13},
                                             "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.6},
                                             "max_period": 2, "checks": 0, "points": 16}}
    group = run_scene(kapitza, tmp_path, scene)[0].group("atlas")
    named = [(kind, period, winding) for kind, period, winding, *_ in curves_of(group)]
    assert named.count((FOLD, 2, 1)) == 2 and named.count((DOUBLING, 2, 1)) == 2


def test_every_motion_of_the_lists_exists(kapitza, tmp_path):
    """A rotation 1/2 doubles in this plane, and the doubled one loses its stability so soon that the two curves are
    nearly one. Without the second curve the list of every point above had a motion that does not exist."""
    scene = {"pendulum": {"k": 0.1, "damping": 0.1, "m": 0.5},
             "atlas": {"x": {"parameter": "k", "min": 0.1, "max": 1.6}, "y": {"parameter": "m", "min": 0, "max": 1},
                       "max_period": 4, "seeds": 4, "checks": 0, "points": 24}}
    result, told = run_scene(kapitza, tmp_path, scene)[0], 0
    group = result.group("atlas")
    for x, y in itertools.product(group["column"].values[1::4], group["row"].values[1::4]):
        motions = result.motions(float(x), float(y))
        assert all(len(values) for values in motions["multipliers"]), (x, y, list(motions["name"]))
        told += len(motions)
    assert told >= 30


@pytest.mark.parametrize("x", with_extensive([{"parameter": "k", "min": -0.3, "max": 0.3}],
                                             [{"parameter": "damping", "min": 0.1, "max": 0.3}]))
def test_without_gravity_both_rests_attract(kapitza, tmp_path, x):
    """Where k = 0 any drive holds both: in the middle of the first plane, and all over the second one."""
    scene = {"pendulum": {"k": 0, "damping": 0.1, "m": 0.3},
             "atlas": {"x": x, "y": {"parameter": "m", "min": 0, "max": 0.4}, "max_period": 1, "checks": 0,
                       "points": 17}}
    result, _ = run_scene(kapitza, tmp_path, scene)
    group = result.group("atlas")
    assert int(group.attrs["negative"]) == 0 and (group["count"].values[:, 8] >= 2).all()
    place = 0 if x["parameter"] == "k" else 0.2
    assert {"down", "inverted"} <= set(result.motions(place, 0.3)["name"])


@pytest.mark.extensive
def test_a_fold_ends_where_it_meets_a_degenerate_period_doubling(kapitza, tmp_path):
    """A fold of four periods runs into one of two periods, and does not go on along the period doubling."""
    scene = {"pendulum": dict(PENDULUM, tilt="5 deg"),
             "atlas": {"x": {"parameter": "drive_frequency", "min": 9, "max": 13},
                       "y": {"parameter": "drive_amplitude", "min": 0.45, "max": 0.6}, "max_period": 4, "checks": 0,
                       "points": 64}}
    assert int(run_scene(kapitza, tmp_path, scene)[0].group("atlas").attrs["negative"]) == 0


def curves_of(group):
    """(kind, period, |winding|, x, y) of each curve."""
    numbers = [group[f"curve_{name}"].values.tolist() for name in ("kind", "period", "winding", "first", "points")]
    x, y = group["x"].values, group["y"].values
    return [(kind, period, abs(winding), x[first:first + n], y[first:first + n])
            for kind, period, winding, first, n in zip(*numbers, strict=True)]


def crossings(curves, x):
    """(kind, period, |winding|, y) where curves pass x within the plane."""
    found = []
    for *named, xs, ys in curves:
        at = np.flatnonzero((xs[:-1] < x) != (xs[1:] < x))
        y = ys[at] + (x - xs[at]) / (xs[at + 1] - xs[at]) * (ys[at + 1] - ys[at])
        found += [(*named, one) for one in y if 0 < one < 2]
    return found


def test_a_fold_begins_at_each_degenerate_doubling(atlas):
    """That of the doubled cycle, which exists on one side of the point alone."""
    group = atlas[0].group("atlas")
    first, points, kind = (group[f"curve_{name}"].values for name in ("first", "points", "kind"))
    places = list(zip(group["x"].values, group["y"].values, strict=True))
    ends = {places[at] for i in range(len(kind)) if kind[i] == FOLD for at in (first[i], first[i] + points[i] - 1)}
    doubled = {(x, y) for x, y, on in zip(*(group[f"special_{name}"].values for name in ("x", "y", "curve")),
                                          strict=True)
               if kind[on] == DOUBLING}
    assert doubled and doubled <= ends
