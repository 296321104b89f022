"""The kinds of pictures: a module each, with `draw` (of a Result, with keywords), `add_options` (the same for the
command line) and `STUDY` (what its file must hold). The first whose name is a group of a result shows its main
study."""

from types import ModuleType

from kapitza.plots import (
                                atlas,
                                basin,
                                chart,
                                compare,
                                escape,
                                measure_lines,
                                orbit,
                                passport,
                                potential,
                                stability,
                                sweep,
                                tradeoff,
)

KINDS: dict[str, ModuleType] = {"basin": basin, "sweep": sweep, "plane": chart, "line": measure_lines, "orbit": orbit,
                                "stability": stability, "potential": potential, "tradeoff": tradeoff, "atlas": atlas,
                                "compare": compare, "passport": passport, "escape": escape}
