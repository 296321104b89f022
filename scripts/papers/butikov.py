"""The numbers of Butikov (2018). A function gives those of one part of the paper; equations and figures are counted as
printed."""

import numpy as np

from .number import Number
from .runs import at, cosine, curves, cycle, sine, undamped

CURVES = {f"curve{n}": [f"exact_{n}", f"butikov_{n}", *([f"butikov_{n}_refined"] if n > 3 else [])]
          for n in range(1, 6)}
FORMULAS = {1: "(3)", 2: "(4)", 3: "(5)", 4: "(6)", 5: "(7)"}


def zones(runs, known):
    """Fig. 1: the transition curves without damping, exact and by every formula."""
    names = [name for row in CURVES.values() for name in row]
    value = undamped(runs, names)
    for n in range(1, 6):
        for row in known[f"butikov_fig1_curve{n}"]:
            k = float(row["k"])
            yield Number("Fig. 1", f"m of curve {n} at k = {k:.9g}, exact", value(k, f"exact_{n}"),
                         reference=row["m_exact"], bar=1e-9)
            yield Number(FORMULAS[n], f"m of curve {n} at k = {k:.9g}", value(k, f"butikov_{n}"),
                         reference=row["m_formula"], bar=1e-9)
            if n > 3:
                yield Number(
                    "(17)" if n == 4 else "(19)",
                    f"m of curve {n} at k = {k:.9g}",
                    value(k, f"butikov_{n}_refined"),
                    reference=row["m_formula2"],
                    bar=1e-9,
                )
    yield Number("(4)", "m of curve 2 at k = 0", value(0, "butikov_2"), "0.4542", known["butikov_k0_curve2_m_formula"],
                 1e-12)
    yield Number(
        "(4)",
        "m of curve 2 at k = 0, exact",
        value(0, "exact_2"),
        "0.4542",
        known["butikov_k0_curve2_m_exact"],
        1e-12,
        "Equation (4) keeps three harmonics.",
        "approximation",
    )


def turns(runs, known):
    """Where curve 3 turns back: the last k at which it exists, and the middle of its two branches there."""
    for name, low, high, printed in (("exact_3", 0.63042, 0.630421, True),
                                     ("butikov_3", 0.65 - 1e-9, 0.65 + 1e-9, False)):
        chart, _ = curves(runs, low, high, 10001, [name])
        last = np.flatnonzero(np.isfinite(chart[name]))[-1]
        exact = known[f"butikov_curve3_turning_point_{'exact' if printed else 'formula'}"]
        middle = (chart[name][last] + chart[f"{name}_upper"][last]) / 2
        remark = ("The printed number follows from the approximate equation (5).", "approximation") if printed else ()
        what = "exact" if printed else "by (5)"
        yield Number("Fig. 1", f"k where curve 3 turns back, {what}", chart["k"][last], "0.65", exact["k"], 1e-9,
                     *remark)
        yield Number("Fig. 1", f"m where curve 3 turns back, {what}", middle, "1.6", exact["m"], 1e-7, *remark)


def parametric_oscillation(runs, known):
    """Fig. 2: the nodding of period 2 at Omega = 3.2, m = 0.388; the paper does not say its Q."""
    for name, row in known["butikov_fig2_omega3.2_a0.388"].items():
        if not name.startswith("Q"):
            continue
        pendulum = {"quality_factor": float(name[1:]), "drive_frequency": 3.2, "drive_amplitude": 0.388}
        values, attributes = cycle(runs, pendulum, round(float(row["theta"]), 3), round(float(row["v"]), 3))
        if name == "Q20":
            yield Number("Fig. 2", "period of the oscillation, drive periods", attributes["period"], "2")
        yield Number(
            "Fig. 2", f"angle of the strobe point at Q = {name[1:]}, rad", values["strobe_theta"][0],
            reference=row["theta"], bar=1e-9
        )
        yield Number(
            "Fig. 2", f"velocity of the strobe point at Q = {name[1:]}", values["strobe_velocity"][0],
            reference=row["v"], bar=1e-9
        )
        yield Number(
            "Fig. 2",
            f"amplitude at Q = {name[1:]}, degrees",
            np.degrees(np.abs(values["maximum_angle"]).max()),
            reference=row["amp_deg"],
            bar=5e-4,
        )


