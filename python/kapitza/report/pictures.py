"""The pictures of a report: those of kapitza plot, without titles: the page has its own."""

from collections.abc import Iterator
from io import BytesIO
from typing import Any

from kapitza.plots.picture import picture
from kapitza.result import Result

# Group of a result -> the pictures of it: caption and options. Those with UNITS are in them if the scene is in SI.
UNITS = {"basin": ("si", "degrees"), "orbit": ("si", "degrees"), "sweep": ("degrees",), "potential": ("degrees",),
         "line": ("si",), "plane": ("si",)}
PICTURES: dict[str, list[tuple[str, dict[str, Any]]]] = {
    "basin": [("Every start in the colour of the motion in which it ends; dots are strobe points.", {}),
              ("After how long it is certain where every start ends.", {"quantity": "settling_time"})],
    "orbit": [("One motion: in time, in space, in the phase plane, and its spectral lines.", {})],
    "stability": [("Where small oscillations stay small.", {})],
    "potential": [("The effective potential of the slow motion.", {})],
    "line": [("Measures along the swept key.", {})],
    "plane": [("Over the plane of two keys.", {})],
    "sweep": [("Along the swept key.", {})],
    "tradeoff": [("Wrong labels against time.", {})],
}
DPI = 130


def pictures(result: Result) -> Iterator[tuple[str, bytes]]:
    """Caption and bytes (PNG) of every picture of the groups that the result holds."""
    for group, rows in PICTURES.items():
        units: dict[str, Any] = dict.fromkeys(UNITS.get(group, ()) if result.pivot_frequency else (), True)
        for caption, options in rows if group in result.groups else ():
            data = BytesIO()
            picture(result, group, no_title=True, **options, **units).savefig(data, format="png", dpi=DPI)
            yield caption, data.getvalue()
