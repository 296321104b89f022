#!/usr/bin/env python3
"""Pictures of the explorer for the documentation, in headless Chromium: explorer.png, explorer-phone.png, explorer-story.png and the film
explorer.gif.

    explorer_pictures.py FOLDER"""

import io
import math
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / folder) for folder in ("python", "tests/python", "tests/tools")]
from explorer_page import Page, Server, browser, wait_for  # noqa: E402
from PIL import Image  # noqa: E402

SCENE = ROOT / "scenes" / "blackburn-fig12.yaml"
DESK, PHONE, LECTURE = (1440, 900), (390, 844), (1920, 1080)
STORY, STEP = 2, 3  # flutter: the line at half of the frequency of the shaker
FILM = (640, 400)
EACH = 130  # ms of a picture of the film
READY = "document.body.dataset.state === 'done' && ($('map').hidden || /up to 4/.test(document.querySelector('#map .note').textContent))"
AMPLITUDES = [0.30 + 0.20 * i / 14 for i in range(15)] + [0.50 - 0.20 * i / 6 for i in range(1, 7)]
KNOWN = "!$('pendulum').classList.contains('awaits')"  # the motion of the start
NOTCHES = 14  # of the wheel


def opened(driver, server, size, more):
    """A page at rest, with its map complete."""
    screen = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size == PHONE}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    driver.get("about:blank")
    page = Page(driver, server.address() + f"#start=2.9~0~a&{more}")
    if not wait_for(lambda: page.run(f"window.explorer?.basins.motion && {READY}"), 300):
        sys.exit("the page did not come to rest in 300 s")
    time.sleep(3)  # the pendulum has a trace
    return page


def shown(driver):
    return Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")


def film(driver, page):
    """The point of the map goes to a larger amplitude and back, and the wheel zooms into a boundary."""
    pictures = []
    for amplitude in AMPLITUDES:
        page.run("(explorer.basins.panes[0].most = 2.5e5, explorer.state.change({pendulum: {...explorer.state.pendulum, "
                 "drive_amplitude: arguments[0]}, jump: false}))", str(round(amplitude, 4)))  # as fine as on a machine at rest
        wait_for(lambda: page.run("((pane) => pane.latest?.key === JSON.stringify(pane.pendulum) && pane.latest.level === 1)"
                                  f"(explorer.basins.panes[0]) && {KNOWN}"))
        pictures.append(shown(driver))
    page.wait()
    page.run("explorer.state.change({drawn: 'on'})")  # the zoom stays on a boundary
    for _ in range(NOTCHES):
        page.wheel(0.5, 0.6, -120)
        page.wait()
        pictures.append(shown(driver))
    return pictures + [pictures[-1]] * math.ceil(1000 / EACH)


def told(driver, server):
    """A step of a story, in a lecture room."""
    page = opened(driver, server, LECTURE, "theme=light&map=off&samples=1&quality=moving")
    page.press("tell")
    wait_for(lambda: page.run(f"$('stories').querySelectorAll('div button').length > {STORY}"))
    page.run(f"$('stories').querySelectorAll('div button')[{STORY}].click()")
    for _ in range(STEP):
        page.press("story-next")
        time.sleep(3)  # values glide to their new ones
    wait_for(lambda: page.run("explorer.basins.motion?.ending.period === 2 && " + KNOWN), 120)
    time.sleep(1)
    return shown(driver)


def main():
    folder = Path(sys.argv[1])
    server = Server(SCENE)
    with tempfile.TemporaryDirectory() as profile, browser(Path(profile), "1440,1040") as driver:
        page = opened(driver, server, DESK, "theme=light")
        shown(driver).save(folder / "explorer.png", optimize=True)
        page.run("explorer.state.change({samples: '1', quality: 'moving'})")
        small = [picture.resize(FILM, Image.Resampling.LANCZOS) for picture in film(driver, page)]
        first, *others = [picture.quantize(64, dither=Image.Dither.NONE) for picture in small]
        first.save(folder / "explorer.gif", save_all=True, append_images=others, duration=EACH, loop=0, optimize=True)
        opened(driver, server, PHONE, "theme=dark&map=off")
        shown(driver).save(folder / "explorer-phone.png", optimize=True)
        told(driver, server).resize((1280, 720), Image.Resampling.LANCZOS).save(folder / "explorer-story.png", optimize=True)
        driver.get("about:blank")
    server.end()


if __name__ == "__main__":
    main()
