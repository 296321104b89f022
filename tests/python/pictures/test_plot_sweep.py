"""kapitza plot sweep: every view of a sweep, and what it says of files that lack one."""

import numpy as np
import pytest
from conftest import plot
from kapitza import Result, style
from kapitza.plots.branches import NAMED, draw_shares, stack_order
from matplotlib.collections import FillBetweenPolyCollection
from matplotlib.figure import Figure


def draw(path, *arguments):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(path.parent)
        return plot("sweep", path, *arguments)


@pytest.mark.parametrize("view", ["fractions", "phases", "branches", "flutter", "releases", "strobe"])
def test_every_view_is_drawn(swept, view):
    done = draw(swept, "--view", view, "-o", f"{view}.svg", "--dpi", "50")
    assert done.returncode == 0, done.stderr
    text = (swept.parent / f"{view}.svg").read_text()
    assert "A short walk" in text and "3 values" in text


def test_fractions_name_the_large_branches(swept):
    draw(swept, "-o", "first.svg")
    text = (swept.parent / "first.svg").read_text()
    for name in ("inverted", "flutter", "rotation +1/1", "rotation −1/1", "period doubling"):
        assert name in text


def test_fractions_show_intervals_and_name_every_band(swept):
    """As many entries as bands: the named ones, and all others as one."""
    result = Result(swept)
    sweep = result.group("sweep")
    share = np.nan_to_num(sweep["fraction"].values)
    axes = draw_shares(Figure().subplots(), sweep)
    large = share.max(axis=0) > NAMED
    bands, bars = [item for item in axes.collections if isinstance(item, FillBetweenPolyCollection)], axes.containers
    assert len(bands) == large.sum() + 1 and len(bars) == large.sum()
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    for branch in np.flatnonzero(large):
        assert any(style.name_text(sweep["branch_name"].values[branch]) in name for name in names)
    assert len(set(names)) == len(names) and "95 % interval of a share" in names
    rest = share[:, ~large].sum(axis=1).max()
    assert (rest > 0) == any(name.startswith(f"{(~large).sum()} smaller ones (≤ {style.share_text(rest)})")
                             for name in names)
    (line,) = bars[0].lines[2]
    segments = np.array([segment for segment in line.get_segments() if len(segment)])
    first = next(branch for branch in stack_order(sweep) if large[branch])
    there = np.isfinite(sweep["fraction"].values[:, first])
    assert np.allclose(segments[:, 0, 1][: there.sum()], sweep["fraction_low"].values[there, first])
    assert np.allclose(segments[:, 1, 1][: there.sum()], sweep["fraction_high"].values[there, first])


def test_a_basin_is_not_a_sweep(small_result):
    done = draw(small_result)
    assert done.returncode == 1 and done.stderr.startswith("kapitza: error: ") and "holds no sweep" in done.stderr
