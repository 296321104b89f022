"""The explorer as its tests reach it: the server's process, its requests, a real browser."""

import json
import os
import shutil
import subprocess
import sys
import urllib.error
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, wait_for

STRIPED = ROOT / "tests" / "tools"


class Server:
    """`kapitza view` at work; with the double of its engine where `striped`, and no program for maps. Its page's token
    is traded at once."""

    def __init__(self, source, *options, striped=False, environment=None):
        command = [PROGRAM, "view", source, "--no-browser", *options]
        if striped:
            command = [sys.executable, STRIPED / "striped_view.py", *options, "--", STRIPED / "stripes.yaml"]
            environment = (environment or os.environ) | {"KAPITZA": shutil.which("false")}
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        env=environment)
        self.title, self.url, self.hint, self.forward = (self.process.stdout.readline().strip() for _ in range(4))
        self.base, _, once = self.url.partition("/?once=")
        self.token = self.request("token", {"once": once}, X_Kapitza_Token=None)[1]["token"]
        self.process.stdout.readline()  # the address for another browser

    @property
    def port(self):
        return int(self.base.rsplit(":", 1)[1])

    def address(self):
        """An address for a browser."""
        return f"{self.base}/?once={self.request('link', {})[1]['once']}"

    def post(self, name, body, **headers):
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        sent = {"X-Kapitza-Token": getattr(self, "token", None)} | {key.replace("_", "-"): value for key,
                                                                    value in headers.items()}
        asked = urllib.request.Request(f"{self.base}/{name}", data,
                                       {key: value for key, value in sent.items() if value is not None})
        return urllib.request.urlopen(asked)

    def request(self, name, body, **headers):
        """Status and JSON of a POST; a header of None is left out."""
        try:
            with self.post(name, body, **headers) as answer:
                return answer.status, json.loads(answer.read())
        except urllib.error.HTTPError as error:
            return error.code, json.loads(error.read())

    def answers(self, request, view="a"):
        """Header and payload of each of the engine's answers, as they come."""
        with self.post(f"ask?view={view}", request) as stream:
            header = {"final": False}
            while not header["final"]:
                header = json.loads(stream.readline())
                yield header, stream.read(header["bytes"])

    def ask(self, request, view="a"):
        return list(self.answers(request, view))

    def children(self):
        """Processes that compute for it, which are not that of multiprocessing itself."""
        return [child for child in children_of(self.process.pid) if b"resource_tracker" not in words_of(child)]

    def end(self):
        """Its exit status and what it said, after SIGTERM."""
        self.process.terminate()
        output, errors = self.process.communicate()
        return self.process.returncode, errors + "".join(line for line in output.splitlines()
                                                         if "for another browser" not in line)


def words_of(process):
    """The command line of a process."""
    try:
        return Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return b""


def children_of(process):
    return [int(path.parent.name) for path in Path("/proc").glob("[0-9]*/stat") if process == parent_of(path)]


def parent_of(path):
    """Parent of the process of a stat file; None where it has gone or is a zombie."""
    try:
        rest = path.read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return None
    return None if rest[0] == "Z" else int(rest[1])


