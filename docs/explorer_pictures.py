#!/usr/bin/env python3
"""Pictures of the explorer for the documentation, in headless Chromium: explorer.png, explorer-phone.png,
explorer-story.png and the film explorer.gif.

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
STORY, STEP = 3, 3  # flutter: the line at half of the frequency of the shaker
FILM = (640, 400)
EACH = 150  # ms of a picture of the film
READY = "document.body.dataset.state === 'done' && document.querySelectorAll('.marks span').length"
KNOWN = "!$('pendulum').classList.contains('awaits')"  # the motion of the start
STEPS = (7, 10, 5, 7, 7, 4)  # pictures of each step of the story of one minute
AMPLITUDES = [0.30 - 0.20 * i / 6 for i in range(7)] + [0.10 + 0.38 * i / 9 for i in range(1, 10)]  # then the slider


def opened(driver, server, size, more):
    """A page at rest, with its tracks."""
    screen = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size == PHONE}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    driver.get("about:blank")
    page = Page(driver, server.address() + f"#{more}")
    if not wait_for(lambda: page.run(f"window.explorer?.basins.motion && {READY}"), 300):
        sys.exit("the page did not come to rest in 300 s")
    time.sleep(3)  # the pendulum has a trace
    return page


def shown(driver):
    return Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")


def film(driver, page):
    """The first minute: the story that Show me tells, then a hand on the slider."""
    pictures = [shown(driver)] * 8
    page.press("show-me")
    wait_for(lambda: page.run("Boolean(explorer.stories.story)"))
    for number, count in enumerate(STEPS):
        if number:
            page.press("story-next")
        pictures += [shown(driver) for _ in range(count)]
        wait_for(lambda: page.run(f"!explorer.stories.busy && document.body.dataset.state === 'done' && {KNOWN}"), 120)
        pictures += [shown(driver)] * 8
    page.press("story-end")
    for amplitude in AMPLITUDES:
        page.run("(explorer.basins.panes[0].most = 2.5e5, explorer.state.change({pendulum: "
                 "{...explorer.state.pendulum, "
                 # As fine as on a machine at rest
                 "drive_amplitude: arguments[0]}, jump: false}))", str(round(amplitude, 4)))
        wait_for(lambda: page.run(
            "((pane) => pane.latest?.key === JSON.stringify(pane.pendulum) && pane.latest.level === 1)"
                                  f"(explorer.basins.panes[0]) && {KNOWN}"))
        pictures.append(shown(driver))
    return pictures + [pictures[-1]] * math.ceil(1000 / EACH)


def told(driver, server):
    """A step of a story, in a lecture room."""
    page = opened(driver, server, LECTURE, "level=explore&theme=light&map=off&samples=1&quality=moving")
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
        page = opened(driver, server, DESK, "level=look&map=off&theme=light")
        shown(driver).save(folder / "explorer.png", optimize=True)
        page.run("explorer.state.change({samples: '1', quality: 'moving'})")
        small = [picture.resize(FILM, Image.Resampling.LANCZOS) for picture in film(driver, page)]
        first, *others = [picture.quantize(64, dither=Image.Dither.NONE) for picture in small]
        first.save(folder / "explorer.gif", save_all=True, append_images=others, duration=EACH, loop=0, optimize=True)
        opened(driver, server, PHONE, "level=look&theme=dark&map=off")
        shown(driver).save(folder / "explorer-phone.png", optimize=True)
        told(driver, server).resize((1280, 720), Image.Resampling.LANCZOS).save(folder / "explorer-story.png",
                                                                                optimize=True)
        driver.get("about:blank")
    server.end()


if __name__ == "__main__":
    main()
