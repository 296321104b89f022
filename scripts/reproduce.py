"""Draws the figures of python/kapitza/figures.py, each scene run once, and writes the papers' numbers (see
scripts/reproduce)."""

import argparse
import fnmatch
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from kapitza.figures import ADDED, FIGURES, TUTORIALS  # noqa: E402
from kapitza.result import Result  # noqa: E402
from papers.page import find_numbers, write_page  # noqa: E402

RESULTS, DOCS = ROOT / "results", ROOT / "docs"
SHEET = """<!doctype html><meta charset='utf-8'><style>
body { margin: 0; font: 20px sans-serif; display: grid; grid-template-columns: repeat(4, 1fr); }
figure { margin: 8px; } img { max-width: 100%; max-height: 460px; }</style>"""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pattern", nargs="?",
                        help="names of the figures, as a shell pattern (default: all, and the numbers)")
    parser.add_argument("--numbers", action="store_true",
                        help="no figure: only the numbers of the papers, docs/validation/results.md")
    parser.add_argument("--ranks", type=int, default=int(os.environ.get("RANKS", os.cpu_count())))
    parser.add_argument("--list", action="store_true", help="print the table and run nothing")
    parser.add_argument("--pages", action="store_true",
                        help="the figures that the pages show, into docs/figures, and a sheet of them")
    arguments = parser.parse_args()
    known = shown() if arguments.pages else {name for name, *_ in FIGURES}
    arguments.names = fnmatch.filter(sorted(known), arguments.pattern or "*")
    arguments.figures = [figure for figure in FIGURES if figure[0] in arguments.names]
    if not arguments.names:
        parser.error(f"no figure is called {arguments.pattern}; --list shows the names")
    return arguments


def step(*command):
    """Runs one command and returns its status."""
    print("reproduce:", *command, flush=True)
    return subprocess.run(command, cwd=ROOT).returncode


def result_of(scene):
    return f"results/{Path(scene).name}.h5"


def run_scene(scene, ranks):
    """Goes on from an interrupted run, keeps a complete result, replaces one of another scene or program (status 2)."""
    run = ["mpirun", "-n", str(ranks), "build/kapitza", "run", f"scenes/{scene}.yaml", "-o", result_of(scene)]
    status = step(*run, "--resume")
    return step(*run, "--force") if status == 2 else status


def draw_figures(arguments):
    RESULTS.mkdir(exist_ok=True)
    for scene in dict.fromkeys(scene for _, scene, _, _ in arguments.figures):
        if status := run_scene(scene, arguments.ranks):
            sys.exit(status)
        if scene in ADDED:
            ADDED[scene](Result(result_of(scene)))
        for name, _, kind, options in (figure for figure in arguments.figures if figure[1] == scene):
            if status := step("build/kapitza", "plot", kind, result_of(scene), "-o", f"results/{name}.png", *options):
                sys.exit(status)
            shrink(RESULTS / f"{name}.png")


def shown():
    """The names of the figures that pages show."""
    text = "".join(path.read_text() for path in DOCS.rglob("*.md"))
    return set(re.findall(r"figures/([\w-]+)\.(?:png|svg)\)", text))


def draw_pages(arguments):
    """The figures of the pages: those of scenes, of tutorials, the drawings; and one sheet of all."""
    draw_figures(arguments)
    for name in TUTORIALS.keys() & set(arguments.names):
        draw_tutorial(name, *TUTORIALS[name])
    for name in arguments.names:
        if (picture := RESULTS / f"{name}.png").exists():
            shutil.copy(picture, DOCS / "figures")
    if any(name.startswith("drawing-") for name in arguments.names):
        step(sys.executable, "docs/drawings.py")
    if arguments.pattern is None:
        draw_sheet()


def draw_tutorial(name, page, result, kind, options):
    """Runs the commands of a tutorial, and draws what they made."""
    commands = re.findall(r"^```bash\n(.+?)^```", (DOCS / "tutorials" / f"{page}.md").read_text(),
                          re.MULTILINE | re.DOTALL)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "build").symlink_to(ROOT / "build")
        subprocess.run(["bash", "-e", "-c", "".join(commands)], cwd=folder, check=True)
        output = RESULTS / f"{name}.png"
        subprocess.run([ROOT / "build" / "kapitza", "plot", kind, Path(folder) / result, "-o", output, *options],
                       cwd=ROOT, check=True)
    shrink(output)


def draw_sheet():
    """Every figure of the pages beside its name."""
    pictures = sorted(path for path in (DOCS / "figures").iterdir() if path.suffix in (".png", ".svg"))
    cells = [f"<figure><img src='{path.as_uri()}'><figcaption>{path.name}</figcaption></figure>" for path in pictures]
    (RESULTS / "sheet.html").write_text(SHEET + "".join(cells))
    photograph("sheet", 2800, 130 * len(cells))


def photograph(name, width, height):
    """results/NAME.png of results/NAME.html, by chromium."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if not chromium:
        print(f"reproduce: chromium is not installed: no results/{name}.png", file=sys.stderr)
        return
    words = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--window-size={width},{height}"]
    subprocess.run([chromium, *words, f"--screenshot={RESULTS / name}.png", (RESULTS / f"{name}.html").as_uri()],
                   check=True, capture_output=True, timeout=300)
    print(RESULTS / f"{name}.png")


def shrink(path):
    """Gives a picture a palette of 256 colours: a fifth of the bytes."""
    picture = Image.open(path)
    small = picture.convert("RGB").quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    small.save(path, optimize=True, dpi=picture.info.get("dpi"))


def write_numbers():
    """docs/validation/results.md; status 1 and a line for each number that failed."""
    found = find_numbers(lambda words: print("reproduce:", words, flush=True))
    failed = write_page(found, ROOT / "docs" / "validation" / "results.md")
    print(f"reproduce: docs/validation/results.md has {sum(len(numbers) for _, numbers in found)} numbers, "
          f"{len(failed)} failed")
    for number in failed:
        print(f"reproduce: FAILED: {number.place}: {number.quantity}: ours {number.ours:.12g}, paper "
              f"{number.printed or '-'}, "
              f"reference {'-' if number.reference is None else format(number.reference, '.12g')}", file=sys.stderr)
    if failed:
        sys.exit(1)


def main():
    arguments = parse_arguments()
    if arguments.list:
        for name, scene, kind, options in arguments.figures:
            print(f"{name:28} scenes/{scene}.yaml  {kind} {' '.join(options)}")
        return
    if arguments.pages:
        draw_pages(arguments)
        return
    if not arguments.numbers:
        draw_figures(arguments)
    if arguments.numbers or not arguments.pattern:
        write_numbers()


if __name__ == "__main__":
    main()
