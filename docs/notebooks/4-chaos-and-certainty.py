# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 4. Chaos and certainty
# Boundaries of these basins are fractal: near them tiny errors change the label. Which labels can be trusted?

# %%
import os

import kapitza

COUNT = int(os.environ.get("KAPITZA_NOTEBOOK_COUNT", 120))
scene = {
    "pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300},
    "basin": {"theta": {"count": COUNT}, "velocity": {"min": -2, "max": 2, "count": COUNT}},
}

# %% [markdown]
# `exact`, the default, follows what double precision leaves open in more digits, until its errors cannot change the label. The other
# methods are faster; where do they differ?

# %%
exact = kapitza.run(scene, method="exact")
fast = kapitza.run(scene, method="direct")
comparison = fast.compare(exact)
comparison

# %% [markdown]
# How fractal is it? The basin entropy, and the uncertainty exponent: halving an error by two leaves 2^-exponent of the doubtful starts.

# %%
print("basin entropy, at boundaries:", exact.basin_entropy())
print("uncertainty exponent:", exact.uncertainty_exponent())

# %% [markdown]
# A window of 1e-20 about a point of the boundary is labelled as well. Find one by halving between two starts that end differently:

# %%
from decimal import Decimal, getcontext

getcontext().prec = 40
low, high = Decimal("2.0"), Decimal("3.1")
with kapitza.Engine(scene) as engine:
    first = engine.where(str(low), "0.3")["name"]
    for _ in range(70):
        middle = (low + high) / 2
        low, high = (middle, high) if engine.where(str(middle), "0.3")["name"] == first else (low, middle)
    labels = engine.frame({"theta": {"centre": str(low), "width": 1e-20}, "velocity": {"centre": "0.3", "width": 1e-20}}, (24, 36))
    print(low, {engine.attractors["name"].get(label, "not settled") for label in set(labels.ravel().tolist())})
