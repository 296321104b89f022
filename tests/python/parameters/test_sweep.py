"""The study sweep against the literature (tests/literature/reference.json), and its promises: ranks, resuming,
agreement."""

import json

import h5py
import numpy as np
import pytest
from conftest import EXTENSIVE, ROOT, datasets, run_scene, stopped_and_resumed, with_extensive
from kapitza import Result

REFERENCE = json.loads((ROOT / "tests" / "literature" / "reference.json").read_text())
KINDS = ["left_the_range", "fold", "period_doubling", "neimark_sacker", "symmetry_breaking", "not_located"]
SCENE = """\
pendulum: {pendulum}
sweep: {{parameter: {parameter}, min: {low}, max: {high}, count: {count}, measure: [{measure}]{more}}}
"""
FORM = "{{quality_factor: {}, drive_frequency: {}, drive_amplitude: 0.3}}"
FIG12 = FORM.format(5, 11)


@pytest.fixture(scope="session")
def sweep(kapitza, tmp_path_factory):
    """Runs a sweep and gives its group as (arrays, attributes); run.file is the file of the last one, run.said its
    summary."""

    def run(measure, low, high, count, parameter="drive_amplitude", pendulum=FIG12, more=""):
        text = SCENE.format(measure=measure, low=low, high=high, count=count, parameter=parameter, pendulum=pendulum,
                            more=more)
        result, run.said = run_scene(kapitza, tmp_path_factory.mktemp("sweep"), text)
        run.file = result.path
        with h5py.File(run.file) as file:
            group = file["sweep"]
            arrays = {name: item.asstr()[:] if h5py.check_string_dtype(item.dtype) else item[()] for name,
                      item in group.items()}
            return arrays, dict(group.attrs)

    return run


def ends(branches, name, count=1, *, symmetric=None):
    """(start, kind, end, kind) of the branch of that name that attracts at a value; `count` branches must have it,
    mirror images alike."""
    rows = [index for index, found in enumerate(branches["branch_name"])
            if found == name and branches["branch_stable"][index]
            and np.isfinite(branches["branch_theta"][:, index]).any()
            and symmetric in (None, branches["branch_symmetric"][index])]
    assert len(rows) == count, list(branches["branch_name"])
    table = [(branches["branch_start"][row], KINDS[branches["branch_start_kind"][row]], branches["branch_end"][row],
              KINDS[branches["branch_end_kind"][row]]) for row in rows]
    for row in table[1:]:
        assert row == (pytest.approx(table[0][0], abs=1e-8), table[0][1], pytest.approx(table[0][2], abs=1e-8),
                       table[0][3])
    return table[0]


def near(value):
    return pytest.approx(value, abs=1e-6)


RANGES = REFERENCE["attractor_existence_ranges_Q5_Omega11"]


def test_inverted_gives_way_to_flutter(sweep):
    branches, _ = sweep("attractors", 0.46, 0.475, 16 if EXTENSIVE else 4, more=", starts: 4096")
    critical = REFERENCE["blackburn_fig4_upper_flutter"]["Omega11_Q5"]["eps_c"]
    exact = pytest.approx(critical, abs=1e-11)
    assert ends(branches, "inverted")[2:] == (exact, "period_doubling")
    assert ends(branches, "flutter")[:2] == (exact, "period_doubling")
    for name, key in (("inverted 3-nodding", "period3_top"), ("inverted 9-nodding", "period9_top")):
        assert ends(branches, name, 2) == (near(RANGES[key]["low"]["eps"]), "fold",
                                           near(RANGES[key]["high"]["eps"]), "period_doubling")
    names, mirrors = branches["branch_name"], branches["branch_mirror"]
    for row in np.flatnonzero(branches["branch_stable"] & np.isfinite(branches["branch_theta"]).any(axis=0)):
        mirror = mirrors[row]
        assert mirrors[mirror] == row and names[mirror].replace("-1/", "+1/") == names[row].replace("-1/", "+1/")
        assert (mirror == row) == bool(branches["branch_symmetric"][row])


def test_flutter_begins_where_rest_ends_however_its_angle_is_written(sweep):
    """Upright rest may stand at -pi in a catalogue: what it turns into is found all the same."""
    branches, _ = sweep("attractors", 0.6, 0.65, 2, "m", "{k: 0.1, damping: 0.1, m: 0.5}",
                        ", starts: 256, max_period: 4")
    assert ends(branches, "flutter") == (pytest.approx(0.625495916, abs=1e-9), "period_doubling", 0.65,
                                         "left_the_range")


