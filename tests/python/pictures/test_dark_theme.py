"""Pictures on dark paper: what was white is dark, lines and letters are read, and hues stay."""

import numpy as np
from kapitza import style
from kapitza.plots.dark_theme import PAPER, READABLE, darken, turned
from matplotlib.colors import ListedColormap, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text


def lightness(colour):
    return float(style.oklab(to_rgba_array(colour)[:, :3])[0, 0])


def hue(colour):
    lab = style.oklab(to_rgba_array(colour)[:, :3])[0]
    return float(np.arctan2(lab[2], lab[1]))


def test_a_figure_on_dark_paper():
    figure = Figure()
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], "o-", color=style.INK, markerfacecolor="white", label="a line")
    axes.pcolormesh(np.array([[0, 1], [1, 0]]), cmap=ListedColormap(["white", "#c6e2d2"]))
    axes.set_title("a title")
    axes.legend()
    darken(figure)
    assert abs(lightness(figure.get_facecolor()) - PAPER) < 0.01 and lightness(axes.get_facecolor()) < 0.2
    letters = [text for text in figure.findobj(Text) if text.get_text()]
    assert {"a title", "a line"} <= {text.get_text() for text in letters}
    assert all(lightness(text.get_color()) >= READABLE - 0.01 for text in letters)
    assert all(lightness(line.get_color()) >= READABLE - 0.01 for line in figure.findobj(Line2D))
    assert lightness(axes.lines[0].get_markerfacecolor()) < 0.2
    shades = axes.collections[0].get_cmap()
    assert lightness(shades(0)) < lightness(shades(1)) < 0.5


def test_colours_keep_their_hue_on_dark_paper():
    for colour in ("#0072b2", "#009e73", "#d55e00", "#cc79a7", "#b8860b"):
        assert abs(hue(turned(colour, READABLE)) - hue(colour)) < 0.15
        assert lightness(turned(colour, READABLE)) >= READABLE - 0.01
