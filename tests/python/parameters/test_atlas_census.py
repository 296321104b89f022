"""What the census of an atlas finds and says, and planes with x and y exchanged."""

import numpy as np
import pytest
from conftest import run_scene, with_extensive
from test_atlas import BREAKING, DOUBLING, FOLD, PENDULUM, SCENE, atlas, crossing  # noqa: F401

BUTIKOV = {"k": 0.1, "damping": 0.1, "m": 0.5}


def test_a_plane_with_x_and_y_exchanged_has_the_same_curves(atlas, kapitza, tmp_path):  # noqa: F811
    """The search follows cycles along columns: what is x and what is y does not matter to it."""
    axes = SCENE["atlas"]
    result, _ = run_scene(kapitza, tmp_path, SCENE | {"atlas": axes | {"x": axes["y"], "y": axes["x"]}})
    here, there = atlas[0].group("atlas"), result.group("atlas")
    for name in here.variables:
        other = {"x": "y", "y": "x"}.get(name[-1], "") if name[-2:] in ("x", "y", "_x", "_y") else ""
        twin = there[{"row": "column", "column": "row"}.get(name, name[:-1] + other if other else name)].values
        assert np.array_equal(np.swapaxes(twin, -1, -2) if name in ("attracting", "count", "list") else twin,
                              here[name].values), name
    assert [there.attrs[name] for name in ("x_parameter", "y_parameter")] == ["drive_amplitude", "drive_frequency"]
    mine, theirs = atlas[0].motions(11, 0.5), result.motions(0.5, 11)
    assert list(mine["name"]) == list(theirs["name"]) and len(mine) >= 3
    assert len(atlas[0].line(x=11)) == len(result.line(y=11))


def test_the_census_says_how_much_is_missing(atlas):  # noqa: F811
    """Places that see a curve, and the estimate of each decade, in the file, the summary and a picture."""
    from kapitza.explorer.atlas import packed
    from kapitza.plots.atlas_classes import missing_text
    from kapitza.reading import arrays_of
    from kapitza.representation import as_text

    result, summary, _ = atlas
    group = result.group("atlas")
    places, band = group["curve_places"].values, group["curve_band"].values
    assert int(group.attrs["places"]) >= 80 and int(group.attrs["cycles"]) > places.sum() > 400
    assert places.max() <= group.attrs["places"]
    assert int(group["decade_curves"].sum()) == group.sizes["curve"]
    assert int(group["decade_once"].sum()) == int((places == 1).sum())
    wide = int((band >= 1e-4).sum())
    low, high = (float(group.attrs[f"missing_{end}"]) for end in ("low", "high"))
    assert int(group["decade_curves"][:4].sum()) == wide and 0 <= low <= high < 3
    assert int(group.attrs["dropped"]) == 0 and "found no room" not in summary + missing_text(group)
    assert "12 cycles found no room" in missing_text(group.assign_attrs(dropped=12))
    upper = float(np.sum(group["decade_missing_high"].values * 0.1 ** np.arange(group.sizes["decade"])))
    lacking = float(group.attrs["lacking_high"])
    assert lacking == pytest.approx(min(1, max(upper, np.exp(-1) / group.attrs["places"])))
    assert result.motions(11, 0.5).attrs == {"lacking_high": lacking}
    words = f"a motion may be missing at a point with a probability of at most {100 * lacking:.1f} %"
    assert words in as_text(result) and packed(*arrays_of(result.path, "atlas"))[0]["certainty"] == words
    assert f"lacks a motion with a probability of at most {lacking:.1g}" in summary
    assert "are missing" in summary and "missing" in missing_text(group) and missing_text(group) in as_text(result)


def test_columns_that_contradict_are_followed(kapitza, tmp_path):
    """A fold was missing, so that the lists of 15 of these cells were not known, until the curves that cross their
    columns are followed."""
    axes = {"x": {"parameter": "k", "min": 0.6, "max": 0.9}, "y": {"parameter": "m", "min": 0, "max": 2}}
    scene = {"pendulum": BUTIKOV, "atlas": axes | {"max_period": 3, "seeds": 2, "checks": 0, "points": 64}}
    group = run_scene(kapitza, tmp_path, scene)[0].group("atlas")
    assert int(group.attrs["negative"]) == 0 and int(group["count"].min()) >= 0