def test_a_doubled_cycle_ends_where_it_is_born(sweep):
    """One value lies so little below the birth of flutter that a step of its branch ended on rest: flutter was told
    where there is none."""
    branches, _ = sweep("attractors", 0.46205128205128204, 0.47974358974358977, 4, more=", starts: 128")
    assert ends(branches, "flutter")[:2] == (pytest.approx(0.46819030239028, abs=1e-11), "period_doubling")
    flutter = list(branches["branch_name"]).index("flutter")
    assert np.isnan(branches["branch_theta"][:2, flutter]).all()
    assert np.isfinite(branches["branch_theta"][2:, flutter]).all()


def test_a_pair_between_two_values_has_its_births_and_ends(sweep):
    branches, _ = sweep("attractors", 0.5195, 0.5235, 5, more=", starts: 2048")
    low, high = (RANGES["period4_top"][key]["eps"] for key in ("low", "high"))
    assert ends(branches, "inverted 4-nodding", 2) == (near(low), "fold", near(high), "period_doubling")


def test_hanging_state_and_its_doubling(sweep):
    branches, _ = sweep("attractors", 0.43, 0.55, 9, more=", starts: 512")
    low, high = (RANGES["period2_bottom"][key]["eps"] for key in ("low", "high"))
    assert ends(branches, "down")[2:] == (near(low), "period_doubling")
    assert ends(branches, "down 2-nodding", symmetric=1) == (near(low), "period_doubling", near(high),
                                                             "symmetry_breaking")


def test_rotation_is_born_in_a_fold(sweep):
    branches, _ = sweep("attractors", 0.02, 0.06, 5, more=", starts: 512")
    low = RANGES["spin_+1/1"]["low"]["eps"]
    assert float(low) == pytest.approx(2 / 55, rel=1e-3)  # twice the damping, a simple law
    assert ends(branches, "rotation +1/1") == (near(low), "fold", 0.06, "left_the_range")
    assert ends(branches, "rotation -1/1") == (near(low), "fold", 0.06, "left_the_range")
    turned = np.flatnonzero((branches["branch_name"] == "rotation +1/1") & (branches["branch_stable"] == 0))
    assert len(turned) == 1 and KINDS[branches["branch_start_kind"][turned[0]]] == "fold"
    assert branches["branch_start"][turned[0]] == pytest.approx(ends(branches, "rotation +1/1")[0], abs=1e-11)
    multiplier = branches["branch_multiplier"][:, turned[0]]
    assert np.isfinite(multiplier).sum() == 3 and np.nanmin(multiplier) > 1


def test_a_branch_between_two_values(sweep):
    """The pair that a symmetric cycle of six periods turns into doubles before the next value."""
    branches, _ = sweep("attractors", 0.3, 0.312, 2, more=", starts: 1024")
    unseen = ~np.isfinite(branches["branch_theta"]).any(axis=0)
    hidden = np.flatnonzero(branches["branch_stable"] & unseen & (branches["branch_period"] == 6)
                            & (branches["branch_centre"] == 0))
    assert len(hidden) == 1
    assert branches["branch_start"][hidden[0]] == ends(branches,
                                                       "down 6-nodding")[2] == pytest.approx(0.305920438, abs=1e-9)
    assert branches["branch_end"][hidden[0]] == pytest.approx(0.308037212, abs=1e-9)
    assert KINDS[branches["branch_end_kind"][hidden[0]]] == "period_doubling"


def test_flutter_loses_its_symmetry_then_doubles(sweep):
    branches, _ = sweep("attractors", 0.555, 0.5715, 6, more=", starts: 2048")
    rows = np.flatnonzero((branches["branch_name"] == "flutter") & (branches["branch_stable"] == 1))
    broken = float(REFERENCE["blackburn_flutter_loss_Q5_Omega11"]["eps_symmetry_breaking"])
    symmetric = [row for row in rows if branches["branch_symmetric"][row]]
    exact = pytest.approx(broken, abs=1e-11)
    assert len(symmetric) == 1 and branches["branch_end"][symmetric[0]] == exact
    assert KINDS[branches["branch_end_kind"][symmetric[0]]] == "symmetry_breaking"
    for row in set(rows) - set(symmetric):
        assert branches["branch_start"][row] == exact
        assert KINDS[branches["branch_start_kind"][row]] == "symmetry_breaking"


