"""scripts/plot_sweep.py: every view of a sweep, and what it says of files that lack one."""

import subprocess
import sys

import pytest
from conftest import ROOT

SCENE = """\
title: A short walk
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.5}
sweep:
  parameter: drive_amplitude
  min: 0.46
  max: 0.48
  count: 3
  measure: [attractors, basin_fractions, flutter_amplitude, release_angle, strobe]
  starts: 128
  transient: 20
  samples: 8
"""


@pytest.fixture(scope="module")
def swept(kapitza, tmp_path_factory):
    folder = tmp_path_factory.mktemp("swept")
    (folder / "walk.yaml").write_text(SCENE)
    kapitza("run", "walk.yaml", folder=folder)
    return folder / "walk.h5"


def draw(path, *arguments):
    command = [sys.executable, ROOT / "scripts" / "plot_sweep.py", path, *arguments]
    return subprocess.run(command, cwd=path.parent, capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("view", ["fractions", "branches", "flutter", "releases", "strobe"])
def test_every_view_is_drawn(swept, view):
    done = draw(swept, "--view", view, "-o", f"{view}.svg", "--dpi", "50")
    assert done.returncode == 0, done.stderr
    text = (swept.parent / f"{view}.svg").read_text()
    assert "A short walk" in text and "3 values" in text


def test_fractions_name_the_large_branches(swept):
    draw(swept, "-o", "first.svg")
    text = (swept.parent / "first.svg").read_text()
    for name in ("inverted", "flutter", "rotation +1/1", "rotation −1/1", "period doubling"):
        assert name in text


def test_zone_of_flutter(kapitza, tmp_path):
    (tmp_path / "zone.yaml").write_text("""\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.5}
sweep: {parameter: drive_frequency, min: 10, max: 12, count: 2, measure: [flutter_zone]}
""")
    kapitza("run", "zone.yaml", folder=tmp_path)
    done = draw(tmp_path / "zone.h5", "-o", "zone.svg")
    assert done.returncode == 0 and "a release of 1° from rest fails" in (tmp_path / "zone.svg").read_text()
    refused = draw(tmp_path / "zone.h5", "--view", "strobe")
    assert refused.returncode == 1 and refused.stderr.endswith("has no strobe; it has zone\n")


def test_a_basin_is_not_a_sweep(small_result):
    done = draw(small_result)
    assert done.returncode == 1 and done.stderr.startswith("error: ") and "holds no sweep" in done.stderr
