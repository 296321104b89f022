"""How kapitza's figures look: one table of colours that keep their meaning from figure to figure, and the page settings.

A colour belongs to a kind of motion, not to an id: the inverted state is amber in every figure. Light and dark shades
within a kind tell periods and mirror partners apart. The kinds stay apart for colour-blind readers (tests/python/test_style.py).
"""

import warnings
from fractions import Fraction
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex, to_rgb

UNSETTLED = "#ffffff"
INK = "#1c2127"
FAINT = "#6b747e"

# Kind -> colour.
KINDS = {
    "inverted": "#f2b233",
    "down": "#d5dce3",
    "rotation +": "#2f6db3",
    "rotation -": "#c2452f",
    "flutter": "#5b2a7a",
    "down nodding": "#12806a",
    "inverted nodding": "#e58ab8",
    "other": "#a8935a",
    "chaotic": "#3b3f45",
}

# Codes of the variable `centre`.
DOWN, INVERTED, ROTATING = 0, 1, 2


def kind(period, winding, centre):
    """The kind of motion of an attractor: a key of KINDS."""
    if period == 0:
        return "chaotic"
    if centre == ROTATING:
        return "rotation +" if winding > 0 else "rotation -"
    if centre == INVERTED:
        return {1: "inverted", 2: "flutter"}.get(period, "inverted nodding")
    if centre == DOWN:
        return "down" if period == 1 else "down nodding"
    return "other"


def colours(attractors):
    """One colour (hex) per attractor of the dataset `attractors`."""
    rows = zip(attractors["period"].values, attractors["winding"].values, attractors["centre"].values,
               attractors["mirror"].values, strict=True)
    return [_colour(index, *row) for index, row in enumerate(rows)]


def _colour(index, period, winding, centre, mirror):
    name = kind(period, winding, centre)
    lighter = 0.0
    if name.startswith("rotation"):
        lighter = _rotation_shade(period, winding)
    elif name in ("down nodding", "inverted nodding"):
        lighter = 0.55 * (1 - 2 / period) if period > 1 else 0.6
    if not name.startswith("rotation") and mirror < index:  # the second of two mirror partners
        return shade(KINDS[name], lighter - 0.3)
    return shade(KINDS[name], lighter)


def _rotation_shade(period, winding):
    """0 for one turn a period; lighter for slower rotations and for longer closures, darker for faster ones."""
    speed = Fraction(abs(int(winding)), int(period))
    repeats = int(period) // speed.denominator
    lighter = 0.5 * float(1 - speed) if speed <= 1 else -0.5 * float(1 - 1 / speed)
    return lighter + 0.4 * (1 - 1 / repeats)


def shade(colour, lighter):
    """The colour moved towards white (lighter > 0) or black (lighter < 0)."""
    rgb = np.array(to_rgb(colour))
    target = np.ones(3) if lighter > 0 else np.zeros(3)
    return to_hex(rgb + abs(lighter) * (target - rgb))


def name_text(name):
    """An attractor's name with a true minus."""
    return str(name).replace(" -", " −")


def share_text(fraction):
    """A share as people write it: 31.9 %, 0.12 %, < 0.01 %."""
    percent = 100 * float(fraction)
    if percent >= 99.95 or percent == 0:
        return f"{percent:.0f} %"
    if percent >= 1:
        return f"{percent:.1f} %"
    return f"{percent:.2f} %" if percent >= 0.01 else "< 0.01 %"


def parameters_text(pendulum):
    """The pendulum's parameters, in the papers' symbols where they are defined."""
    names = [("quality_factor", "Q"), ("drive_frequency", r"$\Omega$"), ("drive_amplitude", r"$\epsilon$")]
    known = [(symbol, pendulum.get(name, np.nan)) for name, symbol in names]
    if not all(np.isfinite(value) for _, value in known):
        known = [("k", pendulum["k"]), (r"$\beta$", pendulum["beta"]), ("m", pendulum["m"])]
    return ",  ".join(f"{symbol} = {value:.6g}" for symbol, value in known)


def pi_text(multiple):
    """A tick label: the multiple of pi as a fraction."""
    part = Fraction(float(multiple)).limit_denominator(96)
    if part == 0:
        return "0"
    sign, top, bottom = ("−" if part < 0 else ""), abs(part.numerator), part.denominator
    return sign + ("" if top == 1 else str(top)) + "π" + ("" if bottom == 1 else f"/{bottom}")


def use():
    """The page settings of every figure. Text stays text in SVG and PDF."""
    mpl.use("Agg")
    mpl.rcParams.update({
        "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 9, "mathtext.fontset": "dejavusans",
        "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": INK, "xtick.color": INK, "ytick.color": INK,
        "axes.linewidth": 0.7, "xtick.major.width": 0.7, "ytick.major.width": 0.7,
        "axes.titlelocation": "left", "axes.titlesize": 11, "axes.titleweight": "bold",
        "legend.frameon": False, "figure.dpi": 100, "savefig.facecolor": "white",
        "svg.fonttype": "none", "pdf.fonttype": 42, "svg.hashsalt": "kapitza",
    })


def save(figure, output, dpi):
    """Writes the picture and prints its name. The same figure gives the same bytes: no clock goes into it."""
    clock = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(Path(output).suffix.lower(), {})
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # a missing glyph or a failed layout is a fault, not a footnote
        figure.savefig(output, dpi=dpi, bbox_inches="tight", metadata=clock)
    print(output)
