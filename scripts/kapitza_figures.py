"""Which figure comes from which scene by which script: the one table behind scripts/reproduce.

A figure is (name, scene, script, options), named after the paper and its figure (docs/theory.md). A scene may serve several
figures; it is run once.
"""

_BASIN = ("plot_basin.py", ["--centre", "inverted"])
_INVERTED = ("plot_basin.py", ["--centre", "inverted", "--attractor", "inverted"])
_FLUTTER = ("plot_basin.py", ["--centre", "inverted", "--attractor", "flutter"])
_ORBIT = ("plot_orbit.py", [])
_PHASE = ("plot_orbit.py", ["--panels", "phase,path"])
_TIME = ("plot_orbit.py", ["--panels", "time"])
_SWEEP = ("plot_sweep.py", [])
_TRADE = ("plot_tradeoff.py", [])

FIGURES = [
    ("bifurcation", "bifurcation", *_SWEEP),
    ("blackburn-fig02", "blackburn-fig02", "plot_stability.py", ["--view", "growth"]),
    ("blackburn-fig03", "blackburn-fig03", "plot_stability.py", []),
    ("blackburn-fig04", "blackburn-fig04", "plot_stability.py", ["--view", "frequency"]),
    ("blackburn-fig04-dots", "blackburn-fig04-dots", *_SWEEP),
    ("blackburn-fig05", "blackburn-fig05", "plot_potential.py", []),
    ("blackburn-fig06-omega11", "blackburn-fig06-omega11", *_SWEEP),
    ("blackburn-fig06-omega30", "blackburn-fig06-omega30", *_SWEEP),
    ("blackburn-fig07", "blackburn-fig07", *_SWEEP),
    ("blackburn-fig07b", "blackburn-fig07b", *_SWEEP),
    ("blackburn-fig08", "blackburn-fig08", *_TIME),
    ("blackburn-fig09a", "blackburn-fig09a", *_PHASE),
    ("blackburn-fig09b", "blackburn-fig09b", *_PHASE),
    ("blackburn-fig09c", "blackburn-fig09c", *_PHASE),
    ("blackburn-fig09d", "blackburn-fig09d", *_PHASE),
    ("blackburn-fig10", "blackburn-fig10", *_SWEEP),
    ("blackburn-fig11", "blackburn-fig11", *_BASIN),
    ("blackburn-fig11-inverted", "blackburn-fig11", *_INVERTED),
    ("blackburn-fig12", "blackburn-fig12", *_BASIN),
    ("blackburn-fig12-inverted", "blackburn-fig12", *_INVERTED),
    ("blackburn-fig13", "blackburn-fig13", *_BASIN),
    ("blackburn-fig13-inverted", "blackburn-fig13", *_INVERTED),
    ("blackburn-fig14", "blackburn-fig14", *_BASIN),
    ("blackburn-fig14-flutter", "blackburn-fig14", *_FLUTTER),
    ("blackburn-fig15", "blackburn-fig15", *_BASIN),
    ("blackburn-fig15-flutter", "blackburn-fig15", *_FLUTTER),
    ("blackburn-walk", "blackburn-walk", *_SWEEP),
    ("blackburn-walk-branches", "blackburn-walk", "plot_sweep.py", ["--view", "branches"]),
    ("butikov-fig01", "butikov-fig01", "plot_stability.py", []),
    ("butikov-fig02", "butikov-fig02", *_ORBIT),
    ("butikov-fig03", "butikov-fig03", *_ORBIT),
    ("butikov-fig04", "butikov-fig04", *_ORBIT),
    ("butikov-fig05", "butikov-fig05", *_ORBIT),
    ("butikov-fig06", "butikov-fig06", *_ORBIT),
    ("butikov-fig07", "butikov-fig07", *_ORBIT),
    ("butikov-fig08", "butikov-fig08", *_ORBIT),
    ("butikov-fig09", "butikov-fig09", "plot_stability.py", []),
    ("butikov-fig10a", "butikov-fig10a", *_ORBIT),
    ("butikov-fig10b", "butikov-fig10b", *_ORBIT),
    ("butikov-fig10c", "butikov-fig10c", *_ORBIT),
    ("butikov-fig11", "butikov-fig11", "plot_stability.py", []),
    ("butikov-fig12", "butikov-fig12", *_ORBIT),
    ("formula-errors", "formula-errors", "plot_stability.py", ["--view", "errors"]),
    ("small", "small", *_BASIN),
    ("tradeoff-fig11", "tradeoff-fig11", *_TRADE),
    ("tradeoff-fig12", "tradeoff-fig12", *_TRADE),
    ("tradeoff-fig13", "tradeoff-fig13", *_TRADE),
    ("tradeoff-fig14", "tradeoff-fig14", *_TRADE),
    ("tradeoff-fig15", "tradeoff-fig15", *_TRADE),
    ("tradeoff-strong-drive", "tradeoff-strong-drive", *_TRADE),
    ("tradeoff-weak-damping", "tradeoff-weak-damping", *_TRADE),
    ("tradeoff-zero-gravity", "tradeoff-zero-gravity", *_TRADE),
]
