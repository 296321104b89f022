"""What the census of an atlas finds and says, and planes with x and y exchanged."""

import numpy as np
from conftest import run_scene
from test_atlas import BREAKING, DOUBLING, FOLD, PENDULUM, SCENE, atlas, crossing  # noqa: F401


def test_a_plane_with_x_and_y_exchanged_has_the_same_curves(atlas, kapitza, tmp_path):  # noqa: F811
    """The search follows cycles along columns: what is x and what is y does not matter to it."""
    axes = SCENE["atlas"]
    result, _ = run_scene(kapitza, tmp_path, SCENE | {"atlas": axes | {"x": axes["y"], "y": axes["x"]}})
    here, there = atlas[0].group("atlas"), result.group("atlas")
    for name in here.variables:
        other = {"x": "y", "y": "x"}.get(name[-1], "") if name[-2:] in ("x", "y", "_x", "_y") else ""
        twin = there[{"row": "column", "column": "row"}.get(name, name[:-1] + other if other else name)].values
        assert np.array_equal(np.swapaxes(twin, -1, -2) if name in ("attracting", "count", "list") else twin, here[name].values), name
    assert [there.attrs[name] for name in ("x_parameter", "y_parameter")] == ["drive_amplitude", "drive_frequency"]
    mine, theirs = atlas[0].motions(11, 0.5), result.motions(0.5, 11)
    assert list(mine["name"]) == list(theirs["name"]) and len(mine) >= 3
    assert len(atlas[0].line(x=11)) == len(result.line(y=11))


def test_the_census_says_how_much_is_missing(atlas):  # noqa: F811
    """Places that see a curve, and the estimate of each decade, in the file, the summary and a picture."""
    from kapitza.plots.atlas_classes import missing_text
    from kapitza.show import as_text

    result, summary, _ = atlas
    group = result.group("atlas")
    places, band = group["curve_places"].values, group["curve_band"].values
    assert int(group.attrs["places"]) >= 80 and int(group.attrs["cycles"]) > places.sum() > 400 and places.max() <= group.attrs["places"]
    assert int(group["decade_curves"].sum()) == group.sizes["curve"] and int(group["decade_once"].sum()) == int((places == 1).sum())
    wide = int((band >= 1e-4).sum())
    low, high = (float(group.attrs[f"missing_{end}"]) for end in ("low", "high"))
    assert int(group["decade_curves"][:4].sum()) == wide and 0 <= low <= high < 3
    assert int(group.attrs["dropped"]) == 0 and "found no room" not in summary + missing_text(group)
    assert "12 cycles found no room" in missing_text(group.assign_attrs(dropped=12))
    assert "are missing" in summary and "missing" in missing_text(group) and missing_text(group) in as_text(result)


def test_families_that_hardly_attract_are_found(kapitza, tmp_path):
    """A symmetric inverted 6-nodding repels over its six periods with the square of what it does over three: it was left out at each place.
    Values by an integrator of its own (fold, loss of symmetry, doubling at Omega = 13.7)."""
    scene = {"pendulum": PENDULUM, "atlas": {"x": {"parameter": "drive_frequency", "min": 13.6, "max": 13.8},
                                             "y": {"parameter": "drive_amplitude", "min": 0.52, "max": 0.55}, "max_period": 6, "seeds": 2,
                                             "checks": 0, "points": 16}}
    group = run_scene(kapitza, tmp_path, scene)[0].group("atlas")
    for kind, symmetric, value in ((FOLD, 1, 0.532813117), (BREAKING, 1, 0.536545728), (DOUBLING, 0, 0.537042433)):
        found = [crossing(group["x"][first:first + n].values, group["y"][first:first + n].values, 13.7)
                 for of, own, period, first, n in zip(*(group[f"curve_{name}"].values for name in (
                     "kind", "symmetric", "period", "first", "points")), strict=True)
                 if (of, own, period) == (kind, symmetric, 6) and n >= 6]
        assert min(abs(y - value) for y in found) < 1e-6, kind
