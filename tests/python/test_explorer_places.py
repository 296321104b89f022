"""Where the explorer's page says that a window lies, how it finds boundaries, its map, sliders, stories and tables, in a real browser over
the double of the program."""

import json
import re

import numpy as np
import pytest
from conftest import wait_for
from explorer_page import Page

pytest_plugins = ("explorer_page",)
TURN = 2 * np.pi


@pytest.mark.extensive
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


@pytest.mark.extensive
def test_a_plain_deep_picture_says_where_it_is_and_goes_to_a_boundary(page):
    page.run("explorer.state.change({window: explorer.state.window.zoomed(1e-7, 0.513, 0.4), jump: true})")
    page.wait()
    assert wait_for(lambda: not page.run("document.querySelector('.inset').hidden || document.querySelector('.offer').hidden"))
    width = page.run("explorer.state.window.theta.width")
    page.run("document.querySelector('.offer').click()")
    assert wait_for(lambda: len(page.shares()) > 1)
    page.wait()
    assert page.run("document.querySelector('.offer').hidden") and page.run("explorer.state.window.theta.width") == pytest.approx(width)
    page.run("document.querySelector('.inset').click()")
    assert page.window()["theta"]["min"] == pytest.approx(-np.pi) and wait_for(lambda: page.run("document.querySelector('.inset').hidden"))


def test_places_without_a_motion_have_a_shade_of_their_own(page):
    """Where a torque turns the pendulum round for ever, 0 motions had the shade of 1."""
    kinds = page.module("backdrop.js", """[0, 1].flatMap((least) => its.countPicture({lists: [0, 1, 2].slice(least), cells: 2,
        countOf: (list) => list + least, list: [0, 1, 1, 0]}, "light").kinds)""")
    assert [words for words, _ in kinds] == ["0 motions", "2 motions", "1 motion", "2 motions"] and kinds[0][1] == kinds[2][1]
    shade = page.module("backdrop.js", """[...its.countPicture({lists: [0, 1, 2], countOf: (list) => list, list: [0, 1, 2, 1], cells: 2},
        "light").canvas.getContext("2d").getImageData(1, 1, 1, 1).data]""")
    assert shade == [181, 209, 220, 255]


def test_the_relief_rises_inside_a_basin(page, webgl):
    """By times that vary smoothly, of fewer cells, and as far as those of the picture itself do."""
    page.wait()
    columns, raised, shades = page.run("""(({columns, rows, cells, raised}) => [columns, raised,
        new Set(Array.from({length: columns / 8}, (_, i) => cells[4 * i + 1])).size])(explorer.basins.panes[0].top)""")
    assert raised and shades > columns / 80
    low, high = page.module("heights.js", """its.heightsOf({cells: Array.from({length: 400}, (_, i) =>
        [i % 4 ? 0 : i === 0 ? 255 : 0, 50 + (i >> 2), 0, 0][i % 4])}, {own: true})""")
    assert (low, high) == (pytest.approx(52 / 255, abs=2 / 255), pytest.approx(140 / 255, abs=2 / 255))
    upper_left, lower_right = page.module("heights.js", """(() => { const n = 40, at = (row, column) => row * n + column;
        const smooth = Float32Array.from({length: n * n}, (_, i) => Math.hypot(i % n - 20, Math.floor(i / n) - 20));  // a hill
        const cells = new Uint8Array(4 * n * n).map((_, i) => i % 4 === 1 ? 25.5 * Math.log2(1 + smooth[i >> 2]) : 0);
        const frame = {rows: n, columns: n, labels: new Uint8Array(n * n), cells, smooth}; its.raise(frame, frame);
        return [at(26, 14), at(14, 26)].map((cell) => cells[4 * cell + 1]); })()""")
    assert upper_left < lower_right - 10  # light comes from the upper left


def test_cells_without_a_label_are_hatched_until_they_are_settled(modules):
    """Quick labels leave cells open; only exact ones say that a cell settles nowhere."""
    script = """(() => { const cells = new Uint8Array(64).fill(255); const planes = { labels: cells };
        const of = (quality) => its.countedShares({ labels: cells, quality, catalogue: { attractors: [] } })[0];
        return [of("moving").name, of("moving").hatched, of("exact").name, of("exact").hatched]; })()"""
    assert modules.module("frames.js", script) == ["not labelled yet", True, "not settled", False]


