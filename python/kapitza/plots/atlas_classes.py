"""Classes of attractors in an atlas of kapitza, and the curves that are about them."""

import math

import xarray

from kapitza import style

FOLD, DOUBLING, BREAKING, SWINGS, LEANS = range(5)  # codes of curve_kind


def motion_text(name: str) -> str:
    """What a class of attractors is called in a picture: its name; of rotations both mirror images are meant."""
    return name.replace("rotation", "rotations")


def missing_text(atlas: xarray.Dataset) -> str:
    """How many curves with wide bands are missing, as a part of a sentence; nothing of files without an estimate."""
    if "missing_high" not in atlas.attrs:
        return ""
    low, high = math.floor(float(atlas.attrs["missing_low"])), math.ceil(float(atlas.attrs["missing_high"]))
    dropped = int(atlas.attrs.get("dropped", 0))
    return (f", an estimated {f'{low} to {high}' if high > low else low} missing with bands above 1e-4 of the plane"
            f"{f', or more: {dropped} cycles found no room' if dropped else ''}")


def lacking_text(lacking: float) -> str:
    """How certain it is that a list is whole: `lacking`, the probability that it is not, at most."""
    return f"a motion may be missing at a point with a probability of at most {100 * lacking:.1f} %"


def centre_of(class_name: object) -> int:
    """The centre of a class, by its name."""
    name = style.name_text(class_name)
    if "rotation" in name:
        return 2
    return 1 if name.startswith(("inverted", "flutter")) else 0 if name.startswith("down") else 3


def belongs(atlas: xarray.Dataset, curve: int, number: int) -> bool:
    """Whether a curve is about the motion of a class."""
    return style.name_text(atlas["curve_name"].values[curve]).rpartition(": ")[0] == style.name_text(
        atlas["class_name"].values[number])


def gives_birth(atlas: xarray.Dataset, curve: int, number: int) -> bool:
    """Whether what branches off on a curve is the motion of a class."""
    kind, centre = int(atlas["curve_kind"][curve]), int(atlas["curve_centre"][curve])
    period, winding = int(atlas["curve_period"][curve]), int(atlas["curve_winding"][curve])
    child = {DOUBLING: (2 * period, 2 * winding, False), BREAKING: (period, 0, False), SWINGS: (2, 0, True),
             LEANS: (1, 0, False)}.get(kind)
    own = int(atlas["class_period"][number]), int(atlas["class_winding"][number]), bool(
        atlas["class_symmetric"][number])
    return own == child and (kind != SWINGS or centre == int(atlas["class_centre"][number]))
