"""Pictures as functions: keywords and the options of the command line are the same, an axes of one's own takes a
picture, colours go by names."""

import inspect

import kapitza
import numpy as np
import pandas
import pytest
from conftest import plot
from kapitza.plots.kinds import KINDS
from kapitza.plots.page_options import colours_of
from kapitza.plots.picture import FILES, parser_of
from kapitza.result import BadFile
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

OF_PAGE = {"width", "font_size", "legend", "colours", "title", "no_title", "no_legend", "theme"}


@pytest.mark.parametrize("kind", KINDS)
def test_the_command_line_has_the_keywords_of_the_function(kind):
    """No default stands twice: what is not given on the command line is not passed on."""
    options = {action.dest for action in parser_of(kind)._actions} - {*FILES}
    parameters = inspect.signature(KINDS[kind].draw).parameters.values()
    keywords = {parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY}
    assert keywords == options - OF_PAGE and OF_PAGE - {"no_legend", "theme"} <= options
    assert vars(parser_of(kind).parse_args(["x.h5", *["y.h5"] * (kind == "compare")])).keys() <= {"file", "other"}


def test_an_axes_takes_a_picture_and_its_figure_stays(made_file):
    result, figure = kapitza.Result(made_file), Figure(figsize=(9, 4))
    left, right = figure.subplots(1, 2)
    right.plot([0, 1], [0, 1])
    assert result.plot(ax=left, centre="inverted", legend="none") is figure
    assert len(left.images) == 1 and left.get_legend() is None and left.lines and "angle" in left.get_xlabel()
    assert tuple(figure.get_size_inches()) == (9, 4) and not figure.texts and figure.get_supxlabel() == ""
    assert len(right.lines) == 1
    alone = result.plot(centre="inverted", legend="none").axes[0]
    assert np.array_equal(left.images[0].get_array(), alone.images[0].get_array())
    assert result.plot(ax=right, quantity="evidence", font_size=7).axes[:2] == [left, right] and right.get_legend()


def test_panels_of_many_kinds_go_into_an_axes(swept):
    result, axes = kapitza.Result(swept), Figure().subplots()
    for view in ("branches", "releases", "up"):
        axes.clear()
        assert result.plot("sweep", ax=axes, view=view) is axes.figure and (axes.lines or axes.collections)
    with pytest.raises(ValueError, match="ax takes one panel, and this picture has several; choose a view"):
        result.plot("sweep", ax=axes, view="strobe")
    for option in ({"width": "86mm"}, {"title": "x"}, {"no_title": True}):
        with pytest.raises(ValueError, match="is of a page of its own; leave it out with ax"):
            result.plot("sweep", ax=axes, **option)


def test_colours_are_a_mapping_too(made_file, tmp_path):
    result, mine = kapitza.Result(made_file), {"inverted": "#010203", "rotation +": "teal"}
    image, labels = result.plot(colours=mine, no_dots=True).axes[0].images[0].get_array(), result.labels().values
    assert np.allclose(image[labels == 1], to_rgb("#010203")) and np.allclose(image[labels == 4], to_rgb("teal"))
    for wrong, words in (({"invertd": "gold"},
                          "invertd is the name of no motion; the names are inverted, down, rotation [+]"),
                         ({"inverted": "goldish"}, "'goldish' is not a colour"),
                         ({"rotation 1/2": "red"}, "such as rotation [+]1/2")):
        with pytest.raises(ValueError, match=words):
            result.plot(colours=wrong)
        (tmp_path / "wrong.yaml").write_text("".join(f"{name}: {colour}\n" for name, colour in wrong.items()))
        done = plot("basin", made_file, "--colours", tmp_path / "wrong.yaml")
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and next(iter(wrong)) in done.stderr


def test_every_name_of_a_motion_may_have_a_colour(made_file, swept):
    """Of attractors of this file or another one, alone or with an id."""
    names = [*kapitza.Result(made_file).names, *map(str, kapitza.Result(swept).group("sweep")["branch_name"].values),
             "wide 3-nodding",
             "rotation -7/3", "inverted 3-nodding (12)", "running -", "running + (3)", "not settled", "down nodding"]
    assert colours_of(dict.fromkeys(names, "gold")) == dict.fromkeys(names, "gold")


@pytest.mark.parametrize(("options", "wrong"), [
    ({"centre": "up"}, "centre: 'up' is unknown; it must be one of down, inverted"),
    ({"font_size": 1}, "font_size: 1 is out of range"),
    ({"attractor": 0, "shade": True}, "^attractor cannot be combined with quantity or shade"),
    ({"dpi": 300}, "'dpi' is no option"),
    ({"width": 900}, "width: 900in is not a width"), ({"quantity": 3}, "quantity: 3 is unknown")])
def test_options_that_are_none(made_file, options, wrong):
    with pytest.raises(ValueError, match=wrong):
        kapitza.Result(made_file).plot(**options)


def test_options_are_values_of_python(made_file):
    result = kapitza.Result(made_file)
    assert result.plot(width=3.5).get_figwidth() == 3.5 and result.plot(width="2in").get_figwidth() == 2
    one = result.plot(attractor=1, no_dots=True, si=None).axes[0].images[0].get_array()[..., 0] == 0
    assert np.array_equal(one, result.labels().values == 1)
    table = pandas.DataFrame({"theta": [0.1], "velocity": [0.0]})
    with pytest.raises(BadFile, match="^points: the table of releases needs a column end"):
        result.plot(points=table)