def test_the_pointer_reads_the_measures_of_the_basin_under_it(page):
    """Share, return time and, of exact labels, the mean settling time at once; the smallest push once the pointer rests."""
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
    assert wait_for(lambda: page.run("$('passport').textContent").startswith("upright rest: "))
    assert wait_for(lambda: "smallest push: beyond this window" in page.run("$('passport').textContent"))  # stripes along theta
    assert re.search(r"largest multiplier 0\.\d+, return time [\d.]+ drive periods; strobe", page.run("$('passport').textContent"))
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
        assert wait_for(lambda: page.window()["theta"]["min"] != -np.pi)  # the page takes a turn of the wheel with its next picture
        return page.window()["theta"]["min"]

    page.key("w")
    with page.screen(1280, 690):
        plain = edge()
        assert plain == pytest.approx(-np.pi + 0.3 * TURN * (1 - np.exp(-0.22)), abs=0.01)
        page.key("w")
        assert wait_for(lambda: edge() != plain)  # once the picture's labels are there


def test_the_point_of_the_map_is_the_pendulum(page):
    """The double of the program draws charts, and no atlas."""
    page.press("map-shown")
    assert wait_for(lambda: "No curves: wrong: no such key" in page.run("document.querySelector('#map .note').textContent"))
    listed = page.run("[...document.querySelectorAll('.kinds > span')].map((entry) => entry.textContent)")
    assert listed == ["inverted", "down nodding", "chaotic"]  # every colour of the chart
    assert "Motions not computed yet" in page.run("document.querySelector('.kinds').textContent")
    page.run("explorer.map.go([0.75, 0.5])")
    page.wait()
    assert page.run("[explorer.state.pendulum.k, explorer.state.pendulum.m]") == ["1", "0.375"]
    page.run("explorer.map.over.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp', bubbles: true, cancelable: true}))")
    assert page.run("[explorer.state.pendulum.m, explorer.map.place[1]]") == ["0.3825", pytest.approx(0.51)]
    ends = page.run("['#map .over', '.pane .over'].map((name) => document.querySelector(name).getBoundingClientRect().bottom)")
    assert ends[0] == ends[1]  # map and basins stand on one line
    refused = [entry["message"] for entry in page.driver.get_log("browser") if entry["level"] == "SEVERE"]
    assert all("/atlas " in message for message in refused)  # which the module's own look at the log would find, if this test is its last
    page.press("map-shown")
    assert page.run("$('map').hidden")


def test_basins_move_while_the_point_does_on_a_slow_machine(page):
    """A level takes 0.6 s, and the point moves every 30 ms: frames that were given up as soon as another was wanted never came."""
    assert page.driver.execute_async_script("""const done = arguments[0], pane = explorer.basins.panes[0], before = pane.latest; let n = 0;
        const hand = setInterval(() => { const pendulum = {...explorer.state.pendulum, m: String(5.6 + 1e-4 * n++)};
            const came = pane.latest !== before && pane.latest.key.includes('"5.6');
            if (came || n > 400) { clearInterval(hand); done(came); }
            explorer.state.change({pendulum}); }, 30)""")
    page.run("explorer.state.change({pendulum: explorer.state.scene})")
    page.wait()
    assert page.run("((pane) => (pane.most = 1e5, pane.measure(300), pane.measure(15), pane.most))(explorer.basins.panes[0])") == 72000


ATLAS = """(() => { const curve = { kind: "period_doubling", period: 1, words: "upright rest", name: "inverted", first: 0, points: 2 };
    const header = { max_period: 2, mirrored: true, cells: 2, points: 2, file: "f", low: [0, 2],
        width: [100, 2], curves: [curve], lists: [[[0, 1]], [[2, 1], [1, 1]]],
        classes: [{ name: "inverted", words: "upright rest", period: 1, symmetric: true },
                  { name: "flutter", words: "flutter", period: 2, symmetric: true },
                  { name: "rotation 2/2", words: "rotations 2/2", period: 2 }] };
    const bytes = new Uint8Array(42);  // a level line at y = 0.5, below which upright attracts
    new Float32Array(bytes.buffer, 0, 8).set([0, 1, 0.5, 0.5, 0, 0, -1, -1]);
    new Uint16Array(bytes.buffer, 32, 4).set([0, 0, 1, 1]);
    bytes.set([1, 1], 40); return [header, bytes]; })()"""


