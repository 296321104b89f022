"""The half-period symmetry: with a motion theta(t) also -theta(t + pi) is one. Values of the driven pendulum of the
textbooks."""

import math

import h5py
import numpy as np
import pytest
from conftest import flown, run_scene

KINDS = ["left_the_range", "fold", "period_doubling", "neimark_sacker", "symmetry_breaking", "not_located"]
SWEEP = ("sweep: {{parameter: torque_amplitude, min: {}, max: {}, count: {}, measure: [attractors], starts: {}, "
         "max_period: {}}}\n")


def branches_of(kapitza, folder, pendulum, *sweep):
    result, _ = run_scene(kapitza, folder, f"pendulum: {pendulum}\n{SWEEP.format(*sweep)}")
    with h5py.File(result.path) as file:
        names = ("period", "symmetric", "stable", "mirror", "start", "start_kind", "end", "end_kind")
        return [dict(zip(names, row, strict=True)) for row in zip(*(file[f"sweep/branch_{name}"][:] for name in names),
                                                                  strict=True)]


def test_symmetry_breaks_where_the_literature_has_it(kapitza, tmp_path):
    """Mathematica's damped pendulum, q = 3.9, omega_D = 2/3: at 1.4074070335, g = .6255142371. The twins are born at
    the same value."""
    found = branches_of(kapitza, tmp_path, f"{{k: 2.25, damping: {1 / 2.6}, m: 0, torque_amplitude: 1.39}}", 1.39, 1.43,
                        3, 128, 1)
    attracting = [row for row in found if row["stable"]]
    symmetric, *twins = attracting
    assert symmetric["symmetric"] and KINDS[symmetric["end_kind"]] == "symmetry_breaking"
    assert symmetric["end"] == pytest.approx(1.4074070335, abs=5e-11)
    assert symmetric["end"] / 2.25 == pytest.approx(0.6255142371, abs=5e-11)
    assert len(twins) == 2 and {row["mirror"] for row in twins} == {found.index(row) for row in twins}
    for row in twins:
        assert KINDS[row["start_kind"]] == "symmetry_breaking" and row["start"] == pytest.approx(symmetric["end"],
                                                                                                 abs=1e-13)


@pytest.mark.parametrize(("low", "high", "values"), [
    (1.05, 1.081, {1: 1.0663729, 2: 1.0793139}), (1.0819, 1.0824, {4: 1.0820844}), (1.0823, 1.0829, {8: 1.0826783})])
def test_twins_double_at_the_same_values(kapitza, tmp_path, low, high, values):
    """Taylor's pendulum, omega_0 = 1.5 omega, beta = omega_0/4: the book's cascade."""
    pendulum = f"{{k: 2.25, damping: 0.75, m: 0, torque_amplitude: {1.05 * 2.25}}}"
    found = branches_of(kapitza, tmp_path, pendulum, low * 2.25, high * 2.25, 2, 64, 8)
    for period, gamma in values.items():
        ends = [row for row in found if row["stable"] and row["period"] == period
                and KINDS[row["end_kind"]] == "period_doubling"]
        assert ends and all(row["end"] / 2.25 == pytest.approx(gamma, abs=1e-7) for row in ends)
        assert np.ptp([row["end"] for row in ends]) < 1e-12
    twins = [row for row in found if row["stable"] and row["period"] == min(values)]
    assert {row["mirror"] for row in twins} == {found.index(row) for row in twins} and len(twins) == 2


def test_a_symmetry_of_one_value_alone_is_none_of_the_way(kapitza, tmp_path):
    """At torque 0 the resting junction is its own image; beside it none is, and the branch goes on to where its step
    ends."""
    text = ("pendulum: {k: 0.02, damping: 0.3, m: 0, torque: 0, torque_amplitude: 1.5}\n"
            "sweep: {parameter: torque, min: 0, max: 0.012, count: 3, measure: [attractors], starts: 16}\n")
    result, _ = run_scene(kapitza, tmp_path, text)
    with h5py.File(result.path) as file:
        step = [(float(a), float(b)) for a, b, stable, name in zip(
            file["sweep/branch_start"], file["sweep/branch_end"], file["sweep/branch_stable"],
            file["sweep/branch_name"].asstr(), strict=True) if stable and name == "down"]
    assert len(step) == 1 and step[0][0] == 0 and step[0][1] == pytest.approx(0.010936, rel=2e-3)


@pytest.mark.parametrize("keys", ["m: 0, torque_amplitude: 1.42", "m: 1.42, tilt: 90 deg"])
def test_images_of_attractors_are_half_a_period_later(kapitza, tmp_path, keys):
    """Flown here: minus the state at t = pi is a strobe point of the image."""
    basin = "{theta: {count: 8}, velocity: {min: -2, max: 2, count: 8}, attractors: {starts: 256}}"
    result, _ = run_scene(kapitza, tmp_path, f"pendulum: {{k: 2.25, damping: {1 / 2.6}, {keys}}}\nbasin: {basin}\n")

    def slope(t, x):
        force = 1.42 * math.cos(t) * (1 if "torque" in keys else math.cos(x[0]))
        return [x[1], force - x[1] / 2.6 - 2.25 * math.sin(x[0])]

    with h5py.File(result.path) as file:
        names = ("period", "winding", "mirror", "symmetric", "strobe_theta", "strobe_velocity")
        found = {name: file[f"attractors/{name}"][:] for name in names}
    points = np.stack([found["strobe_theta"], found["strobe_velocity"]], axis=-1)
    assert len(found["period"]) > ("torque" in keys)
    for i, n in enumerate(found["period"]):
        j = found["mirror"][i]
        assert j >= 0 and found["mirror"][j] == i and bool(found["symmetric"][i]) == (i == j)
        assert found["winding"][j] == -found["winding"][i]
        for p in range(n):
            theta, velocity = flown(slope, math.pi, points[i, p], 1e-12)
            assert min(abs(math.remainder(-theta - x, 2 * math.pi)) + abs(velocity + v) for x,
                       v in points[j, :n]) < 1e-8


def test_phases_half_a_period_apart_are_labelled_once(kapitza, tmp_path):
    """Of eight phases four are followed: shares and ends are those of a scene whose window is no mirror image, which
    follows all."""
    said = []
    for low in ("-1", "-1.000000001"):
        basin = (f"{{theta: {{count: 24}}, velocity: {{min: {low}, max: 1, count: 24}}, phases: 8, attractors: "
                 f"{{starts: 256}}}}")
        result, _ = run_scene(kapitza, tmp_path,
                              f"pendulum: {{k: 2.25, damping: 0.75, m: 0, torque_amplitude: 2.38}}\nbasin: {basin}\n")
        with h5py.File(result.path) as file:
            said.append([file[f"phases/{name}"][:] for name in ("fraction", "common", "ends")])
    (fraction, common, ends), (all_fraction, all_common, all_ends) = said
    assert np.abs(fraction - all_fraction).max() < 0.01 and (common == all_common).mean() > 0.99
    assert (ends == all_ends).mean() > 0.98
    assert (fraction[4:] == fraction[:4, ::-1]).all() and len(fraction[0]) == 2 and (ends == 2).any()
