"""Basins of attraction of Kapitza's pendulum: run a scene, read its result, draw it.

>>> import kapitza
>>> result = kapitza.run("scenes/small.yaml", set={"pendulum.drive_amplitude": 0.4})   # a file, YAML text or a dict
>>> result.attractors[["name", "fraction"]]                # pandas
>>> result.at("175 deg", 0)["name"]                        # what the map says of a start; result.labels() is an xarray
>>> result.plot(centre="inverted")                         # matplotlib
>>> result.compare(kapitza.run("scenes/small.yaml"))
>>> kapitza.explore("scenes/small.yaml") # in a cell of a notebook: the basins, to be zoomed and dragged
>>> kapitza.where("scenes/small.yaml", [3.1, 3.0], "0.2")  # where single starts end
>>> pendulum = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3) # in this process: .map, .attractors, .where, .basin,
.cycles, .orbit ...
>>> pendulum.basin(theta=300, velocity=(-2, 2, 300)).kapitza.plot()

A result that is there already: kapitza.Result("blackburn-fig12.h5"). kapitza.plots has the panels of the pictures; each
of its draw_* functions takes and returns a matplotlib Axes.
"""

import importlib
import importlib.util
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kapitza.boundaries.manifolds import manifolds
    from kapitza.boundaries.tangency import tangency
    from kapitza.boundaries.wada import wada
    from kapitza.engine import Engine
    from kapitza.explorer.notebook import explore
    from kapitza.films import film
    from kapitza.fitting import fit
    from kapitza.pendulum import Pendulum
    from kapitza.program import RunError, SceneError
    from kapitza.result import BadFile, Result
    from kapitza.session import check, orbit, run, sweep
    from kapitza.shaker import needs
    from kapitza.starts import where

    __version__: str

__all__ = ["BadFile", "Engine", "Pendulum", "Result", "RunError", "SceneError", "check", "explore", "film", "fit",
           "manifolds", "needs", "orbit", "run", "sweep", "tangency", "wada", "where"]

# The module of each name: modules are loaded when one of their names is first used, because pandas and xarray take most
# of a second.
_MODULES = {name: module for module, names in {
    "boundaries.manifolds": "manifolds", "boundaries.tangency": "tangency", "boundaries.wada": "wada",
    "engine": "Engine",
    "explorer.notebook": "explore", "films": "film", "fitting": "fit", "pendulum": "Pendulum",
    "program": "RunError SceneError",
    "result": "BadFile Result", "session": "check orbit run sweep", "shaker": "needs",
    "starts": "where"}.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return importlib.import_module("kapitza.program").version()
    if name in _MODULES:
        return globals().setdefault(name, getattr(importlib.import_module(f"kapitza.{_MODULES[name]}"), name))
    if not name.startswith("_") and importlib.util.find_spec(f"kapitza.{name}"):
        return importlib.import_module(f"kapitza.{name}")
    raise AttributeError(f"module 'kapitza' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*__all__, "plots", "__version__"})
