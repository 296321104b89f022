"""Which figure comes from which scene drawn how: the one table behind scripts/reproduce.

A row is a scene of scenes/, named after the paper and its figure (docs/explanation/theory.md), and its figures: (suffix
of the name, kind, options).
"""

from kapitza.boundaries.manifolds import manifolds
from kapitza.boundaries.tangency import tangency
from kapitza.pendulum import Pendulum
from kapitza.result import Result

_Row = tuple[str, str, list[str]]
_LETTERS = ["--font-size", "8", "--dpi", "300"]
PAGE, COLUMN = ["--width", "178mm", *_LETTERS], ["--width", "86mm", *_LETTERS]  # two columns of a journal, and one
_BASIN: _Row = ("", "basin", ["--centre", "inverted"])
_ZOOM: _Row = ("", "basin", [])
_INVERTED: _Row = ("-inverted", "basin", ["--centre", "inverted", "--attractor", "inverted"])
_TIMES: _Row = ("-settling-time", "basin", ["--centre", "inverted", "--quantity", "settling_time"])
_ALIKE = "What ends alike at all 12 phases of release"
_COMMON: _Row = ("-common", "basin", ["--centre", "inverted", "--quantity", "common", "--title", _ALIKE])
_FLUTTER: _Row = ("-flutter", "basin", ["--centre", "inverted", "--attractor", "flutter"])
_SADDLES: _Row = ("", "basin", ["--centre", "inverted", "--saddles"])
_MANIFOLDS: _Row = ("", "basin", ["--centre", "inverted", "--saddles", "--manifolds"])
_LABORATORY: _Row = ("", "basin", ["--centre", "inverted", "--degrees", "--si"])
_ORBIT: _Row = ("", "orbit", [])
_PHASE: _Row = ("", "orbit", ["--panels", "phase,path"])
_CHAOS: _Row = ("", "orbit", ["--panels", "time,phase"])
_TIME: _Row = ("", "orbit", ["--panels", "time"])
_SWEEP: _Row = ("", "sweep", [])
_UP: _Row = ("", "sweep", ["--view", "up"])
_FLUTTER_GROWS: _Row = ("", "sweep", ["--view", "flutter"])
_BRANCHES: _Row = ("-branches", "sweep", ["--view", "branches"])
_CHART: _Row = ("", "stability", [])
_GROWTH: _Row = ("", "stability", ["--view", "growth"])
_TRAP: _Row = ("", "stability", ["--view", "trap"])
_FREQUENCY: _Row = ("", "stability", ["--view", "frequency"])
_ERRORS: _Row = ("", "stability", ["--view", "errors"])
_ENDS: _Row = ("", "plane", [])
_POTENTIAL: _Row = ("", "potential", [])
_ESCAPE: _Row = ("", "escape", ["--attractor", "inverted"])
_BARRIER: _Row = ("", "escape", ["--view", "barrier"])
_COUNTED: _Row = ("", "escape", ["--view", "barrier", "--points", "scenes/escape-line.csv"])
_TRADE: _Row = ("", "tradeoff", [])
_PROVED: _Row = ("", "basin", ["--quantity", "evidence"])

_ATLAS: _Row = ("", "atlas", [])
_MOTIONS: _Row = ("-motions", "atlas", ["--view", "motions"])
_LINE: _Row = ("-line", "atlas", ["--view", "line", "--x", "11", "--longest", "2"])
_BLACKBURN: _Row = ("-fig04", "atlas", ["--longest", "2", "--points", "scenes/atlas-blackburn-fig04.csv"])
_BUTIKOV: _Row = ("-fig01", "atlas", ["--longest", "2", "--points", "scenes/atlas-butikov-fig01.csv"])

