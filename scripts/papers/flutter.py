"""The numbers of Blackburn, Smith and Groenbech-Jensen (1992) on flutter, and on where attractors begin and end."""

import numpy as np

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
            runs, FIVE | {"drive_amplitude": float(row["eps"])}, np.pi + float(row["phi_strobe"]), float(row["dphi_strobe"]), period=2
        )
        amplitude = np.abs(values["maximum_angle"]).max()
        yield Number("Figs 9, 10", f"amplitude of flutter at epsilon = {row['eps']}, rad", amplitude, reference=row["amp_rad"], bar=1e-8)
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
    values, attributes = sweep(runs, FIVE, "drive_amplitude", 0.4683, 0.473, 48, "flutter_amplitude")
    yield Number(
        "Sec. III",
        "epsilon where flutter begins, Omega = 11, Q = 5, from the multiplier -1 of the map",
        attributes["critical_value"],
        "0.468",
        known["blackburn_fig4_upper_flutter"]["Omega11_Q5"]["eps_c"],
        1e-12,
    )
    yield Number(
        "Fig. 10",
        "exponent of the amplitude as a power of epsilon - epsilon_c",
        attributes["fit_exponent"],
        "0.5",
        printed_bar=attributes["fit_exponent_error"],
    )


def flutter_ends(runs, known):
    """The dots of Fig. 4 and the text's 0.53: the cycle loses its symmetry and doubles its period; releases fail earlier."""
    for low, high, count in ((5, 15, 11), (20, 30, 2)):
        values, _ = sweep(runs, FIVE, "drive_frequency", low, high, count, "flutter_zone")
        for index, omega in enumerate(values["value"]):
            row = known["blackburn_fig4_upper_flutter"].get(f"Omega{round(omega)}_Q5")
            if row is None:
                continue
            yield Number(
                "Fig. 4",
                f"epsilon where flutter begins, Omega = {omega:g}, Q = 5",
                values["flutter_onset"][index],
                reference=row["eps_c"],
                bar=1e-9,
            )
            yield Number(
                "Fig. 4",
                f"epsilon where flutter loses its symmetry, Omega = {omega:g}, Q = 5",
                values["flutter_asymmetry"][index],
                reference=row["eps_symmetry_breaking"],
                bar=1e-6,
            )
            if omega == 11:
                end = known["blackburn_flutter_cascade_Q5_Omega11"]["eps_period_doubling_of_asymmetric_flutter"]
                yield Number(
                    "Sec. III",
                    "epsilon where flutter ends, Omega = 11, Q = 5",
                    values["flutter_end"][index],
                    "0.53",
                    end,
                    1e-6,
                    "From 0.53 on, releases from rest do not reach flutter. The attractor exists up to 0.5717, where its period doubles.",
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
