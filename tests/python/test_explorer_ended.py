"""Frames of the explorer that others end, and pages that others lock out."""

import matplotlib.image
import numpy as np
from explorer_page import wait_for
from kapitza.explorer.access import Access

pytest_plugins = ("explorer_page",)


def deciding(page):
    """Asks for labels that take a while, and waits until they are being decided."""
    page.run("explorer.state.change({quality: 'exact', pendulum: {...explorer.state.pendulum, m: '5.3'}})")
    assert wait_for(lambda: page.state() == "computing")


def test_a_picture_that_is_saved_ends_no_frame(page, folder):
    deciding(page)
    page.choose("save-width", "400")
    (folder / "view.png").unlink(missing_ok=True)
    picture = matplotlib.image.imread(page.saved("save-png", folder / "view.png"))
    assert "undecided" in page.wait()
    colours = {tuple(pixel) for pixel in np.round(255 * picture[::7, ::7, :3]).reshape(-1, 3)}
    assert len(colours & {tuple(pixel[:3]) for pixel in page.pixels()}) >= 2  # it has the colours of the page


def test_a_frame_that_others_end_is_asked_for_again(page):
    """The page settled for quick labels, or said for ever that it was computing."""
    deciding(page)
    page.run("void explorer.basins.panes[0].engine.cancel()")
    assert "undecided" in page.wait()
    page.run("explorer.state.change({shade: 'relief', pendulum: {...explorer.state.pendulum, m: '5.2'}})")
    assert wait_for(lambda: page.state() == "computing")
    page.run("void explorer.basins.panes[0].glance(explorer.state.home, {width: 40, height: 40})")
    assert "undecided" in page.wait()


def test_a_page_keeps_its_own_token(page):
    """The browser's storage may hold the token of a page of an earlier server at the same address."""
    page.run("Object.keys(localStorage).filter((key) => key.startsWith('kapitza /')).forEach((key) => "
             "localStorage.setItem(key, 'stale'))")
    assert page.module("engine.js", "its.ask('state')") != "Error: the token is wrong; open the address that kapitza view has printed"
    page.run("explorer.state.change({pendulum: {...explorer.state.pendulum, m: '0.31'}})")
    assert "quick labels" in page.wait()


def test_pages_that_still_ask_stay_admitted():
    """However many come after them: a lecturer's page is not locked out by those of the audience."""
    access = Access()
    first, silent = (access.trade(access.new_address()) for _ in range(2))
    for _ in range(40):
        assert access.admits(first) and access.admits(access.trade(access.new_address()))
    assert access.admits(first) and not access.admits(silent) and not access.admits(None)
