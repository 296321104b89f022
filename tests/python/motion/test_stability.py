"""The studies stability and potential, from the scene to the file."""

import json
import re
import subprocess
import sys

import h5py
import numpy as np
import pytest
from conftest import ROOT, datasets, plot, refused_scene, with_extensive
from kapitza import Result
from kapitza.plots.curves import whole_curve
from matplotlib import image

PENDULUM = "pendulum: {k: 0.008264462809917356, damping: 0.01818181818181818, m: 0.3}\n"
CHART = PENDULUM + """\
stability:
  k: {min: -1, max: 4, count: 101}
  m: {min: 0, max: 4, count: 81}
"""


def run(kapitza, folder, scene, ranks=None):
    (folder / "chart.yaml").write_text(scene)
    kapitza("run", "chart.yaml", "--force", folder=folder, ranks=ranks)
    return h5py.File(folder / "chart.h5")


def test_axes_hold_both_ends_exactly(kapitza, tmp_path):
    with run(kapitza, tmp_path, CHART) as file:
        k, m = file["stability/k"][:], file["stability/m"][:]
    assert (k[0], k[20], k[-1], len(k)) == (-1, 0, 4, 101)
    assert (m[0], m[-1], len(m)) == (0, 4, 81)


def test_note_13_and_the_tangent_of_blackburn(kapitza, tmp_path):
    """0.450 + 2.22/Omega^2 at Omega = 11 beside the exact .46787, and the line that touches curve 2 at k = 1/4."""
    names = "[exact_2, blackburn_upper, blackburn_upper_note, blackburn_tangent]"
    chart = "stability: {k: {min: %r, max: %r, count: 2}, m: {min: 0, max: 1, count: 2}, curves: %s}\n"
    with run(kapitza, tmp_path, PENDULUM + chart % (-1 / 121, 0.2499, names)) as file:
        exact, chord, note, tangent = (file[f"stability/{name}"][:] for name in names[1:-1].split(", "))
    assert abs(note[0] - (0.450 + 2.22 / 121)) < 1e-15 and abs(note[0] - exact[0]) < 5e-4 < abs(chord[0] - exact[0])
    assert abs(tangent[1] - 2e-4) < 1e-15 and abs(exact[1] / tangent[1] - 1) < 1e-4


def test_curves_bring_their_upper_branch_and_subharmonics_both_kinds(kapitza, tmp_path):
    scene = CHART + "  curves: [exact_5, butikov_5_refined, exact_5]\n  subharmonics: [6, 2, 6]\n"
    with run(kapitza, tmp_path, scene) as file:
        names = set(file["stability"])
        long_name = file["stability/subharmonic_6"].attrs["long_name"]
    assert names == {"k", "m", "log_multiplier", "angle", "stable", "exact_5", "exact_5_upper", "butikov_5_refined",
                     "butikov_5_refined_upper", "subharmonic_6", "butikov_subharmonic_6", "subharmonic_2",
                     "butikov_subharmonic_2"}
    assert "repeat" in long_name


@pytest.mark.parametrize("last_k, parted", [(0.7, False), (0.5, True)])
def test_a_damped_tongue_is_drawn_around_its_turn(kapitza, tmp_path, last_k, parted):
    """Both branches as one line where the chart holds the turn (k = 0.6298), as two where it ends before."""
    axes = f"k: {{min: 0.1, max: {last_k}, count: 61}}, m: {{min: 0, max: 4, count: 3}}"
    chart = f"stability: {{{axes}, damping: 0.07, curves: [damped_1]}}\n"
    run(kapitza, tmp_path, PENDULUM + chart).close()
    k, m = whole_curve(Result(tmp_path / "chart.h5").group("stability"), "damped_1")
    assert np.isnan(m).sum() == parted
    at = np.flatnonzero(np.abs(k - 0.5) < 1e-9)
    assert (k[0], k[-1]) == (0.1, 0.1) and m[at] == pytest.approx([0.612655265, 2.369918349], abs=1e-8)


