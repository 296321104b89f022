# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 1. First basin
# A pendulum whose pivot is shaken can stand upside down. From which starts does it end there?

# %%
import os

import kapitza

COUNT = int(os.environ.get("KAPITZA_NOTEBOOK_COUNT", 300))  # cells along each axis; the tests take few

# %% [markdown]
# A scene says which pendulum, and what to study. It is a dict here; a YAML file holds the same.

# %%
scene = {
    "title": "First basin",
    "pendulum": {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300},
    "basin": {"theta": {"count": COUNT}, "velocity": {"min": -2, "max": 2, "count": COUNT}},
}
result = kapitza.run(scene)
result

# %% [markdown]
# Every start has the label of the motion in which it ends. `attractors` lists these motions, with the share of the starts of each.

# %%
result.attractors[["name", "period", "winding", "fraction"]]

# %%
result.plot(centre="inverted")

# %% [markdown]
# Numbers are xarray and pandas: the label of one start, the share that ends upright, after how long the ends are certain.

# %%
print("(3.1, 0.2) ends on", result.at(3.1, 0.2)["name"])
print(f"upright: {float(result.basin('inverted').mean()):.1%}")
print(f"median time: {float(result.convergence_times().median()):.0f} drive periods")

# %% [markdown]
# Single starts need no grid.

# %%
kapitza.where(scene, [3.1, "175 deg", "pi/2"], 0.2)[["theta", "velocity", "name", "settling_time", "decided"]]
