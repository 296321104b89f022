"""The pictures of a report: those of kapitza plot, without titles: the page has its own."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

from kapitza.plots import basin, chart, line, orbit, potential, stability, sweep, tradeoff
from kapitza.result import Result

# Group of a result -> the pictures of it: caption, what draws it, options. Those with UNITS are in them if the scene is in SI.
UNITS = {"basin": ["--si", "--degrees"], "orbit": ["--si", "--degrees"], "sweep": ["--degrees"], "potential": ["--degrees"],
         "line": ["--si"], "plane": ["--si"]}
PICTURES: dict[str, list[tuple[str, Callable[[list[str]], None], list[str]]]] = {
    "basin": [("Every start in the colour of the motion in which it ends; dots are strobe points.", basin.main, []),
              ("After how long it is certain where every start ends.", basin.main, ["--quantity", "settling_time"])],
    "orbit": [("One motion: in time, in space, in the phase plane, and its spectral lines.", orbit.main, [])],
    "stability": [("Where small oscillations stay small.", stability.main, [])],
    "potential": [("The effective potential of the slow motion.", potential.main, [])],
    "line": [("Measures along the swept key.", line.main, [])],
    "plane": [("Over the plane of two keys.", chart.main, [])],
    "sweep": [("Along the swept key.", sweep.main, [])],
    "tradeoff": [("Wrong labels against time.", tradeoff.main, [])],
}
DPI = 130


def pictures(result: Result) -> Iterator[tuple[str, bytes]]:
    """Caption and bytes (PNG) of every picture of the groups that the result holds."""
    with tempfile.TemporaryDirectory(prefix="kapitza-report-") as folder:
        picture = Path(folder) / "picture.png"
        for group, rows in PICTURES.items():
            units = UNITS.get(group, []) if result.pivot_frequency else []
            for caption, draw, options in rows if group in result.groups else ():
                with redirect_stdout(StringIO()):  # the picture's name
                    draw([str(result.path), "-o", str(picture), "--dpi", str(DPI), "--no-title", *options, *units])
                yield caption, picture.read_bytes()