@contextmanager
def browser(folder, size):
    """Chromium without a window, of size "width,height", that saves into `folder`; skips the test by name where there
    is none."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="no selenium: the explorer is not tested in a browser")
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        pytest.skip("chromium or chromedriver is not installed: the explorer is not tested in a browser")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for word in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "disable-gpu", "enable-unsafe-swiftshader",
                 "force-prefers-reduced-motion", f"window-size={size}", f"user-data-dir={folder / 'profile'}"):
        options.add_argument(f"--{word}")
    options.add_experimental_option("prefs", {
        "download.default_directory": str(folder), "profile.default_content_setting_values.automatic_downloads": 1})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    page = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    try:
        yield page
    finally:
        page.quit()


class Page:
    """What a person sees and does on the page."""

    def __init__(self, driver, url):
        self.driver = driver
        driver.get(url)

    def run(self, text, *arguments):
        """The value of a JavaScript expression; `explorer` is the page's own, `$` finds an element by its id."""
        return self.driver.execute_script(f"const $ = (id) => document.getElementById(id); return ({text})", *arguments)

    def module(self, name, text):
        """The value of an expression of what a module of the page exports, as `its`."""
        script = (f"const done = arguments[0]; import('/{name}').then((its) => done({text})).catch((error) => "
                  "done(String(error)))")
        return self.driver.execute_async_script(script)

    def wait(self, state="done"):
        """Until the page has what was asked of it, and asks for no more; its status line."""
        asks = "window.explorer?.basins?.panes.some((pane) => pane.pursuing)"
        assert wait_for(lambda: self.state() in ("done", "error") and not self.run(asks)), self.state()
        words = self.run("$('status').textContent")
        assert self.state() == state, words
        return words

    def state(self):
        return self.run("document.body.dataset.state")

    @contextmanager
    def screen(self, width, height, mobile=False):
        """Shows the page in a window of this size, CSS pixels."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        yield
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def fits(self, width, height):
        """Whether a window of this size cuts nothing off, and the controls end above the line at the bottom."""
        controls, line = ("$('sliders').closest('aside').getBoundingClientRect()",
                          "document.querySelector('footer').getBoundingClientRect()")
        sliders = "$('sliders').getBoundingClientRect()"
        hidden = (f"getComputedStyle($('sliders').closest('aside')).overflowY === 'auto' || {sliders}.bottom <= "
                  f"{line}.top + 1")
        test = f"{controls}.bottom <= {line}.top + 1 && ({hidden}) && document.scrollingElement.scrollWidth <= {width}"
        with self.screen(width, height):
            return wait_for(lambda: self.run(test))  # the picture takes its new size a moment later

    def press(self, name):
        self.run("$(arguments[0]).click()", name)

    def choose(self, name, value):
        self.run("($(arguments[0]).value = arguments[1], $(arguments[0]).dispatchEvent(new Event('change')))", name,
                 value)

    def slide(self, name, place):
        self.run("($(arguments[0]).value = arguments[1], $(arguments[0]).dispatchEvent(new Event('input')))",
                 f"slider-{name}", place)

    def key(self, name):
        self.run("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], bubbles: true, "
                 "cancelable: true}))", name)

    def shares(self):
        """Name and share of every line of the legend that is seen; mirror images may share a name."""
        rows = self.run("[...$('legend').rows].map((row) => [row.dataset.name, Number(row.dataset.share)])")
        return sorted((name, share) for name, share in rows if share > 0)

    def window(self):
        """The window that the page says; it is written with the next picture, which a busy machine draws late."""
        said = "document.getElementById('where').dataset.window"
        script = f"const done = arguments[0]; requestAnimationFrame(() => setTimeout(() => done({said})))"
        return json.loads(self.driver.execute_async_script(script))

    def wheel(self, x, y, *steps):
        """Wheel events of so many px at a share of the plot."""
        self.run("""((x, y, steps) => { const pane = explorer.basins.panes[0], box = pane.over.getBoundingClientRect();
            const [left, top] = pane.plane.placeOf(x, y);
            const at = {clientX: box.left + left, clientY: box.top + top, bubbles: true, cancelable: true};
            for (const deltaY of steps) pane.over.dispatchEvent(new WheelEvent("wheel", {deltaY, ...at}));
              })(...arguments)""",
                 x, y, list(steps))

    def hand(self, x, y, to_x, to_y):
        """A drag between shares of the plot; a click where they are equal."""
        from selenium.webdriver import ActionChains
        pane = self.driver.find_element("css selector", "#panes .over")
        def offset(across, up):
            left, top, wide, high = self.run("[...explorer.basins.panes[0].plane.placeOf(arguments[0], arguments[1]), "
                                             "explorer.basins.panes[0].over.clientWidth, "
                                             "explorer.basins.panes[0].over.clientHeight]",
                                             across, up)
            return round(left - wide / 2), round(top - high / 2)
        chain = ActionChains(self.driver, duration=0).move_to_element_with_offset(pane, *offset(x, y)).click_and_hold()
        if (x, y) != (to_x, to_y):
            chain = chain.move_to_element_with_offset(pane, *offset((x + to_x) / 2, (y + to_y) / 2))
            chain = chain.move_to_element_with_offset(pane, *offset(to_x, to_y))
        chain.release().perform()

    def pixels(self):
        """The basins as drawn: rows of [r, g, b, a] of every 7th pixel."""
        return self.run("""(() => { const pane = explorer.basins.panes[0]; pane.drawNow();
            const copy = document.createElement("canvas");
            Object.assign(copy, {width: pane.basins.width, height: pane.basins.height});
              const context = copy.getContext("2d");
            context.drawImage(pane.basins, 0, 0); const data = context.getImageData(0, 0, copy.width,
              copy.height).data, found = [];
            for (let i = 0; i < data.length; i += 28) found.push([...data.slice(i, i + 4)]); return found; })()""")

    def saved(self, button, path):
        """The file that a button saves, whole: the browser first makes an empty one."""
        path.unlink(missing_ok=True)
        self.press(button)
        part = path.with_name(f"{path.name}.crdownload")
        assert wait_for(lambda: path.is_file() and path.stat().st_size > 0 and not part.exists())
        return path

    def plays_alone(self, path):
        """A saved view, opened without its server: the list, and a motion that a line of it plays."""
        first = self.driver.current_window_handle
        self.driver.switch_to.new_window("tab")
        self.driver.get(path.as_uri())
        *others, last = self.driver.find_elements("css selector", "#list button")
        assert len(others) == 2 and "inverted" in others[1].text and not last.get_attribute("disabled")
        before, words = self.run("[$('pendulum').toDataURL(), $('words').textContent]")
        last.click()
        assert wait_for(lambda: self.run("$('pendulum').toDataURL()")
                        != before) and self.run("$('words').textContent") != words
        self.driver.close()
        self.driver.switch_to.window(first)


# ---- fixtures of the modules that name this one in pytest_plugins ----


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("browser")


@pytest.fixture(scope="module")
def driver(folder):
    with browser(folder, "960,640") as found:  # smaller ones draw fewer pixels
        yield found
        assert [entry for entry in found.get_log("browser") if entry["level"] == "SEVERE"] == []


@pytest.fixture(scope="module")
def striped():
    running = Server(None, striped=True)
    yield running
    assert running.end() == (0, "")


@pytest.fixture
def modules(driver, striped):
    """The modules of the page, without the page: numbers are asked for alone."""
    return Page(driver, f"{striped.base}/window.js")


@pytest.fixture
def webgl():
    """The page of a test that asks for this draws as others see it; those of other tests need a third of the processor
    time to draw."""


@pytest.fixture
def page(driver, striped, request):
    """A fresh page of stripes, one cell a pixel."""
    plain = "" if "webgl" in request.fixturenames else "&painter=2d&shade=none"
    driver.get("about:blank")
    fresh = Page(driver,
                 striped.address() + f"#level=measure&samples=1&quality=moving&middle=hanging&map=off&drawn=on{plain}")
    fresh.wait()
    yield fresh
    driver.get("about:blank")  # it asks no more when its server ends
