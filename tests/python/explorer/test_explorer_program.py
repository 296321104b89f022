"""The explorer's page with the program itself, in a real browser."""

import json

import numpy as np
import pytest
import yaml
from conftest import ROOT, wait_for
from explorer_page import Page, Server, browser
from kapitza.result import Result

SMALL = ROOT / "scenes" / "small.yaml"
TURN = 2 * np.pi


@pytest.fixture
def driver(tmp_path):
    with browser(tmp_path, "560,440") as found:  # fewer cells
        yield found


def test_labels_of_the_page_are_those_of_runs_of_the_saved_scenes(driver, kapitza, tmp_path):
    """The whole circle, a slider, a deep window, a start; labels are those of runs of the saved scenes."""
    running = Server(SMALL)
    page = Page(driver, running.address() + "#samples=1&level=measure&drawn=off")
    assert "every label decided" in page.wait()
    check_saved_scene(page, kapitza, tmp_path)
    page.slide("drive_amplitude", 0.1)
    page.wait()
    check_saved_scene(page, kapitza, tmp_path)
    page.hand(0.68, 0.36, 0.68, 0.36)
    assert wait_for(lambda: page.run("$('ending').dataset.ending"))
    ending = json.loads(page.run("$('ending').dataset.ending"))
    assert ending["name"] in page.run("$('ending').textContent").replace("−", "-") and ending["decided"]
    page.run("explorer.basins.zoom(1e-20, 0.4, 0.6)")
    page.wait()
    assert page.run("explorer.state.window.theta.width") == pytest.approx(TURN * 1e-20)
    assert page.run("explorer.basins.panes[0].top.level") == 1
    driver.get("about:blank")
    assert running.end() == (0, "")


def check_saved_scene(page, kapitza, tmp_path):
    path = tmp_path / "view.yaml"
    path.unlink(missing_ok=True)
    scene = yaml.safe_load(page.saved("save-scene", path).read_text())
    kapitza("run", path, "-o", tmp_path / "view.h5", "--force")
    table = Result(tmp_path / "view.h5").group("attractors")
    run = sorted((str(name), float(share)) for name, share in zip(table["name"].values, table["fraction"].values,
                                                                  strict=True) if share)
    shown = page.shares()
    assert scene["basin"]["method"] == "exact" and [name for name, _ in shown] == [name for name, _ in run]
    # Undecided cells may differ
    assert [share for _, share in shown] == pytest.approx([share for _, share in run], abs=1e-4)
