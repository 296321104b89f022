"""Curves of the study atlas where they meet."""

import json

from kapitza import Result
from test_atlas import DOUBLING, FOLD, SCENE


def test_a_fold_begins_at_each_degenerate_doubling(kapitza, tmp_path):
    """That of the doubled cycle, which exists on one side of the point alone."""
    (tmp_path / "s.yaml").write_text(json.dumps(SCENE | {"atlas": SCENE["atlas"] | {"checks": 0}}))
    kapitza("run", "s.yaml", folder=tmp_path)
    group = Result(tmp_path / "s.h5").group("atlas")
    first, points, kind = (group[f"curve_{name}"].values for name in ("first", "points", "kind"))
    places = list(zip(group["x"].values, group["y"].values, strict=True))
    ends = {places[at] for i in range(len(kind)) if kind[i] == FOLD for at in (first[i], first[i] + points[i] - 1)}
    doubled = {(x, y) for x, y, on in zip(*(group[f"special_{name}"].values for name in ("x", "y", "curve")), strict=True)
               if kind[on] == DOUBLING}
    assert doubled and doubled <= ends
