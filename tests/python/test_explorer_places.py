"""Where the explorer's page says that a window lies, and how it finds boundaries, in a real browser over the double of the program."""

import numpy as np
import pytest
from explorer_page import Page, wait_for

pytest_plugins = ("explorer_page",)
TURN = 2 * np.pi


def test_upright_is_in_the_middle_until_another_choice_which_is_remembered(driver, striped):
    driver.get("about:blank")
    driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
    first = Page(driver, striped.address())
    first.wait()
    assert [first.window()["theta"][edge] for edge in ("min", "max")] == pytest.approx([0, TURN])
    first.choose("middle", "hanging")
    assert first.window()["theta"]["min"] == pytest.approx(-np.pi)
    again = Page(driver, striped.address())
    again.wait()
    assert again.window()["theta"]["min"] == pytest.approx(-np.pi) and again.run("$('middle').value") == "hanging"
    driver.get("about:blank")


def test_a_plain_deep_picture_says_where_it_is_and_goes_to_a_boundary(page):
    page.run("explorer.state.change({window: explorer.state.window.zoomed(1e-7, 0.513, 0.4), jump: true})")
    page.wait()
    assert wait_for(lambda: not page.run("document.querySelector('.inset').hidden || document.querySelector('.offer').hidden"))
    width = page.run("explorer.state.window.theta.width")
    page.run("document.querySelector('.offer').click()")
    assert wait_for(lambda: len(page.shares()) > 1 and page.state() == "done")
    assert page.run("document.querySelector('.offer').hidden") and page.run("explorer.state.window.theta.width") == pytest.approx(width)
    page.run("document.querySelector('.inset').click()")
    assert page.window()["theta"]["min"] == pytest.approx(-np.pi) and wait_for(lambda: page.run("document.querySelector('.inset').hidden"))


def test_the_list_lights_a_basin_and_keeps_the_one_that_is_clicked(page):
    page.wait()
    plain = np.unique(np.array(page.pixels()), axis=0).tolist()
    page.run("document.querySelector('#legend tr:nth-child(2) button').click()")
    assert page.run("[explorer.state.pinned, explorer.state.lit]") == ["inverted 1", "inverted 1"]
    lit = np.unique(np.array(page.pixels()), axis=0).tolist()
    assert sum(colour in plain for colour in lit) == 1 and len(lit) == len(plain) > 1  # one keeps its colour
    assert wait_for(lambda: page.run("$('passport').textContent").startswith("inverted: "))
    assert "closes after 1 drive period;" in page.run("$('passport').textContent") and page.run("explorer.state.start.theta") == "0.1"
    page.run("document.querySelector('#legend tr:nth-child(2) button').click()")
    assert page.run("explorer.state.lit") is None and np.unique(np.array(page.pixels()), axis=0).tolist() == plain
    assert wait_for(lambda: page.run("$('passport').hidden"))


def test_the_wheel_goes_to_boundaries_where_it_is_asked_to(page):
    page.key("w")
    near = page.module("boundary.js", "its.edgeNear({rows: 4, columns: 100, labels: [...Array(400)].map((_, i) => Number(i % 100 >= 50))}, "
                                      "0.45, 0.5, 0.15)")
    assert near[0] == 0.5 and page.run("$('drawn').checked")

    def edge():
        page.press("home")
        page.wait()
        page.wheel(0.3, 0.5, -100)
        return page.window()["theta"]["min"]

    page.key("w")
    plain = edge()
    assert plain == pytest.approx(-np.pi + 0.3 * TURN * (1 - np.exp(-0.22)), abs=0.01)
    page.key("w")
    assert wait_for(lambda: edge() != plain)  # once the picture's labels are there
