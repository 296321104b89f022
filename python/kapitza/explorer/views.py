"""Results of the program as the page draws them: labels, attractors with their colours, motions, overlays."""

import base64

import numpy as np

from kapitza import style
from kapitza.result import Result

OVERLAYS = ("saddles", "manifolds")  # groups of a result that are drawn over the basins


def view(path):
    """Labels of every cell and the legend of a result."""
    result = Result(path)
    basin, attractors = result.group("basin"), result.group("attractors")
    labels = basin["attractor"].values
    rows = [{"id": index, "name": str(attractors["name"].values[index]), "colour": colour,
             "share": float(np.mean(labels == index)), **_points(attractors, index)}
            for index, colour in enumerate(style.colours(attractors))]
    return {"labels": base64.b64encode(labels.astype("<i2").tobytes()).decode(), "attractors": rows,
            "height": labels.shape[0], "width": labels.shape[1], "unsettled": float(np.mean(labels < 0)),
            "unsettled_colour": style.UNSETTLED, "undecided": int(basin.attrs["undecided"]) if "undecided" in basin.attrs else None}


def _points(table, index):
    """The strobe points of one row."""
    theta, velocity = table["strobe_theta"].values[index], table["strobe_velocity"].values[index]
    known = np.isfinite(theta)
    return {"theta": theta[known].tolist(), "velocity": velocity[known].tolist()}


def motion(path):
    """One motion with its strobe points."""
    orbit = Result(path).group("orbit")
    names = ("time", "theta", "velocity", "pivot", "strobe_theta", "strobe_velocity")
    return {name: orbit[name].values.tolist() for name in names}


def overlays(result):
    """What the groups /saddles and /manifolds of a result bring: points, or lines as lists of (theta, velocity)."""
    found = {}
    for group in OVERLAYS:
        if result is None or group not in result.groups:
            continue
        table = result.group(group)
        if group == "saddles":
            points = [_points(table, index) for index in range(table["strobe_theta"].shape[0])]
            found[group] = {"points": [pair for row in points for pair in zip(row["theta"], row["velocity"], strict=True)]}
        else:
            found[group] = {"lines": _lines(table)}
    return found


def _lines(table):
    """Polylines: rows of a matrix, or runs of one (saddle, branch, kind) in a list of points; cut where the angle wraps."""
    theta, velocity = table["theta"].values, table["velocity"].values
    ends = np.zeros(theta.shape, dtype=bool)
    for name in ("saddle", "branch", "kind"):
        if name in table and table[name].shape == theta.shape:
            ends[1:] |= table[name].values[1:] != table[name].values[:-1]
    rows = theta.reshape(-1, theta.shape[-1]), velocity.reshape(-1, theta.shape[-1]), ends.reshape(-1, theta.shape[-1])
    lines = []
    for angles, speeds, cuts in zip(*rows, strict=True):
        known = np.isfinite(angles)
        angles, speeds, cuts = angles[known], speeds[known], cuts[known]
        breaks = np.flatnonzero(cuts[1:] | (np.abs(np.diff(angles)) > np.pi)) + 1
        for part in np.split(np.arange(len(angles)), breaks):
            if len(part) > 1:
                lines.append(np.column_stack([angles[part], speeds[part]]).tolist())
    return lines
