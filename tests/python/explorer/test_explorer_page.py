"""The explorer's page in a real browser: numbers of its modules, hands and keys, what is drawn, what it saves. Most of
it stands on the double of the engine (tests/tools/striped_view.py), whose basins are stripes along theta."""

import json
import re
import xml.etree.ElementTree as ElementTree
import zipfile

import matplotlib.image
import mpmath
import numpy as np
import pytest
import yaml
from conftest import wait_for
from explorer_page import Page
from kapitza.explorer.picture import scene_in

pytest_plugins = ("explorer_page",)
TURN = 2 * np.pi
BLURRED = "document.querySelector('.pane').classList.contains('stale')"
mpmath.mp.dps = 120


# ---- modules ----


def test_windows_are_counted_in_all_their_digits(modules):
    assert modules.module("decimal.js", "its.turn(110).toString()") == mpmath.nstr(2 * mpmath.pi, 111)
    text = modules.module("decimal.js", "its.Decimal.from('-1.25e-3').plus(its.Decimal.from('1e-40')).toString()")
    assert text == "-0.001249" + "9" * 34
    deep = """(() => { let w = its.Window.from({theta: {min: -3, max: 3}, velocity: {min: -2, max: 2}});
        for (let i = 0; i < 90; i++) w = w.zoomed(0.1, 0.31, 0.77);
        return [w.theta.width, w.theta.centre.toString(), w.moved(0.25, 0).moved(-0.25,
          0).theta.low.minus(w.theta.low).toString(),
                w.placeOf(w.moved(0.5, 0)).left, JSON.stringify(w.toRequest())]; })()"""
    width, centre, back, left, request = modules.module("window.js", deep)
    assert width == pytest.approx(6e-90) and back == "0" and left == pytest.approx(0.5)
    point = -3 + mpmath.mpf(repr(6 * 0.31))  # stays where it is
    assert abs(mpmath.mpf(centre) - point) < mpmath.mpf("6e-90") and json.loads(request)["theta"]["centre"] == centre


def test_windows_have_bounds_and_wrap(modules):
    script = """(() => { const w = its.Window.from({theta: {min: -3.14159, max: 3.14159}, velocity: {min: -2, max: 2}});
        const out = w.zoomed(50, 0.5, 0.5), far = out.moved(3.25, 0).wrapped(); let deep = w;
        for (let i = 0; i < 60; i++) deep = deep.zoomed(0.01, 0.5, 0.5);
        const most = w.zoomed(3000, 0.5, 0.4).moved(0, 0.9).zoomed(0.5, 0.5, 1).moved(0, -0.2);
        const edges = [most, most.moved(0, 0.3), most.zoomed(9, 0.5, 0)].map((one) => one.toRequest().velocity);
        return [out.theta.width, out.velocity.width, far.theta.centre.toNumber(), deep.theta.width, edges]; })()"""
    width, fast, centre, deep, edges = modules.module("window.js", script)
    assert edges == [{"min": 2800, "max": 8800}, {"min": 4000, "max": 10000}, {"min": -10000, "max": 10000}]
    assert width == pytest.approx(TURN) and fast == pytest.approx(200) and centre == pytest.approx(0.25 * TURN)
    assert 1e-100 <= deep < 1e-97


@pytest.mark.parametrize("width", ["3", "0.02", "1e-5", "3e-13", "7e-40", "2e-99"])
def test_ticks_differ_and_lie_where_they_say(modules, width):
    """1e-5, 1e-5 stood twice on an axis."""
    axis = json.dumps({"centre": "-1.2345678901234567890123", "width": width})
    found = modules.driver.execute_async_script(f"""const done = arguments[0]; Promise.all([import('/ticks.js'),
        import('/window.js')])
        .then(([ticks, window]) => done(ticks.ticksOf(window.Range.from({axis}), 8)))""")
    words = [tick["words"] for tick in found["ticks"]]
    assert 3 <= len(words) == len(set(words)) and not any(re.search("e", word) for word in words)
    origin, unit = re.fullmatch(r"(.*) \+ n × (.*)", found["origin"]).groups() if found["origin"] else ("0", "1")
    low = mpmath.mpf("-1.2345678901234567890123") - mpmath.mpf(width) / 2
    for tick in found["ticks"] if "…" not in origin else []:
        value = number(origin) + number(tick["words"]) * number(unit)
        assert abs((value - low) / mpmath.mpf(width) - tick["share"]) < 1e-6


