"""Opens every page of the site in Chromium at a phone's width, and every twelfth page in two wider windows, and names
the pages whose text is wider than the window.

    phone_pages.py build/site/VERSION [--width 390] [--pictures FOLDER]      status 1 if there is such a page

Tables and blocks of code may scroll inside their own frames; the page itself may not.
"""

import argparse
import sys
from pathlib import Path

from selenium import webdriver

HIGHEST = 2400  # height of a picture, CSS pixels
WINDOWS = (820, 1100)  # widths of a tablet and of a small screen, CSS pixels


def browser(width):
    options = webdriver.ChromeOptions()
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage"):
        options.add_argument(option)
    options.add_experimental_option("mobileEmulation",
                                    {"deviceMetrics": {"width": width, "height": 800, "pixelRatio": 2}})
    return webdriver.Chrome(options=options, service=webdriver.ChromeService("/usr/bin/chromedriver"))


def look(driver, page, pictures):
    """Width of the page's content, CSS pixels."""
    driver.get(page.as_uri())
    wide = driver.execute_script("return document.scrollingElement.scrollWidth")
    if pictures:
        name = "-".join(page.with_suffix("").parts[-2:])
        high = min(driver.execute_script("return document.scrollingElement.scrollHeight"), HIGHEST)
        screen = {"width": wide, "height": high, "deviceScaleFactor": 1, "mobile": True}
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        driver.save_screenshot(str(pictures / f"{name}.png"))
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    return wide


def text_ends(driver, page, window):
    """The right edge of a page's text in a window, CSS pixels."""
    driver.get(page.as_uri())
    screen = {"width": window, "height": 800, "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    return driver.execute_script("return document.querySelector('article').getBoundingClientRect().right")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("site", type=Path)
    parser.add_argument("--width", type=int, default=390, help="of the phone, CSS pixels")
    parser.add_argument("--pictures", type=Path, help="a folder for pictures of the pages")
    arguments = parser.parse_args()
    pages = sorted(page.resolve() for page in [arguments.site / "index.html", *arguments.site.glob("[!_]*/*.html")])
    with browser(arguments.width) as driver:
        widths = {(page, arguments.width): look(driver, page, arguments.pictures) for page in pages}
        widths |= {(page, window): text_ends(driver, page, window) for window in WINDOWS for page in pages[::12]}
    wide = {place: width for place, width in widths.items() if width > place[1]}
    for (page, window), width in wide.items():
        print(f"{page.relative_to(arguments.site.resolve())}: {width:.0f} px wide in a window of {window} px")
    print(f"{len(pages)} pages, {len(wide)} too wide")
    return 1 if wide or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
