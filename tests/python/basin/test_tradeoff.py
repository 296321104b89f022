"""The trade between speed and accuracy: the study, the cache of true labels, and basin.accuracy."""

import subprocess
import sys

import h5py
import matplotlib.image
import numpy as np
import pytest
from conftest import ROOT, datasets, plot, stopped_in_each_stage
from kapitza.layout import VARIABLES
from kapitza.plots.tradeoff import WAYS, way

SMALL = ROOT / "scenes" / "small.yaml"
SETTINGS = "tradeoff={samples: 60, settings: [direct-24, icm-500, processed-1e-8]}"
COVERAGE = ROOT / "benchmarks" / "reference_coverage.py"
TIMING = {"tradeoff/seconds", "tradeoff/seconds_per_million_cells", "tradeoff/pareto"}
WINDOW = ("--set", "basin={theta: {count: 60}, velocity: {min: -2, max: 2, count: 60}, accuracy: %s, "
                   "attractors: {starts: 2048}}")


def untimed(path):
    return {name: data for name, data in datasets(path).items() if name not in TIMING}


def trade(kapitza, folder, name, *options, ranks=None, amplitude=0.46, status=0):
    kapitza("run", SMALL, "-o", name, "--set", f"pendulum.drive_amplitude={amplitude}", "--set", SETTINGS, *options,
            ranks=ranks, folder=folder, status=status)
    return folder / name


@pytest.fixture(scope="module")
def reference(kapitza, tmp_path_factory):
    return trade(kapitza, tmp_path_factory.mktemp("trade"), "one.h5")


def front(wrong, seconds):
    """Settings that no other one beats: none is better in one of both and not worse in the other."""
    return [not np.any((wrong <= w) & (seconds <= s) & ((wrong < w) | (seconds < s))) for w,
            s in zip(wrong, seconds, strict=True)]


def test_group_holds_what_the_contract_says(reference):
    with h5py.File(reference) as file:
        group = file["tradeoff"]
        assert group["label"].asstr()[:].tolist() == ["direct-24", "icm-500", "processed-1e-8"]
        wrong, low, high = (group[name][:] for name in ("wrong", "wrong_low", "wrong_high"))
        assert np.all(low <= wrong) and np.all(wrong <= high) and np.all(high < 0.5) and np.all(high > 0)
        assert np.all(group["fraction_error"][:] <= wrong) and np.all(group["wrong_inside"][:] <= wrong)
        assert np.all(group["seconds"][:] > 0) and (group["pareto"][:]
                                                    == front(group["wrong"][:], group["seconds"][:])).all()
        assert group.attrs["samples"] == 60 and 0 <= group.attrs["floor"] < 0.2
        assert group.attrs["best_wrong"] == wrong.min()
        assert np.all(np.isnan(group["wrong_distance"][:]) == (wrong == 0))


def test_a_stopped_study_is_resumed(kapitza, tmp_path, reference):
    """Stopped in each of its stages, and resumed on other numbers of ranks until it is complete."""
    words = [SMALL, "-o", "two.h5", "--set", "pendulum.drive_amplitude=0.46", "--set", SETTINGS]
    assert len(stopped_in_each_stage(kapitza, *words, file="two.h5", folder=tmp_path, ranks=[1, 2, 3])) > 3
    assert untimed(tmp_path / "two.h5") == untimed(reference)


@pytest.mark.extensive
def test_the_cache_is_used_extended_and_not_trusted_blindly(kapitza, tmp_path, reference):
    path = trade(kapitza, tmp_path, "cached.h5", "--set", "tradeoff.samples=40")
    cache = path.with_name("cached.h5.truth")
    short = cache.read_text().splitlines()
    assert len(short) == 42
    assert untimed(trade(kapitza, tmp_path, "cached.h5", "--force")) == untimed(reference)
    assert cache.read_text() == reference.with_name("one.h5.truth").read_text()
    assert cache.read_text().splitlines()[:41] == short[:41]
    lines = cache.read_text().splitlines(keepends=True)
    label, rest = lines[1].split(" ", 1)
    cache.write_text("".join([lines[0], f"{int(label) + 1} {rest}", *lines[2:]]))
    assert untimed(trade(kapitza, tmp_path, "cached.h5", "--force")) == untimed(reference)


