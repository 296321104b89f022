# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 3. How hard may it be pushed?
# Three answers: along the drive amplitude (a sweep), by single pushes, over a plane of two parameters (a plane).

# %%
import os

import kapitza

COUNT = int(os.environ.get("KAPITZA_NOTEBOOK_COUNT", 60))
pendulum = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300}

# %% [markdown]
# The share of the starts that end upright, along the drive amplitude.

# %%
swept = kapitza.sweep({"pendulum": pendulum}, "drive_amplitude", {"min": 0.15, "max": 0.45, "count": max(3, COUNT // 4)}, starts=8 * COUNT)
swept.plot()

# %% [markdown]
# A push gives the upright pendulum a velocity. The weakest that throws it over, of a few thousand on a line:

# %%
import numpy as np

scene = {"pendulum": pendulum, "basin": {"velocity": {"min": -2, "max": 2}}}
pushes = np.linspace(0, 1, 20 * COUNT)
ends = kapitza.where(scene, np.pi, pushes)
falls = ends[ends["name"] != "inverted"]
print(f"It stands {falls['velocity'].iloc[0] - pushes[1]:.4f} and falls at {falls['velocity'].iloc[0]:.4f}, onto {falls['name'].iloc[0]}.")

# %% [markdown]
# The smallest shock in any direction, and where it leads, is `basin: {shocks: {scale: 0.5}}` in a scene
# ([how far to the edge](../explanation/boundaries.md#smallest-shocks)).

# %% [markdown]
# Where a release near the upright position ends, over frequency and amplitude of the drive.

# %%
plane = {"x": {"parameter": "drive_frequency", "min": 3, "max": 20, "count": COUNT},
         "y": {"parameter": "drive_amplitude", "min": 0.01, "max": 0.7, "count": COUNT},
         "measure": ["ends"], "ends": {"theta": [3.04]}}
kapitza.run({"pendulum": pendulum, "sweep": plane}).plot()