def test_crossing_a_curve_says_what_happens_and_sliders_mark_it(page):
    script = f"""const done = arguments[0]; Promise.all(["atlas", "happenings", "ground", "marks"].map((name) => import(`/${{name}}.js`)))
        .then(([atlas, happenings, ground, marks]) => {{ const map = new atlas.Atlas(...{ATLAS});
            const axes = [{{name: "q", unit: "", low: 0, high: 10}}, {{name: "a", unit: "mm", low: 0, high: 0.936}}];
            const turned = {{...map.curves[0], kind: "fold", words: "rotations 2/2"}};
            const turning = Object.assign(Object.create(map),
                {{crossed: (...way) => map.crossed(...way).map((one) => ({{...one, curve: turned}}))}});
            done([happenings.happening(map, [0.3, 0.2], [0.3, 0.9]), happenings.happening(map, [0.3, 0.9], [0.3, 0.2]),
                  happenings.happening(turning, [0.3, 0.2], [0.3, 0.9]),
                  happenings.happening(map, [0.3, 0.2], [0.6, 0.3]), map.motionsAt([0.1, 0.7])[1].words,
                  map.nearest([0.2, 0.52], [0.1, 0.1]).name,
                  ground.listedAt({{ atlas: map, axes, others: '{{"q":null,"a":null}}' }}, {{q: "5", a: "0.234 mm"}}),
                  ground.listedAt({{ atlas: map, axes, others: '{{"q":null,"a":null}}' }}, {{q: "5", a: "1 mm"}}),
                  marks.marksOf({{ atlas: map, axes }}, "a", {{q: "5", a: "0.3 mm"}}, "0.3 mm")[0].words]); }})"""
    up, down, turns, along, there, near, listed, outside, mark = page.driver.execute_async_script(script)
    assert up == "Flutter is born: upright rest loses its stability by period doubling"
    assert down == "Upright rest is stable again; flutter ends in it" and along == "" and (there, near) == ("flutter", "inverted")
    assert turns == "Rotations 2/2 end: they meet unstable motions (fold)"
    assert listed == {"atlas": "f", "x": 50, "y": pytest.approx(2.5)} and outside == {}  # by the numbers of the file
    assert mark == "0.468 mm: upright rest, period doubling"


def test_a_jump_over_several_curves_says_what_lives_at_its_ends(modules):
    """It named the first of 43 curves: "upright rest is stable again", beside a slider by which it does not stand."""
    script = f"""import("/happenings.js").then(({{happening}}) => {{ const map = new its.Atlas(...{ATLAS});
        const leans = {{...map.curves[0], kind: "rest_leans"}}, up = [[0.3, 0.2], [0.3, 0.9]], within = [[0.3, 0.7], [0.3, 0.9]];
        map.crossed = () => [map.curves[0], leans].map((curve) => ({{curve, point: 0, at: 0.5, into: true}}));
        const said = [up, up.toReversed(), within].map((way) => happening(map, ...way));
        map.classes.push({{name: "x", words: "x 5/5", period: 5}}, {{name: "y", words: "y 3/3", period: 3}});
        map.lists[1] = [3, 4, 2, 1].map((motion) => [motion, 1]);
        said.push(happening(map, ...up)); map.lists[0] = null; return [...said, happening(map, ...up)]; }})"""
    up, down, within, many, unknown = modules.module("atlas.js", script)
    assert up == "New here: rotations 2/2, flutter. Gone: upright rest" and down == "New here: upright rest. Gone: rotations 2/2, flutter"
    assert within == "" and many == "New here: rotations 2/2, flutter, y 3/3 and 1 more. Gone: upright rest"
    assert unknown == "What has changed is not known: a curve of the map is missing"


def test_sliders_know_their_unit_and_say_what_is_no_number(page):
    words = "[its.typed('9', '8 mm'), its.typed('1e1 cm', '8 mm'), its.typed('.5', '0.3'), its.typed('x', '0.3')]"
    assert page.module("sliders.js", words) == ["9 mm", "10 cm", "0.5", None]
    page.choose("value-m", "much")
    assert page.run("[$('message-m').textContent, explorer.state.pendulum.m]") == ["much is not a number; write for example 0.3", "0.3"]
    page.run("$('slider-m').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', cancelable: true}))")
    assert page.run("[$('slider-m').getAttribute('aria-valuetext'), $('message-m').textContent]") == [str(round(0.3 * 4**0.01, 6)), ""]
    page.run("$('slider-m').dispatchEvent(new MouseEvent('dblclick'))")
    assert page.run("explorer.state.pendulum.m") == "0.3"


