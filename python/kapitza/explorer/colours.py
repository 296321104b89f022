"""Colours of the attractors of a view: those of the figures (kapitza.style), kept by each attractor while sliders
move."""

import pandas

from kapitza import style

CENTRES = {"down": 0, "inverted": 1, "rotating": 2, "neither": 3}


class Colours:
    """(`track` of an attractor, its kind) -> its colour."""

    def __init__(self):
        self._kept = {}

    def added(self, attractors):
        """The rows of a catalogue, each with its `colour`; where kept colours would look like new ones, all are chosen
        anew."""
        if not attractors:
            return []
        table = pandas.DataFrame(attractors)
        found = style.colours(table.assign(centre=table["centre"].map(CENTRES)))
        names = [(row["track"], row["kind"]) for row in attractors]
        chosen = [self._kept.get(name, colour) for name, colour in zip(names, found, strict=True)]
        if len(set(chosen)) < len(set(found)):
            chosen = found
        self._kept |= dict(zip(names, chosen, strict=True))
        return [row | {"colour": colour} for row, colour in zip(attractors, chosen, strict=True)]
