"""Flutter along a sweep, from its branches: the amplitude, where it begins, loses its symmetry and doubles its
period."""

import numpy as np
import xarray

from kapitza.layout import VARIABLES

KINDS = VARIABLES["sweep", "branch_start_kind"]["flags"]
DOUBLING, BREAKING = KINDS.index("period_doubling"), KINDS.index("symmetry_breaking")
INVERTED = VARIABLES["sweep", "branch_centre"]["flags"].index("inverted")
SAME = 1e-9  # relative to the value: both sides of an event are located separately


def flutter(sweep: xarray.Dataset) -> xarray.Dataset:
    """As Result.flutter, from the group `sweep`."""
    if "branch_stable" not in sweep:
        raise KeyError("the sweep has no branches; add attractors to sweep.measure")
    period, winding, centre, stable, symmetric = (sweep[f"branch_{name}"].values
                                                  for name in ("period", "winding", "centre", "stable", "symmetric"))
    rows = np.flatnonzero((period == 2) & (winding == 0) & (centre == INVERTED) & (stable == 1))
    whole, broken = rows[symmetric[rows] == 1], rows[symmetric[rows] == 0]
    ends = {int(row): _ends(sweep, int(row)) for row in rows}
    born = [int(row) for row in whole if DOUBLING in ends[row]] or [int(row) for row in whole][:1]
    onset, asymmetry, end, amplitude = np.nan, np.nan, np.nan, np.full(sweep.sizes["value"], np.nan)
    if born:
        onset, asymmetry = (ends[born[0]].get(kind, np.nan) for kind in (DOUBLING, BREAKING))
        amplitude = sweep["branch_amplitude"].values[:, born[0]]
        after = [ends[row] for row in broken if abs(ends[row].get(BREAKING, np.nan) - asymmetry) <= SAME
                 * abs(asymmetry)]
        end = next((found[DOUBLING] for found in after if DOUBLING in found), np.nan)
    found = xarray.Dataset({"amplitude": ("value", amplitude, sweep["branch_amplitude"].attrs)},
                           {"value": sweep["value"]})
    return found.assign_attrs(sweep.attrs, onset=onset, asymmetry=asymmetry, end=end,
                              **_law(sweep["value"].values - onset, amplitude))


def _ends(sweep: xarray.Dataset, row: int) -> dict[int, float]:
    """Kind of an end of a branch -> the value there."""
    return {int(sweep[f"branch_{end}_kind"].values[row]): float(sweep[f"branch_{end}"].values[row])
            for end in ("start", "end")}


def _law(distance: np.ndarray, amplitude: np.ndarray) -> dict[str, float]:
    """How the amplitude grows with the distance from the onset: amplitude^2 = slope * distance over all values, and the
    exponent at 0."""
    there = np.isfinite(amplitude) & np.isfinite(distance) & (distance != 0)
    x, square = distance[there], amplitude[there] ** 2
    slope, error = np.nan, np.nan
    if len(x) > 2:
        (slope, _), covariance = np.polyfit(x, square, 1, cov=True)
        error = np.sqrt(covariance[0, 0])
    near, all_of_them = (_exponent(x, square, share * np.abs(x).max(initial=0)) for share in (0.5, 1))
    return {"slope": float(slope), "slope_stderr": float(error), "exponent": near,
            "exponent_error": abs(near - all_of_them)}


def _exponent(distance: np.ndarray, square: np.ndarray, farthest: float) -> float:
    """The exponent at distance 0: the slopes of ln(amplitude) over ln(distance) between neighbours, as a line over the
    distance (its logarithmic mean), carried to 0. Neighbours farther than `farthest` do not count."""
    ratio = np.log(distance[1:] / distance[:-1])
    middle, slope = np.diff(distance) / ratio, np.diff(np.log(square)) / (2 * ratio)
    near = np.abs(middle) <= farthest
    return float(np.polyfit(middle[near], slope[near], 1)[1]) if near.sum() > 1 else np.nan
