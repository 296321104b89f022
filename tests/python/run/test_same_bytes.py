"""The program as a whole: the same bytes on any number of ranks, mirrored starts, files and exit statuses, names."""

import re
import shutil

import numpy as np
import pytest
from conftest import ROOT, datasets, with_extensive
from kapitza import Result

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=40", "--set", "basin.velocity.count=30", "--set", "basin.attractors.starts=1024"]


@pytest.mark.parametrize("method", with_extensive(["icm"], ["direct"]))
def test_the_same_bytes_on_any_number_of_ranks(kapitza, tmp_path, method):
    contents = []
    for ranks in (1, 2, 3, 5):
        path = tmp_path / f"{ranks}.h5"
        kapitza("run", SMALL, *TINY, "--set", f"basin.method={method}", "-o", path, ranks=ranks)
        contents.append(datasets(path))
    assert all(other == contents[0] for other in contents[1:])


@pytest.mark.parametrize("method", with_extensive(["icm"], ["direct"]))
def test_a_mirrored_scene_has_mirrored_labels(kapitza, tmp_path, method):
    found = []
    for low, high in ((-1.5, 0.5), (-0.5, 1.5)):
        path = tmp_path / f"{low}.h5"
        kapitza("run", SMALL, *TINY, "--set", f"basin.method={method}", "--set", f"basin.velocity.min={low}",
                "--set", f"basin.velocity.max={high}", "-o", path)
        result = Result(path)
        found.append((result.group("basin")["attractor"].values, result.group("attractors")))
    (labels, table), (image, other) = found
    assert np.allclose(table["strobe_theta"], other["strobe_theta"], rtol=0, atol=1e-9, equal_nan=True)
    assert np.array_equal(image[::-1, ::-1], np.append(table["mirror"].values, -1)[labels])


def test_the_scene_given_by_a_bare_name_writes_into_the_current_folder(kapitza, tmp_path):
    (tmp_path / "scenes").mkdir()
    shutil.copy(SMALL, tmp_path / "scenes" / "mine.yaml")
    kapitza("run", "scenes/mine.yaml", *TINY, folder=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.h5", "scenes"]


def test_check_runs_nothing(kapitza, tmp_path):
    said = kapitza("check", SMALL, folder=tmp_path).stdout
    rows = dict(re.findall(r"^(.+?)\s{2,}(.+)$", said, re.MULTILINE))
    assert len(said.splitlines()) == 5 and rows["studies"] == "basin (exact), 10000 cells" and "max_periods" not in said
    assert re.fullmatch(r"[\d.]+ MB of memory, 633.9 kB on disk", rows["cost"])
    assert "\n\ntitle: " in kapitza("check", SMALL, "--all", folder=tmp_path).stdout
    assert list(tmp_path.iterdir()) == []
