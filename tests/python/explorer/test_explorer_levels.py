"""The levels of the explorer's page: what a first look shows and says, on a desk and on a phone; what each level adds;
one key for all."""

import io
import re

import numpy as np
import pytest
from conftest import wait_for
from explorer_page import Page
from PIL import Image

pytest_plugins = ("explorer_page",)

# Parts that hands can take hold of, groups as one: radio buttons, the bar of a window, tabs, the list, a slider with
# its field.
CONTROLS = """[...new Set([...document.querySelectorAll("button, select, input, summary")]
    .filter((part) => part.offsetParent && part.checkVisibility({visibilityProperty: true})
      && !part.closest(".menu > div, dialog"))
    .map((part) => part.closest("fieldset, .head, #legend, #sliders, .menu") ?? part)
    .map((part) => part.id || part.dataset.head || part.textContent))]"""
LETTERS = """(() => { const hasText = (part) => [...part.childNodes].some((node) => node.nodeType === 3
    && node.textContent.trim());
    const seen = [...document.querySelectorAll("body *")].filter((part) => part.offsetParent
      && part.checkVisibility() && hasText(part));
    const styles = seen.map((part) => getComputedStyle(part)),
      weights = new Set(styles.map((style) => style.fontWeight));
    return [Math.min(...styles.map((style) => parseFloat(style.fontSize))), [...weights]]; })()"""
# Words that a school book has, with "pendulum"; names of motions are explained beside them.
SCHOOL = set("""
    a about after all amplitude an and angle at before can cannot colour degrees does down each end ends explore falls
    far first flutter flutters from go hangs home how in inverted is it its labelled left let look me measure new
    nodding none not of on one or over pause pendulum picture play point push right rotation round second shake shaken
    show side stand stands start starts swings that the this to turns up upside way where with yet""".split())


@pytest.fixture
def first(driver, striped):
    """The page as a first visitor gets it; it stands still, and is drawn in labels alone."""
    driver.get("about:blank")
    driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
    page = Page(driver, striped.address() + "#painter=2d&shade=none&samples=1&quality=moving")
    page.wait()
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    yield page
    driver.get("about:blank")


def test_each_level_has_few_controls_and_letters_that_are_read(first):
    before = set()
    for level in ("look", "explore", "measure"):
        first.run("document.querySelector(`#levels [value=${arguments[0]}]`).click()", level)
        assert first.run("document.body.dataset.level") == level
        found = set(first.run(CONTROLS))
        assert len(found - before) <= 7 and before - {"show-me"} <= found, (level, found)
        smallest, weights = first.run(LETTERS)
        assert smallest >= 14 and len(weights) <= 2
        before = found
    sizes = """(() => { const sizes = [], nothing = () => {};
        const fillText = function () { sizes.push(parseFloat(this.font)); };
        const context = {fillText, save: nothing, restore: nothing, translate: nothing};
        new its.CanvasSurface(context).text("a", 0, 0, "left"); return sizes; })()"""
    assert first.module("surface.js", sizes) == [14]  # size of letters on canvases


def test_a_first_look_is_in_words_of_a_school_book(first):
    first.wait()
    words = first.run("document.body.innerText.replace(/[−+\\d.%]+/g, ' ')")
    assert {word.lower() for word in re.findall(r"[A-Za-z]+", words)} <= SCHOOL, words
    explained = ("[...document.querySelectorAll('#legend button')].every((one) => one.title && "
                 "one.querySelector('small').textContent)")
    assert first.run(explained)
    assert first.run("[document.querySelector('.slider.main label').title, $('map').hidden]") == [
        "how far it is shaken up and down, as a part of the pendulum's length", True]


def test_the_bob_the_start_and_the_list_have_one_colour_and_the_pendulum_a_third_of_the_page(first):
    width, page, colour = first.run(
        "[$('motion').getBoundingClientRect().width, innerWidth, explorer.basins.panes[0].plain.bob]")
    assert width >= page / 3
    name = first.run("explorer.basins.motion.ending.name")
    line = "[...$('legend').rows].find((row) => row.dataset.name === arguments[0])"
    red, green, blue = bytes.fromhex(colour[1:])
    assert first.run(f"getComputedStyle({line}.querySelector('.patch')).backgroundColor",
                     name) == f"rgb({red}, {green}, {blue})"


