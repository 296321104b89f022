"""Where the explorer's page says that a window lies, how it finds boundaries, its sliders, stories and tables, in a
real browser over the double of the program."""

import re

import numpy as np
import pytest
from conftest import wait_for
from explorer_page import Page

pytest_plugins = ("explorer_page",)
TURN = 2 * np.pi


@pytest.mark.extensive
def test_inverted_is_in_the_middle_until_another_choice_which_is_remembered(driver, striped):
    driver.get("about:blank")
    driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
    first = Page(driver, striped.address())
    first.wait()
    assert [first.window()["theta"][edge] for edge in ("min", "max")] == pytest.approx([0, TURN])
    first.choose("middle", "down")
    assert first.window()["theta"]["min"] == pytest.approx(-np.pi)
    again = Page(driver, striped.address())
    again.wait()
    assert again.window()["theta"]["min"] == pytest.approx(-np.pi) and again.run("$('middle').value") == "down"
    driver.get("about:blank")


@pytest.mark.extensive
def test_a_plain_deep_picture_says_where_it_is_and_goes_to_a_boundary(page):
    page.run("explorer.state.change({window: explorer.state.window.zoomed(1e-7, 0.513, 0.4), jump: true})")
    page.wait()
    assert wait_for(
        lambda: not page.run("document.querySelector('.inset').hidden || document.querySelector('.offer').hidden"))
    width = page.run("explorer.state.window.theta.width")
    page.run("document.querySelector('.offer').click()")
    assert wait_for(lambda: len(page.shares()) > 1)
    page.wait()
    assert page.run("document.querySelector('.offer').hidden")
    assert page.run("explorer.state.window.theta.width") == pytest.approx(width)
    page.run("document.querySelector('.inset').click()")
    assert page.window()["theta"]["min"] == pytest.approx(-np.pi)
    assert wait_for(lambda: page.run("document.querySelector('.inset').hidden"))


def test_the_relief_rises_inside_a_basin(page, webgl):
    """By times that vary smoothly, of fewer cells, and as far as those of the picture itself do."""
    page.wait()
    columns, raised, shades = page.run("""(({columns, rows, cells, raised}) => [columns, raised,
        new Set(Array.from({length: columns / 8}, (_, i) => cells[4 * i + 1])).size])(explorer.basins.panes[0].top)""")
    assert raised and shades > columns / 80
    upper_left, lower_right = page.module("heights.js", """(() => { const n = 40, at = (row,
        column) => row * n + column;
        const smooth = Float32Array.from({length: n * n}, (_, i) => Math.hypot(i % n - 20, Math.floor(i / n) - 20));
          // a hill
        const cells = new Uint8Array(4 * n * n).map((_, i) => i % 4 === 1 ? 25.5 * Math.log2(1 + smooth[i >> 2]) : 0);
        const frame = {rows: n, columns: n, labels: new Uint8Array(n * n), cells, smooth}; its.raise(frame, frame);
        return [at(26, 14), at(14, 26)].map((cell) => cells[4 * cell + 1]); })()""")
    assert upper_left < lower_right - 10  # light comes from the upper left


def test_a_line_of_the_list_has_the_colour_of_its_basin_with_and_without_relief(page, webgl):
    """Relief darkened the blue of the picture by a fifth, beside a patch that stayed."""
    page.choose("shade", "relief")
    page.wait()
    assert wait_for(lambda: page.run("Boolean(explorer.basins.panes[0].top.raised)"))
    raised = np.array(page.pixels())[:, :3]
    page.choose("shade", "none")
    page.wait()
    flat = np.array(page.pixels())[:, :3]
    plain, counts = np.unique(flat, axis=0, return_counts=True)
    listed = page.run("explorer.basins.panes[0].engine.catalogue.attractors.map(({colour}) => colour)")
    for colour in plain[np.argsort(counts)[-len(listed):]]:
        here = np.all(flat == colour, axis=1)
        assert "#" + bytes(colour.tolist()).hex() in listed and np.abs(raised[here].mean(axis=0) - colour).max() < 8


def test_cells_without_a_label_are_hatched_until_they_are_settled(modules):
    """Quick labels leave cells open; only exact ones say that a cell settles nowhere."""
    script = """(() => { const cells = new Uint8Array(64).fill(255); const planes = { labels: cells };
        const of = (quality) => its.countedShares({ labels: cells, quality, catalogue: { attractors: [] } })[0];
        return [of("moving").name, of("moving").hatched, of("exact").name, of("exact").hatched]; })()"""
    assert modules.module("frames.js", script) == ["not labelled yet", True, "not settled", False]


