"""How kapitza's figures look: one table of colours that keep their meaning from figure to figure, and the page
settings.

A colour belongs to a kind of motion, not to an id: the inverted state is amber in every figure. Light and dark shades
within a kind tell periods and mirror partners apart; where they would not, in one catalogue, the rarer motion gets
another hue. The kinds stay apart for colour-blind readers (tests/python/pictures/test_colours.py).
"""

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import xarray
from matplotlib.colors import to_hex, to_rgb

from kapitza import units
from kapitza.motion_kinds import DOWN as DOWN
from kapitza.motion_kinds import kind as kind

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FONT_SIZE = 9.0  # points
UNSETTLED = "#ffffff"
INK = "#1c2127"
FAINT = "#6b747e"
FIGURE_SPACE = "\u2007"  # as wide as a digit
WITH_SHARES = "shares"  # mark of a legend whose second column holds shares

# Kind -> colour.
KINDS = {
    "inverted": "#f2b233",
    "down": "#d5dce3",
    "rotation +": "#2f6db3",
    "rotation -": "#c2452f",
    "running +": "#85acf8", "running -": "#fad1a7",
    "flutter": "#5b2a7a",
    "down nodding": "#12806a",
    "inverted nodding": "#e58ab8",
    "other": "#a8935a",
    "chaotic": "#3b3f45",
}

_chosen: ContextVar[Mapping[str, str]] = ContextVar("chosen", default={})  # noqa: B039  # never changed

