"""Maps of the explorer: atlases over two keys of a pendulum."""

import numpy as np

from kapitza import style
from kapitza.plots.atlas_classes import centre_of, lacking_text
from kapitza.reading import arrays_of

from .requests import BadRequest
from .run_cache import CALM

# A map comes soon, as its first stage is computed beside the page's pictures, and then with more periods. Where they
# are asked for, those
# of four come too, with gaps between the curves looked for, and finer cells.
STAGES = ({"max_period": 1, "seeds": 4, "checks": 0, "points": 160},
          {"max_period": 2, "seeds": 8, "checks": 0, "points": 160}, {"max_period": 4, "checks": 60, "points": 400})


def maps(kept, request):
    """(header, payload) of each answer: `progress` while the program computes, `atlas` for each stage. `kept`: runs of
    the explorer."""
    axes = {axis: request.get(axis) for axis in ("x", "y")}
    if any(not isinstance(value, dict) for value in (*axes.values(), request.get("pendulum"))):
        raise BadRequest("a map needs the mappings pendulum, x and y")
    longest = request.get("max_period", STAGES[-1]["max_period"])
    stages = [stage for stage in STAGES if stage["max_period"] <= longest] if isinstance(longest, int) else []
    if not stages:
        raise BadRequest("max_period of a map must be an integer from 1")
    scenes = [{"pendulum": request["pendulum"], "atlas": {**axes, **stage}} for stage in stages]
    known = max((number for number, scene in enumerate(scenes) if kept.has(scene)), default=0)
    for number, scene in enumerate(scenes[known:], known):
        yield from kept.answers(scene, lambda result: packed(*arrays_of(result.path, "atlas")),
                                calm=CALM if number else 0, answer="atlas",
                                final=scene is scenes[-1], file=kept.name(scene))


def packed(atlas, attributes):
    """An atlas as the page takes it: a header, and bytes: x, y, side_x, side_y of all points (float32; places are
    shares of the plane), the number of the list of every cell (uint16; a list that is not known is null), whether the
    cycle that branches off attracts (uint8). `atlas`: the arrays of the group, by name."""
    low, width = zip(*(_edges(atlas[name]) for name in ("column", "row")), strict=True)
    numbers, cells = np.unique(atlas["list"], return_inverse=True)
    attracting = atlas["attracting"].reshape(len(atlas["class"]), -1)
    first = {int(number): int(np.argmax(atlas["list"].ravel() == number)) for number in numbers}
    lists = [None if number < 0 else [[int(row), int(attracting[row, first[int(number)]])]
                                      for row in np.flatnonzero(attracting[:, first[int(number)]])]
             for number in numbers]
    header = {
        "max_period": int(attributes["max_period"]), "certainty": lacking_text(float(attributes["lacking_high"])),
        "mirrored": bool(attributes["mirrored"]), "cells": len(atlas["row"]),
        "points": len(atlas["x"]), "low": low, "width": width,
        "curves": [_curve(atlas, i) for i in range(len(atlas["curve"]))],
        "classes": [_motion(atlas, i) for i in range(len(atlas["class"]))], "lists": lists}
    places = [(atlas[name] - low[i]) / width[i] for i, name in enumerate("xy")]
    floats = np.array([*places, atlas["side_x"], atlas["side_y"]], dtype="<f4")
    return header, floats.tobytes() + cells.astype("<u2").tobytes() + atlas["supercritical"].astype("u1").tobytes()


def _edges(middles):
    """Lower edge and width of an axis of cells."""
    step = middles[1] - middles[0]
    return middles[0] - step / 2, step * len(middles)


def _curve(atlas, i):
    name = style.name_text(atlas["curve_name"][i]).rpartition(": ")[0]
    kinds = ("fold", "period_doubling", "symmetry_breaking", "rest_swings", "rest_leans")
    return {"kind": kinds[int(atlas["curve_kind"][i])], "period": int(atlas["curve_period"][i]),
            "first": int(atlas["curve_first"][i]), "points": int(atlas["curve_points"][i]), "name": name}


def _motion(atlas, i):
    name, period = style.name_text(atlas["class_name"][i]), int(atlas["class_period"][i])
    colour = style.motion_colour(period, int(atlas["class_winding"][i]), centre_of(atlas["class_name"][i]))
    return {"name": name, "period": period, "symmetric": bool(atlas["class_symmetric"][i]), "colour": colour}