@pytest.mark.parametrize("places, words", [
    ([20, 200], ["a 0.1", "b 2.3"]),
    ([20, 32], ["a 0.1, b 2.3"]),  # close together: one of two limits
    ([20, 32, 44], ["b 2.3", "c 4.5"]),
    ([150, 290], ["a 0.1", "b 2.3"]),
    ([290, 296, 299], ["a 0.1, b 2.3"]),
    ([], []),
])
def test_words_of_limits_never_touch(modules, places, words):
    """They lay over each other where upright loses stability and gains it again nearby."""
    laid = modules.module("marks.js", f"""(() => {{ const names = ["a 0.1", "b 2.3", "c 4.5"], wide = (words) => 7 * words.length;
        const limits = {json.dumps(places)}.map((x, i) => ({{x, words: names[i], below: i % 2 === 0}}));
        return its.laidOut(limits, wide, [-8, 308]).map(({{first, last, left, words}}) =>
            [words, left ? limits[first].x - 4 - wide(words) : limits[last].x + 4, wide(words)]); }})()""")
    assert [text for text, _, _ in laid] == words
    edges = [edge for _, left, wide in laid for edge in (left, left + wide)]
    assert edges == sorted(edges) and all(-8 <= edge <= 308 for edge in edges)


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
        .filter((part) => part.offsetParent && part.checkVisibility({visibilityProperty: true}) && !part.closest(".menu > div"))
        .map((part) => [part.id || part.textContent, part.getBoundingClientRect()])
        .filter(([, box]) => Math.min(box.width, box.height) < 44 || box.left < 0 || box.right > innerWidth).map(([name]) => name)"""
    for width in (390, 360):
        with page.screen(width, 800, mobile=True):
            if width == 390:
                _ = page.press("map-shown"), page.press("values-shown")
            assert wait_for(lambda: page.run(script) == []), (width, page.run(script))
            page.run("document.body.dataset.story = 'told'")  # its sentence is as wide as the screen, and in sight
            sentence = page.run("(({width, bottom}) => [width, bottom])($('story-words').getBoundingClientRect())")
            page.run("delete document.body.dataset.story")
            assert sentence[0] > width - 40 and sentence[1] <= 800


def test_stories_are_told_by_keys_and_leave_the_page_as_it_was(page):
    before = page.run("[explorer.state.pendulum, explorer.state.view]")
    page.key("s")
    assert wait_for(lambda: len(page.run("[...$('stories').querySelectorAll('div button')]")) == 6)
    page.run("$('stories').querySelector('div button').click()")
    assert page.run("[$('story-place').textContent, explorer.state.pendulum.quality_factor]") == ["1 / 5", "5"]
    _ = page.key("ArrowRight"), page.key("PageDown")
    assert page.run("[$('story-place').textContent, explorer.state.view]") == ["3 / 5", "trace"]
    assert wait_for(lambda: page.run("explorer.state.pendulum.drive_amplitude") == "0.3")  # it went there in steps
    page.key("PageUp")
    assert page.run("explorer.state.view") == "pendulum"
    page.key("Escape")
    assert page.run("[explorer.state.pendulum, explorer.state.view]") == before and page.run("document.body.dataset.story ?? null") is None
    page.wait()


@pytest.mark.extensive
def test_releases_of_a_table_are_compared(page):
    text = "theta_deg;velocity;end\\n5.7;0;hanging\\n-17.2;0;flutter\\n28.6;0;upright"
    page.run(f"""(() => {{ const data = new DataTransfer(); data.items.add(new File(["{text}"], "mine.csv"));
        $('panes').dispatchEvent(new DragEvent("drop", {{dataTransfer: data, cancelable: true}})); }})()""")
    assert wait_for(lambda: page.run("$('agreement').textContent").count("agree") == 3)
    assert page.run("$('agreement').textContent").split("\n")[0].startswith("hanging: ")
    wrong = page.module("table.js", "(() => { try { its.releasesOf('a,b', null) } catch (error) { return error.message } })()")
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
    assert page.module("heights.js", "[-5, -4, 0, 1, 2, 3, NaN].map(its.shadeOfTurns)") == pytest.approx([1, 0, 0, 1 / 3, 2 / 3, 1, 0])