def third_harmonics(runs, known):
    """Fig. 3 on curve 3; on curve 2 without gravity, and Fig. 4: flutter there."""
    row = known["butikov_fig3"]
    k = float(row["k_from_omega"])
    chart, _ = curves(runs, k, 2 * k, 2, ["exact_3", "butikov_3"])
    yield Number("Fig. 3", "m of curve 3 at omega = 1.529 omega0, exact", at(chart, k, "exact_3"),
                 reference=row["m_exact"], bar=1e-9)
    yield Number("Fig. 3", "m of curve 3 at omega = 1.529 omega0, by (5)", at(chart, k, "butikov_3"),
                 reference=row["m_formula"], bar=1e-9)
    values, _ = cycle(runs, {"k": k, "damping": 0, "m": float(row["m_exact"])}, 0.1, 0, model="mathieu", period=2)
    yield Number(
        "Fig. 3",
        "C3/C1 on curve 3",
        cosine(values, 3) / cosine(values, 1),
        "-0.112",
        row["C3/C1_exact"],
        1e-9,
        "At the stated k and m the paper's own formula gives -0.110.",
    )
    boundary = float(known["butikov_k0_curve2_m_exact"])
    values, _ = cycle(runs, {"k": 0, "damping": 0, "m": boundary}, 0, 0.1, model="mathieu", period=2)
    yield Number(
        "Fig. 4",
        "S3/S1 on curve 2 at k = 0",
        sine(values, 3) / sine(values, 1),
        "-0.1009",
        known["butikov_k0_S3_over_S1_exact"],
        1e-9,
        "The printed number follows from an equation that keeps three harmonics.",
        "approximation",
    )
    for name, row in known["butikov_fig4_k0"].items():
        damping, m = name.removeprefix("beta").split("_m")
        values, _ = cycle(runs, {"k": 0, "damping": float(damping), "m": float(m)}, float(row["theta"]),
                          float(row["v"]), period=2)
        lines, where = values["line_amplitude"], f"k = 0, beta = {damping}, m = {m}"
        yield Number("Fig. 4", f"amplitude of line 1/2 at {where}, rad", lines[1], reference=row["A1"], bar=1e-8)
        yield Number(
            "Fig. 4", f"amplitude of line 3/2 over that of line 1/2 at {where}", lines[3] / lines[1],
            reference=row["A3_over_A1"], bar=1e-8
        )
        yield Number(
            "Fig. 4", f"amplitude of line 5/2 over that of line 1/2 at {where}", lines[5] / lines[1],
            reference=row["A5_over_A1"], bar=1e-8
        )


def transition_orbits(runs, known):
    """Figs 5 and 6: the oscillations on curves 4 and 5, whose harmonics follow from the recurrence of the Mathieu
    functions."""
    for place, scene, part, lines in (("Fig. 5", "butikov-fig05", sine, (2, 3)),
                                      ("Fig. 6", "butikov-fig06", cosine, (2, 3))):
        values, attributes = runs(scene, "orbit")
        k, m = (0.9, 1.106725136346255) if place == "Fig. 5" else (1.1, 0.5212279114123391)
        orders = np.arange(1 if place == "Fig. 5" else 0, 40)
        matrix = np.diag(k - orders.astype(float) ** 2) - m / 2 * (np.eye(len(orders), k=1) + np.eye(len(orders), k=-1))
        if place == "Fig. 6":
            matrix[1, 0] *= 2  # the constant term stands once in cos(0)
        mode = np.linalg.svd(matrix)[2][-1]
        of = dict(zip(orders, mode, strict=True))
        yield Number(place, "period of the oscillation, drive periods", attributes["period"], reference=1)
        for line in lines:
            yield Number(
                place,
                f"amplitude of harmonic {line} over that of harmonic 1",
                part(values, line) / part(values, 1),
                reference=of[line] / of[1],
                bar=1e-8,
            )


def nodding(runs, known):
    """Figs 7 and 8: multiple nodding of every kind; the paper does not state k, m and Q of Fig. 7."""
    for row in known["multiple_nodding_cycles"].values():
        points = np.array(row["strobe_theta_v_at_t0"], dtype=float)
        pendulum = {"k": row["k"], "damping": float(row["beta"]), "m": row["m"]}
        values, attributes = cycle(runs, pendulum, *(points[0] + [1e-3, -1e-3]))
        where = (f"{row['n']}-nodding about {'down' if row['about'] == 'bottom' else 'inverted'}, k = {row['k']}, m = "
                 f"{row['m']}")
        exact = max((complex(text) for text in row["multipliers_of_P_n"]), key=lambda value: value.imag)
        ours = complex(attributes["multiplier_re"], attributes["multiplier_im"])
        strongest, amplitude = max(row["spectrum_amplitudes"].items(), key=lambda line: line[1])
        yield Number("Figs 7, 8", f"period of the {where}", attributes["period"], reference=row["n"])
        yield Number(
            "Figs 7, 8", f"velocity of the strobe point of the {where}", values["strobe_velocity"][0],
            reference=points[0, 1], bar=1e-9
        )
        yield Number("Figs 7, 8", f"real part of the multiplier of the {where}", ours.real, reference=exact.real,
                     bar=1e-7)
        yield Number(
            "Figs 7, 8",
            f"amplitude of line {strongest} of the {where}, rad",
            values["line_amplitude"][int(strongest.split("/")[0])],
            reference=amplitude,
            bar=1e-8,
        )