def number(text):
    return mpmath.mpf(text.replace("−", "-"))


# ---- hands and keys ----


def test_the_wheel_zooms_by_distance_not_by_events(page):
    """A trackpad's 25 events of 4 px are one notch of 100 px, about the place under the pointer."""
    page.wheel(0.3, 0.6, *[-4] * 25)
    many = page.window()
    page.press("home")
    page.wheel(0.3, 0.6, -100)
    one = page.window()
    width = one["theta"]["max"] - one["theta"]["min"]
    assert 1.2 < TURN / width < 1.35 and many["theta"]["max"] - many["theta"]["min"] == pytest.approx(width)
    assert one["theta"]["min"] + 0.3 * width == pytest.approx(-np.pi + 0.3 * TURN, abs=0.005)


def test_two_fingers_zoom_about_the_place_between_them(page):
    """Touches of the browser itself: from 80 to 160 px apart is a zoom of 2."""
    left, top, wide, high = page.run("(() => { const box = explorer.basins.panes[0].over.getBoundingClientRect(); "
                                     "return [box.left, box.top, box.width, box.height]; })()")
    before = page.window()["theta"]
    for kind, apart in (("touchStart", 40), ("touchMove", 50), ("touchMove", 80), ("touchEnd", None)):
        points = [{"x": left + wide / 2 + side * apart, "y": top + high / 2, "id": max(side, 0)}
                  for side in (-1, 1)] if apart else []
        page.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    after = page.window()["theta"]
    assert after["max"] - after["min"] == pytest.approx((before["max"] - before["min"]) / 2, rel=1e-6)


def test_axes_in_degrees_and_si(page):
    """Of a pivot at 50 Hz: a velocity of 0.01 rad per drive radian is pi rad/s."""
    page.choose("units", "degrees")
    assert wait_for(lambda: "units=degrees" in page.run("location.hash"))
    words = page.module("plane.js",
                        "[its.axesOf('degrees', null).theta.words, its.axesOf('si', 100 * Math.PI).velocity.words]")
    assert "degrees" in words[0] and "rad/s" in words[1]
    assert page.module("plane.js",
                       "0.01 * its.axesOf('si', 100 * Math.PI).velocity.factor(1).toNumber()") == pytest.approx(np.pi)


def test_starts_are_told_in_the_units_of_the_axes(page):
    """Of a pivot at 50 Hz a drive period is 0.02 s."""
    page.run("explorer.state.change({pivotFrequency: 100 * Math.PI})")
    page.hand(0.7, 0.5, 0.7, 0.5)
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    words = page.run("$('ending').textContent")
    assert "certain after 12 drive periods, within 1° after 30 drive periods" in words and "rad/s" not in words
    page.run("explorer.state.change({units: 'si'})")
    words = page.run("$('ending').textContent")
    assert "certain after 0.24 s, within 1° after 0.6 s" in words and re.search(r"velocity \S+ rad/s", words)
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.25, 0.75])")
    assert wait_for(lambda: "rad/s" in page.run("$('pointer').textContent"))
    assert "after" not in page.run("$('pointer').textContent")
    page.run("explorer.state.change({units: 'degrees'})")
    assert wait_for(lambda: page.run("$('pointer').textContent").startswith("θ −90"))
    assert "°" in page.run("$('ending').textContent")


def test_dragging_wraps_the_angle_and_moves_the_picture_at_once(page, webgl):
    page.driver.execute_script("explorer.basins.panes[0].pursue = () => {}")  # no new frame: the old one is moved
    before = np.array(page.pixels())
    for _ in range(3):
        page.hand(0.9, 0.5, 0.4, 0.5)
    window = page.window()["theta"]
    assert window["min"] == pytest.approx(-np.pi + 1.5 * TURN - TURN,
                                          abs=0.05) and window["max"] - window["min"] == pytest.approx(TURN)
    after = np.array(page.pixels())
    assert np.all(after[:, 3] == 255) and np.any(before != after)  # the picture goes round: nothing is empty