# Colours nearer than this in OKLab cannot be distinguished in a fine mixture.
APART = 0.06
_OKLAB = (np.array([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
                    [0.0883024619, 0.2817188376, 0.6299787005]]),
          np.array([[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
                    [0.0259040371, 0.7827717662, -0.8086757660]]))
_OKLAB_INVERSE = tuple(np.linalg.inv(matrix) for matrix in _OKLAB)

TORQUES = ("torque", "torque_amplitude")  # attributes of the group pendulum

def colours(attractors: xarray.Dataset, apart: Iterable[int] | None = None) -> list[str]:
    """One colour (hex) per attractor of the dataset `attractors`: that of its motion, moved in hue where another one is
    too near; `apart`: the ids that must be distinguished (default: all)."""
    rows = list(zip(attractors["period"].values, attractors["winding"].values, attractors["centre"].values,
                    attractors["mirror"].values, strict=True))
    order = sorted(range(len(rows)) if apart is None else apart,
                   key=lambda index: (rows[index][0], abs(rows[index][1]), _is_second(index, rows[index][3]), index))
    found = _told_apart([_colour(index, *row) for index, row in enumerate(rows)], order)
    names = [str(name) for name in attractors["name"].values] if "name" in attractors else [""] * len(rows)
    both = zip(found, names, names_with_ids(names), strict=True)
    return [_chosen.get().get(full) or _chosen.get().get(name) or colour for colour, name, full in both]


def kind_colour(name: str) -> str:
    """The colour of a kind of motion: that of the page, else of KINDS; white of what has not settled."""
    return _chosen.get().get(name) or KINDS.get(name, UNSETTLED)


def _told_apart(wanted: Sequence[str], order: Iterable[int]) -> list[str]:
    """The colours, each at least APART from white and from those before it in `order`; or as far as it goes."""
    taken, chosen = [_oklab(UNSETTLED)], list(wanted)
    for index in order:
        variants = [(wanted[index], _oklab(wanted[index])), *_variants(wanted[index])]
        distances = [np.linalg.norm(np.array(taken) - place, axis=1).min() for _, place in variants]
        best = next((n for n, distance in enumerate(distances) if distance >= APART), int(np.argmax(distances)))
        chosen[index] = variants[best][0]
        taken.append(variants[best][1])
    return chosen


def _variants(colour: str) -> list[tuple[str, np.ndarray]]:
    """(colour, its OKLab) of other hues and lightnesses, the nearest hues first; never paler than is seen."""
    lightness, chroma, hue = _oklab(colour)[0], max(np.hypot(*_oklab(colour)[1:]),
                                                    0.09), np.arctan2(*_oklab(colour)[:0:-1])
    found = []
    for turn in np.radians((0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180)):
        for lighter in (0, -0.12, 0.12, -0.24):
            place = (np.clip(lightness + lighter, 0.3, 0.88), chroma * np.cos(hue + turn), chroma * np.sin(hue + turn))
            hexadecimal = to_hex(of_oklab(np.array(place)).tolist())
            found.append((hexadecimal, _oklab(hexadecimal)))
    return found


def oklab(rgb: np.ndarray) -> np.ndarray:
    """(L, a, b) of B. Ottosson's OKLab (2020), in which equal distances look about equally different; rgb [.., 3] in 0
    .. 1."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return np.asarray(np.cbrt(linear @ _OKLAB[0].T) @ _OKLAB[1].T)


def of_oklab(place: np.ndarray) -> np.ndarray:
    """The nearest rgb [.., 3] of OKLab's (L, a, b)."""
    linear = np.clip((place @ _OKLAB_INVERSE[1].T) ** 3 @ _OKLAB_INVERSE[0].T, 0, 1)
    return np.asarray(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def _oklab(colour: str) -> np.ndarray:
    return oklab(np.array(to_rgb(colour)))


def motion_colour(period: int, winding: int, centre: int) -> str:
    """The colour (hex) of a motion by itself, outside of any catalogue."""
    return _colour(0, period, winding, centre, 0)


def _colour(index: int, period: int, winding: int, centre: int, mirror: int) -> str:
    name = kind(period, winding, centre)
    if name.startswith("rotation"):
        return shade(kind_colour(name), _rotation_shade(period, winding))
    lighter = -0.3 if _is_second(index, mirror) and winding == 0 else 0.0
    if name in ("down nodding", "inverted nodding"):
        lighter += 0.55 * (1 - 2 / period) if period > 1 else 0.6
    return shade(kind_colour(name), lighter)


def _is_second(index: int, mirror: int) -> bool:
    """Whether it is the second of two mirror partners; `mirror`: -1 = it has none."""
    return mirror != -1 and mirror < index


def _rotation_shade(period: int, winding: int) -> float:
    """0 for one turn a period; lighter for slower rotations and for longer closures, darker for faster ones."""
    speed = Fraction(abs(int(winding)), int(period))
    repeats = int(period) // speed.denominator
    lighter = 0.5 * float(1 - speed) if speed <= 1 else -0.5 * float(1 - 1 / speed)
    return lighter + 0.4 * (1 - 1 / repeats)


def shade(colour: str, lighter: float) -> str:
    """The colour moved towards white (lighter > 0) or black (lighter < 0)."""
    rgb = np.array(to_rgb(colour))
    target = np.ones(3) if lighter > 0 else np.zeros(3)
    return to_hex(rgb + abs(lighter) * (target - rgb))


def name_text(name: object) -> str:
    """An attractor's name with a true minus; never read as a formula."""
    return str(name).replace(" -", " −").replace("$", r"\$")


def names_with_ids(names: Iterable[object]) -> list[str]:
    """The names; two attractors of one name get their ids: "inverted 3-nodding (2)"."""
    texts = [str(name) for name in names]
    return [f"{name} ({index})" if texts.count(name) > 1 else name for index, name in enumerate(texts)]


def share_text(fraction: float) -> str:
    """A share as people write it: 31.9 %, 0.12 %, < 0.01 %."""
    percent = 100 * float(fraction)
    if percent >= 99.95 or percent == 0:
        return f"{percent:.0f} %"
    if percent >= 1:
        return f"{percent:.1f} %"
    return f"{percent:.2f} %" if percent >= 0.01 else "< 0.01 %"


def parameters_text(pendulum: Mapping[str, Any]) -> str:
    """The pendulum's parameters: in SI if the scene is, else in the papers' symbols where they are defined."""
    if "pivot_frequency" in pendulum:
        return ",  ".join(units.si_parameters(pendulum).values())
    names = [("quality_factor", "Q"), ("drive_frequency", r"$\Omega$"), ("drive_amplitude", r"$\epsilon$")]
    known = [(symbol, pendulum.get(name, np.nan)) for name, symbol in names]
    if not all(np.isfinite(value) for _, value in known):
        known = [("k", pendulum["k"]), (r"$\beta$", pendulum["beta"]), ("m", pendulum["m"])]
    torques = [(name.replace("_", " "), pendulum[name]) for name in TORQUES if pendulum.get(name)]
    if torques and pendulum["m"] == 0:
        known = known[:-1]  # the pivot is at rest
    return ",  ".join(f"{symbol} = {value:.6g}" for symbol, value in [*known, *torques])


def pi_text(multiple: float) -> str:
    """A tick label: the multiple of pi as a fraction."""
    part = Fraction(float(multiple)).limit_denominator(96)
    if part == 0:
        return "0"
    sign, top, bottom = ("−" if part < 0 else ""), abs(part.numerator), part.denominator
    return sign + ("" if top == 1 else str(top)) + "π" + ("" if bottom == 1 else f"/{bottom}")


def settings(font_size: float = FONT_SIZE) -> dict[str, Any]:
    """The page settings of every figure, for matplotlib's rcParams. Text stays text in SVG and PDF."""
    scale = font_size / FONT_SIZE
    ticks = {f"{axis}tick.{which}": size * scale for axis in "xy" for which, size in
             (("major.width", 0.7), ("major.size", 3.5), ("major.pad", 3.5), ("minor.width", 0.6), ("minor.size", 2.0),
              ("minor.pad", 3.4))}
    return {
        "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": font_size,
        "mathtext.fontset": "dejavusans",
        "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": INK, "xtick.color": INK, "ytick.color": INK,
        "axes.linewidth": 0.7 * scale, "axes.labelpad": 4.0 * scale, **ticks,
        "axes.titlelocation": "left", "axes.titlesize": "large", "axes.titleweight": "bold",
        "legend.frameon": False, "figure.dpi": 100, "savefig.facecolor": "auto",
        "svg.fonttype": "none", "pdf.fonttype": 42, "svg.hashsalt": "kapitza",
    }


def use() -> None:
    """Gives all figures from now on these settings."""
    mpl.rcParams.update(settings())  # type: ignore[arg-type]


@contextmanager
def using(font_size: float = FONT_SIZE, colours: Mapping[str, str] | None = None) -> Iterator[None]:
    """Figures drawn inside have these letters, and `colours` (name of an attractor, or kind of motion, -> colour)
    before those of KINDS."""
    token = _chosen.set({name: to_hex(colour) for name, colour in (colours or {}).items()})
    try:
        with mpl.rc_context(settings(font_size)):  # type: ignore[arg-type]
            yield
    finally:
        _chosen.reset(token)


def save(figure: "Figure", output: Path, dpi: float) -> None:
    """Writes the picture. The same figure gives the same bytes: no clock goes into it."""
    clock = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(Path(output).suffix.lower(), {})
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # a failed layout is a fault, not a footnote
        warnings.filterwarnings("ignore", message="Glyph")  # a letter of the title that the font lacks is seen as a box
        figure.savefig(output, dpi=dpi, metadata=clock)