def test_the_pointer_reads_the_measures_of_the_basin_under_it(page):
    """Share, return time and, of exact labels, the mean settling time at once; the smallest push once the pointer
    rests."""
    page.choose("quality", "exact")
    page.wait()
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.25, 0.75])")
    measures = r": [\d.]+ % of this window, settles in [\d.]+ drive periods \(mean\), return time [\d.]+ drive periods"
    assert wait_for(lambda: re.search(measures, page.run("$('pointer').textContent")))
    assert wait_for(lambda: "smallest push" in page.run("$('pointer').textContent"))
    words = page.module("passport.js", """its.measureWords({share: 0.5, settling: 20, period: 1, multiplier: 0.5}, "",
        {time: (periods) => `${periods / 50} s`})""")
    assert words.endswith("settles in 0.4 s (mean), return time 0.0288 s")


@pytest.mark.extensive
def test_the_list_lights_a_basin_and_keeps_the_one_that_is_clicked(page, webgl):
    page.choose("shade", "none")  # one colour a basin
    page.wait()
    plain = np.unique(np.array(page.pixels()), axis=0).tolist()
    page.run("document.querySelector('#legend tr:nth-child(2) button').click()")
    assert page.run("[explorer.state.pinned, explorer.state.lit]") == ["inverted 1", "inverted 1"]
    lit = np.unique(np.array(page.pixels()), axis=0).tolist()
    assert sum(colour in plain for colour in lit) == 1 and len(lit) == len(plain) > 1  # one keeps its colour
    assert wait_for(lambda: page.run("$('passport').textContent").startswith("inverted: "))
    # Stripes along theta
    assert wait_for(lambda: "smallest push: beyond this window" in page.run("$('passport').textContent"))
    assert re.search(r"largest multiplier 0\.\d+, return time [\d.]+ drive periods; strobe",
                     page.run("$('passport').textContent"))
    assert "closes after 1 drive period;" in page.run("$('passport').textContent")
    assert page.run("explorer.state.start.theta") == "0.135"
    page.run("document.querySelector('#legend tr:nth-child(2) button').click()")
    assert page.run("explorer.state.lit") is None and np.unique(np.array(page.pixels()), axis=0).tolist() == plain
    assert wait_for(lambda: page.run("$('passport').hidden"))


def test_a_zoom_into_one_colour_goes_on_to_the_nearest_boundary(page):
    """Unless it is switched off; a zoom that sees a boundary goes where the hand goes."""
    stripe = """(({labels, columns: n}) => { const line = [...labels.slice(0, n)];
        const edges = line.flatMap((one, i) => i && one !== line[i - 1] ? [i / n] : []);
        const [a, b] = edges.slice(1).map((edge, i) => [edges[i], edge]).sort(([a, b], [c, d]) => d - c - b + a)[0];
        return (a + b) / 2; })(explorer.basins.panes[0].top)"""
    base = "explorer.state.change({window: explorer.state.home.zoomed(0.05, 0.6, 0.5), jump: true})"
    page.run(base)
    page.wait()
    middle, wide = page.run(stripe), 0.05 * TURN  # middle and width of the widest stripe
    start = page.window()["theta"]["min"] + middle * wide

    def zoomed(factor):
        page.run(base)
        page.wait()
        page.run("explorer.basins.zoom(arguments[0], arguments[1], 0.5)", factor, middle)
        page.wait()
        return page.window()["theta"], len(page.shares())

    window, labels = zoomed(0.04)
    assert labels > 1 and window["max"] - window["min"] == pytest.approx(0.04 * wide, rel=1e-3)
    page.key("w")
    assert not page.run("$('drawn').checked")
    window, labels = zoomed(0.04)
    assert labels == 1 and window["min"] < start < window["max"]
    assert not page.run("document.querySelector('.offer').hidden")
    page.key("w")
    zoomed(1e-4)  # fewer cells of the picture than are known: the boundary is found by the program
    assert wait_for(lambda: len(page.shares()) > 1)
    page.wait()
    page.press("home")
    assert page.window()["theta"]["min"] == pytest.approx(-np.pi) and len(page.shares()) > 1


def test_basins_move_while_the_point_does_on_a_slow_machine(page):
    """A level takes 0.6 s, and the point moves every 30 ms: frames that were given up as soon as another was wanted
    never came."""
    assert page.driver.execute_async_script("""const done = arguments[0], pane = explorer.basins.panes[0],
        before = pane.latest; let n = 0;
        const hand = setInterval(() => { const pendulum = {...explorer.state.pendulum, m: String(5.6 + 1e-4 * n++)};
            const came = pane.latest !== before && pane.latest.key.includes('"5.6');
            if (came || n > 400) { clearInterval(hand); done(came); }
            explorer.state.change({pendulum}); }, 30)""")
    page.run("explorer.state.change({pendulum: explorer.state.scene})")
    page.wait()
    assert page.run("((pane) => (pane.most = 1e5, pane.measure(300), pane.measure(15), "
                    "pane.most))(explorer.basins.panes[0])") == 72000