def test_keys_do_what_hands_do(page):
    for key in ("+", "+", "ArrowRight", "ArrowUp"):
        page.key(key)
    window = page.window()["theta"]
    width = TURN / 1.6**2
    assert window["max"] - window["min"] == pytest.approx(width)
    assert window["min"] + window["max"] == pytest.approx(width / 4)
    page.key("Enter")
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    page.key(" ")
    assert page.run("explorer.state.playing") is False
    for key in ("Backspace", "Backspace", "h"):
        page.key(key)
    assert page.window()["theta"]["min"] == pytest.approx(-np.pi)
    _ = page.key("c"), page.key("m")
    assert page.run("[document.querySelectorAll('.pane').length, $('map').hidden]") == [2, False]
    page.key("?")
    listed = page.run("[...$('keys').querySelectorAll('dt')].map((key) => key.textContent)")
    assert page.run("$('help').open") and {"n", "w", "space", "Enter", "?"} <= set(listed)


@pytest.mark.extensive
def test_dive_goes_to_a_boundary_between_two_starts(page):
    page.press("dive")
    for across in np.linspace(0.52, 0.58, 7):
        page.hand(across, 0.5, across, 0.5)
        page.wait()
        if page.run("!explorer.basins.onClick"):
            break
    assert wait_for(lambda: page.run("explorer.state.window.theta.width") < 1e-3)
    page.key("Escape")
    page.wait()
    width = page.run("explorer.state.window.theta.width")
    assert len(page.shares()) > 1 and width < 1e-3 and page.run("$('dive').getAttribute('aria-pressed')") == "false"
    _ = page.press("dive"), page.key("Escape")
    assert page.run("[$('dive').getAttribute('aria-pressed'), $('status').textContent.includes('Dive')]") == ["false",
                                                                                                              False]


def test_escape_ends_a_film(page):
    page.choose("film-count", "200")
    page.press("film-play")
    before = page.run("explorer.state.pendulum.m")
    assert wait_for(lambda: page.run("explorer.state.pendulum.m") != before)
    page.key("Escape")
    assert wait_for(lambda: page.run("$('film-play').textContent")
                    == "Play") and page.run("explorer.state.pendulum.m") == "0.3"
    page.wait()


# ---- what is shown ----


def test_the_pendulum_moves_from_the_first_second_and_shows_its_motion_in_other_ways(page):
    """Unless the reader's system asks for pictures that stand still, as the browser of these tests does."""
    assert wait_for(lambda: page.run("explorer.basins.motion?.at === 0 && !explorer.state.playing"))
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                {"features": [{"name": "prefers-reduced-motion", "value": "no-preference"}]})
    page.driver.refresh()
    assert wait_for(lambda: page.run("window.explorer?.basins.motion?.at > 2"))  # nothing was clicked
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    ticks = page.module("plot.js", """its.apart(its.fractionTicks(3, 6).map(({at, words, rank}) =>
        ({x: 400 * at, wide: 7 * words.length, words, rank}))).sort((a, b) => a.x - b.x)""")
    words = [tick["words"] for tick in ticks]
    assert {"0", "1", "2", "3", "1/2", "1/6"} <= set(words)
    assert all(two["x"] - one["x"] >= (one["wide"] + two["wide"]) / 2 for one,
               two in zip(ticks, ticks[1:], strict=False))
    line = page.module("motion.js", """(() => { const n = 48, answer = (periods, rest) => {
            const samples = periods * n + 1, numbers = new Float64Array(2 * samples);
              // half of the drive's frequency, and a rest
            for (let i = 0; i < samples; i++)
              numbers[samples + i] = 0.3 * Math.cos((Math.PI * i) / n) + rest * Math.exp(-i / (20 * n));
            return [{ samples, samples_per_period: n, pivot: [] }, new Uint8Array(numbers.buffer)]; };
        const motion = new its.Motion(...answer(40, 1), { period: 2, settling_time: 4, near_time: 6 }, answer(2, 0));
        return motion.spectrum(3).filter(([, amplitude]) => amplitude > 1e-9); })()""")
    assert line == [pytest.approx([0.5, 0.3])]
    drawn = set()
    for tab in page.driver.find_elements("css selector", "#views button"):
        tab.click()
        assert tab.get_attribute("aria-selected") == "true"
        drawn.add(page.run("$('pendulum').toDataURL()"))
    assert len(drawn) == 5
    for key, gone in (("f", "aside"), ("p", "#panes")):
        page.key(key)
        assert page.run("getComputedStyle(document.querySelector(arguments[0])).display", gone) == "none"
        page.key(key if key == "p" else "f")
    assert page.run("document.body.dataset.filled") == ""


