"""Results of kapitza in Python.

>>> import kapitza
>>> result = kapitza.Result("blackburn-fig12.h5")
>>> result.pendulum["k"], result.attributes["title"]
>>> result.tree["basin/attractor"]          # an xarray.DataTree: numbers are read when they are asked for
>>> basin = result.group("basin")           # an xarray.Dataset in memory, checked

kapitza.plots has the pictures; each of its draw_* functions takes and returns a matplotlib Axes.
"""

from kapitza.result import BadFile, Result, run

__all__ = ["BadFile", "Result", "run"]