def test_sliders_know_their_unit_and_say_what_is_no_number(page):
    words = "[its.typed('9', '8 mm'), its.typed('1e1 cm', '8 mm'), its.typed('.5', '0.3'), its.typed('x', '0.3')]"
    assert page.module("sliders.js", words) == ["9 mm", "10 cm", "0.5", None]
    page.choose("value-m", "much")
    assert (page.run("[$('message-m').textContent, explorer.state.pendulum.m]")
            == ["much is not a number; write for example 0.3", "0.3"])
    page.run("$('slider-m').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', cancelable: true}))")
    assert page.run("[$('slider-m').getAttribute('aria-valuetext'), $('message-m').textContent]") == [
        str(round(0.3 * 4**0.01, 6)), ""]
    page.run("$('slider-m').dispatchEvent(new MouseEvent('dblclick'))")
    assert page.run("explorer.state.pendulum.m") == "0.3"


def test_the_track_of_a_slider_says_what_a_start_does_along_it(page):
    """The double's chart has three motions in turn; words stand where there is room, and do not touch."""
    script = """const done = arguments[0]; import("/track.js").then(async (its) => { const engine = explorer.map.engine;
        const {scene} = explorer.state, stretches = await its.stretchesOf(engine, "m", scene, scene.m);
        const range = document.createElement("input"), marks = document.createElement("div");
        marks.className = "marks"; marks.style.cssText = "position: fixed; width: 300px; margin: 0";
          document.body.append(marks);
        its.drawTrack({range, marks}, [["falls", 0, 0, 0.2], ["stands", 0.1294, 0.2, 0.66], ["flutters", 0.468, 0.66,
          0.7],
            ["turns", 0.5, 0.7, 0.71], ["turns", 0.54, 0.71, 1]].map(([words, number, from, to]) => ({words, number,
              from, to})));
        const words = [...marks.children].map((mark) => [mark.textContent, mark.offsetLeft]); marks.remove();
        done([stretches.map(({words, from, to}) => [words, from, to]), words,
          range.style.getPropertyValue("--track")]); })"""
    stretches, words, track = page.driver.execute_async_script(script)
    # Stretches of 20 cells each, two thirds of which fall
    assert len(stretches) == 14 and {one[0] for one in stretches} == {"stands", "falls"}
    assert stretches[0][1] == 0 and stretches[-1][2] == 1
    assert all(one[2] == two[1] for one, two in zip(stretches, stretches[1:], strict=False))
    assert [text for text, _ in words] == ["falls", "stands 0.13",
                                           "flutters"] and words[1][1] == 60 and words[2][1] == 198
    assert track.startswith("linear-gradient(to right, var(--down) 0% 20%") and "var(--flutter) 66% 70%" in track


def test_a_slider_moves_there_and_back_until_it_is_stopped(page):
    press = "[...document.querySelectorAll('.sweep')].find((button) => button.title.includes(' m ')).click()"
    values = set()
    page.run(press)
    assert wait_for(lambda: values.add(page.run("explorer.state.pendulum.m")) or len(values) > 4)
    assert page.run("[...document.querySelectorAll('.sweep[aria-pressed=true]')].length") == 1
    page.key("Escape")
    assert wait_for(lambda: page.run("[...document.querySelectorAll('.sweep[aria-pressed=true]')].length") == 0)
    assert page.run("explorer.state.pendulum.m") != "0.3"  # it stays where it is
    page.key("Backspace")
    assert page.run("explorer.state.pendulum.m") == "0.3"
    page.run(press)
    page.slide("k", 0.1)  # a hand ends it
    assert wait_for(lambda: page.run("[...document.querySelectorAll('.sweep[aria-pressed=true]')].length") == 0)


def test_the_pointer_is_read_on_both_axes(page):
    """With more digits than the ticks, in deep windows too."""
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.25, 0.75])")
    assert page.run("explorer.basins.panes[0].plain.pointed") == [0.25, 0.75]
    words = "its.ticksOf(explorer.state.window.{}, 8, {}).wordsAt({})"
    assert page.module("ticks.js", words.format("theta", "{inPi: true}", 0.25)) == "−0.500π"
    assert page.module("ticks.js", words.format("velocity", "{}", 0.75)) == "1.000"
    page.run("explorer.basins.zoom(1e-12, 0.3, 0.3)")
    assert re.fullmatch(r"−?[\d.]+", page.module("ticks.js", words.format("theta", "{inPi: true}", 0.5)))


