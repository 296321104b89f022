"""The explorer: its numbers held against runs of the program; what its server refuses; one computation at a time; a real browser."""

import base64
import json
import os
import re
import shutil
import socket
import subprocess
import threading
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import matplotlib.image
import numpy as np
import pytest
import yaml
from conftest import PROGRAM, ROOT
from explorer_page import Page, Server, answer_of, browser
from kapitza.explorer.scene import read_resolved
from kapitza.result import Result

SMALL = ROOT / "scenes" / "small.yaml"
SCREENSHOTS = os.environ.get("KAPITZA_SCREENSHOTS")  # a folder for the picture of the documentation
VIEW = {"window": [-3.0, 2.5, -1.0, 1.5], "width": 90, "height": 60, "method": "direct"}
SLOW = VIEW | {"width": 1400, "height": 1400, "pendulum": {"quality_factor": 150}}


@pytest.fixture(scope="module")
def server():
    running = Server(SMALL)
    yield running
    assert running.hint == "Ctrl-C ends it." and running.end() == (0, "")


def wait_for(condition, seconds=30):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def test_a_view_has_the_labels_of_a_run_of_the_saved_scene(server, kapitza, tmp_path):
    wanted = VIEW | {"pendulum": {"drive_amplitude": 0.35}}
    status, view = server.request("view", wanted)
    assert status == 200
    text = server.request("scene", wanted)[1]["text"]
    (tmp_path / "view.yaml").write_text(text)
    scene = yaml.safe_load(text)
    assert scene["pendulum"] == {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.35}
    kapitza("run", "view.yaml", folder=tmp_path)
    basin = Result(tmp_path / "view.h5").group("basin")["attractor"].values
    labels = np.frombuffer(base64.b64decode(view["labels"]), "<i2").reshape(view["height"], view["width"])
    assert np.array_equal(labels, basin)
    assert [row["share"] for row in view["attractors"]] == [np.mean(basin == row["id"]) for row in view["attractors"]]


def test_a_start_is_answered_as_by_where_and_played_to_its_end(server):
    status, answer = server.request("start", VIEW | {"theta": 2.4, "velocity": 0.3})
    assert status == 200
    ending, motion = answer["ending"], answer["motion"]
    command = [PROGRAM, "where", SMALL, "2.4", "0.3", "--json"]
    asked = json.loads(subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout)
    assert {key: ending[key] for key in ("name", "period", "decided")} == {key: asked[key] for key in ("name", "period", "decided")}
    assert (motion["theta"][0], motion["velocity"][0]) == (2.4, 0.3)
    assert len(motion["strobe_theta"]) - 1 == (len(motion["theta"]) - 1) / 48 >= ending["settling_time"] + 4 * ending["period"]
    last = np.exp(1j * (motion["strobe_theta"][-1] - np.array(ending["strobe_theta"])))
    assert np.min(np.abs(last - 1)) < 0.1


def test_a_quick_look_is_coarse_in_its_table_alone(server):
    status, view = server.request("view", VIEW | {"coarse": True})
    assert status == 200 and (view["method"], view["width"], view["height"]) == ("icm", 90, 60)


def test_exact_labels_say_how_many_are_undecided(server, kapitza, tmp_path):
    wanted = VIEW | {"width": 30, "height": 20, "method": "exact"}
    view = server.request("view", wanted)[1]
    (tmp_path / "view.yaml").write_text(server.request("scene", wanted)[1]["text"])
    kapitza("run", "view.yaml", folder=tmp_path)
    basin = Result(tmp_path / "view.h5").group("basin")
    assert base64.b64decode(view["labels"]) == basin["attractor"].values.astype("<i2").tobytes()
    assert (view["method"], view["undecided"]) == ("exact", basin.attrs["undecided"])
    assert server.request("view", VIEW | {"width": 30, "height": 20})[1]["undecided"] is None


def test_what_the_program_refuses_is_said_in_its_words(server):
    status, answer = server.request("view", VIEW | {"window": [1.0, 0.5, -1, 1]})
    assert status == 400 and "basin.theta.max" in answer["error"]