def test_a_chart_needs_no_pendulum(kapitza, tmp_path):
    """The study has its own k, m and damping: the same chart without the mapping, from the resolved scene too, and a
    picture."""
    alone = CHART.removeprefix(PENDULUM)
    with run(kapitza, tmp_path, CHART) as file:
        one = file["stability/log_multiplier"][:]
    for _ in range(2):
        (tmp_path / "alone.yaml").write_text(alone)
        said = kapitza("run", "alone.yaml", "--force", folder=tmp_path).stdout
        assert "nan" not in said and "nan" not in kapitza("check", "alone.yaml", folder=tmp_path).stdout
        with h5py.File(tmp_path / "alone.h5") as file:
            assert "pendulum" not in file and np.array_equal(file["stability/log_multiplier"][:], one)
            alone = file.attrs["scene_resolved"]
    assert plot("stability", tmp_path / "alone.h5", "-o", tmp_path / "alone.png", "--dpi", "60").returncode == 0


def test_any_number_of_ranks_gives_the_same_bytes(kapitza, tmp_path):
    scene = CHART + "  damping: 0.05\n  curves: [exact_1, damped_1, damped_2]\n  subharmonics: [4]\n"
    results = []
    for ranks in (None, 2, 3):
        run(kapitza, tmp_path, scene, ranks).close()
        results.append(datasets(tmp_path / "chart.h5"))
    assert results[0] == results[1] == results[2]


SQUARE = """\
pendulum: {k: 0.1, damping: 0, m: 1, waveform: square, harmonics: [{order: 2, amplitude: 0.3, phase: 40 deg}]}
stability:
  k: {min: -0.5, max: 1.5, count: 81}
  m: {min: -1, max: 1.5, count: 51}
  curves: [hill_1, hill_2, hill_3, hill_4, hill_5]
"""


def test_zones_of_any_wave_form_lie_between_its_curves(kapitza, tmp_path):
    """A wave form that is even neither in time nor in m: stable between curves 1 and 2, 3 and 4, above 5, on both sides
    of the axis."""
    with run(kapitza, tmp_path, SQUARE) as file:
        chart = {name: item[:] for name, item in file["stability"].items()}
        assert file["stability"].attrs["odd_harmonics"] == 0
    one, two, three, four, five = (chart[f"hill_{number}"][:, None] for number in range(1, 6))
    k = chart["k"][None, :]
    expected = ((k > one) & (k < two)) | ((k > three) & (k < four)) | (k > five)
    clear = (np.abs(k - np.stack([one, two, three, four, five])) > 1e-9).all(axis=0)
    assert clear.mean() > 0.95 and (expected == (chart["stable"] == 1))[clear].all()
    assert (chart["hill_1"][chart["m"] == -1] != chart["hill_1"][chart["m"] == 1]).all()


def test_rest_of_a_square_wave_agrees_with_its_chart(kapitza, tmp_path):
    """The line of a summary and the curves are two ways: integration along m, and the determinant."""
    pendulum = "pendulum: {k: 0.01, damping: 0, m: 0.3, waveform: square}\n"
    (tmp_path / "rest.yaml").write_text(pendulum + "attractors: {velocity: {min: -1, max: 1}}\n")
    said = kapitza("check", "rest.yaml", folder=tmp_path).stdout
    low, high = (float(word) for word in re.search(r"Rest inverted: stable \(for m from (\S+) to ([0-9.]+)\)",
                                                   said).groups())
    with run(kapitza, tmp_path, f"{pendulum}stability:\n  k: {{min: -0.01, max: 0, count: 2}}\n"
             f"  m: {{min: {low}, max: {high}, count: 2}}\n  curves: [hill_1, hill_2]\n") as file:
        edges = file["stability/hill_1"][0], file["stability/hill_2"][1]
    assert edges == pytest.approx((-0.01, -0.01), abs=1e-4)


