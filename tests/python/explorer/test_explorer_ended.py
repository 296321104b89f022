"""Frames of the explorer that others end, and pages that others lock out."""

import re

import matplotlib.image
import numpy as np
from conftest import wait_for
from kapitza.explorer.access import Access

pytest_plugins = ("explorer_page",)


def deciding(page):
    """Asks for labels that take a while, and waits until they are being decided."""
    page.run("explorer.state.change({quality: 'exact', pendulum: {...explorer.state.pendulum, m: '5.3'}})")
    assert wait_for(lambda: page.state() == "computing")


def test_a_picture_that_is_saved_ends_no_frame(page, webgl, folder):
    deciding(page)
    page.choose("save-width", "400")
    picture = matplotlib.image.imread(page.saved("save-png", folder / "view.png"))
    assert "undecided" in page.wait()
    colours = {tuple(pixel) for pixel in np.round(255 * picture[::7, ::7, :3]).reshape(-1, 3)}
    assert len(colours & {tuple(pixel[:3]) for pixel in page.pixels()}) >= 2  # it has the colours of the page


def test_a_picture_that_is_late_leaves_the_last_one_blurred_with_how_far_it_is(page):
    """Each level takes 0.9 s. While pictures come at once, none is blurred, however fast a hand moves on."""
    page.run("explorer.state.change({pendulum: {...explorer.state.pendulum, m: '5.9'}})")
    seen = "[document.querySelector('.pane').classList.contains('stale'), document.querySelector('.wait').textContent]"
    assert wait_for(lambda: page.run(seen) == [True, "0 % of the new picture"])
    assert len(page.shares()) > 1 and page.run("$('legend').classList.contains('stale')")
    page.wait()
    assert not page.run(seen)[0] and page.run("explorer.basins.panes[0].pendulum.m") == "5.9"


def test_a_picture_that_was_cancelled_is_not_the_one_wanted_since(page):
    """The page said "done" until the next one was asked for."""
    deciding(page)
    change = "explorer.state.change({pendulum: {...explorer.state.pendulum, m: '5.4'}})"
    assert page.run(f"($('cancel').click(), {change}, document.body.dataset.state)") == "moving"
    assert "decided" in page.wait()


SHOWN = "((pane) => [pane.top && pane.shows(pane.top), pane.top?.level, " \
        "[...$('legend').rows].map((row) => row.cells[2].textContent), " \
        "$('cancel').textContent])(explorer.basins.panes[0])"


def test_what_is_cancelled_at_once_still_shows_the_window_that_was_asked_for(page):
    """The list kept the numbers of the window before, beside a patch of its picture, and a second Home did nothing."""
    page.run("explorer.state.change({quality: 'exact', pendulum: {...explorer.state.pendulum, m: '5.2'}})")
    page.wait()
    page.run("explorer.state.change({window: explorer.state.window.zoomed(0.1, 0.52, 0.4), jump: true})")
    page.wait()
    page.press("home")
    page.key("Escape")
    assert page.wait().startswith("Cancelled.")
    shown, level, shares, button = page.run(SHOWN)
    assert shown and level < 8 and "–" not in shares and button == "Resume"
    page.press("home")
    assert "undecided" in page.wait()
    drawn = "explorer.basins.panes[0].drawnFrames.map((frame) => explorer.basins.panes[0].shows(frame))"
    assert wait_for(lambda: set(page.run(drawn)) == {True})  # no patch of the window before
    assert page.run(SHOWN)[::3] == [True, "Cancel"] and page.run("$('cancel').disabled")


def test_numbers_of_another_window_are_not_said_of_this_one(page):
    """Where nothing of the window wanted came before it was cancelled twice."""
    page.run("explorer.state.change({pendulum: {...explorer.state.pendulum, m: '5.2'}})")
    page.wait()
    zoom = "explorer.state.change({window: explorer.state.window.zoomed(1.9, 0.5, 0.5).moved(0, 0.2), jump: true})"
    page.run("explorer.state.change({window: explorer.state.window.zoomed(0.1, 0.52, 0.4), jump: true})")
    page.wait()
    stop = "document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape', bubbles: true, cancelable: true}))"
    page.run(f"({zoom}, {stop}, {stop})")
    assert page.wait().startswith("Cancelled.")
    assert wait_for(lambda: page.run(SHOWN) == [False, 1, ["–"] * 3, "Resume"])
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.5, 0.45])")
    assert "window" not in page.run("$('pointer').textContent")
    page.press("cancel")
    page.wait()
    assert page.run(SHOWN)[::3] == [True, "Cancel"]
    page.run(f"(explorer.state.change({{pendulum: {{...explorer.state.pendulum, m: '7'}}}}), {stop}, {stop})")
    page.wait()
    assert wait_for(lambda: page.run(SHOWN)[1:] == [1, ["–"] * 3, "Resume"])  # no shares of another pendulum
    page.run("explorer.state.change({pendulum: explorer.state.scene})")
    page.wait()


