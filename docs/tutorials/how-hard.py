#!/usr/bin/env python3
"""Tutorial: how hard may a pendulum that stands upside down be pushed before it falls?

Run it in the folder of the sources, after scripts/setup; it writes push.yaml and push.h5 there:

    .venv/bin/python docs/tutorials/how-hard.py

It goes from a scene to an answered question: a run, the basins, a look at the file, and single starts for the last digits.
"""

import json
import math
import subprocess
from pathlib import Path

import numpy as np
import xarray

KAPITZA = Path(__file__).resolve().parents[2] / "build" / "kapitza"

# 1. The scene. A pendulum shaken eleven times as fast as it swings, with an amplitude of 0.3 of its length, stands upside down.
#    A push gives it a velocity and no angle, so the window of starts is a narrow one about theta = pi (180 degrees), and as wide
#    in the velocity as the strongest push that we want to ask about. A velocity of 1 is one turn per shake.
SCENE = """
title: How hard may it be pushed?
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.300}
basin:
  theta: {min: 170 deg, max: 190 deg, count: 101}
  velocity: {min: -0.5, max: 0.5, count: 400}
"""
scene, result = Path("push.yaml"), Path("push.h5")
scene.write_text(SCENE)

# 2. The run. `kapitza run` finds the attractors by itself and labels every start with the one that it ends on.
summary = subprocess.run([KAPITZA, "run", scene, "--force"], check=True, capture_output=True, text=True).stdout
print(summary)

# 3. The file. One group for the attractors, one for the labels of the starts; xarray opens both.
attractors = xarray.open_dataset(result, group="attractors", engine="h5netcdf")
basin = xarray.open_dataset(result, group="basin", engine="h5netcdf")
inverted = list(attractors["name"].values).index("inverted")
share = float((basin["attractor"] == inverted).mean())
print(f"Of all starts in the window {100 * share:.1f} % end upright.")

# 4. The column of the starts that stand exactly upright, from no push upward: where does the first one fall?
upright = basin["attractor"].sel(theta=np.pi, method="nearest")
pushes = upright.sel(velocity=slice(0, None))
falls = int(np.argmax(pushes.values != inverted))
low, high = float(pushes["velocity"][falls - 1]), float(pushes["velocity"][falls])
print(f"On the grid it stands a push of {low:.4f} and falls at {high:.4f}.")


# 5. The last digits. `kapitza where` answers for single starts, here for a table of them, and says whether double precision can
#    decide them. Basins are mixed beyond their first edge, so halving an interval would find some edge; we look for the first.
def ends_of(pushes):
    """Where the upright pendulum ends after each push."""
    table = "".join(f"{math.pi!r},{push!r}\n" for push in pushes.tolist())
    command = [KAPITZA, "where", scene, "-", "--json"]
    answers = subprocess.run(command, input=table, check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in answers.splitlines()]


for _ in range(3):
    line = np.linspace(low, high, 101)
    ends = ends_of(line)
    first = next(place for place, end in enumerate(ends) if end["name"] != "inverted")
    low, high = float(line[first - 1]), float(line[first])
decided = "decided" if ends[first - 1]["decided"] and ends[first]["decided"] else "not decided"

# 6. The answer. Some harder pushes end upright again, which the picture of the whole plane shows
#    (kapitza view scenes/blackburn-fig12.yaml).
print(f"It stands a push of {low:.10f} rad per drive radian; at {high:.10f} it ends on \"{ends[first]['name']}\" ({decided}).")
again = int(np.sum(pushes.values[falls:] == inverted))
print(f"Of the {pushes.size - falls} harder pushes on the grid {again} end upright all the same.")