def test_a_reload_keeps_the_view_and_the_address_has_no_token(page, striped):
    page.wheel(0.3, 0.6, -900)
    _ = page.slide("m", 0.4), page.choose("units", "degrees"), page.wait()
    window, shares = page.window(), page.shares()
    assert wait_for(lambda: "units=degrees" in page.driver.current_url and "pendulum.m" in page.driver.current_url)
    assert "once" not in page.driver.current_url and page.driver.current_url.startswith(striped.base)
    page.driver.refresh()
    page.wait()
    assert page.window() == window and page.shares() == shares
    assert float(page.run("$('value-m').value")) == pytest.approx(0.3 * 4**0.4, rel=1e-5)


def test_a_refusal_keeps_the_last_picture_blurred_and_the_view_lives_on(page, webgl):
    before = page.pixels()
    assert np.any(np.array(before)[:, 3]) and not page.run(BLURRED)
    page.choose("value-m", "8")
    assert (page.wait(state="error") == "pendulum.m: must not be 8"
            == page.run("document.querySelector('.refusal').textContent"))
    # Nothing is said of pictures that are not computed
    assert page.pixels() == before and page.run(BLURRED) and page.shares() == []
    page.choose("value-m", "9")
    assert page.wait(state="error") == "the engine has ended"
    _ = page.choose("value-m", "0.3"), page.wait()
    assert page.pixels() == before and not page.run(BLURRED) and page.run("document.querySelector('.refusal').hidden")


def test_a_change_of_the_pendulum_takes_its_motion_away(page):
    page.hand(0.7, 0.5, 0.7, 0.5)
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    words, is_gone = page.run(
        "($('slider-m').value = 0.2, $('slider-m').oninput(), [$('ending').textContent, !explorer.basins.motion])")
    assert words == "…" and is_gone
    page.wait()
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))  # followed anew, with the new pendulum
    assert page.run("explorer.basins.motion.pivot[0]") == pytest.approx([0, 0.3 * 4**0.2], rel=1e-5)


def test_a_slow_frame_can_be_cancelled(page):
    page.choose("value-m", "7")
    assert wait_for(lambda: not page.run("$('cancel').disabled"))
    page.key("Escape")
    assert "Cancelled" in page.wait()
    page.choose("value-m", "0.3")
    page.wait()


def test_sliders_stand_above_the_fold_and_nothing_jumps(page):
    with page.screen(1280, 690):
        bottoms = page.run(
            "[...document.querySelectorAll('#sliders > *')].map((row) => row.getBoundingClientRect().bottom)")
        assert len(bottoms) == 4 and max(bottoms) < 690 >= page.run("document.documentElement.scrollHeight")
    places = ("JSON.stringify(['legend', 'ending', 'pendulum', 'slider-m'].map((id) => "
              "$(id).getBoundingClientRect().top))")
    names = "JSON.stringify([...$('legend').rows].map((row) => row.dataset.name))"
    before = page.run(places), page.run(names)
    for place in (0.1, 0.35, -0.4):
        _ = page.slide("m", place), page.wait()
        assert (page.run(places), page.run(names)) == before
    assert page.fits(840, 520) and page.fits(390, 800)
    # Values that say nothing are not sent
    for tilt, form, sent in (("0.2", "square", {"tilt": 0.2, "waveform": "square"}), ("0", "sine", {})):
        _ = page.choose("value-tilt", tilt), page.choose("value-waveform", form)
        assert ({"k": 0.1, "damping": 0.05}
                | sent == page.module("frames.js", "(({m, ...p}) => p)(its.asScene(explorer.state.pendulum))"))


@pytest.mark.extensive
def test_two_values_stand_side_by_side_with_linked_cursors(page, webgl):
    page.press("compare")
    page.slide("m", 0.5)
    page.wait()
    assert page.run("explorer.basins.panes.map((pane) => pane.pendulum.m)") == ["0.3", "0.6"]
    assert page.run("[...document.querySelectorAll('.caption')].map((words) => words.textContent)") == ["A  m 0.3",
                                                                                                        "B  m 0.6"]
    page.run("explorer.basins.point(explorer.basins.panes[0], [0.25, 0.75])")
    assert page.run("explorer.basins.panes.map((pane) => pane.plain.cursor)") == [None, [0.25, 0.75]]
    assert "|" in page.run("$('pointer').textContent") and len(page.run("[...$('legend').rows[0].cells]")) == 4
    page.press("compare")
    page.wait()
    assert page.run("document.querySelectorAll('.pane').length") == 1
    assert "|" not in page.run("$('pointer').textContent")