@pytest.mark.extensive
def test_an_accuracy_within_reach_is_met(kapitza, tmp_path):
    done = kapitza("run", SMALL, "-o", "met.h5", "--set", "pendulum.drive_amplitude=0.150", *without_method(0.98),
                   folder=tmp_path, ranks=2)
    # Smooth boundaries: 0 of 1000 cells wrong
    assert "accuracy 0.98: processed-1e-4 is the cheapest of 1 settings" in done.stdout
    with h5py.File(tmp_path / "met.h5") as file:
        basin = file["basin"].attrs
        assert basin["wrong_high"] <= 0.02 and basin["setting"] in done.stdout
        scene = file.attrs["scene_resolved"]
    assert "accuracy: 0.98" in scene and "method" not in scene and "scheme" not in scene
    (tmp_path / "again.yaml").write_text(scene)
    (tmp_path / "met.h5.truth").rename(tmp_path / "again.h5.truth")  # the reference labels, which take most of the time
    kapitza("run", "again.yaml", folder=tmp_path)
    assert datasets(tmp_path / "again.h5") == datasets(tmp_path / "met.h5")


def without_method(accuracy):
    return WINDOW[0], WINDOW[1] % accuracy


@pytest.mark.extensive
def test_what_no_other_setting_reaches_is_exact(kapitza, tmp_path):
    window = "basin={theta: {count: 20}, velocity: {min: -2, max: 2, count: 20}, accuracy: 0.999}"
    done = kapitza("run", SMALL, "-o", "exact.h5", "--set", "pendulum.drive_amplitude=0.460", "--set", window,
                   folder=tmp_path)
    assert "accuracy 0.999: method exact is taken" in done.stdout and "other settings is accurate enough" in done.stdout
    assert (tmp_path / "exact.h5.truth").exists()
    with h5py.File(tmp_path / "exact.h5") as file:
        basin = file["basin"].attrs
        assert (basin["setting"], basin["method"]) == ("exact", "exact") and "wrong" not in basin


@pytest.mark.parametrize("key", ["basin.method=icm", "basin.icm.theta=500", "numerics.scheme=rk4"])
def test_accuracy_excludes_what_it_chooses(kapitza, tmp_path, key):
    done = kapitza("check", SMALL, *without_method(0.995), "--set", key, folder=tmp_path, status=2)
    assert f"{key.split('=')[0]}: contradicts basin.accuracy" in done.stderr


def test_every_method_has_its_line():
    ways = [way(code, "processed", 1) for code in range(len(VARIABLES["tradeoff", "method"]["flags"]))]
    assert ways == ["table, quintic", "direct, processed", "exact"] and set(ways) <= set(WAYS)


def test_a_trade_needs_a_basin(kapitza, tmp_path):
    (tmp_path / "scene.yaml").write_text("pendulum: {k: 0, damping: 0.05, m: 0.5}\ntradeoff: {samples: 50}\n")
    assert "tradeoff: needs a window; add a basin study" in kapitza("check", "scene.yaml", folder=tmp_path,
                                                                    status=2).stderr


def test_without_damping_there_is_nothing_to_trade(kapitza, tmp_path):
    (tmp_path / "scene.yaml").write_text("pendulum: {k: 0, damping: 0, m: 0.5}\ntradeoff: {samples: 50}\n"
                                         "basin: {theta: {count: 8}, velocity: {min: -1, max: 1, count: 8}}\n")
    assert "without damping" in kapitza("run", "scene.yaml", folder=tmp_path).stdout


@pytest.mark.extensive
def test_the_trade_off_is_drawn_per_run_and_per_cell(reference, tmp_path):
    for options in ([], ["--per-cell"]):
        done = plot("tradeoff", reference, "-o", tmp_path / "trade.png", *options)
        assert (done.returncode, done.stdout, done.stderr) == (0, f"{tmp_path / 'trade.png'}\n", "")
        assert matplotlib.image.imread(tmp_path / "trade.png")[..., :3].std() > 0.05


@pytest.mark.extensive
@pytest.mark.timeout(0)
def test_intervals_hold_on_pendulums_of_no_scene():
    done = subprocess.run([sys.executable, COVERAGE], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.extensive
def test_starts_too_fast_to_judge_are_refused(kapitza, tmp_path):
    done = kapitza("run", SMALL, "-o", "no.h5", *without_method(0.9), "--set", "basin.velocity.max=1e4",
                   folder=tmp_path, status=2)
    assert ("basin.velocity: 3072 steps a period are too few for reference labels of starts with speed 1e+04"
            in done.stderr)
    assert list(tmp_path.iterdir()) == []
