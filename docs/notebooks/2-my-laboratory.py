# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 2. My laboratory's pendulum, in SI units
# A rod of 20 cm with a small mass at its end, on a shaker at 50 Hz. How hard must it be shaken to stand upside down?

# %%
import os

import kapitza

COUNT = int(os.environ.get("KAPITZA_NOTEBOOK_COUNT", 200))
pendulum = {"length": "20 cm", "frequency": "50 Hz", "amplitude": "5 mm", "quality_factor": 20}
scene = {
    "title": "On the shaker",
    "pendulum": pendulum,
    "basin": {"theta": {"count": COUNT}, "velocity": {"min": -0.3, "max": 0.3, "count": COUNT}},
}

# %% [markdown]
# The first line of a summary says it: which rest positions are stable, and between which amplitudes.

# %%
print(next(line for line in kapitza.check(scene).text.splitlines() if line.startswith("Rest")))

# %% [markdown]
# 5 mm are not enough. With 8 mm:

# %%
result = kapitza.run(scene, set={"pendulum.amplitude": "8 mm"})
result.plot(centre="inverted", si=True, degrees=True)

# %% [markdown]
# Which starts at 170 degrees with a push of 1, 5 and 20 rad/s stay up?

# %%
pushes = ["1 rad/s", "5 rad/s", "20 rad/s"]
kapitza.where(scene, "170 deg", pushes, set={"pendulum.amplitude": "8 mm"})[["velocity", "name", "settling_time"]]

# %% [markdown]
# What is missing or wrong is named, all at once, with what would do.

# %%
try:
    kapitza.check({"pendulum": {"length": "20 cm"}, "basin": scene["basin"]})
except kapitza.SceneError as error:
    print(error)