def test_without_damping_multipliers_are_on_the_unit_circle(sweep):
    group, _ = sweep("attractors", 0, 0.02, 3, "damping", "{k: 0.008264462809917356, damping: 0.02, m: 0.3}",
                     ", starts: 256")
    row = list(group["branch_name"]).index("inverted")
    assert KINDS[group["branch_start_kind"][row]] == "neimark_sacker" and abs(group["branch_start"][row]) < 1e-9
    assert np.isnan(group["branch_amplitude"][0]).all() and group["branch_amplitude"][1, row] == 0


@pytest.mark.extensive
def test_gravity_upside_down(sweep):
    """k -> -k turns the pendulum over and shifts the drive by half a period: branches are mirrored, down becomes
    inverted."""
    group, _ = sweep("attractors", -0.1, 0.1, 5, "k", "{k: 0.1, damping: 0.05, m: 0.4}", ", starts: 256")
    turned = {"down": "inverted", "inverted": "down", "flutter": "down 2-nodding", "down 2-nodding": "flutter"}
    lives = {name: (group["branch_start"][row], group["branch_start_kind"][row], group["branch_end"][row],
                    group["branch_end_kind"][row]) for row, name in enumerate(group["branch_name"])
             if group["branch_stable"][row]}
    assert turned.keys() <= lives.keys()
    for name, other in turned.items():
        start, start_kind, end, end_kind = lives[name]
        assert lives[other] == (pytest.approx(-end, abs=1e-6), end_kind, pytest.approx(-start, abs=1e-6), start_kind)
    assert lives["inverted"][2] == pytest.approx(0.0749420725, abs=1e-8)


@pytest.mark.extensive
def test_chaos_is_one_branch(sweep):
    pendulum, more = "{k: 0.25, damping: 0.05, m: 0.5}", ", starts: 64, velocity: {min: -1, max: 1}"
    group, _ = sweep("basin_fractions", 0.45, 0.5, 3, "m", pendulum, more)
    names = list(group["branch_name"][group["branch_stable"] == 1])
    row = names.index("chaotic")
    share = 100 * group["fraction"][:, row]
    assert f"{np.nanmin(share):.2f} to {np.nanmax(share):.2f} %" in next(line for line in sweep.said.splitlines()
                                                                         if "chaotic" in line)
    assert names.count("rotation +8/8") == names.count("rotation -8/8") == names.count("chaotic") == 1
    assert group["branch_period"][row] == 0 and group["branch_mirror"][row] == row
    assert (group["branch_start"][row], KINDS[group["branch_start_kind"][row]]) == (0.475, "not_located")
    assert KINDS[group["branch_end_kind"][row]] == "left_the_range" and group["fraction"][2, row] == 1
    rotation = names.index("rotation +8/8")
    assert KINDS[group["branch_end_kind"][rotation]] == "period_doubling"
    assert 0.45 < group["branch_end"][rotation] < 0.475


NEAR_INVERTED = ", theta: {min: 3, max: 3.3}, velocity: {min: -0.02, max: 0.02}, starts: 16, max_period: 2"


@pytest.fixture(scope="session")
def flutter(sweep):
    """Result.flutter of a sweep over the drive amplitude, from few starts beside inverted."""

    def run(low, high, count, pendulum=FIG12):
        sweep("attractors", low, high, count, pendulum=pendulum, more=NEAR_INVERTED)
        return Result(sweep.file).flutter()

    return run


def test_flutter_amplitudes(flutter):
    found = flutter(0.46, 0.56, 21)
    known = {round(float(row["eps"]), 6): row["amp_rad"] for row in REFERENCE["blackburn_fig9_10_flutter_Q5_Omega11"]}
    compared = [(float(found["amplitude"].sel(value=value)), known[round(value, 6)]) for value in found["value"].values
                if round(value, 6) in known]
    assert len(compared) >= 15
    assert all(ours == pytest.approx(theirs, abs=1e-8) for ours, theirs in compared)
    assert found.attrs["onset"] == pytest.approx(0.46819030239029, abs=1e-12) and np.isnan(found["amplitude"][0])