TRAP = ("stability: {a: {min: -0.5, max: 0.5, count: 41}, q: {min: 0, max: 1.2, count: 31}, curves: [exact_2, hill_1, "
        "hill_2]}\n")


def test_words_of_ion_traps_give_the_same_numbers(kapitza, tmp_path):
    with run(kapitza, tmp_path, TRAP) as file:
        trap, resolved = {name: item[:] for name, item in file["stability"].items()}, file.attrs["scene_resolved"]
    assert (trap["a"] == 4 * trap["k"]).all() and (trap["q"] == 2 * trap["m"]).all()
    plain = ("stability: {k: {min: -0.125, max: 0.125, count: 41}, m: {min: 0, max: 0.6, count: 31}, curves: "
             "[exact_2, hill_1, hill_2]}\n")
    for scene in (plain, resolved):
        with run(kapitza, tmp_path, scene) as file:
            assert ("a" in file["stability"]) == (scene == resolved)
            assert all(np.array_equal(item[:], trap[name], equal_nan=True) for name, item in file["stability"].items())


@pytest.mark.parametrize("scene, view", [(TRAP, "trap"), (TRAP, "zones"), (TRAP, "growth"),
                                         (SQUARE.replace("hill_5]", "hill_5, meissner_1, meissner_3]"), "zones")])
def test_charts_of_other_words_and_wave_forms_draw(kapitza, tmp_path, scene, view):
    run(kapitza, tmp_path, scene).close()
    assert plot("stability", tmp_path / "chart.h5", "-o", tmp_path / "chart.png", "--view", view, "--dpi",
                "60").returncode == 0
    assert image.imread(tmp_path / "chart.png")[..., :3].std() > 0.05


@pytest.mark.parametrize("scene, word",
                         [(SQUARE, "axes a and q"), (TRAP.replace("-0.5", "-0.4"), "as many values of a")])
def test_trap_needs_both_directions(kapitza, tmp_path, scene, word):
    run(kapitza, tmp_path, scene).close()
    done = plot("stability", tmp_path / "chart.h5", "--view", "trap", "-o", tmp_path / "chart.png")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and word in done.stderr


def test_the_potential_has_the_wells_of_its_formulas(kapitza, tmp_path):
    with run(kapitza, tmp_path,
             PENDULUM + "potential: {drive_amplitudes: [0.05, 0.2, 0.3], theta: {count: 201}}\n") as file:
        group = {name: item[:] for name, item in file["potential"].items()}
    theta, exact = group["theta"], group["energy"]
    assert exact.shape == (3, 201) and (theta[0], theta[100], theta[-1]) == (-np.pi, 0, np.pi)
    assert (exact[:, 100] == 0).all() and np.allclose(exact, exact[:, ::-1], rtol=0, atol=1e-15)
    assert group["stable_inverted"].tolist() == [0, 1, 1]
    assert np.isnan(group["rim"][0]) and np.degrees(group["rim"][1:]) == pytest.approx([114.41, 100.58], abs=0.01)
    for row in (1, 2):
        half = theta >= 0
        assert theta[half][exact[row][half].argmax()] == pytest.approx(group["rim_exact"][row], abs=0.02)
    assert np.abs(group["energy_simple"] - exact).max() < 2e-3 and np.abs(group["energy_blackburn"]
                                                                          - exact).max() < 2e-3


VIEWS = {
    "zones": "  curves: [exact_1, exact_2, exact_3, damped_1, butikov_3]\n  subharmonics: [2, 4]\n  quality_factor: "
             "5\n",
    "growth": "  curves: [exact_5]\n",
    "frequency": "  curves: [damped_0, damped_1, blackburn_lower]\n  damping: 0.01\n",
    "errors": "  curves: [exact_4, butikov_4, butikov_4_refined]\n  subharmonics: [3]\n",
}


