"""The explorer in headless Chromium: pictures a second, the slowest of them, and frames of basins a second, while the
wheel zooms from 1 to 1e-20, while a slider is dragged, and while the point of the map is. Frames are drawn by software
where there is no graphics card, and clocks count what else the machine does."""

import argparse
import json
import statistics
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / folder) for folder in ("python", "tests/python", "tests/tools")]
from explorer_page import Page, Server, browser  # noqa: E402

SCENE = ROOT / "scenes" / "blackburn-fig12.yaml"
EVERY = 16  # ms between two events of a hand
# Times between pictures, in ms, while `step` is called every EVERY ms until it returns true.
WATCH = """
const [place] = arguments, done = arguments[arguments.length - 1], times = [];
let last = performance.now(), over = false, count = 0;
const pane = explorer.basins.panes[0];
let frames = 0, shown = pane.latest;
const picture = () => {
  if (pane.latest !== shown) { frames++; shown = pane.latest; }
  const now = performance.now(); times.push(now - last); last = now; if (!over) requestAnimationFrame(picture); };
const step = STEP;
requestAnimationFrame(picture);
const rest = () => { clearInterval(hand); setTimeout(() => { over = true; done([times, frames]); }, 500); };
const hand = setInterval(() => { if (step(count++)) rest(); }, EVERY);
"""
WHEEL = """() => {
  const box = pane.over.getBoundingClientRect(), [left, top] = pane.plane.placeOf(0.37, 0.42);
  const at = { clientX: box.left + left, clientY: box.top + top, bubbles: true, cancelable: true };
  pane.over.dispatchEvent(new WheelEvent("wheel", { deltaY: -100, ...at }));
  return JSON.parse(document.getElementById("where").dataset.window).theta.width < 1e-20; }"""
SLIDER = """(n) => {
  const slider = document.getElementById("slider-drive_amplitude");
  slider.value = n / 3000;
  slider.dispatchEvent(new Event("input"));
  return n >= 300; }"""

MAP = """(n) => { explorer.map.go([0.3 + n / 3000, 0.4 + n / 6000]); return n >= 300; }"""


def watch(driver, step):
    return driver.execute_async_script(WATCH.replace("STEP", step).replace("EVERY", str(EVERY)))


def measure(size):
    """name -> times between pictures, ms, and the number of frames of basins."""
    found = {}
    with tempfile.TemporaryDirectory() as folder, browser(Path(folder), size) as driver:
        driver.set_script_timeout(300)
        server = Server(SCENE)
        for name, step in (("zoom-1e-20", WHEEL), ("slider-drive-amplitude", SLIDER), ("map", MAP)):
            driver.get("about:blank")
            page = Page(driver, server.address() + f"#samples=1&map={'on' if step is MAP else 'off'}")
            page.wait()
            found[name] = watch(driver, step)
            page.wait()
        driver.get("about:blank")
        server.end()
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="1280,829", help="of the window, px (default: 1280,829)")
    parser.add_argument("--json", action="store_true", help="figures for other programs")
    options = parser.parse_args()
    rows = [{"name": name, "pictures": len(times), "pictures_per_second": 1e3 * len(times) / sum(times),
             "median_ms": statistics.median(times), "slowest_ms": max(times),
             "frames_per_second": 1e3 * frames / sum(times)}
            for name, (times, frames) in measure(options.size).items()]
    if options.json:
        print(json.dumps(rows, indent=1))
        return
    for row in rows:
        print(f"{row['name']:24}{row['pictures_per_second']:7.1f} pictures/s, median {row['median_ms']:.0f} ms, "
              f"slowest {row['slowest_ms']:.0f} ms, {row['frames_per_second']:.1f} frames/s")


if __name__ == "__main__":
    main()
