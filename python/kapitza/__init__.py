"""Basins of attraction of Kapitza's pendulum: run a scene, read its result, draw it.

>>> import kapitza
>>> result = kapitza.run("scenes/small.yaml", set={"pendulum.drive_amplitude": 0.4})   # a file, YAML text or a dict
>>> result.attractors[["name", "fraction"]]                # pandas
>>> result.at("175 deg", 0)["name"]                        # what the map says of a start; result.labels() is an xarray
>>> result.plot(centre="inverted")                         # matplotlib
>>> result.compare(kapitza.run("scenes/small.yaml"))
>>> kapitza.explore("scenes/small.yaml")                   # in a cell of a notebook: the basins, to be zoomed and dragged
>>> kapitza.where("scenes/small.yaml", [3.1, 3.0], "0.2")  # where single starts end

A result that is there already: kapitza.Result("blackburn-fig12.h5"). kapitza.plots has the panels of the pictures; each of its draw_*
functions takes and returns a matplotlib Axes.
"""

from kapitza.engine import Engine
from kapitza.explorer.notebook import explore
from kapitza.films import film
from kapitza.fitting import fit
from kapitza.program import RunError, SceneError
from kapitza.result import BadFile, Result
from kapitza.session import check, orbit, run, sweep, where

__all__ = ["BadFile", "Engine", "Result", "RunError", "SceneError", "check", "explore", "film", "fit", "orbit", "run", "sweep", "where"]