def test_escape_that_ends_something_else_stops_no_labels(page):
    deciding(page)
    page.run("document.querySelector('.menu').open = true")
    page.key("Escape")
    assert not page.run("document.querySelector('.menu').open") and "undecided" in page.wait()
    page.run("explorer.state.change({pendulum: {...explorer.state.pendulum, m: '5.4'}})")
    page.press("dive")
    page.key("Escape")
    assert page.run("$('dive').getAttribute('aria-pressed')") == "false" and "undecided" in page.wait()


def test_a_view_that_changes_while_its_picture_is_computed_is_not_saved(page):
    """The basins of one window stood under the axes of another."""
    page.run("explorer.state.change({quality: 'moving', samples: '1'})")
    page.wait()
    said = page.module("save.js", "(() => { const saved = its.savePng(explorer.state, explorer.basins, 300);"
                                  "explorer.state.change({pendulum: {...explorer.state.pendulum, m: '0.45'}});"
                                  "return saved.catch(String); })()")
    assert said == "Error: The view has changed while its picture was computed. Save it again."
    page.wait()
    page.choose("save-width", "400")
    page.run("document.getElementById('save-png').click()")
    assert page.run("document.getElementById('save-png').disabled")  # one at a time
    assert wait_for(lambda: not page.run("document.getElementById('save-png').disabled"))


def test_a_frame_that_others_end_is_asked_for_again(page):
    """The page settled for quick labels, or said for ever that it was computing."""
    deciding(page)
    page.run("void explorer.basins.panes[0].engine.cancel()")
    assert "undecided" in page.wait()
    page.run("explorer.state.change({shade: 'relief', pendulum: {...explorer.state.pendulum, m: '5.2'}})")
    assert wait_for(lambda: page.state() == "computing")
    page.run("void explorer.basins.panes[0].glance(explorer.state.home, {width: 40, height: 40}).catch(() => null)")
    assert "undecided" in page.wait()


def test_a_page_keeps_its_own_token(page):
    """The browser's storage may hold the token of a page of an earlier server at the same address."""
    page.run("Object.keys(localStorage).filter((key) => key.startsWith('kapitza /')).forEach((key) => "
             "localStorage.setItem(key, 'stale'))")
    assert page.module(
        "engine.js", "its.ask('state')") != "Error: the token is wrong; open the address that kapitza view has printed"
    page.run("explorer.state.change({pendulum: {...explorer.state.pendulum, m: '0.31'}})")
    assert "quick labels" in page.wait()


def test_a_story_of_other_keys_leaves_the_map_as_it_was(page):
    """At its end the map was opened with the names of the story's pendulum, and nothing moved any more."""
    page.run("explorer.state.change({map: 'on'})")
    axes = page.run("explorer.map.axes.map(({name}) => name)")
    page.press("tell")
    assert wait_for(lambda: page.run("$('stories').querySelectorAll('div button').length") == 7)
    page.run("$('stories').querySelectorAll('div button')[6].click()")
    assert page.run("explorer.state.pendulum.length") == "20 cm"
    page.key("Escape")
    assert page.run("explorer.map.axes.map(({name}) => name)") == axes
    page.run("explorer.state.change({map: 'off'})")


def test_the_bob_has_the_colour_of_its_end_where_nothing_moves(page):
    """Its motion may come before the list of attractors, which has the colour."""
    page.wait()
    assert wait_for(lambda: page.run("Boolean(explorer.basins.motion)"))
    colour = page.run("explorer.basins.panes[0].engine.catalogue.attractors.find(({name}) => "
                      "name === explorer.basins.motion.ending.name).colour")
    page.run("((its) => its.stage.draw(its.motion, 'pendulum', explorer.state.colours, its.units, "
             "null))(explorer.basins)")
    page.run("explorer.basins.panes[0].report()")
    drawn = """(([r, g, b]) => { const {data} = $('pendulum').getContext('2d').getImageData(0, 0, $('pendulum').width,
        $('pendulum').height);
        for (let i = 0; i < data.length; i += 4) if (data[i] === r && data[i + 1] === g
          && data[i + 2] === b) return true;
        return false; })(arguments[0])"""
    assert wait_for(lambda: page.run(drawn, [int(colour[at:at + 2], 16) for at in (1, 3, 5)]))


