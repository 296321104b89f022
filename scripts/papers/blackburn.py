"""The numbers of Blackburn, Smith and Groenbech-Jensen (1992). A function gives those of one part of the paper."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

from .number import Number
from .runs import FIVE, at, curves, sweep


def mathieu_m(characteristic, k):
    """m of the curve 4k = characteristic(2m), by Mathieu's functions of scipy."""
    return brentq(lambda m: characteristic(2 * m) - 4 * k, 1e-6, 2, xtol=1e-14)


def fast_motion(runs, known):
    """(9): the slow angle with xi(t) against the angle itself, after a release of 10 degrees from inverted, epsilon =
    0.15."""
    pendulum, start, periods = {"quality_factor": 5, "drive_frequency": 11,
                                "drive_amplitude": 0.15}, np.pi + np.radians(10), 5
    slow, _ = runs(
        {"pendulum": pendulum, "orbit": {"model": "effective", "start": {"theta": start, "velocity": 0},
                                         "periods": periods}}, "orbit"
    )

    def motion(t, y):
        return y[1], -y[1] / 55 - (1 / 121 - 0.15 * np.cos(t)) * np.sin(y[0])

    true = solve_ivp(motion, (0, slow["time"][-1]), (start + slow["xi"][0], 0), "DOP853", slow["time"], rtol=1e-12,
                     atol=1e-12).y[0]
    without, with_xi = (np.abs(angle - true).max() for angle in (slow["theta"], slow["theta"] + slow["xi"]))
    yield Number(
        "(9)",
        f"largest distance of Theta + xi from theta over that of Theta alone, {periods} drive periods, epsilon = 0.15",
        with_xi / without,
        reference=0,
        bar=0.3,
    )


def boundaries(runs, known):
    """Eqs (5), (6), Figs 3 and 4: where both positions at rest are stable."""
    names = (
        "damped_0",
        "damped_1",
        "exact_1",
        "exact_2",
        "blackburn_lower",
        "blackburn_upper",
        "blackburn_down_upper",
        "blackburn_upper_note",
    )
    for name, row in known.items():
        if not name.startswith("blackburn_fig4_Omega"):
            continue
        omega, quality = name.removeprefix("blackburn_fig4_Omega").split("_Q")
        k, damping = float(omega) ** -2, {} if quality == "None" else {"quality_factor": float(quality)}
        chart, _ = curves(runs, -k, k, 2, names, **damping)
        where = f"Omega = {omega}, " + (f"Q = {quality}" if damping else "no damping")
        lower, upper = ("damped_0", "damped_1") if damping else ("exact_1", "exact_2")
        for what, curve, sign, key in (
            ("lower boundary of the inverted position", lower, -1, "eps_lower_exact"),
            ("upper boundary of the inverted position", upper, -1, "eps_upper_exact"),
            ("upper boundary of the down position", upper, 1, "eps_down_upper_exact"),
        ):
            yield Number("Fig. 4", f"{what}, {where}", at(chart, sign * k, curve), reference=row[key], bar=1e-9)
        for equation, what, curve, sign, key in (
            ("(5)", "lower boundary of the inverted position", "blackburn_lower", -1, "eq5"),
            ("(6)", "upper boundary of the inverted position", "blackburn_upper", -1, "eq6"),
            ("(6)", "upper boundary of the down position", "blackburn_down_upper", 1, "eq6_down"),
        ):
            if not damping:
                yield Number(equation, f"{what}, Omega = {omega}", at(chart, sign * k, curve), reference=row[key],
                             bar=1e-9)
    k = 1 / 121
    free, _ = curves(runs, -k, k, 2, names)
    damped, _ = curves(runs, -k, k, 2, names, quality_factor=5.0)
    yield Number("(5)", "lower boundary of the inverted position, Omega = 11", at(free, -k, "blackburn_lower"), "0.129")
    yield Number("(6)", "upper boundary of the inverted position, Omega = 11", at(free, -k, "blackburn_upper"), "0.465")
    yield Number(
        "note 13",
        "upper boundary of the inverted position, Omega = 11, by 0.450 + 2.22/Omega^2",
        at(free, -k, "blackburn_upper_note"),
        reference=0.450 + 2.22 / 121,
        bar=1e-12,
    )
    for what, curve, value in (("lower", "exact_1", lambda q: mathieu_a(0, q)),
                               ("upper", "exact_2", lambda q: mathieu_b(1, q))):
        text = f"{what} boundary of the inverted position, Omega = 11, exact"
        yield Number("Figs 2, 3", text, at(free, -k, curve), reference=mathieu_m(value, -k), bar=1e-9)
    near, _ = curves(runs, 0.25 - 1e-4, 0.25, 2, ["exact_2", "blackburn_tangent"])
    yield Number(
        "Sec. II",
        "m of the upper boundary over that of its tangent, delta = 1/4 - epsilon/2, at delta = 0.2499",
        near["exact_2"][0] / near["blackburn_tangent"][0],
        reference=1,
        bar=1e-4,
    )
    yield Number(
        "Sec. III",
        "upper boundary of the inverted position, Omega = 11, exact",
        at(free, -k, "exact_2"),
        "0.465",
        remark="Equation (6) is a straight chord of the exact curve.",
        kind="approximation",
    )
    yield Number(
        "Sec. III", "epsilon where flutter begins, Omega = 11, Q = 5, from the linear equation",
        at(damped, -k, "damped_1"), "0.468"
    )
    yield Number(
        "Sec. II",
        "epsilon where the inverted position becomes stable, Omega = 11, Q = 5",
        at(damped, -k, "damped_0"),
        "0.12",
        remark="The inverted position becomes stable at 0.129. At 0.125 no release stays.",
    )
    fine, _ = curves(runs, -0.0276, -0.0275, 1001, ["exact_2"])
    order = np.argsort(fine["exact_2"])
    yield Number(
        "Sec. II",
        "delta of the upper boundary at epsilon = 0.5",
        np.interp(0.5, fine["exact_2"][order], fine["k"][order]),
        "-0.02756",
        known["blackburn_delta_at_eps0.5_exact"],
        1e-9,
    )


