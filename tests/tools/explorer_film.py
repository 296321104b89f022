"""Records the film of the explorer that README.md shows, from the real page in Chromium:  tests/tools/explorer_film.py OUT.gif

The wheel zooms into a boundary, Home leads back, the drive amplitude rises, and a click plays the pendulum. A GIF by ffmpeg.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "python"), str(ROOT / "python")]

from explorer_page import Page, Server, browser, wait_for  # noqa: E402

SCENE = ROOT / "scenes" / "blackburn-fig12.yaml"
SIZE = "960,690"  # of the window; the page itself is 139 px lower
WIDTH = 600  # of the film, px
RATE = 8  # pictures a second
BOUNDARY = (-0.264011425069458, 1.42)  # theta, velocity


class Film:
    """Pictures of the page in a folder."""

    def __init__(self, page, folder):
        self.page, self.folder, self.count = page, folder, 0

    def shoot(self, copies=1):
        """The page as it is, for so many pictures of the film."""
        picture = self.page.driver.get_screenshot_as_png()
        for _ in range(copies):
            (self.folder / f"{self.count:04d}.png").write_bytes(picture)
            self.count += 1


def zoom(film, page):
    """Into a boundary by the wheel, and back."""
    for _ in range(14):
        page.wheel(*shares(page.window()), -100, -100, -100, -100)
        page.wait()
        film.shoot()
    film.shoot(RATE)
    page.key("h")
    page.wait()
    film.shoot(RATE // 2)


def shares(window):
    """Where BOUNDARY lies in a window, from its left and lower edge on."""
    edges = [[float(window[axis][key]) for key in ("min", "max")] for axis in ("theta", "velocity")]
    return [(value - low) / (high - low) for value, (low, high) in zip(BOUNDARY, edges, strict=True)]


def drag(film, page):
    """The drive amplitude from 0.30 to 0.46 and back."""
    for amplitude in [*(0.30 + 0.016 * i for i in range(1, 11)), 0.30]:
        page.choose("value-drive_amplitude", f"{amplitude:.3f}")
        page.wait()
        film.shoot(2)


def play(film, page):
    """A start beside the inverted position, for two seconds."""
    page.hand(0.93, 0.52, 0.93, 0.52)
    wait_for(lambda: page.run("$('ending').dataset.ending"))
    for _ in range(3 * RATE):
        film.shoot()
        time.sleep(0.05)


def join(folder, path):
    """The pictures as one GIF with a palette of their own."""
    look = (f"scale={WIDTH}:-1:flags=area,split[a][b];[a]palettegen=max_colors=64:stats_mode=full[p];"
            "[b][p]paletteuse=dither=none:diff_mode=rectangle")
    command = ["ffmpeg", "-v", "error", "-y", "-framerate", str(RATE), "-i", folder / "%04d.png", "-filter_complex", look, path]
    subprocess.run(list(map(str, command)), check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", type=Path)
    path = parser.parse_args().path
    server = Server(SCENE)
    with tempfile.TemporaryDirectory() as name, browser(Path(name), SIZE) as driver:
        pictures = Path(name) / "film"
        pictures.mkdir()
        page = Page(driver, server.address() + "#samples=1&theme=light")
        page.wait()
        film = Film(page, pictures)
        film.shoot(RATE)
        zoom(film, page)
        drag(film, page)
        play(film, page)
        join(pictures, path)
    server.end()
    print(f"{path}: {film.count} pictures, {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
