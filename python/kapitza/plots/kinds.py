"""The kinds of pictures, by the group of a result that each draws; the first that a result holds is its main one."""

from types import ModuleType

from kapitza.plots import atlas, basin, chart, line, orbit, potential, stability, sweep, tradeoff

KINDS: dict[str, ModuleType] = {"basin": basin, "sweep": sweep, "plane": chart, "line": line, "orbit": orbit, "stability": stability,
                                "potential": potential, "tradeoff": tradeoff, "atlas": atlas}