def test_a_phone_has_the_pendulum_and_its_amplitude_on_the_first_screen(first):
    for width, height in ((390, 844), (844, 390)):
        with first.screen(width, height, mobile=True):
            boxes = "['pendulum', 'slider-m', 'panes'].map((id) => { " \
                    "const {top, bottom, width} = $(id).getBoundingClientRect(); " \
                    "return [top, bottom, width]; })"
            assert wait_for(lambda boxes=boxes: first.run(boxes)[0][1] <= 844)
            pendulum, slider, basins = first.run(boxes)
            assert pendulum[1] - pendulum[0] > 100 and slider[1] <= height and pendulum[0] >= 0
            # Beside each other where there is room
            assert basins[0] < height and (width > height or basins[0] > slider[1])


def test_a_phone_presents_the_basins_of_each_step_of_the_story_whole(page, webgl):
    """Chromium presented no canvas of WebGL that the story's panel covered in part, although it had been drawn."""
    page.run("document.querySelector('#levels [value=look]').click()")
    for width, height in ((390, 844), (500, 900)):
        with page.screen(width, height, mobile=True):
            page.press("show-me")
            assert wait_for(lambda: page.run("explorer.stories.story?.steps.map((step) => (step.glide = 0))"))
            for step in range(page.run("explorer.stories.story.steps.length")):
                if page.run("$('map').hidden"):
                    assert wait_for(lambda: page.run("!explorer.stories.busy"))
                    page.wait()
                    drawn, presented = shown(page)
                    assert 0.2 < drawn and 0.8 * drawn < presented, (width, step)
                assert page.run("$('story').getBoundingClientRect().bottom") <= height
                page.press("story-next")
            page.press("story-end")


def shown(page):
    """Shares of coloured pixels in the basins' box: as drawn, and in a screenshot, where black where out of sight."""
    box = page.run("(({left, top, right, bottom}) => [left, top, right, bottom].map(Math.round))"
                   "(explorer.basins.panes[0].basins.getBoundingClientRect())")
    with Image.open(io.BytesIO(page.driver.get_screenshot_as_png())) as shot:
        seen = np.asarray(shot.convert("RGB").crop(box)).reshape(-1, 3)
    return [(np.ptp(pixels[:, :3].astype(int), axis=1) > 24).mean() for pixels in (np.array(page.pixels()), seen)]


def test_the_story_of_the_first_look_goes_on_by_itself_until_somebody_takes_a_step(first):
    moving = {"features": [{"name": "prefers-reduced-motion", "value": "no-preference"}]}
    first.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", moving)
    first.run("window.setTimeout = ((own) => (then, ms) => "
              "(ms === 10000 ? ((window.onward = then), 0) : own(then, ms)))(window.setTimeout)")
    first.press("show-me")
    place = "$('story-place').textContent"
    for step in range(1, 7):
        said = f"{step} / 6" + ", plays on" * (step < 6)
        assert wait_for(lambda said=said: first.run(place) == said), first.run(place)
        first.run("((then) => { window.onward = null; then?.(); })(window.onward)")
    _ = first.press("story-end"), first.press("show-me")
    assert wait_for(lambda: first.run(place) == "1 / 6, plays on")
    first.press("story-next")
    assert first.run(place) == "2 / 6"
    first.press("story-end")
    first.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def test_a_key_shows_the_level_that_has_its_control_and_a_visitor_who_returns_finds_it(first, striped):
    for key, level in (("h", "look"), ("Escape", "look"), ("m", "explore"), ("d", "measure")):
        first.key(key)
        assert first.run("explorer.state.level") == level, key
    first.key("Escape")
    again = Page(first.driver, striped.address())
    assert wait_for(lambda: again.run("[window.explorer?.state.level, window.explorer?.state.map]")
                    == ["measure", "on"])
    again.run("document.querySelector('#levels [value=look]').click()")
    assert again.run("[explorer.state.map, explorer.state.view, $('map').hidden]") == ["off", "pendulum", True]
    again.driver.get_log("browser")  # the double draws no atlas
