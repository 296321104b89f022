"""The explorer as its tests reach it: the server's process, its requests, a real browser."""

import json
import shutil
import subprocess
import time
import urllib.error
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import PROGRAM


class Server:
    """`kapitza view` at work."""

    def __init__(self, source, *options):
        command = [PROGRAM, "view", source, "--no-browser", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.title, self.url, self.hint = (self.process.stdout.readline().strip() for _ in range(3))
        self.base, _, self.token = self.url.partition("/?token=")

    def request(self, name, body, **headers):
        """Status and JSON of a POST; a header of None is left out."""
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        sent = {"X-Kapitza-Token": self.token} | {key.replace("_", "-"): value for key, value in headers.items()}
        asked = urllib.request.Request(f"{self.base}/{name}", data, {key: value for key, value in sent.items() if value is not None})
        return answer_of(asked)

    def children(self):
        """Processes that compute for it."""
        found = []
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                name, rest = path.read_text().rsplit(")", 1)
            except (FileNotFoundError, ProcessLookupError):
                continue
            if int(rest.split()[1]) == self.process.pid and rest.split()[0] != "Z":
                found.append(int(name.split()[0]))
        return found

    def end(self):
        """Its exit status and what it said, after SIGTERM."""
        self.process.terminate()
        output, errors = self.process.communicate(timeout=20)
        return self.process.returncode, output + errors


def answer_of(request):
    try:
        with urllib.request.urlopen(request, timeout=120) as answer:
            return answer.status, json.loads(answer.read())
    except urllib.error.HTTPError as error:
        return error.code, json.loads(error.read())


@contextmanager
def browser(folder, size):
    """Chromium without a window, of size "width,height", that saves into `folder`; skips the test by name where there is none."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="no selenium: the explorer is not tested in a browser")
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        pytest.skip("chromium or chromedriver is not installed: the explorer is not tested in a browser")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for word in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "disable-gpu", f"window-size={size}",
                 f"user-data-dir={folder / 'profile'}"):
        options.add_argument(f"--{word}")
    options.add_experimental_option("prefs", {"download.default_directory": str(folder)})
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

    def element(self, name):
        return self.driver.find_element("id", name)

    def wait(self, seconds=120):
        """Until the page has what was asked of it; its status line."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.driver.find_element("tag name", "body").get_attribute("data-state")
            if state in ("done", "error"):
                assert state == "done", self.element("status").text
                return self.element("status").text
            time.sleep(0.05)
        raise AssertionError(f"the page is still {state} after {seconds} s")

    def shares(self):
        """Name and share of every line of the legend; mirror images may share a name."""
        rows = self.driver.find_elements("css selector", "#legend tr")
        return sorted((row.get_attribute("data-name"), float(row.get_attribute("data-share"))) for row in rows)

    def window(self):
        return json.loads(self.element("where").get_attribute("data-window"))

    def saved(self, button, path, seconds=30):
        """The file that a button saves."""
        self.element(button).click()
        end = time.monotonic() + seconds
        while time.monotonic() < end and not path.is_file():
            time.sleep(0.05)
        return path