@pytest.mark.parametrize("view", with_extensive(["zones", "frequency"], ["growth", "errors"]))
def test_every_view_draws(kapitza, tmp_path, view):
    chart = CHART
    if view == "frequency":  # it needs stability at k and at -k, close enough at small k
        chart = chart.replace("min: -1, max: 4, count: 101", "min: -0.25, max: 0.25, count: 4001")
        chart = chart.replace("max: 4, count: 81", "max: 0.6, count: 40")
    run(kapitza, tmp_path, chart + VIEWS[view]).close()
    assert plot("stability", tmp_path / "chart.h5", "-o", tmp_path / "chart.png", "--view", view, "--dpi",
                "60").returncode == 0
    assert image.imread(tmp_path / "chart.png")[..., :3].std() > 0.05


def test_view_that_the_chart_cannot_give(kapitza, tmp_path):
    run(kapitza, tmp_path, CHART).close()
    done = plot("stability", tmp_path / "chart.h5", "--view", "errors", "-o", tmp_path / "chart.png")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "formulas" in done.stderr


def test_potential_draws(kapitza, tmp_path):
    run(kapitza, tmp_path, PENDULUM + "potential: {drive_amplitudes: [0.05, 0.3], theta: {count: 101}}\n").close()
    assert plot("potential", tmp_path / "chart.h5", "-o", tmp_path / "potential.png", "--dpi", "60").returncode == 0
    assert image.imread(tmp_path / "potential.png")[..., :3].std() > 0.05


@pytest.mark.extensive
def test_benchmark_measures_speed_and_error(kapitza):
    script = [sys.executable, ROOT / "benchmarks" / "benchmark_stability.py", "--json", "--count", "60", "--points",
              "6", "--exact", "6", "--rounds", "1"]
    figures = json.loads(subprocess.run(script, check=True, capture_output=True, text=True).stdout)
    assert figures["largest_error"] < 1e-12 and figures["scipy_largest_error"] < 1e-8
    assert figures["points"] == 3600


BAD = {
    "curve of the sine under another wave": (SQUARE.replace("hill_1", "exact_1"), "hill_1 to hill_5"),
    "nothing rests": (SQUARE.replace("waveform: square", "tilt: 5 deg"), "can rest"),
    "half of the words of traps": ("stability: {a: {min: 0, max: 1}}\n", "stability.q"),
    "words of two kinds": (TRAP.replace("a: {", "m: {min: 0, max: 1}, a: {"), "contradicts stability.m"),
    "no unit of coefficients": (SQUARE.replace("m: 1, waveform: square", "m: 0, vertical: [0, 0, 0.1, 0]").replace(
        ", harmonics: [{order: 2, amplitude: 0.3, phase: 40 deg}]", ""), "in units of it"),
    "too far for the determinant": (SQUARE.replace("max: 1.5, count: 51", "max: 1001, count: 51"), "m = 1000"),
    "both dampings": (CHART + "  damping: 0.1\n  quality_factor: 5\n", "stability."),
    "unknown curve": (CHART + "  curves: [exact_6]\n", "exact_6"),
    "order below two": (CHART + "  subharmonics: [1]\n", "stability.subharmonics"),
    "no quality": (CHART + "  quality_factor: 0\n", "stability.quality_factor"),
    "k upside down": (CHART.replace("max: 4, count: 101", "max: -2, count: 101"), "stability.k.max"),
    "one value but a range": (CHART.replace("count: 81", "count: 1"), "stability.m.max"),
    "no m": (PENDULUM + "stability: {k: {min: 0, max: 1}}\n", "stability.m"),
    "no amplitudes": (PENDULUM + "potential: {}\n", "potential.drive_amplitudes"),
    "one angle": (PENDULUM + "potential: {drive_amplitudes: [0.1], theta: {count: 1}}\n", "potential.theta.count"),
}


@pytest.mark.parametrize("name", BAD)
def test_scenes_without_a_chart_are_refused_by_their_key(kapitza, tmp_path, name):
    scene, key = BAD[name]
    assert key in refused_scene(kapitza, tmp_path, scene)
