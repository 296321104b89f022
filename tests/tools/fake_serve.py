#!/usr/bin/env python3
"""A double of `kapitza serve` (docs/reference/serve.md) without mechanics: its basins are stripes. As the program of an
explorer it shows what page and server do with what the program gives seldom: slow levels (pendulum m from 5 to 6: 0 to
1 s), deafness after the first level (m = 6), slow frames (m = 7), refusals (m = 8), a sudden end (m = 9)."""

import json
import math
import os
import struct
import sys
import threading
import time
from decimal import Decimal, getcontext

getcontext().prec = 150
ROWS = [("down", "down", 1, 0, "down"), ("inverted", "inverted", 1, 0, "inverted"),
        ("flutter", "flutter", 2, 0, "inverted")]
STROBE = (0.0, 0.135, 0.165)  # in their own stripes, whatever the cells
PENDULUM = {"k": 0.1, "damping": 0.05, "m": 0.3}
out, newest = threading.Lock(), {}


def answer(kind, sequence, payload=b"", final=True, **more):
    with out:
        header = {"answer": kind, "sequence": sequence, "final": final, "bytes": len(payload)} | more
        sys.stdout.buffer.write(json.dumps(header).encode() + b"\n" + payload)
        sys.stdout.buffer.flush()


def catalogue(sequence, pendulum, final):
    rows = [{"id": i, "track": i, "name": name, "kind": kind, "period": period, "winding": winding, "centre": centre,
             "symmetric": True,
             "mirror": i, "multiplier": 0.5, "strobe": [[STROBE[i], 0.0]]} for i,
            (name, kind, period, winding, centre) in enumerate(ROWS)]
    answer("catalogue", sequence, final=final, version=int(1000 * pendulum["m"]), pendulum=pendulum, attractors=rows)


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


def frame(request):
    sequence, view = request["sequence"], request.get("view", "")
    pendulum = {"m": amplitude(request)} | request.get("pendulum", PENDULUM)
    if pendulum["m"] == 8:
        return answer("error", sequence, status=2, message="kapitza: error: -:1:418: pendulum.m: must not be 8")
    if pendulum["m"] == 9:
        print("kapitza: error: out of memory", file=sys.stderr, flush=True)
        os._exit(1)
    catalogue(sequence, pendulum, final=False)
    low, width = edges(request["window"]["theta"])
    levels = request.get("levels", [1])
    for level in levels:
        if pendulum["m"] == 7 or 5 < pendulum["m"] < 6:
            time.sleep(1.0 if pendulum["m"] == 7 else pendulum["m"] - 5)
        if pendulum["m"] == 6 and level < levels[0]:
            time.sleep(60)
        if newest.get(view) != sequence:
            return answer("ended", sequence)
        rows, columns = (math.ceil(request[name] / level) for name in ("rows", "columns"))
        line = bytes(label(low + width * (2 * level * j + level) / (2 * request["columns"]), pendulum["m"])
                     for j in range(columns))
        planes = request.get("planes", ["labels"])
        parts = {"labels": line, "settling_time": struct.pack(f"<{columns}f", *(9.0 * x for x in line)),
                 "smooth_time": struct.pack(f"<{columns}f", *(9.0 * x + 0.5 + j / columns for j, x in enumerate(line))),
                 "doubt": bytes(x == 2 for x in line), "other": bytes(0 if x == 2 else 255 for x in line),
                 "turns": struct.pack(f"<{columns}f", *(8 * j // columns for j in range(columns)))}
        answer("frame", sequence, b"".join(parts[name] * rows for name in planes), level == levels[-1], level=level,
               rows=rows,
               columns=columns, planes=planes, catalogue=int(1000 * pendulum["m"]),
               quality=request.get("quality", "exact"))


def other(request):
    sequence, name, m = request["sequence"], request["request"], amplitude(request)
    if name == "catalogue":
        catalogue(sequence, PENDULUM, True)
    elif name == "where":
        end = label(Decimal(str(request["theta"])), m)
        answer("where", sequence, theta=float(request["theta"]), velocity=float(request["velocity"]), attractor=end,
               name=ROWS[end][0], period=ROWS[end][2], settling_time=12, near_time=30, decided=True, precision="double",
               strobe_theta=[0.5], strobe_velocity=[0])
    elif name == "orbit":
        n, start = request["samples_per_period"], float(request["theta"])
        times = [2 * math.pi * i / n for i in range(request["periods"] * n + 1)]
        values = [start * math.cos(t / 3) for t in times] + [-start / 3 * math.sin(t / 3) for t in times]
        answer("orbit", sequence, struct.pack(f"<{len(values)}d", *values), samples=len(times), samples_per_period=n,
               pivot=[[0, m * math.cos(t)] for t in times[:n]])
    elif name == "chart":
        rows, columns = request["y"]["count"], request["x"]["count"]
        cells = bytes((i // 20) % 3 for _ in range(rows) for i in range(columns))
        answer("chart", sequence, cells + bytes(c % 2 for c in cells), level=1, rows=rows, columns=columns)
    else:
        answer("ended" if name == "cancel" else "error", sequence, status=2, message=f"no request {name}")


def main():
    if not os.path.exists(sys.argv[2]) or "wrong" in open(sys.argv[2]).read():
        print(f"kapitza: error: {sys.argv[2]}:1:1: wrong: no such key", file=sys.stderr)
        sys.exit(2)
    window = {"theta": {"min": -math.pi, "max": math.pi, "count": 100}, "velocity": {"min": -2, "max": 2, "count": 100}}
    answer("ready", None, protocol=1, program="0", title="Stripes", pendulum=PENDULUM, window=window, threads=1)
    for line in sys.stdin:
        request = json.loads(line)
        if request["request"] == "quit":
            break
        if request["request"] in ("frame", "cancel"):
            newest[request.get("view", "")] = request["sequence"]
        threading.Thread(target=frame if request["request"] == "frame" else other, args=[request], daemon=True).start()
    os._exit(0)


main()