def test_flutter_grows_with_the_square_root(flutter):
    found = flutter(0.4681, 0.473, 50)
    law = found.attrs
    assert abs(law["exponent"] - 0.5) < law["exponent_error"] < 1e-3
    assert law["slope"] == pytest.approx(3.7902**2, rel=1e-2)
    there = np.isfinite(found["amplitude"].values)
    distance = found["value"].values[there] - law["onset"]
    slope, intercept = np.polyfit(distance, found["amplitude"].values[there] ** 2, 1)
    assert law["slope"] == pytest.approx(slope, rel=1e-9) and abs(intercept) < 2e-4
    assert 0 < law["slope_stderr"] < 1e-2 and np.isnan(law["asymmetry"]) and np.isnan(law["end"])


def test_a_law_of_few_values_is_not_known(flutter):
    law = flutter(0.46, 0.475, 4).attrs
    assert law["onset"] == pytest.approx(0.46819030239029,
                                         abs=1e-12) and np.isnan([law["slope"], law["exponent"]]).all()


def test_without_damping_a_sweep_says_that_nothing_attracts(sweep):
    arrays, _ = sweep("attractors", 0.2, 0.3, 2, pendulum="{drive_frequency: 11, drive_amplitude: 0.3}",
                      more=", starts: 16")
    assert "without damping there are none" in sweep.said and "nan" not in sweep.said
    assert arrays["branch"].shape == (0,) and np.isnan(Result(sweep.file).flutter()["amplitude"]).all()


@pytest.mark.parametrize("omega", with_extensive([11], [5, 7, 9, 13, 15, 20, 30]))
def test_flutter_ends_at_any_frequency(flutter, omega):
    """The dots of Fig. 4: the cycle goes on far beyond the releases of 1 degree that fail."""
    known = REFERENCE["blackburn_fig4_upper_flutter"][f"Omega{omega}_Q5"]
    law = flutter(0.44, 0.62, 10, FORM.format(5, omega)).attrs
    assert law["onset"] == pytest.approx(known["eps_c"], abs=1e-11)
    assert law["asymmetry"] == pytest.approx(known["eps_symmetry_breaking"], abs=1e-11)
    assert known["first_eps_1deg_release_fails"] < law["asymmetry"] < law["end"]
    doubling = float(REFERENCE["blackburn_flutter_cascade_Q5_Omega11"]["eps_period_doubling_of_asymmetric_flutter"])
    assert omega != 11 or law["end"] == pytest.approx(doubling, abs=1e-11)


@pytest.mark.parametrize("omega", with_extensive([9], [5, 7, 11, 13, 15, 20, 30]))
def test_releases_of_one_degree_fail_where_the_dots_are(kapitza, tmp_path, omega):
    """Steps of 0.002, as the reference: at its value a release no longer ends about inverted."""
    first = REFERENCE["blackburn_fig4_upper_flutter"][f"Omega{omega}_Q5"]["first_eps_1deg_release_fails"]
    over = f"{{parameter: drive_frequency, min: {omega}, max: {omega + 1}, count: 2}}"
    up = f"{{parameter: drive_amplitude, min: {first - 0.02}, max: {first}, count: 11}}"
    text = (f"pendulum: {FORM.format(5, omega)}\nsweep: {{x: {over}, y: {up}, measure: [ends], ends: {{theta: [179 "
            f"deg]}}}}\n")
    plane = run_scene(kapitza, tmp_path, text)[0].group("plane")
    about = (plane["end"].values[0, :, 0] == 0) & (plane["end_centre"].values[0, :, 0] == 1)
    assert not about[-1] and (about[:-1].all() or omega == 11)  # there a step in between fails too


def test_what_replaces_the_measures_of_flutter_is_said(kapitza, tmp_path):
    for word in ("flutter_amplitude", "flutter_zone"):
        text = SCENE.format(measure=word, low=0.46, high=0.47, count=2, parameter="drive_amplitude", pendulum=FIG12,
                            more="")
        (tmp_path / "old.yaml").write_text(text)
        said = kapitza("check", tmp_path / "old.yaml", status=2).stderr
        assert said.count("\n") == 1 and f'"{word}"' in said and "it was removed: use attractors" in said


RELEASES = [(20, 11, 0.13, 0.25, 13 if EXTENSIVE else 4), (20, 11, 0.3, 0.5, 5 if EXTENSIVE else 2),
            (20, 30, 0.05, 0.2, 4), (5, 11, 0.15, 0.2, 2)]