@pytest.mark.parametrize(("name", "change"), [
    ("view", {"width": 4000, "height": 4000}), ("view", {"width": 0}), ("view", {"width": True}), ("view", {"width": "90"}),
    ("view", {"method": "guess"}), ("view", {"window": [0, 1]}), ("view", {"window": [0, 1, 2, "x"]}), ("view", {"pendulum": {"mass": 1}}),
    ("view", {"pendulum": {"drive_amplitude": None}}), ("view", {"pendulum": []}), ("start", {"theta": "1", "velocity": 0}), ("start", {}),
    ("view", {"window": [0, 1, 0, 10**400]}), ("view", {"window": [0, 1, 0, float("nan")]}),
])
def test_requests_that_cannot_be_meant_are_refused(server, name, change):
    status, answer = server.request(name, VIEW | change)
    assert status == 400 and answer["error"] and server.process.poll() is None


@pytest.mark.parametrize("headers", [
    {"X_Kapitza_Token": None}, {"X_Kapitza_Token": "wrong"}, {"X_Kapitza_Token": "\u00e4"}, {"Origin": "http://example.org"},
    {"Host": "example.org"}, {"Host": "localhost.example.org:80"}, {"Origin": "null"},
])
def test_tokens_and_origins_that_are_not_the_pages_own_are_refused(server, headers):
    assert server.request("state", {}, **headers)[0] == 403


def test_the_page_needs_the_token_too(server):
    assert answer_of(f"{server.base}/")[0] == 403 and answer_of(f"{server.base}/?token=x")[0] == 403
    assert answer_of(f"{server.base}/elsewhere?token={server.token}")[0] == 404


def test_huge_and_broken_requests_are_refused(server):
    assert server.request("view", b"x" * 20_001)[0] == 400
    assert server.request("view", b"{")[0] == 400 and server.request("view", b"[]")[0] == 400
    assert server.request("nothing", {})[0] == 404


def test_it_listens_on_this_machine_alone(server):
    port = int(server.base.rsplit(":", 1)[1])
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", port), timeout=5).close()


def test_a_new_request_ends_the_one_before(server):
    answers = []
    first = threading.Thread(target=lambda: answers.append(server.request("view", SLOW)))
    first.start()
    assert wait_for(server.children)
    slow = server.children()
    begun = time.monotonic()
    status, _ = server.request("view", VIEW)
    first.join(30)
    assert status == 200 and answers[0][0] == 409 and len(slow) == 1
    assert not Path(f"/proc/{slow[0]}").exists() and not server.children(), f"after {time.monotonic() - begun:.1f} s"


def test_it_leaves_no_process_and_no_file_behind(tmp_path):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMPDIR", str(tmp_path))
        running = Server(SMALL)
    assert list(tmp_path.glob("kapitza-view-*"))
    asked = threading.Thread(target=lambda: suppress(running.request, "view", SLOW))
    asked.start()
    assert wait_for(running.children)
    computing = running.children()
    assert running.end()[0] == 0
    asked.join(30)
    assert not any(Path(f"/proc/{process}").exists() for process in computing) and not list(tmp_path.glob("kapitza-view-*"))


def suppress(call, *arguments):
    """The server may go before it answers."""
    try:
        call(*arguments)
    except OSError:
        pass