_SCENES = {
    "atlas-blackburn": [_ATLAS, _MOTIONS, _LINE, _BLACKBURN],
    "atlas-butikov": [_ATLAS, _BUTIKOV],
    "atlas-tilted": [_ATLAS],
    "bifurcation": [_UP],
    "blackburn-fig02": [_GROWTH],
    "blackburn-fig03": [_CHART],
    "blackburn-fig04": [_FREQUENCY],
    "blackburn-fig04-dots": [_ENDS],
    "blackburn-fig05": [_POTENTIAL],
    "blackburn-fig06-omega11": [_SWEEP],
    "blackburn-fig06-omega30": [_SWEEP],
    "blackburn-fig07": [_SWEEP],
    "blackburn-fig07b": [_SWEEP],
    "blackburn-fig08": [_TIME],
    "blackburn-fig09a": [_PHASE],
    "blackburn-fig09b": [_PHASE],
    "blackburn-fig09c": [_PHASE],
    "blackburn-fig09d": [_PHASE],
    "blackburn-fig10": [_FLUTTER_GROWS],
    "blackburn-fig11": [_BASIN, _INVERTED],
    "blackburn-fig12": [_BASIN, _INVERTED, _TIMES],
    "blackburn-fig13": [_BASIN, _INVERTED],
    "blackburn-fig14": [_BASIN, _FLUTTER],
    "blackburn-fig15": [_BASIN, _FLUTTER],
    "blackburn-walk": [_SWEEP, _BRANCHES],
    "blackburn-chaos": [_CHAOS],
    "butikov-chaos": [_CHAOS],
    "butikov-fig01": [_CHART],
    "butikov-fig02": [_ORBIT],
    "butikov-fig03": [_ORBIT],
    "butikov-fig04": [_ORBIT],
    "butikov-fig05": [_ORBIT],
    "butikov-fig06": [_ORBIT],
    "butikov-fig07": [_ORBIT],
    "butikov-fig08": [_ORBIT],
    "butikov-fig09": [_CHART],
    "butikov-fig10a": [_ORBIT],
    "butikov-fig10b": [_ORBIT],
    "butikov-fig10c": [_ORBIT],
    "butikov-fig11": [_CHART],
    "butikov-fig12": [_ORBIT],
    "chart-blackburn": [_ENDS],
    "chart-butikov": [_ENDS],
    "escape-fig12": [_ESCAPE],
    "escape-line": [_COUNTED],
    "escape-plane": [_BARRIER],
    "formula-errors": [_ERRORS],
    "josephson": [_SWEEP],
    "laboratory": [_LABORATORY],
    "manifolds-fig12": [_MANIFOLDS],
    "measures-erosion": [("", "line", ["--measure", "share", "integrity_factor"])],
    "measures-fig12": [("", "passport", ["--attractor", "rotation +1/1"])],
    "measures-forced": [("", "passport", ["--attractor", "rotation +2/2"])],
    "measures-plane": [("", "plane", ["--measure", "shock", "--attractor", "inverted"])],
    "measures-riddled": [("", "passport", ["--attractor", "wide 3-nodding"])],
    "measures-share": [("", "plane", ["--measure", "share"])],
    "paul-trap": [_TRAP],
    "phases-walk": [_SWEEP],
    "proof-fig12": [_PROVED],
    "proof-fig13": [_PROVED],
    "ramp": [_BASIN],
    "ramp-areas": [_SWEEP],
    "saddles-fig12": [_SADDLES],
    "small": [_BASIN],
    "square-chart": [_CHART],
    "square-wave": [_BASIN],
    "start-phase": [_BASIN, _COMMON],
    "tilted": [_BASIN],
    "tradeoff-fig11": [_TRADE],
    "tradeoff-fig12": [_TRADE],
    "tradeoff-fig13": [_TRADE],
    "tradeoff-fig14": [_TRADE],
    "tradeoff-fig15": [_TRADE],
    "tradeoff-strong-drive": [_TRADE],
    "tradeoff-weak-damping": [_TRADE],
    "tradeoff-zero-gravity": [_TRADE],
    "textbooks/hubbard": [("-turns", "basin", ["--quantity", "turns"])],
    "wada-forced": [("", "basin", ["--saddles", "--manifolds"])],
    "zoom-fig12": [_ZOOM],
}



def _add_boundaries(result: Result) -> Result:
    """The curves that a figure shows over its result: what no study computes."""
    pendulum = Pendulum(result.scene)
    if result.path.stem == "measures-erosion":
        return result.add("tangency", tangency(pendulum, "m", 0.04, 0.08))
    cycles = result.group("saddles")
    if result.path.stem == "wada-forced":
        return result.add("manifolds", manifolds(pendulum, cycles.isel(saddle=[0]), kind="unstable", length=12,
                                                 max_speed=10))
    return result.add("manifolds", manifolds(pendulum, cycles, kind="stable", length=14))


# Scene -> what its result gets before it is drawn.
ADDED = dict.fromkeys(("manifolds-fig12", "measures-erosion", "wada-forced"), _add_boundaries)

# Figures that stand side by side on the pages.
_NARROW = {"blackburn-fig04-dots", "blackburn-fig06-omega11", "square-wave", "tilted", "start-phase",
           "start-phase-common", "tradeoff-fig12", "tradeoff-fig13"}

# (name, scene, kind, options); a scene is run once for all its figures.
FIGURES = [(scene.rpartition("/")[2] + suffix, scene, kind,
            [*options, *(COLUMN if scene + suffix in _NARROW else PAGE)])
           for scene, rows in _SCENES.items() for suffix, kind, options in rows]

# Name -> (page of docs/tutorials, result that its commands make, kind, options).
TUTORIALS = {
    "tutorial-first": ("first-basin", "first.h5", "basin", ["--centre", "inverted", *PAGE]),
    "tutorial-mine": ("my-pendulum", "eight.h5", "basin", ["--centre", "inverted", "--si", "--degrees", *PAGE]),
}
