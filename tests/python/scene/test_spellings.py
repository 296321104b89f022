"""What Python calls take for values of a sweep and for keys of a scene, in every spelling."""

import kapitza
import numpy as np
import pytest
from conftest import ROOT
from kapitza.scene import Scene

SMALL = ROOT / "scenes" / "small.yaml"
FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300}
STROBE = {"measure": "strobe", "transient": 0, "samples": 1, "progress": False}


@pytest.mark.parametrize("key", ["drive_amplitude", "pendulum.drive_amplitude"])
def test_a_sweep_has_the_values_that_are_given(key):
    """An array or a list of any spacing is these values, and the resolved scene has them; a range says that it is
    one."""
    for values in (np.linspace(0.1, 0.5, 5), [0.1, 0.15, 0.4], (0.2, 0.3)):
        swept = kapitza.sweep({"pendulum": FIG12}, key, values, **STROBE)
        assert swept.group("sweep")["value"].values.tolist() == list(values)
        again = kapitza.run(swept.scene, progress=False)
        assert again.group("sweep").identical(swept.group("sweep"))
    swept = kapitza.sweep({"pendulum": FIG12}, key, {"min": 0.1, "max": 0.5, "count": 3}, **STROBE).group("sweep")
    assert swept["value"].values.tolist() == pytest.approx([0.1, 0.3, 0.5],
                                                           rel=1e-15) and swept.attrs["parameter"] == "drive_amplitude"


def test_values_of_a_sweep_may_have_units():
    pendulum = {"length": "20 cm", "frequency": "50 Hz", "amplitude": "5 mm", "quality_factor": 20}
    swept = kapitza.sweep({"pendulum": pendulum}, "amplitude", ["2 mm", "5 mm", "1 cm"], **STROBE)
    assert swept.group("sweep")["value"].values.tolist() == pytest.approx([0.002, 0.005, 0.01], rel=1e-15)
    assert swept.group("sweep", written=True).attrs["parameter_units"] == "mm"


@pytest.mark.parametrize(("values", "wrong"), [
    ([0.2, 0.1], "0.1 is not above the value before it, 0.2"), ([0.2, 0.2], "is not above"),
    ([0.2], "give two or more"), ([], "empty list"), ([0.1, "1 mm"], "another quantity"), ([[0.1, 0.2]], "is a list"),
    ({"min": 0.1, "max": 0.5}, "sweep.count"), ({"min": 0.1, "max": 0.5, "count": 3, "values": [0.1]}, "contradicts")])
def test_values_that_are_no_sweep_are_refused(values, wrong):
    with pytest.raises(kapitza.SceneError, match=wrong):
        kapitza.sweep({"pendulum": FIG12}, "drive_amplitude", values, progress=False)


def test_a_sweep_of_two_ends_and_a_count_is_told_the_new_spelling():
    for old in (lambda: kapitza.sweep(SMALL, "drive_amplitude", (0.1, 0.5), 9),
                lambda: kapitza.sweep(SMALL, "k", (0.1, 0.5), count=9)):
        with pytest.raises(TypeError, match='"count": 50'):
            old()


@pytest.mark.parametrize("change", [
    {"drive_amplitude": 0.4}, {"pendulum.drive_amplitude": 0.4}, {"pendulum": {"drive_amplitude": 0.4}}])
def test_a_change_keeps_its_neighbours_however_it_is_spelled(change):
    """The other keys of the pendulum stay; a mapping is merged at any depth, and a key of the ramp stands alone too."""
    pendulum = {**FIG12, "ramp": {"key": "drive_amplitude", "from": 0, "periods": 5}}
    changed = Scene({"pendulum": pendulum}, change | {"ramp.periods": 7, "basin": {"theta": {"count": 9}},
                                                      "title": "x"})
    assert changed.tree() == {"pendulum": {"quality_factor": "5", "drive_frequency": "11", "drive_amplitude": "0.4",
                                           "ramp": {
        "key": "drive_amplitude", "from": "0", "periods": "7"}}, "basin": {"theta": {"count": "9"}}, "title": "x"}
    assert "--set" in changed.sets and kapitza.check(SMALL, set=change).scene == kapitza.check(
        SMALL, set={"pendulum.drive_amplitude": 0.4}).scene


def test_axes_of_planes_take_both_spellings():
    axes = {"x": {"parameter": "pendulum.drive_frequency", "min": 5, "max": 15},
            "y": {"parameter": "drive_amplitude", "min": 0.1, "max": 0.5}}
    assert "parameter: drive_frequency" in kapitza.check({"pendulum": FIG12, "atlas": axes}).scene
    with pytest.raises(kapitza.SceneError, match=r"pendulum\.tiltt"):
        kapitza.check(SMALL, set={"tiltt": 1})


@pytest.mark.parametrize("call", [
    lambda: kapitza.check(SMALL, set={"title": "\ud800"}), lambda: kapitza.check("\ud800.yaml"),
    lambda: kapitza.check("title: \ud800\npendulum: {}\n"), lambda: kapitza.run(SMALL, "\ud800.h5"),
    lambda: kapitza.where(SMALL, "\ud800", 0), lambda: kapitza.needs("\ud800", "1"),
    lambda: kapitza.Engine(SMALL, {"title": "\ud800"})])
def test_half_of_a_character_is_refused_in_words(call):
    with pytest.raises(ValueError, match="half of a character") as caught:
        call()
    assert not isinstance(caught.value, UnicodeError) and str(caught.value).isascii()


def test_a_name_with_nul_is_refused_in_words():
    for call in (lambda: kapitza.check("a\0b.yaml"), lambda: kapitza.run(SMALL, "a\0b.h5")):
        with pytest.raises(ValueError, match="holds the character NUL"):
            call()


@pytest.mark.parametrize("ranks", [1.5, "2", 0, None, float("nan")])
def test_ranks_are_a_whole_number(ranks):
    with pytest.raises(ValueError, match="it must be a whole number, at least 1"):
        kapitza.run(SMALL, ranks=ranks)