def test_a_result_opens_with_what_lies_over_its_basins(small_result, tmp_path):
    shutil.copy(small_result, tmp_path / "more.h5")
    with h5py.File(tmp_path / "more.h5", "a") as file:
        saddles, manifolds = file.create_group("saddles"), file.create_group("manifolds")
        saddles["strobe_theta"], saddles["strobe_velocity"] = [[0.5, np.nan], [1.0, 2.0]], [[0.1, np.nan], [0.2, 0.3]]
        manifolds["theta"], manifolds["velocity"] = [0.0, 0.5, 3.1, -3.1, 1.0, 1.5], [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
        manifolds["branch"] = [0, 0, 0, 0, 1, 1]
        manifolds["arc_length"] = np.zeros(6)
        for name, dtype in (("saddle", "i4"), ("polyline", "i4"), ("kind", "i1")):
            manifolds[name] = np.zeros(6, dtype)
        for name, dtype in (("period", "i4"), ("winding", "i4"), ("index", "i1")):
            saddles[name] = np.ones(2, dtype)
        saddles["name"] = ["unstable", "unstable"]
        for group, sizes in ((saddles, {"saddle": 2, "phase": 2}), (manifolds, {"point": 6})):
            variables = list(group.values())
            for axis, (name, size) in enumerate(sizes.items()):
                group[name] = np.arange(size)
                group[name].make_scale(name)
                for variable in (variable for variable in variables if axis < variable.ndim):
                    variable.dims[axis].attach_scale(group[name])
        saddles["pair"] = np.arange(2)
        saddles["pair"].make_scale("pair")
        for name in ("multiplier_re", "multiplier_im"):
            saddles[name] = np.ones((2, 2))
            saddles[name].dims[0].attach_scale(saddles["saddle"])
            saddles[name].dims[1].attach_scale(saddles["pair"])
    running = Server(tmp_path / "more.h5")
    state = running.request("state", {})[1]
    assert running.end()[0] == 0
    assert state["title"] == "A small look well inside the stable zone" and state["sliders"]["quality_factor"] == 5
    assert state["overlays"]["saddles"]["points"] == [[0.5, 0.1], [1.0, 0.2], [2.0, 0.3]]
    assert state["overlays"]["manifolds"]["lines"] == [[[0, 0], [0.5, 0.1], [3.1, 0.2]], [[1, 0.4], [1.5, 0.5]]]


@pytest.mark.parametrize(("arguments", "message"), [
    (["nothing.yaml"], "nothing.yaml: cannot be read"), ([SMALL, "--port", "80"], "--port: 80 is no port"),
    ([ROOT / "README.md"], "README.md"), ([], "view: names no scene"),
])
def test_what_cannot_be_opened_is_one_line(arguments, message):
    done = subprocess.run([PROGRAM, "view", *arguments, "--no-browser"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("python", ["/nonexistent/python", "bare"])
def test_without_python_or_its_packages_one_line_says_what_to_set(python, tmp_path):
    if python == "bare":
        python = tmp_path / "python"
        python.write_text('#!/bin/sh\nexec "$REAL_PYTHON" -S "$@"\n')
        python.chmod(0o755)
    environment = os.environ | {"KAPITZA_PYTHON": str(python), "REAL_PYTHON": os.path.realpath(shutil.which("python3"))}
    done = subprocess.run([PROGRAM, "view", SMALL], env=environment, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "KAPITZA_PYTHON" in done.stderr and len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["blackburn-fig12", "blackburn-fig05", "butikov-fig01", "bifurcation"])
def test_resolved_scenes_are_read_as_yaml_reads_them(kapitza, name):
    text = kapitza("check", ROOT / "scenes" / f"{name}.yaml").stdout.split("\n\n")[1]
    numbers = re.sub(r"(?<=[ \[])(-?\d+)(e[-+]\d+)", r"\1.0\2", text)  # YAML 1.1 takes 1e-05 for a text
    assert read_resolved(text) == yaml.safe_load(numbers)


def test_in_a_real_browser(server, kapitza, tmp_path):
    """Zoom three times, click, slide, save: what the page shows is what the program says."""
    with browser(tmp_path, "1280,1000" if SCREENSHOTS else "760,520") as driver:
        page = Page(driver, server.url)
        check_home(page, kapitza, tmp_path)
        check_zoom(page)
        check_click(page)
        take_screenshot(page)
        check_slider(page, kapitza, tmp_path)
        check_exact(page)
        check_saved(page, kapitza, tmp_path)
        assert [entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"] == []


def run_shares(kapitza, path, *sets):
    """Names and shares of a run of the whole window as the page computes it."""
    kapitza("run", SMALL, *sets, "-o", path)
    table = Result(path).group("attractors")
    return sorted((str(name), float(share)) for name, share in zip(table["name"].values, table["fraction"].values, strict=True) if share)


def size_of(status):
    """Cells along both axes, from the status line."""
    width, height = re.match(r"(\d+) × (\d+) starts", status).groups()
    return ["--set", f"basin.theta.count={width}", "--set", f"basin.velocity.count={height}", "--set", "basin.method=direct"]


def check_home(page, kapitza, folder):
    assert page.shares() == [] or page.wait()
    sets = size_of(page.wait())
    assert page.shares() == run_shares(kapitza, folder / "home.h5", *sets)
    assert page.window() == pytest.approx([-np.pi, np.pi, -2, 2])


def check_zoom(page):
    for _ in range(3):
        page.element("zoom-in").click()
        page.wait()
    assert page.window() == pytest.approx([-np.pi / 8, np.pi / 8, -0.25, 0.25]) and "Depth 8×" in page.element("where").text
    page.element("home").click()
    page.wait()


def check_click(page):
    """A start at a place of the map, named by `where` at the very numbers that the page shows."""
    from selenium.webdriver import ActionChains
    canvas = page.element("map")
    aside, up = 0.18 * canvas.size["width"], 0.14 * canvas.size["height"]
    ActionChains(page.driver).move_to_element_with_offset(canvas, aside, -up).click().perform()
    assert wait_for(lambda: page.element("ending").get_attribute("data-ending"), 60)
    ending = json.loads(page.element("ending").get_attribute("data-ending"))
    command = [PROGRAM, "where", SMALL, repr(ending["theta"]), repr(ending["velocity"]), "--json"]
    asked = json.loads(subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout)
    assert (ending["name"], ending["decided"]) == (asked["name"], asked["decided"]) and ending["name"] in page.element("ending").text
    page.wait()
    first = page.driver.execute_script("return page.shown")
    assert wait_for(lambda: page.driver.execute_script("return page.shown") > first)
    pixels = page.driver.execute_script(
        "const c = document.getElementById('pendulum'); return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]")
    assert len(np.unique(np.reshape(pixels, (-1, 4)), axis=0)) > 5


def take_screenshot(page):
    """Of a motion that has been played for some periods."""
    if SCREENSHOTS:
        wait_for(lambda: page.driver.execute_script("return page.shown") > 6)
        page.driver.save_screenshot(str(Path(SCREENSHOTS) / "explorer.png"))


def check_slider(page, kapitza, folder):
    page.driver.execute_script("arguments[0].value = 0.1; arguments[0].dispatchEvent(new Event('input'))",
                               page.element("slider-drive_amplitude"))
    sets = size_of(page.wait())
    value = page.element("value-drive_amplitude").get_attribute("value")
    assert float(value) == pytest.approx(0.3 * 4**0.1, rel=1e-4)
    assert page.shares() == run_shares(kapitza, folder / "slid.h5", *sets, "--set", f"pendulum.drive_amplitude={value}")


def check_exact(page):
    """Exact labels where they are asked for; then integration again."""
    for method, words in (("exact", "decided"), ("direct", "method direct")):
        page.driver.execute_script("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('change'))",
                                   page.element("method"), method)
        assert words in page.wait()


def check_saved(page, kapitza, folder):
    scene = yaml.safe_load(page.saved("save-scene", folder / "view.yaml").read_text())
    kapitza("check", folder / "view.yaml")
    assert scene["basin"]["theta"]["max"] == page.window()[1] and scene["basin"]["method"] == "direct"
    picture = matplotlib.image.imread(page.saved("save-png", folder / "view.png"))
    assert picture.shape[1] > 1500 and picture[..., :3].std() > 0.05
    drawing = ElementTree.parse(page.saved("save-svg", folder / "view.svg")).getroot()
    words = [item.text for item in drawing.iter("{http://www.w3.org/2000/svg}text")]
    assert "inverted" in words and len(list(drawing.iter("{http://www.w3.org/2000/svg}image"))) == 1