@pytest.mark.extensive
def test_both_painters_draw_the_same(page, webgl, driver, striped):
    page.choose("shade", "settling")
    page.choose("quality", "exact")
    page.wait()
    first = np.array(page.pixels())
    assert page.run("explorer.basins.panes[0].painter.kind") == "webgl"
    driver.get("about:blank")
    plain = Page(driver, striped.address() + "#level=measure&samples=1&shade=settling&painter=2d&middle=down")
    plain.wait()
    second = np.array(plain.pixels())
    assert plain.run("explorer.basins.panes[0].painter.kind") == "2d" and len(np.unique(second, axis=0)) > 2
    # Doubtful cells are striped otherwise, and shares of pixels
    assert np.mean(np.max(np.abs(first - second), axis=1) > 12) < 0.35


def test_samples_soften_what_is_finer_than_a_pixel(page, webgl):
    before = len(np.unique(np.array(page.pixels()), axis=0))
    page.choose("samples", "3")
    assert "3 × 3 a pixel" in page.wait()
    assert len(np.unique(np.array(page.pixels()), axis=0)) > before


# ---- what is saved ----


def test_pictures_and_tables_are_saved(page, webgl, folder):
    page.hand(0.7, 0.5, 0.7, 0.5)
    assert wait_for(lambda: not page.run("$('save-csv').disabled"))
    table = np.genfromtxt(page.saved("save-csv", folder / "orbit.csv"), delimiter=",", names=True)
    assert len(table) == 42 * 48 + 1 and table["pivot_height"][0] == 0.3
    assert table["theta_rad"][0] == pytest.approx(-np.pi + 0.7 * TURN, abs=0.02)
    page.run("explorer.state.change({window: explorer.state.window.zoomed(0.3, 0.4, 0.6), jump: true})")
    page.wait()
    window = page.window()
    picture = matplotlib.image.imread(page.saved("save-png", folder / "view.png"))
    assert picture.shape[1] > 1500 and picture[..., :3].std() > 0.05
    # A picture opens the view that it shows, by the program and by the page
    scene = yaml.safe_load(scene_in(folder / "view.png"))
    assert scene["pendulum"]["m"] == 0.3 and scene["basin"]["theta"]["min"] == pytest.approx(window["theta"]["min"])
    _ = page.press("home"), page.slide("m", 0.2)
    page.driver.find_element("css selector", "#open").send_keys(str(folder / "view.png"))
    assert wait_for(lambda: page.window() == window) and page.run("explorer.state.pendulum.m") == "0.3"
    page.choose("save-width", "900")
    assert matplotlib.image.imread(page.saved("save-png", folder / "view.png")).shape[1] == 900
    alone = page.saved("save-html", folder / "view.html").read_text()
    assert alone.count("<button") == 0 and "data:image/png" in alone
    assert "import " not in alone.split("<script>")[1].split("modules[")[0]
    page.plays_alone(folder / "view.html")
    drawing = ElementTree.parse(page.saved("save-svg", folder / "view.svg")).getroot()
    words = [item.text for item in drawing.iter("{http://www.w3.org/2000/svg}text")]
    assert "inverted" in words and len(list(drawing.iter("{http://www.w3.org/2000/svg}image"))) == 1


@pytest.mark.extensive
def test_films_are_saved(page, webgl, folder):
    _ = page.choose("film-count", "3"), page.press("film-loop")
    with zipfile.ZipFile(page.saved("film-png", folder / "film.zip")) as film:
        assert film.testzip() is None and film.namelist() == [f"film-00{n}.png" for n in range(4)]  # there and back
    for kind in ("webm", "mp4"):
        # A head without pictures has 110 bytes
        assert page.saved(f"film-{kind}", folder / f"film.{kind}").stat().st_size > 2000
        assert wait_for(lambda: page.run("$('film-state').textContent") == "")