# Families whose bands starts hardly ever reach, by an integrator of their own: curves (kind, whether the cycle is
# symmetric, value) of
# cycles of six periods across a line, and a point of it with the multipliers and a strobe point of one of its motions.
FAMILIES = {
    "13.7, symmetric": (PENDULUM, {"x": ("drive_frequency", 13.69, 13.71), "y": ("drive_amplitude", 0.525, 0.545)},
                        13.7, [(FOLD, 1, 0.532813117), (BREAKING, 1, 0.536545728), (DOUBLING, 0, 0.537042433)],
                        0.5347, (0.759438, 0.759438), (2.391146461415400929945, -0.006100438780240941489)),
    "13.7, asymmetric": (PENDULUM, {"x": ("drive_frequency", 13.69, 13.71), "y": ("drive_amplitude", 0.495, 0.51)},
                         13.7, [(FOLD, 0, 0.501471804), (DOUBLING, 0, 0.502082616)], None, None, None),
    "14.4011, down": (PENDULUM, {"x": ("drive_frequency", 14.39, 14.41), "y": ("drive_amplitude", 0.675, 0.7)}, 14.4011,
                      [(FOLD, 1, 0.681935), (BREAKING, 1, 0.682844), (DOUBLING, 0, 0.683093)],
                      0.6824, (0.769681, 0.769681), (-0.8900242233, -1.0275572553)),
    "14.4011, inverted": (PENDULUM, {"x": ("drive_frequency", 14.4, 14.402), "y": ("drive_amplitude", 0.6945, 0.6975)},
                          14.4011, [(FOLD, 1, 0.695394), (BREAKING, 1, 0.696160), (DOUBLING, 0, 0.696368)],
                          0.6958, (0.769681, 0.769681), (-2.7059035693, -2.1016951629)),
    "k = -.2": (BUTIKOV, {"x": ("k", -0.21, -0.19), "y": ("m", 0.57, 0.585)}, -0.2,
                [(FOLD, 0, 0.576048242), (DOUBLING, 0, 0.580031115)],
                0.578, (0.20637, 0.11171), (2.8383184853070825350, -1.2663423823554121889)),
    "k = -.45": (BUTIKOV, {"x": ("k", -0.451, -0.449), "y": ("m", 0.353, 0.359)}, -0.45,
                 [(FOLD, 0, 0.355589834), (DOUBLING, 0, 0.356272811)], None, None, None),
}


@pytest.mark.parametrize("name", with_extensive(["13.7, symmetric", "k = -.2"],
                                                ["13.7, asymmetric", "14.4011, down", "14.4011, inverted", "k = -.45"]))
def test_families_that_hardly_attract_are_found(kapitza, tmp_path, name):
    """A symmetric 6-nodding repels over its six periods with the square of what it does over three: it was left out at
    each place."""
    pendulum, axes, x, curves, y, moduli, strobe = FAMILIES[name]
    plane = {axis: dict(zip(("parameter", "min", "max"), words, strict=True)) for axis, words in axes.items()}
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": pendulum,
                                              "atlas": plane | {"max_period": 6, "seeds": 2, "checks": 0,
                                                                "points": 16}})
    group = result.group("atlas")
    for kind, symmetric, value in curves:
        found = [crossing(group["x"][first:first + n].values, group["y"][first:first + n].values, x)
                 for of, own, period, first, n in zip(*(group[f"curve_{name}"].values for name in (
                     "kind", "symmetric", "period", "first", "points")), strict=True)
                 if (of, own, period) == (kind, symmetric, 6) and n >= 6]
        assert min(abs(at - value) for at in found) < 1e-6, kind
    if strobe is None:
        return
    motions = result.motions(x, y)
    motion = motions[motions["period"] == 6].iloc[0]
    assert sorted(map(abs, motion["multipliers"])) == pytest.approx(sorted(moduli), abs=1e-5)
    states = np.array([motion["strobe_theta"], motion["strobe_velocity"]])
    away = min(np.hypot(*(side * states - np.reshape(strobe, (2, 1)))).min() for side in (1, -1))
    assert away < (1e-5 if x == 14.4011 else 1e-9)  # 14.4011 is a rounded frequency