def potential(runs, known):
    """(11), (12), Fig. 5: the effective potential; the values at one angle by quadrature
    (docs/explanation/stability.md)."""
    pendulum = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
    values, _ = runs({"pendulum": pendulum, "potential": {"drive_amplitudes": [0.13, 0.3], "theta": {"count": 20001}}},
                     "potential")
    from scipy.interpolate import CubicSpline

    for name, what, exact in (
        ("energy", "exact, by (10)", 0.030434554),
        ("energy_blackburn", "by (11)", 0.030237336),
        ("energy_simple", "by (12)", 0.030307184),
    ):
        yield Number(
            "Fig. 5",
            f"effective potential at theta = 2 rad, epsilon = 0.3, {what}",
            CubicSpline(values["theta"], values[name][1])(2.0),
            reference=exact,
            bar=6e-10,
        )
    rim = known["blackburn_fig6_7_release"]["11_20_0.13"]["well_rim_from_top_deg"]
    yield Number(
        "(12)", "angle of the rim of the well at epsilon = 0.13, degrees", 180 - np.degrees(values["rim"][0]),
        reference=rim, bar=1e-9
    )


def releases(runs, known):
    """Figs 6 and 7: releases from rest, scanned in whole degrees as the figures were; and Fig. 6's sentence on them.

    A reference of 0 says that one degree fails. The edge is known less well where motions settle slowly (epsilon = 0.13
    and below) and where it is fractal (0.3 and above); below the onset of the inverted state there is none.
    """
    groups = {}
    for name, row in known["blackburn_fig6_7_release"].items():
        omega, quality, epsilon = map(float, name.split("_"))
        if row["first_fail_deg"] is not None and epsilon > float(
            known[f"blackburn_fig4_Omega{omega:g}_QNone"]["eps_lower_exact"]):
            groups.setdefault((omega, quality), []).append((epsilon, row))
    for (omega, quality), rows in groups.items():
        pairs = [rows[i : i + 2] if i + 1 < len(rows) else rows[i - 1 : i + 1] for i in range(0, len(rows), 2)]
        for pair in pairs:
            values, _ = sweep(
                runs,
                {"quality_factor": quality, "drive_frequency": omega, "drive_amplitude": 0.3},
                "drive_amplitude",
                pair[0][0],
                pair[1][0],
                2,
                "release_angle",
            )
            for index, (epsilon, row) in enumerate(pair):
                yield Number(
                    "Fig. 6" if quality == 20 else "Fig. 7",
                    f"smallest angle of a release that fails, Omega = {omega:g}, Q = {quality:g}, epsilon = "
                    f"{epsilon:g}, degrees",
                    np.degrees(values["release_angle_scan"][index]),
                    reference=row["first_fail_deg"],
                    bar=_release_bar(epsilon, row["first_fail_deg"]),
                )
    values, _ = sweep(
        runs, {"quality_factor": 20, "drive_frequency": 11, "drive_amplitude": 0.3}, "drive_amplitude", 0.13, 0.135, 2,
        "release_angle"
    )
    yield Number(
        "Fig. 6",
        "angle below which every release stays, Omega = 11, Q = 20, epsilon = 0.13, degrees",
        np.degrees(values["release_angle"][0]),
        "45",
        remark="The paper says that the angle is always above 45 degrees. This holds for epsilon from 0.15 to 0.49 "
               "only.",
    )