@pytest.mark.parametrize(("q", "omega", "low", "high", "count"), RELEASES)
def test_releases_from_rest(sweep, q, omega, low, high, count):
    arrays, _ = sweep("release_angle", low, high, count, pendulum=FORM.format(q, omega))
    compared = 0
    for row, value in enumerate(arrays["value"]):
        known = REFERENCE["blackburn_fig6_7_release"].get(f"{omega}_{q}_{round(value, 6):g}")
        if known is None:
            continue
        compared += 1
        stays = np.flatnonzero(arrays["release_stays"][row][1::2]) + 1  # edges in whole degrees
        scan, first, largest = (np.degrees(arrays[name][row]) for name in
                                ("release_angle_scan", "release_angle", "release_angle_largest"))
        assert scan == pytest.approx(known["first_fail_deg"], abs=2e-5 if value < 0.3 else 1e-3)  # above: fractal edges
        assert first <= scan + 1e-6 <= largest + 2e-6
        # A simple law: the rim, and the slow angle at t = 0, phi - epsilon sin phi
        if (q, high) == (20, 0.25) and value > 0.15:
            rim = 2 / (omega * value) ** 2
            assert first == pytest.approx(np.degrees(np.arccos(rim) + value * np.sqrt(1 - rim**2)), abs=1.5)
        assert stays.max() == round(known["last_ok_deg"]) and abs(len(stays) - known["n_ok"]) <= 1
    assert compared >= 2


def test_strobe_points_walk_up_and_down(sweep):
    arrays, _ = sweep("strobe", 0.46, 0.48, 5, more=", transient: 2000, samples: 8, start: {theta: 3.1, velocity: 0}")
    theta, walk = arrays["strobe_theta"], arrays["sample_walk"]
    deflection = np.abs(np.abs(theta) - np.pi)
    assert np.all(deflection[0] < 1e-9)  # at rest below the critical value
    for name, direction in (("up", 0), ("down", 1)):
        points = deflection[-1][walk == direction]
        assert np.allclose(points, 0.4083406284436, atol=1e-8), name
    assert theta.min() >= -np.pi and theta.max() < np.pi


def test_grid_and_starts_agree(kapitza, tmp_path):
    scene = """\
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}
sweep: {parameter: drive_amplitude, min: 0.25, max: 0.3, count: 2, measure: [basin_fractions], starts: 4096}
"""
    grid = """\
basin:
  theta: {count: 100}
  velocity: {min: -2, max: 2, count: 100}
  icm: {theta: 300, velocity: 300}
"""
    shares = []
    for text in (scene, scene + grid):
        result, _ = run_scene(kapitza, tmp_path, text)
        with h5py.File(result.path) as file:
            group = file["sweep"]
            shares.append({(row, label): group["fraction"][row, column] for column, label in
                           enumerate(group["branch_name"].asstr()[:]) for row in range(2)})
            low, share, high = (group[key][:] for key in ("fraction_low", "fraction", "fraction_high"))
            there = np.isfinite(share)
            assert np.all((low[there] <= share[there]) & (share[there] <= high[there]))
            assert np.nansum(share, axis=1) == pytest.approx([1, 1], abs=1e-3)
            if text != scene:
                basin, ids = file["basin/attractor"][:], file["attractors/name"].asstr()[:]
                own = np.mean(np.isin(basin, np.flatnonzero(ids == "inverted")))
                assert shares[1][1, "inverted"] == pytest.approx(own, abs=1e-12)
    for key in ((row, name) for row in range(2) for name in ("down", "inverted", "rotation +1/1", "rotation -1/1")):
        assert shares[0][key] == pytest.approx(shares[1][key], abs=0.02), key


ALL = "attractors, basin_fractions, release_angle, strobe"


def test_same_bytes_on_any_number_of_ranks_and_resumed(kapitza, tmp_path):
    text = SCENE.format(measure=ALL, low=0.46, high=0.48, count=2, parameter="drive_amplitude",
                        pendulum=FIG12, more=", starts: 64, transient: 100, samples: 16")
    one, three = (datasets(run_scene(kapitza, tmp_path, text, ranks=ranks)[0].path) for ranks in (1, 3))
    assert one == three == datasets(stopped_and_resumed(kapitza, tmp_path, text, ranks=2).path)
