"""What belongs to the letters of a page: lines, marks and ticks as thick as these are large, ticks that stay where they
were laid out."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection, PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import AutoLocator, FixedLocator


def scale_strokes(figure: Figure, factor: float) -> None:
    """Lines and marks of every panel and legend `factor` times as thick and large; ticks and frames have their sizes
    from kapitza.style."""
    if factor == 1:
        return
    legends = [legend for legend in (*figure.legends, *(axes.get_legend() for axes in figure.axes)) if legend]
    for artist in (*_of_panels(figure), *(handle for legend in legends for handle in legend.legend_handles if handle)):
        if isinstance(artist, Line2D):
            artist.set(linewidth=factor * artist.get_linewidth(), markersize=factor * artist.get_markersize(),
                       markeredgewidth=factor * artist.get_markeredgewidth())
        elif isinstance(artist, Collection):
            artist.set_linewidth(list(factor * np.atleast_1d(artist.get_linewidth())))
            if isinstance(artist, PathCollection):
                artist.set_sizes(factor**2 * artist.get_sizes())
        elif isinstance(artist, Patch):
            artist.set_linewidth(factor * artist.get_linewidth())


def _of_panels(figure: Figure) -> list[Artist]:
    return [artist for axes in figure.axes for artist in (*axes.lines, *axes.collections, *axes.patches)]


def fix_ticks(figure: Figure) -> None:
    """Keeps the ticks that each panel has now: others, with more digits, would not fit beside a panel that was laid out
    for these."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_locator(), AutoLocator):
                axis.set_major_locator(FixedLocator(list(axis.get_majorticklocs())))
