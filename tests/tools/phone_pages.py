"""Opens every page of the site in Chromium on a phone's width, and says which pages are wider than the phone.

    phone_pages.py build/site/VERSION [--width 390] [--pictures FOLDER]      status 1 where a page has to be scrolled sideways

Tables and blocks of code may scroll inside their own frames; the page itself may not.
"""

import argparse
import sys
from pathlib import Path

from selenium import webdriver

HIGHEST = 2400  # of a picture, CSS pixels


def browser(width):
    options = webdriver.ChromeOptions()
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage"):
        options.add_argument(option)
    options.add_experimental_option("mobileEmulation", {"deviceMetrics": {"width": width, "height": 800, "pixelRatio": 2}})
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("site", type=Path)
    parser.add_argument("--width", type=int, default=390, help="of the phone, CSS pixels")
    parser.add_argument("--pictures", type=Path, help="a folder for pictures of the pages")
    arguments = parser.parse_args()
    pages = sorted(page.resolve() for page in [arguments.site / "index.html", *arguments.site.glob("[!_]*/*.html")])
    with browser(arguments.width) as driver:
        widths = {page: look(driver, page, arguments.pictures) for page in pages}
    wide = {page: width for page, width in widths.items() if width > arguments.width}
    for page, width in wide.items():
        print(f"{page.relative_to(arguments.site.resolve())}: {width} px wide on a phone of {arguments.width} px")
    print(f"{len(pages)} pages, {len(wide)} too wide")
    return 1 if wide or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
