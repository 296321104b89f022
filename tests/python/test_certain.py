"""Labels that are called decided are right where errors are not linear, and where they hang together.

The right ends are those of quad precision, by Taylor series of another order and by circles around the strobe points."""
import re

import pytest

# k, damping, m, start, its end; beside folds a saddle lies nearer to the attractor than 0.03 rad
BESIDE_FOLDS = [
    (0.1, 0.1, 0.3997, (-2.1185540809750316, 0.8669870372823835), "down 2-nodding"),
    (0.1, 0.1, 0.6902925389207152, (-0.8627010903637058, 1.0431368818445625), "flutter"),
    (0.3, 0.05, 0.17986044278083926, (2.0497217392915363, -1.8212938083385788), "rotation -1/1"),
    (-0.05, 0.08, 0.5133467257604597, (2.722867269927126, -0.1466870505356177), "down"),
]
# epsilon = 0.52: orbits that linger repeat the same step error period after period
COHERENT = [
    (1 / 121, 1 / 55, 0.52, (0.6880087911361648, -0.682), "rotation -1/1"),
    (1 / 121, 1 / 55, 0.52, (-0.20420352248333656, -0.198), "rotation +1/1"),
]


def where(kapitza, tmp_path, k, damping, m, start):
    scene = tmp_path / "start.yaml"
    scene.write_text(f"pendulum: {{k: {k!r}, damping: {damping!r}, m: {m!r}}}\n"
                     "attractors: {theta: {min: -180 deg, max: 180 deg}, velocity: {min: -2, max: 2}}\n")
    return kapitza("where", scene, *map(repr, start)).stdout


@pytest.mark.parametrize("k, damping, m, start, end", BESIDE_FOLDS + COHERENT)
def test_decided_labels_are_right(kapitza, tmp_path, k, damping, m, start, end):
    told = where(kapitza, tmp_path, k, damping, m, start)
    assert re.search(rf"^ends on +{re.escape(end)} \(", told, re.M), told
    assert re.search(r"^decided +yes", told, re.M), told


def test_a_flutter_is_not_taken_for_its_mirror_image(kapitza, tmp_path):
    told = where(kapitza, tmp_path, *BESIDE_FOLDS[1][:4])
    assert re.search(r"^ +-2\.2823869797\d\d +-0\.0551763165\d\d$", told, re.M), told