def _release_bar(epsilon, first):
    if first == 0:
        return 1.0
    return 2e-5 if 0.13 < epsilon < 0.3 else 1e-3


def attractors(runs, known):
    """Figs 11 to 15: every attractor of the five pictures, and its share of starts with |v| < 3 (reference: 1500 random
    starts)."""
    for epsilon, table in known["blackburn_fig11_15_attractors_Q5_Omega11"].items():
        scene = {
            "pendulum": FIVE | {"drive_amplitude": float(epsilon)},
            "basin": {"theta": {"count": 300}, "velocity": {"min": -3, "max": 3, "count": 300}},
        }
        values, _ = runs(scene, "attractors")
        for row in table["attractors"]:
            points = np.array(row["strobe_points"], dtype=float)
            gap = np.abs(np.exp(1j * values["strobe_theta"])
                         - np.exp(1j * points[0, 0])) + np.abs(values["strobe_velocity"] - points[0, 1])
            id_, phase = np.unravel_index(np.nanargmin(gap), gap.shape)
            what = f"{row['kind']} at epsilon = {epsilon}"
            exact = max((complex(text) for text in row["multipliers"]), key=lambda value: (abs(value), value.imag))
            share, doubt = row["basin_frac_v3"], 4 * np.sqrt(max(row["basin_frac_v3"], 1 / 1500) / 1500)
            yield Number("Figs 11-15", f"period of {what}", values["period"][id_], reference=row["period"])
            yield Number("Figs 11-15", f"winding of {what}", values["winding"][id_], reference=row["winding_total"])
            yield Number(
                "Figs 11-15",
                f"velocity of the strobe point of {what}",
                values["strobe_velocity"][id_, phase],
                reference=points[0, 1],
                bar=1e-9,
            )
            yield Number(
                "Figs 11-15", f"real part of the multiplier of {what}", values["multiplier_re"][id_, 0],
                reference=exact.real, bar=1e-7
            )
            yield Number("Figs 11-15", f"share of the starts of {what}", values["fraction"][id_], reference=share,
                         bar=doubt)


def cores(runs, known):
    """Figs 11 to 15: how far up theta = pi, in steps of 0.005 of the velocity, starts stay about inverted; finer steps
    find more gaps."""
    for epsilon, row in known["blackburn_fig11_15_core_extent_v_at_theta_pi"].items():
        scene = {
            "pendulum": FIVE | {"drive_amplitude": float(epsilon)},
            "basin": {
                "theta": {"min": np.pi - 1e-9, "max": np.pi + 1e-9, "count": 1},
                "velocity": {"min": 0.0025, "max": 0.2025, "count": 40},
            },
        }
        labels, centre = runs(scene, "basin")[0], runs(scene, "attractors")[0]["centre"]
        leaves = centre[labels["attractor"][:, 0]] != 1
        yield Number(
            "Figs 11-15",
            f"smallest velocity at theta = pi whose motion leaves the inverted position, epsilon = {epsilon}",
            labels["velocity"][np.argmax(leaves)],
            reference=row["first_fail_v_at_top"],
            bar=0.0051,
        )


PARTS = [boundaries, fast_motion, potential, releases, attractors, cores]
