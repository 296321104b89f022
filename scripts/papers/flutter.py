"""The numbers of Blackburn, Smith and Groenbech-Jensen (1992) on flutter, and on where attractors begin and end."""

import numpy as np
from kapitza import Result

from .number import Number
from .runs import FIVE, cycle, sweep


def flutter(runs, known):
    """Figs 8, 9, 10 and the text: flutter, its amplitude, where it begins and how it ends."""
    for release, row in known["blackburn_fig8_turning_points_deg_Q5_Omega11_eps0.5"].items():
        orbit = {"start": {"theta": np.pi + np.radians(float(release)), "velocity": 0}, "periods": 20}
        values, _ = runs({"pendulum": FIVE, "orbit": orbit}, "orbit")
        for turn, exact in enumerate(row["first12"]):
            yield Number(
                "Fig. 8",
                f"turning point {turn + 1} after a release from {release} degrees, degrees",
                np.degrees(values["maximum_angle"][turn]),
                reference=exact,
                bar=2e-3,
            )
    for row in known["blackburn_fig9_10_flutter_Q5_Omega11"]:
        values, _ = cycle(
            runs, FIVE | {"drive_amplitude": float(row["eps"])}, np.pi + float(row["phi_strobe"]),
            float(row["dphi_strobe"]), period=2
        )
        amplitude = np.abs(values["maximum_angle"]).max()
        yield Number("Figs 9, 10", f"amplitude of flutter at epsilon = {row['eps']}, rad", amplitude,
                     reference=row["amp_rad"], bar=1e-8)
        if row["eps"] == "0.5":
            yield Number(
                "Fig. 8",
                "final amplitude of flutter at epsilon = 0.5, degrees",
                np.degrees(amplitude),
                "40",
                row["amp_deg"],
                1e-6,
                printed_bar=5,
            )
    found = grown(runs, 11, 0.4681, 0.473, 50)
    yield Number(
        "Sec. III",
        "epsilon where flutter begins, Omega = 11, Q = 5, from the multiplier -1 of the map",
        found["onset"],
        "0.468",
        known["blackburn_fig4_upper_flutter"]["Omega11_Q5"]["eps_c"],
        1e-12,
    )
    yield Number(
        "Fig. 10",
        "exponent of the amplitude as a power of epsilon - epsilon_c",
        found["exponent"],
        "0.5",
        printed_bar=found["exponent_error"],
    )


def grown(runs, omega, low, high, count):
    """Result.flutter of a sweep over the drive amplitude, from few starts beside inverted."""
    near = {"theta": {"min": 3, "max": 3.3}, "velocity": {"min": -0.02, "max": 0.02}, "starts": 16, "max_period": 2}
    along = {"parameter": "drive_amplitude", "min": low, "max": high, "count": count, "measure": ["attractors"]}
    return Result(runs.path({"pendulum": FIVE | {"drive_frequency": omega}, "sweep": along | near})).flutter().attrs


def flutter_ends(runs, known):
    """Where flutter ends, beside the text's 0.53: it loses its symmetry, then doubles its period; releases fail
    earlier."""
    for omega in (*range(5, 16), 20, 30):
        row = known["blackburn_fig4_upper_flutter"].get(f"Omega{omega}_Q5")
        if row is None:
            continue
        found = grown(runs, omega, 0.44, 0.62, 10)
        for what, name, key, bar in (("begins", "onset", "eps_c", 1e-9),
                                     ("loses its symmetry", "asymmetry", "eps_symmetry_breaking", 1e-6)):
            yield Number("Fig. 4", f"epsilon where flutter {what}, Omega = {omega}, Q = 5", found[name],
                         reference=row[key], bar=bar)
        if omega == 11:
            yield Number(
                "Sec. III",
                "epsilon where flutter ends, Omega = 11, Q = 5",
                found["end"],
                "0.53",
                known["blackburn_flutter_cascade_Q5_Omega11"]["eps_period_doubling_of_asymmetric_flutter"],
                1e-6,
                "From 0.53 on, releases from rest do not reach flutter. The attractor exists up to 0.5717, where its "
                "period doubles.",
            )


RANGES = {
    "period3_top": ("inverted 3-nodding", 0.46, 0.475, 16),
    "period9_top": ("inverted 9-nodding", 0.46, 0.475, 16),
    "period4_top": ("inverted 4-nodding", 0.5195, 0.5235, 5),
    "period2_bottom": ("down 2-nodding", 0.43, 0.55, 9),
    "spin_+1/1": ("rotation +1/1", 0.03, 0.05, 5),
}


def lives(runs, known):
    """From where to where the attractors of Figs 11 to 15 exist."""
    for name, ends in known["attractor_existence_ranges_Q5_Omega11"].items():
        words, low, high, count = RANGES[name]
        values, _ = sweep(runs, FIVE, "drive_amplitude", low, high, count, "attractors", starts=4096)
        row = [str(found) for found in values["branch_name"]].index(words)
        for what, side in (("begins", "low"), ("ends", "high")):
            if low < ends[side]["eps"] < high:
                yield Number(
                    "Figs 11-15",
                    f"epsilon where the {words} {what}",
                    values["branch_start" if side == "low" else "branch_end"][row],
                    reference=ends[side]["eps"],
                    bar=1e-7,
                )


PARTS = [flutter, flutter_ends, lives]
