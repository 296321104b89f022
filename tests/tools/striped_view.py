"""`kapitza view` with a double of its engine without mechanics: its basins are stripes. It shows what page and server
do with what an engine gives seldom: slow levels (pendulum m from 5 to 6: 0 to 1 s), deafness after the first level (m =
6), slow frames (m = 7), refusals (m = 8), a sudden end (m = 9)."""

import os
import sys
import time
from decimal import Decimal, getcontext
from pathlib import Path

import numpy as np

getcontext().prec = 150
ROWS = [("down", "down", 1, 0, "down"), ("inverted", "inverted", 1, 0, "inverted"),
        ("flutter", "flutter", 2, 0, "inverted")]
STROBE = (0.0, 0.135, 0.165)  # in their own stripes, whatever the cells
PENDULUM = {"k": 0.1, "damping": 0.05, "m": 0.3}
SCENE = Path(__file__).with_name("stripes.yaml")


def catalogue(pendulum):
    rows = [{"id": i, "track": i, "name": name, "kind": kind, "period": period, "winding": winding, "centre": centre,
             "symmetric": True,
             "mirror": i, "multiplier": 0.5, "strobe": [[STROBE[i], 0.0]]} for i,
             (name, kind, period, winding, centre) in enumerate(ROWS)]
    return {"answer": "catalogue", "version": int(1000 * pendulum["m"]), "pendulum": pendulum, "attractors": rows}


def edges(axis):
    if "centre" in axis:
        return Decimal(str(axis["centre"])) - Decimal(str(axis["width"])) / 2, Decimal(str(axis["width"]))
    return Decimal(str(axis["min"])), Decimal(str(axis["max"])) - Decimal(str(axis["min"]))


def label(theta, m):
    """Stripes at every scale: the third of the first decimal in which theta / m differs from 1/3."""
    scaled = abs(theta) / Decimal(str(m))
    return int(str(scaled % 1 + 2)[2:60].lstrip(".").lstrip("3")[:1] or 0) % 3


def amplitude(request):
    """Stories have other keys."""
    pendulum = request.get("pendulum", {})
    return pendulum.get("m", pendulum.get("drive_amplitude", PENDULUM["m"]))


class Stripes:
    """Answers as kapitza.explorer.requests.Engine does."""

    def __init__(self, *scene):
        pass

    def answers(self, request, show, between):
        if request["request"] == "frame":
            return self.frame(request, show, between)
        show(*self.other(request))
        return True

    def frame(self, request, show, between):
        from kapitza.explorer.requests import BadRequest
        pendulum = {"m": amplitude(request)} | request.get("pendulum", PENDULUM)
        m, levels = pendulum["m"], request.get("levels", [1])
        if m == 8:
            raise BadRequest("pendulum.m: must not be 8")
        if m == 9:
            os._exit(1)
        show(catalogue(pendulum) | {"final": False}, ())
        low, width = edges(request["window"]["theta"])
        for level in levels:
            if m == 6 and level < levels[0]:
                time.sleep(60)
            end = time.monotonic() + (1.0 if m == 7 else m - 5 if 5 < m < 6 else 0)
            while between() and time.monotonic() < end:
                time.sleep(0.01)
            if not between():
                return False
            rows, columns = (-(-request[name] // level) for name in ("rows", "columns"))
            line = np.array([label(low + width * (2 * level * j + level) / (2 * request["columns"]), m)
                             for j in range(columns)], np.uint8)
            parts = {"labels": line, "settling_time": np.float32(9.0 * line), "doubt": np.uint8(line == 2),
                     "smooth_time": np.float32(9.0 * line + 0.5 + np.arange(columns) / columns),
                     "other": np.where(line == 2, 0, 255).astype(np.uint8),
                     "turns": np.float32(8 * np.arange(columns) // columns)}
            planes = request.get("planes", ["labels"])
            show({"answer": "frame", "final": level == levels[-1], "level": level, "rows": rows, "columns": columns,
                  "planes": planes,
                  "catalogue": int(1000 * m), "quality": request.get("quality", "exact")},
                 [np.tile(parts[name], (rows, 1)) for name in planes])
        return True

    def other(self, request):
        name, m = request["request"], amplitude(request)
        if name == "catalogue":
            return catalogue(PENDULUM) | {"final": True}, ()
        if name == "where":
            end = label(Decimal(str(request["theta"])), m)
            return {"answer": "where", "final": True, "theta": float(request["theta"]),
                    "velocity": float(request["velocity"]),
                    "attractor": end, "name": ROWS[end][0], "period": ROWS[end][2], "settling_time": 12,
                    "near_time": 30, "decided": True,
                    "precision": "double", "strobe_theta": [0.5], "strobe_velocity": [0]}, ()
        if name == "orbit":
            n, start = request["samples_per_period"], float(request["theta"])
            times = 2 * np.pi * np.arange(request["periods"] * n + 1) / n
            return {"answer": "orbit", "final": True, "samples": len(times), "samples_per_period": n,
                    "pivot": [[0, m * np.cos(t)] for t in times[:n]]}, [np.array([start * np.cos(times / 3),
                                                                                  -start / 3 * np.sin(times / 3)])]
        rows, columns = request["y"]["count"], request["x"]["count"]
        cells = np.tile(np.uint8(np.arange(columns) // 20 % 3), (rows, 1))
        return {"answer": "chart", "final": True, "level": 1, "rows": rows, "columns": columns}, [cells, cells % 2]


if __name__ == "__main__":
    from kapitza.explorer import command
    from striped_view import Stripes as Importable  # processes of the explorer find it by this name
    sys.argv.insert(1, "--no-browser")
    command.main(Importable)
