"""Which figure comes from which scene by which script: the one table behind scripts/reproduce.

A figure is (name, scene, script, options). One scene may serve several figures; it is run once.
"""

PAPERS = {
    "blackburn": "J. A. Blackburn, H. J. T. Smith, N. Groenbech-Jensen, Am. J. Phys. 60 (1992) 903",
    "butikov": "E. I. Butikov, Am. J. Phys. 86 (2018) 257",
}

_BASIN = ("plot_basin.py", ["--centre", "inverted"])
_INVERTED = ("plot_basin.py", ["--centre", "inverted", "--attractor", "inverted"])
_FLUTTER = ("plot_basin.py", ["--centre", "inverted", "--attractor", "flutter"])

FIGURES = [
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
    ("small", "small", *_BASIN),
]
