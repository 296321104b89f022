"""Which figure comes from which scene by which script: the one table behind scripts/reproduce.

A row is a scene, named after the paper and its figure (docs/theory.md), and its figures: (suffix of the name, script, options).
"""

_BASIN = ("", "plot_basin.py", ["--centre", "inverted"])
_INVERTED = ("-inverted", "plot_basin.py", ["--centre", "inverted", "--attractor", "inverted"])
_FLUTTER = ("-flutter", "plot_basin.py", ["--centre", "inverted", "--attractor", "flutter"])
_ORBIT = ("", "plot_orbit.py", [])
_PHASE = ("", "plot_orbit.py", ["--panels", "phase,path"])
_TIME = ("", "plot_orbit.py", ["--panels", "time"])
_SWEEP = ("", "plot_sweep.py", [])
_BRANCHES = ("-branches", "plot_sweep.py", ["--view", "branches"])
_CHART = ("", "plot_stability.py", [])
_GROWTH = ("", "plot_stability.py", ["--view", "growth"])
_FREQUENCY = ("", "plot_stability.py", ["--view", "frequency"])
_ERRORS = ("", "plot_stability.py", ["--view", "errors"])
_POTENTIAL = ("", "plot_potential.py", [])
_TRADE = ("", "plot_tradeoff.py", [])

_SCENES = {
    "bifurcation": [_SWEEP],
    "blackburn-fig02": [_GROWTH],
    "blackburn-fig03": [_CHART],
    "blackburn-fig04": [_FREQUENCY],
    "blackburn-fig04-dots": [_SWEEP],
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
    "blackburn-fig10": [_SWEEP],
    "blackburn-fig11": [_BASIN, _INVERTED],
    "blackburn-fig12": [_BASIN, _INVERTED],
    "blackburn-fig13": [_BASIN, _INVERTED],
    "blackburn-fig14": [_BASIN, _FLUTTER],
    "blackburn-fig15": [_BASIN, _FLUTTER],
    "blackburn-walk": [_SWEEP, _BRANCHES],
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
    "formula-errors": [_ERRORS],
    "small": [_BASIN],
    "tradeoff-fig11": [_TRADE],
    "tradeoff-fig12": [_TRADE],
    "tradeoff-fig13": [_TRADE],
    "tradeoff-fig14": [_TRADE],
    "tradeoff-fig15": [_TRADE],
    "tradeoff-strong-drive": [_TRADE],
    "tradeoff-weak-damping": [_TRADE],
    "tradeoff-zero-gravity": [_TRADE],
}

# (name, scene, script, options); a scene is run once for all its figures.
FIGURES = [(scene + suffix, scene, script, options) for scene, rows in _SCENES.items() for suffix, script, options in rows]
