"""The explorer whose engine is in the tab: colours, a page within another page, and, of a page that scripts/page has
built (KAPITZA_PAGE), labels beside those of the program."""

import functools
import http.server
import json
import os
import threading
import time
from pathlib import Path

import numpy as np
import pandas
import pytest
from explorer_page import Page, wait_for
from kapitza import style
from kapitza.explorer.colours import CENTRES
from kapitza.motion_kinds import kind

pytest_plugins = ("explorer_page",)
BUILT = os.environ.get("KAPITZA_PAGE")
SCENES = ("blackburn-fig11", "blackburn-fig12", "blackburn-fig13", "blackburn-fig14", "blackburn-fig15", "square-wave",
          "tilted", "wada-forced", "laboratory", "tradeoff-zero-gravity")
ROWS, COLUMNS = 40, 60


def rows_of(names):
    """A catalogue with these motions: (period, winding, centre, mirror) each."""
    numbers = [row[:2] + (CENTRES[row[2]],) for row in names]
    return [{"id": index, "track": index, "name": "", "kind": kind(*numbers[index]), "period": row[0],
             "winding": row[1], "centre": row[2], "mirror": row[3]} for index, row in enumerate(names)]


def test_a_tab_gives_motions_the_colours_of_figures(modules):
    down = [(1, 0, "down", 0)]
    crowded = [(n, n, "rotating", -1) for n in range(1, 9)] + [(n, 1, "rotating", -1) for n in range(2, 12)]
    pairs = [(3, 0, "inverted", 1), (3, 0, "inverted", 0), (6, 0, "down", 2), (2, 0, "inverted", 3)]
    rare = [(2, -4, "rotating", -1), (0, 1, "rotating", -1), (0, 0, "neither", -1), (4, 0, "neither", 3)]
    for names in (down, down + crowded, pairs, rare):
        rows = rows_of(names)
        table = pandas.DataFrame(rows)
        wanted = style.colours(table.assign(centre=table["centre"].map(CENTRES)))
        words = f"its.colouredRows({json.dumps(rows)}, {json.dumps(style.KINDS)}).map((row) => row.colour)"
        assert modules.module("colours.js", words) == wanted


def test_a_page_within_another_has_the_pendulum_its_slider_and_the_basins_in_sight(driver, striped):
    driver.get("about:blank")
    page = Page(driver, striped.address() + "#embed;amplitude=0.1;painter=2d;quality=moving;samples=1")
    with page.screen(390, 640):
        page.wait()
        boxes = "['pendulum', 'slider-m', 'panes'].map((id) => $(id).getBoundingClientRect())" \
                ".map(({top, bottom}) => [top, bottom])"
        assert wait_for(lambda: all(0 <= top < bottom <= 640 for top, bottom in page.run(boxes))), page.run(boxes)
        said = "[document.querySelector('header').offsetParent, explorer.state.pendulum, explorer.state.level]"
        header, pendulum, level = page.run(said)
        assert header is None and "0.1" in (pendulum.get("drive_amplitude"), pendulum.get("m")) and level == "look"
    driver.get("about:blank")


@pytest.fixture(scope="module")
def site():
    """The address of the built page, from any static host."""
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            """Nothing."""

        def do_GET(self):
            if self.path == "/favicon.ico":  # the browser asks for it beside files that are no page
                self.send_response(204)
                return self.end_headers()
            return super().do_GET()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=BUILT))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()


@pytest.mark.skipif(not BUILT, reason="no page was built: scripts/test_page")
@pytest.mark.parametrize("build", ["engine.wasm", "engine-plain.wasm"])
@pytest.mark.parametrize("name", SCENES)
def test_a_tab_decides_each_cell_as_the_program_does(driver, site, name, build):
    """What is guessed of undecided cells may differ, as between processors; so may which they are, in few cells."""
    from kapitza.live import Live, change

    scenes = {row["name"]: row for row in json.loads((Path(BUILT) / "page.json").read_text())["scenes"]}
    scene, planes = scenes[name], ["labels", "doubt"]
    live = Live("{" + change(pendulum=scene["pendulum"], basin=scene["basin"]) + "}")
    counts = {"theta": COLUMNS, "velocity": ROWS}
    basin = {axis: {**scene["window"][axis], "count": count} for axis, count in counts.items()}
    driver.get(f"{site}/page.json")
    driver.get(f"{site}/tab.js?{build}#scene={name}")
    driver.execute_script(f"""window.begun = import("{site}/tab.js?{build}").then(async ({{ Engine }}) => {{
        window.engine = new Engine("a"); await window.engine.worker; }})""")
    for quality in ("exact", "moving"):
        parts, begun = [], time.monotonic()
        live.frame(lambda part, parts=parts: parts.append(part[1]) or True, changed=change(basin=basin), planes=planes,
                   moving=quality == "moving")
        native = time.monotonic() - begun
        request = {"request": "frame", "quality": quality, "rows": ROWS, "columns": COLUMNS, "planes": planes,
                   "window": scene["window"]}
        driver.execute_script(f"""window.got = null; window.begun.then(async () => {{ const begun = performance.now();
            const [header, bytes] = await window.engine.answer({json.dumps(request)});
            window.got = [[...bytes], performance.now() - begun]; }}).catch((error) => (window.got = String(error)))""")
        assert wait_for(lambda: driver.execute_script("return window.got"))
        cells, milliseconds = driver.execute_script("return window.got")
        labels, doubt = np.array(cells).reshape(2, ROWS, COLUMNS)
        wanted, doubtful = parts[-1]["labels"], parts[-1]["doubt"]
        different = int(((labels != wanted) & (doubtful == 0) & (doubt == 0)).sum())
        print(f"{name} {build} {quality}: {(labels != wanted).sum()} labels differ, {different} of them decided; "
              f"doubt differs {(doubt != doubtful).sum()} times; {milliseconds / 1e3 / native:.1f} times as long")
        assert different == 0 and (doubt != doubtful).mean() < 1e-3