def test_a_phone_reaches_every_control(page):
    """Film and ? lay beyond the edge of the bar."""
    script = """[...document.querySelectorAll("button, select, input:not([type=file], [type=checkbox]), summary")]
        .filter((part) => part.offsetParent && part.checkVisibility({visibilityProperty: true})
          && !part.closest(".menu > div"))
        .map((part) => [part.id || part.name || part.textContent,
          (part.type === "radio" ? part.parentElement : part).getBoundingClientRect()])
        .filter(([, box]) => Math.min(box.width,
          box.height) < 44 || box.left < 0 || box.right > innerWidth).map(([name]) => name)"""
    for width in (390, 360):
        with page.screen(width, 800, mobile=True):
            for level in ("look", "explore", "measure"):
                page.run("document.querySelector(`#levels [value=${arguments[0]}]`).click()", level)
                if width == 390 and level != "look":
                    page.run("$('map').hidden && $('map-shown').click()")
                    page.run("document.body.dataset.filled || $('values-shown').click()")
                assert wait_for(lambda: page.run(script) == []), (width, level, page.run(script))
            page.run("document.body.dataset.story = 'told'")  # its sentence is as wide as the screen, and in sight
            sentence = page.run("(({width, bottom}) => [width, bottom])($('story-words').getBoundingClientRect())")
            page.run("delete document.body.dataset.story")
            assert sentence[0] > width - 40 and sentence[1] <= 800


def test_stories_are_told_by_keys_and_leave_the_page_as_it_was(page):
    before = page.run("[explorer.state.pendulum, explorer.state.view, explorer.state.level]")
    page.key("s")
    assert wait_for(lambda: len(page.run("[...$('stories').querySelectorAll('div button')]")) == 7)
    page.run("$('stories').querySelectorAll('div button')[1].click()")
    told = "[$('story-place').textContent, explorer.state.pendulum.quality_factor, explorer.state.level]"
    assert page.run(told) == ["1 / 5", "5", "look"]
    _ = page.key("ArrowRight"), page.key("PageDown")
    assert page.run("[$('story-place').textContent, explorer.state.view]") == ["3 / 5", "trace"]
    assert wait_for(lambda: page.run("explorer.state.pendulum.drive_amplitude") == "0.3")  # it went there in steps
    page.key("PageUp")
    assert page.run("explorer.state.view") == "pendulum"
    page.key("Escape")
    assert page.run("[explorer.state.pendulum, explorer.state.view, explorer.state.level]") == before
    assert page.run("document.body.dataset.story ?? null") is None
    page.wait()


@pytest.mark.extensive
def test_releases_of_a_table_are_compared(page):
    text = "theta_deg;velocity;end\\n5.7;0;hanging\\n-17.2;0;flutter\\n28.6;0;upright"
    page.run(f"""(() => {{ const data = new DataTransfer(); data.items.add(new File(["{text}"], "mine.csv"));
        $('panes').dispatchEvent(new DragEvent("drop", {{dataTransfer: data, cancelable: true}})); }})()""")
    assert wait_for(lambda: page.run("$('agreement').textContent").count("agree") == 3)
    assert page.run("$('agreement').textContent").split("\n")[0].startswith("hanging: ")
    wrong = page.module("table.js",
                        "(() => { try { its.releasesOf('a,b', null) } catch (error) { return error.message } })()")
    assert wrong.startswith("a table of releases needs a head")
    page.choose("spread", "10")
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.5, 0.5])")
    shares = [int(share) for share in re.findall(r"(\d+) %", page.run("$('pointer').textContent"))]
    assert len(shares) > 1 and sum(shares) == pytest.approx(100, abs=2)
    page.run("$('releases-gone').click()")
    assert page.run("$('agreement').textContent") == ""


def test_turns_shade_the_labels(page, webgl):
    """Of eight stripes of turns neighbours differ, also where their label is the same; four shades in all."""
    page.choose("shade", "none")
    page.choose("quality", "exact")
    page.wait()
    plain = len(np.unique(np.array(page.pixels()), axis=0))
    page.choose("shade", "turns")
    page.wait()
    assert len(np.unique(np.array(page.pixels()), axis=0)) > plain
    assert (page.module("heights.js", "[-5, -4, 0, 1, 2, 3, NaN].map(its.shadeOfTurns)")
            == pytest.approx([1, 0, 0, 1 / 3, 2 / 3, 1, 0]))
