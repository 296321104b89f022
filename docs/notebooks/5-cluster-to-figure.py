# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 5. From a cluster's job to a figure
# A job writes the scene's result; the figure is made of the file, anywhere.
#
# ```
# KAPITZA=$(command -v kapitza) sbatch --ntasks=64 --time=01:00:00 kapitza.sbatch scene.yaml
# ```

# %%
import os
from pathlib import Path

import kapitza
from matplotlib.figure import Figure

COUNT = int(os.environ.get("KAPITZA_NOTEBOOK_COUNT", 300))
SCENE = f"""
title: Well inside the stable zone
pendulum: {{quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.300}}
basin:
  theta: {{count: {COUNT}}}
  velocity: {{min: -2, max: 2, count: {COUNT}}}
"""

# %% [markdown]
# Here two ranks stand for the job. `resume=True` goes on from a checkpoint, and takes a complete file as it is: the cell may run again.

# %%
result = kapitza.run(SCENE, output="job.h5", ranks=2, resume=True)
result.summary.splitlines()[0] if result.summary else "complete already"

# %% [markdown]
# A figure for one column: 86 mm, letters of 8 points, the legend below.

# %%
result.plot(centre="inverted", width="86mm", font_size=8, no_title=True)

# %% [markdown]
# The same from a shell: `kapitza plot basin job.h5 --centre inverted --width 86mm --font-size 8 --no-title -o figure.pdf`.
#
# Or panels on a figure of one's own:

# %%
from kapitza.plots.basin import draw_basins, draw_one

figure = Figure(figsize=(7, 2.6), layout="constrained")
left, right = figure.subplots(1, 2, sharey=True)
basin, attractors = result.group("basin"), result.group("attractors")
draw_basins(left, basin, attractors, centre="inverted", legend=False)
draw_one(right, basin, attractors, result.ids("inverted"), centre="inverted", legend=False)
figure.savefig("figure.pdf")
print(Path("figure.pdf").stat().st_size > 1000)
