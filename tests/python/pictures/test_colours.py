"""The colour table: the same kind has the same colour everywhere, and colour-blind readers can tell kinds apart."""

import itertools

import numpy as np
import pytest
import xarray
from kapitza import style
from matplotlib.colors import to_rgb

# Full dichromacy: Machado, Oliveira & Fernandes, IEEE TVCG 15 (2009) 1291, severity 1.0, on linear RGB.
SIGHT = {
    "full": np.eye(3),
    "protan": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                        [-0.003882, -0.048116, 1.051998]]),
    "deutan": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                        [-0.011820, 0.042940, 0.968881]]),
}
# CIE XYZ (D65, relative to white) from linear sRGB: IEC 61966-2-1.
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]) / [[0.9505], [1.0],
                                                                                                  [1.089]]


def lab(colour, sight):
    """CIE L*a*b* of the colour as that eye sees it."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    x, y, z = np.cbrt(np.clip(XYZ @ np.clip(SIGHT[sight] @ linear, 0, 1), 1e-4, None))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("sight", SIGHT)
def test_colours_of_kinds_stay_apart_for_every_sight(sight):
    colours = {**style.KINDS, "unsettled": style.UNSETTLED}
    near = {pair: np.linalg.norm(lab(colours[pair[0]], sight) - lab(colours[pair[1]], sight))
            for pair in itertools.combinations(colours, 2)}
    pair, distance = min(near.items(), key=lambda item: item[1])
    assert distance > 10, f"{pair} look alike ({sight}): {distance:.1f}"


def catalogue(*rows):
    """A dataset of attractors from rows of (period, winding, centre, mirror)."""
    columns = np.array(rows).T
    names = ("period", "winding", "centre", "mirror")
    return xarray.Dataset({name: ("attractor", column) for name, column in zip(names, columns, strict=True)})


def test_a_colour_does_not_depend_on_the_id():
    first = catalogue((1, 0, 0, 0), (1, 0, 1, 1), (1, 1, 2, 3), (1, -1, 2, 2))
    second = catalogue((1, 0, 1, 0), (6, 0, 0, 1), (1, 1, 2, 3), (1, -1, 2, 2))
    assert style.colours(first)[1] == style.colours(second)[0] == style.KINDS["inverted"]
    assert style.colours(first)[2:] == style.colours(second)[2:]


@pytest.mark.parametrize("rows", [
    [(2, 0, 0, 0), (2, 0, 1, 1), (3, 0, 1, 3), (3, 0, 1, 2), (9, 0, 1, 5), (9, 0, 1, 4)],
    [(1, 1, 2, 0), (8, 1, 2, 1), (9, 1, 2, 2), (10, 1, 2, 3), (20, 2, 2, 4)],
    [(4, 0, 1, 1), (4, 0, 1, 0), (4, 0, 1, 3), (4, 0, 1, 2), (1, 0, 1, 4)],
    [(period, 0, 0, index) for index, period in enumerate(range(1, 25))],
])
def test_colours_of_one_catalogue_can_be_told_apart(rows):
    colours = [lab(colour, "full") for colour in (*style.colours(catalogue(*rows)), style.UNSETTLED)]
    assert min(np.linalg.norm(one - other) for one, other in itertools.combinations(colours, 2)) > 5
    simplest = min(range(len(rows)), key=lambda index: rows[index])
    assert style.colours(catalogue(*rows))[simplest] == style.KINDS[style.kind(*rows[simplest][:3])]


def test_names_that_occur_twice_get_their_ids():
    assert style.names_with_ids(["flutter", "down", "flutter"]) == ["flutter (0)", "down", "flutter (2)"]


@pytest.mark.parametrize("share, text", [(0.3191, "31.9 %"), (0.0012, "0.12 %"), (1e-6, "< 0.01 %"), (1, "100 %"),
                                         (0, "0 %")])
def test_shares_are_written_in_percent(share, text):
    assert style.share_text(share) == text


@pytest.mark.parametrize("multiple, text", [(0, "0"), (1, "π"), (-0.5, "−π/2"), (1.5, "3π/2"), (-0.0, "0")])
def test_angles_are_written_in_parts_of_pi(multiple, text):
    assert style.pi_text(multiple) == text
