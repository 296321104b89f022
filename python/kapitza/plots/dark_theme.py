"""Pictures on dark paper: the colours of a finished figure, with their lightness turned over and their hues kept."""

from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.collections import Collection
from matplotlib.colors import Colormap, ListedColormap, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from kapitza import style

PAPER = 0.17  # lightness (OKLab) of what was white
READABLE = 0.64  # least lightness of lines and letters


def turned(colours: Any, least: float = PAPER) -> np.ndarray:
    """Colours (anything that matplotlib takes) for dark paper, [n, 4]; `least`: their least lightness in OKLab. Pale
    areas are farther from dark paper than they were from white, because the eye sees less there."""
    rgba = to_rgba_array(colours)
    lab = style.oklab(rgba[:, :3])
    lab[:, 0] = np.clip(PAPER + 0.95 * np.clip(1 - lab[:, 0], 0, 1) ** 0.8, least, 0.95)
    rgba[:, :3] = style.of_oklab(lab)
    return rgba


def turned_map(shades: Colormap) -> ListedColormap:
    """The shades of areas for dark paper."""
    return ListedColormap(turned(shades(np.arange(shades.N))))


def turn_line(line: Line2D) -> None:
    line.set_color(tuple(turned(line.get_color(), READABLE)[0]))
    if line.get_marker() not in ("None", "", " ", None):
        line.set_markerfacecolor(tuple(turned(line.get_markerfacecolor())[0]))
        line.set_markeredgecolor(tuple(turned(line.get_markeredgecolor(), READABLE)[0]))


def turn_text(text: Text) -> None:
    text.set_color(tuple(turned(text.get_color(), READABLE)[0]))
    if text.get_path_effects():
        text.set_path_effects([patheffects.withStroke(linewidth=2.2, foreground=tuple(turned("white")[0]), alpha=0.85)])


def darken(figure: Figure) -> None:
    """Turns the colours of a finished figure: areas and markers by their lightness, lines and letters so that they are
    read."""
    figure.draw_without_rendering()  # ticks are made
    for artist in figure.findobj():
        if isinstance(artist, Line2D):
            turn_line(artist)
        elif isinstance(artist, Text):
            turn_text(artist)
        elif isinstance(artist, Patch):
            artist.set_edgecolor(turned(artist.get_edgecolor(), READABLE)[0])
            artist.set_facecolor(turned(artist.get_facecolor())[0])
        elif isinstance(artist, Collection):
            artist.set_cmap(turned_map(artist.get_cmap()))
    for axes in figure.axes:
        axes.tick_params(colors=tuple(turned(style.INK, READABLE)[0]))
