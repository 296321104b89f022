"""What the tests of orbits share: the literature's values and ways to write scenes."""

import json
from math import pi

from conftest import ROOT

REFERENCE = json.loads((ROOT / "tests" / "literature" / "reference.json").read_text())
NODDING = REFERENCE["multiple_nodding_cycles"]
FIGURES = REFERENCE["blackburn_fig11_15_attractors_Q5_Omega11"]
BLACKBURN = {"quality_factor": 5, "drive_frequency": 11}
WINDOW = {"velocity": {"min": -1.5, "max": 1.5}}
TURN = 2 * pi


def closed(theta, velocity, **more):
    return {"start": {"theta": theta, "velocity": velocity}, "closed": True, **more}


def parameters(cycle):
    return {"k": cycle["k"], "damping": float(cycle["beta"]), "m": cycle["m"]}


def near(angle, other=0.0):
    """The difference of two angles around the circle."""
    return abs((angle - other + pi) % TURN - pi)