def test_an_axis_has_room_for_its_numbers(modules):
    """The title of the velocity lay over them; on a desk, and by the larger letters of a lecture."""
    script = """Promise.all(["window.js", "decimal.js"].map((name) => import("/" + name)))
        .then(([{Range, Window}, {Decimal}]) => [0.2, 2e-2, 3e-3, 2e-4, 1e-9].flatMap((width) => [1,
          1.35].map((letters) => {
        const range = (at) => new Range(Decimal.from(at - width / 2), Decimal.from(at + width / 2));
        const plane = new its.Plane(new Window(range(3), range(-0.1241)), 800, 600, letters);
        const context = document.createElement("canvas").getContext("2d");
        const size = (words) => { context.font = `${12 * letters}px "DejaVu Sans", "Helvetica Neue", Arial, sans-serif`;
            return context.measureText(words); };
        const found = {numbers: [], title: 0};
        its.drawAxes({theme: {}, line() {}, text(words, x, y, align, {turned} = {}) {
            if (turned) found.title = x + size(words).actualBoundingBoxDescent;
            else if (align === "right") found.numbers.push(x - size(words).width); }}, plane, its.axesOf("pi", null));
        return [Math.min(...found.numbers), found.title]; })))"""
    found = modules.module("plane.js", script)
    assert len(found) == 10 and all(number > title for number, title in found), found


def test_pages_that_still_ask_stay_admitted():
    """However many come after them: a lecturer's page is not locked out by those of the audience."""
    access = Access()
    first, silent = (access.trade(access.new_address()) for _ in range(2))
    for _ in range(40):
        assert access.admits(first) and access.admits(access.trade(access.new_address()))
    assert access.admits(first) and not access.admits(silent) and not access.admits(None)


def test_back_undoes_values_and_windows_one_hand_at_a_time(page):
    shown = "[explorer.state.pendulum.m, explorer.state.window.theta.width, explorer.state.past.length]"
    before = page.run(shown)
    for place in (0.1, 0.2, 0.3):
        page.slide("m", place)
    moved = page.run(shown)
    page.key("+")
    assert moved[0] != before[0] and moved[2] == 1 and page.run("explorer.state.past.length") == 2
    page.run("$('slider-m').dispatchEvent(new KeyboardEvent('keydown', {key: 'z', ctrlKey: true, bubbles: true, "
             "cancelable: true}))")
    assert page.run(shown) == moved
    page.press("back")
    assert page.run(shown) == before
    page.press("forward")
    assert page.run(shown) == moved and page.run("$('back').disabled") is False


def test_the_title_follows_the_pendulum(page):
    """"Well inside the stable zone" stood over pendulums far outside of it."""
    titles = "[$('title').textContent, document.title, explorer.state.shownTitle]"
    assert page.run(titles) == ["Stripes"] * 3
    page.choose("value-m", "0.05")
    assert page.run(titles) == ["m 0.05 instead of 0.3"] * 3
    page.choose("value-m", "0.3")
    assert page.run(titles) == ["Stripes"] * 3


def test_a_spectrum_without_lines_says_why(page):
    """It looked as if something had failed."""
    drawn = """(() => { const stage = explorer.basins.stage, said = [],
        own = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function (words, ...at) { said.push(words); own.call(this, words,
          ...at); };
        const motion = (amplitude) => ({ending: {period: 1}, spectrum: () => [[0, 0], [1, amplitude]]});
        stage.draw(motion(arguments[0]), 'spectrum', explorer.state.colours, explorer.basins.units, null);
        CanvasRenderingContext2D.prototype.fillText = own; return said.includes("At rest nothing moves:"); })"""
    assert [page.run(f"{drawn}(arguments[0])", amplitude) for amplitude in (1e-9, 0.1)] == [True, False]


def test_keys_work_while_a_menu_has_the_focus(page):
    press = """((target, key) => { document.querySelector(target).focus(); document.activeElement.dispatchEvent(
        new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true})); })(...arguments)"""
    width = page.run("explorer.state.window.theta.width")
    for target in (".menu summary", "#home", "#slider-m"):
        page.run(press, target, "+")
        assert page.run("explorer.state.window.theta.width") < width, target
        page.press("home")
    page.run(press, "#value-m", "+")  # a text keeps its own keys, as a button does
    page.run(press, "#slider-m", "ArrowRight")
    playing = page.run("explorer.state.playing")
    page.run(press, "#home", " ")
    assert page.run("[explorer.state.window.theta.width, explorer.state.playing]") == [width, playing]
    page.run("explorer.state.change({pendulum: explorer.state.scene})")


def test_a_start_is_told_in_few_digits_and_plain_words(page):
    page.hand(0.7, 0.5, 0.7, 0.5)
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    words = page.run("$('ending').textContent")
    assert "double" not in words and "decided: no rounding error can change this end" in words
    assert max(len(digits) for digits in re.findall(r"\.(\d+)", words)) <= 4, words
    deep = page.module("units.js", "new its.Units('pi', null).start({theta: '3.' + '1'.repeat(60), velocity: '1e-9'})")
    assert deep == ["3." + "1" * 39, "0"]  # a window 1e-35 wide


def test_no_program_stays_for_a_closed_page(page, striped):
    assert striped.children()
    page.driver.get("about:blank")
    assert wait_for(lambda: not striped.children())