def subharmonics(runs, known):
    """Fig. 9: the curves of order n, exact and by (21) with its signs corrected."""
    value = undamped(runs, subharmonics=(2, 4, 6))
    chart, _ = curves(runs, -0.1, 0, 2, ["butikov_1"], (1000,))
    yield Number(
        "(21)",
        "m of the curve of order 1000 at k = -0.1 over that of (3), its limit",
        at(chart, -0.1, "butikov_subharmonic_1000") / at(chart, -0.1, "butikov_1"),
        reference=1,
        bar=1e-5,
    )
    for n in (2, 4, 6):
        for row in known[f"butikov_fig9_n{n}"]:
            k, printed = float(row["k"]), row["roots_as_printed"]
            yield Number(
                "Fig. 9", f"m of the curve of order {n} at k = {k:g}", value(k, f"subharmonic_{n}"),
                reference=row["m_exact"], bar=1e-9
            )
            ours = value(k, f"butikov_subharmonic_{n}")
            if printed:
                yield Number(
                    "(21)",
                    f"m of the curve of order {n} at k = {k:g}",
                    ours,
                    printed[0],
                    row["m_eq21"],
                    1e-9,
                    "The last terms of rows 3 to 5 are printed with a plus. Right is a minus, as in the paper's "
                    "equation (22).",
                )


def subharmonic_orbits(runs, known):
    """(22) and Fig. 10: orbits that close after six drive periods."""
    exact = known["butikov_eq22"]["exact"]
    m = undamped(runs, subharmonics=(2, 4, 6))(0, "subharmonic_6")
    yield Number("(22)", "m of the curve of order 6 at k = 0", m, "0.2256", exact["m_exact"], 1e-12)
    yield Number("Fig. 10a", "m of the curve of order 6 at k = 0", m, "0.226", exact["m_exact"], 1e-12)
    values, _ = runs("butikov-fig10a", "orbit")
    printed = {"A5": ("0.163",), "A7": ("-0.083",), "A11": ("-0.006", "The paper's own equation gives -0.0055."),
               "A13": ("0.002",)}
    for name, words in printed.items():
        yield Number(
            "(22)",
            f"{name}/A1 of the orbit of order 6 at k = 0",
            sine(values, int(name[1:])) / sine(values, 1),
            words[0],
            exact[name],
            1e-10,
            *words[1:],
        )
    for letter, leading, omega in (("b", 5, "1.155"), ("c", 7, "0.845")):
        row = known[f"butikov_fig10{letter}"]
        m, near = float(row["m_printed"]), float(row["k_exact_at_m"])
        axes = {"k": {"min": near - 2e-4, "max": near + 2e-4, "count": 401}, "m": {"min": m, "max": m, "count": 1}}
        grid, _ = runs({"stability": axes}, "stability")
        order = np.argsort(grid["angle"][0])
        k = np.interp(1 / 6, grid["angle"][0][order], grid["k"][order])
        yield Number(
            f"Fig. 10{letter}",
            f"omega/omega0 of an orbit that closes after 6 periods, m = {m:g}",
            1 / np.sqrt(k),
            omega,
            row["omega_exact_at_m"],
            1e-8,
        )
        pendulum = {"k": float(row["k"]), "damping": 0, "m": float(row["m_exact_at_k"])}
        values, attributes = cycle(runs, pendulum, 0, 0.1, model="mathieu", period=6)
        yield Number(
            f"Fig. 10{letter}",
            "frequency of the strongest line, in sixths of the drive frequency",
            attributes["dominant_line"],
            str(leading),
        )
        for line, relative in row["harmonics_rel_to_dominant"].items():
            j = int(line.split("/")[0])
            yield Number(
                f"Fig. 10{letter}",
                f"sine part of line {line} over that of line {leading}/6",
                sine(values, j) / sine(values, leading),
                reference=relative,
                bar=1e-8,
            )


PARTS = [zones, turns, parametric_oscillation, third_harmonics, transition_orbits, nodding, subharmonics,
         subharmonic_orbits]
