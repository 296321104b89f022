"""The numbers of Butikov (2018) on the tongues of parametric resonance with damping."""

import numpy as np

from .number import Number
from .runs import at, cosine, curves, sine


def damped_tongues(runs, known):
    """Section 6, Figs 11 and 12: the tongues of parametric resonance with damping."""
    names, lowest = ("damped_1", "damped_2", "butikov_damped_1", "butikov_damped_2"), {}
    for quality in (5, 10, 20, 100, 1000):
        chart, lowest[quality] = curves(runs, 0.1, 1.5, 15, names, quality_factor=quality)
        if f"butikov_sec6_Q{quality}" not in known:
            continue
        for tongue, tuned in ((1, "m_at_k0.25"), (2, "m_at_k1")):
            for kind, suffix in ((f"tongue{tongue}_exact", ""), (f"tongue{tongue}_eq{24 + tongue}", "_determinant")):
                row = known[f"butikov_sec6_Q{quality}"][kind]
                by = f", by the corrected ({24 + tongue})" if suffix else ""
                for what, key, name in (
                    ("lowest k", "k_min", "lowest_k"),
                    ("lowest m", "m_min", "lowest_m"),
                    ("m at exact tuning", tuned, "tuned_m"),
                ):
                    yield Number(
                        "Sec. 6",
                        f"{what} of tongue {tongue} at Q = {quality}{by}",
                        lowest[quality][f"tongue_{tongue}_{name}{suffix}"],
                        reference=row[key],
                        bar=1e-8,
                    )
    five, fine = lowest[5], lowest[1000]
    yield Number("Sec. 6", "lowest k of tongue 1 at Q = 5", five["tongue_1_lowest_k"], "0.244")
    yield Number("Sec. 6", "lowest m of tongue 1 at Q = 5", five["tongue_1_lowest_m"], "0.099")
    yield Number("Sec. 6", "m at exact tuning of tongue 1 at Q = 5", five["tongue_1_tuned_m"], "0.1002")
    remark = "The printed point is on the curve, but not its lowest. Rows 2 and 3 of (26) need 2(k - 1)."
    yield Number("Sec. 6", "lowest k of tongue 2 at Q = 5", five["tongue_2_lowest_k"], "1.106", remark=remark)
    yield Number("Sec. 6", "lowest m of tongue 2 at Q = 5", five["tongue_2_lowest_m"], "0.999", remark=remark)
    yield Number("Sec. 6", "lowest m of tongue 1 times Q, at Q = 1000", 1000 * fine["tongue_1_lowest_m"], "0.5")
    yield Number(
        "Sec. 6",
        "lowest m of tongue 2 times sqrt(Q), at Q = 1000",
        np.sqrt(1000) * fine["tongue_2_lowest_m"],
        "2.32",
        remark="The lowest m is 2/sqrt(Q). The printed 2.32 belongs to exact tuning, k = 1.",
    )
    yield Number("Sec. 6", "m at exact tuning of tongue 2 times sqrt(Q), at Q = 1000",
                 np.sqrt(1000) * fine["tongue_2_tuned_m"], "2.32")
    yield from _damped_curves(runs, known)


def _damped_curves(runs, known):
    for tongue in (1, 2):
        rows = next(rows for name, rows in known.items() if name.startswith(f"butikov_fig11_Q5_tongue{tongue}"))
        for k, exact, formula in (map(float, row) for row in rows):
            names = (f"damped_{tongue}", f"butikov_damped_{tongue}")
            chart, _ = curves(runs, k, k + 0.01, 2, names, quality_factor=5)
            yield Number(
                "Fig. 11", f"m of the edge of tongue {tongue} at Q = 5, k = {k:g}", at(chart, k, names[0]),
                reference=exact, bar=1e-9
            )
            yield Number(
                f"({24 + tongue})",
                f"m of the edge of tongue {tongue} at Q = 5, k = {k:g}, with the equation corrected",
                at(chart, k, names[1]),
                reference=formula,
                bar=1e-9,
            )
    values, _ = runs("butikov-fig12", "orbit")
    scale = values["line_amplitude"][1]
    for name, relative in next(row for key, row in known.items() if key.startswith("butikov_fig12")).items():
        part = cosine if name[0] == "C" else sine
        yield Number("Fig. 12", f"{name} over the amplitude of line 1", part(values, int(name[1])) / scale,
                     reference=relative, bar=1e-7)


PARTS = [damped_tongues]
