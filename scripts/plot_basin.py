#!/usr/bin/env python3
"""Draws the basins of attraction in a result file of kapitza.

    .venv/bin/python scripts/plot_basin.py blackburn-fig12.h5                              every basin in its colour
    .venv/bin/python scripts/plot_basin.py blackburn-fig12.h5 --attractor inverted         one basin, black on white, as the papers print it
    .venv/bin/python scripts/plot_basin.py blackburn-fig12.h5 --quantity settling_time     how long every start takes to settle
"""

import kapitza_style as style
import matplotlib.pyplot as plt
import numpy as np
from kapitza_file import BadFile, Result, run
from kapitza_plot import argument_parser, parsed, title_text
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

EVIDENCE_COLOURS = ["#ffffff", "#35618f", "#a9c4df", "#e58a2b", "#8c1d18"]
PLANE_WIDTH = 5.6  # inches, the same in every figure


def parse_arguments():
    parser = argument_parser(__doc__, "a basin")
    parser.add_argument("--quantity", choices=["attractor", "settling_time", "evidence"], default="attractor")
    parser.add_argument("--attractor", metavar="ID|NAME", help="black and white: the basin of one attractor, or of all of one name")
    parser.add_argument("--centre", choices=["down", "inverted"], default="down",
                        help="state in the middle of a whole-circle picture (default: down)")
    parser.add_argument("--shade", action="store_true", help="darken cells that take long to settle")
    parser.add_argument("--no-legend", action="store_true")
    parser.add_argument("--no-dots", action="store_true", help="leave out the strobe points of the attractors")
    arguments = parsed(parser)
    if arguments.attractor and (arguments.quantity != "attractor" or arguments.shade):
        parser.error("--attractor goes with neither --quantity nor --shade")
    return arguments


class Plane:
    """The window of starts as drawn: cells in the order of the picture, and its edges."""

    def __init__(self, basin, centre):
        theta, velocity = basin["theta"].values, basin["velocity"].values
        width = _step(theta) * len(theta)
        self.whole_circle = abs(width - 2 * np.pi) < 1e-9
        turn = len(theta) // 2 if self.whole_circle and centre == "inverted" else 0
        self.order = np.roll(np.arange(len(theta)), -turn)
        left = theta[0] - _step(theta) / 2 + turn * _step(theta)
        self.theta_range = (left, left + width)
        half = _step(velocity) / 2
        self.velocity_range = (velocity[0] - half, velocity[-1] + half)

    def cells(self, variable):
        """A (velocity, theta) variable in the order of the picture."""
        return variable.values[:, self.order]

    def inside(self, theta, velocity):
        """Every image of the points, theta + 2 pi n, that lies in the window (edges included)."""
        theta, velocity = np.ravel(theta), np.ravel(velocity)
        known = np.isfinite(theta)
        theta, velocity = theta[known], velocity[known]
        (left, right), (low, high) = self.theta_range, self.velocity_range
        turns = np.arange(np.floor((left - np.pi) / (2 * np.pi)), np.ceil((right + np.pi) / (2 * np.pi)) + 1)
        images = theta[:, None] + 2 * np.pi * turns
        heights = np.broadcast_to(velocity[:, None], images.shape)
        edge = 1e-9
        keep = (images >= left - edge) & (images <= right + edge) & (heights >= low) & (heights <= high)
        return images[keep], heights[keep]

    def label_at(self, basin, theta, velocity):
        """The labels of the cells in which points of the window lie."""
        (left, right), (low, high) = self.theta_range, self.velocity_range
        labels = self.cells(basin["attractor"])
        rows, columns = (np.clip(np.floor((place - start) / (end - start) * count).astype(int), 0, count - 1) for place, start, end, count
                         in ((velocity, low, high, labels.shape[0]), (theta, left, right, labels.shape[1])))
        return labels[rows, columns]

    @property
    def extent(self):
        return (*self.theta_range, *self.velocity_range)

    @property
    def shape(self):
        """Height over width of the picture: a radian is as long on both axes where that gives a readable shape."""
        width, height = np.ptp(self.theta_range), np.ptp(self.velocity_range)
        return height / width if 1 / 3 <= height / width <= 1.5 else 0.7


def _step(centres):
    """Width of a cell; a single cell is drawn one unit wide."""
    return (centres[-1] - centres[0]) / (len(centres) - 1) if len(centres) > 1 else 1.0


def chosen_ids(result, attractors, wanted):
    """The ids that ID or NAME stands for."""
    names = [str(name) for name in attractors["name"].values]
    ids = [index for index, name in enumerate(names) if name == wanted]
    if not ids and wanted.lstrip("-").isdigit() and 0 <= int(wanted) < len(names):
        ids = [int(wanted)]
    if not ids:
        raise BadFile(f"{result.path}: has no attractor {wanted}; it has 0..{len(names) - 1}: {', '.join(dict.fromkeys(names))}")
    return ids


def draw_basins(axes, plane, basin, attractors, shaded, dots):
    """Every basin in its colour."""
    colours = style.colours(attractors)
    table = np.array([to_rgb(colour) for colour in [*colours, style.UNSETTLED]])
    image = table[plane.cells(basin["attractor"])]  # -1 takes the last row
    if shaded:
        image = image * (1 - 0.55 * _slowness(plane.cells(basin["settling_time"])))[..., None]
    axes.imshow(image, extent=plane.extent, origin="lower", aspect="auto")
    if dots:
        mark_strobe_points(axes, plane, basin, attractors, {index: style.shade(colour, -0.45) for index, colour in enumerate(colours)},
                           "white")
    return basin_entries(attractors, colours, basin["attractor"].values)


def _slowness(periods):
    """0 for the cells that settle first, 1 for the slowest percent, by the logarithm of the time."""
    time = np.log1p(periods.astype(float))
    return np.clip(time / max(np.percentile(time, 99), 1e-300), 0, 1)


def mark_strobe_points(axes, plane, basin, attractors, faces, edge):
    """Every strobe point of the attractors in `faces` (id -> colour), at every place of the window where it shows; many points are
    drawn smaller, and what would hide a small basin is smaller still or left out."""
    room = Room(plane, basin)
    for index, face in faces.items():
        size, line = (4.6, 0.9) if attractors["period"].values[index] <= 2 else (3.2, 0.6)
        points = plane.inside(attractors["strobe_theta"].values[index], attractors["strobe_velocity"].values[index])
        scale = room.taken_by(*points, size + line)
        if scale:
            axes.plot(*points, "o", markersize=scale * size, markerfacecolor=face, markeredgecolor=edge, markeredgewidth=scale * line,
                      clip_on=False, zorder=3)


class Room:
    """How much of every basin is still to be seen under the dots."""

    HIDDEN = 0.2  # share of a basin's picture that dots may cover

    def __init__(self, plane, basin):
        self.plane, self.basin = plane, basin
        labels, counts = np.unique(basin["attractor"].values, return_counts=True)
        page = (72 * PLANE_WIDTH) ** 2 * plane.shape  # square points
        self.left = dict(zip(labels, self.HIDDEN * page * counts / counts.sum(), strict=True))
        across = np.linspace(-1, 1, 15)
        disk = np.array(np.meshgrid(across, across)).reshape(2, -1)
        self.disk = disk[:, np.hypot(*disk) <= 1]

    def taken_by(self, theta, velocity, diameter):
        """The scale (1, 1/2, 1/4 or 0) at which the dots of an attractor leave every basin under them visible; takes their place."""
        for scale in (1, 0.5, 0.25):
            covered = self._covered(theta, velocity, scale * diameter)
            if all(area <= self.left[label] for label, area in covered.items()):
                self.left.update({label: self.left[label] - area for label, area in covered.items()})
                return scale
        return 0

    def _covered(self, theta, velocity, diameter):
        """Label -> square points under the dots."""
        half = diameter / 2 / (72 * PLANE_WIDTH)
        x = theta[:, None] + half * np.ptp(self.plane.theta_range) * self.disk[0]
        y = velocity[:, None] + half / self.plane.shape * np.ptp(self.plane.velocity_range) * self.disk[1]
        labels, counts = np.unique(self.plane.label_at(self.basin, x, y), return_counts=True)
        return dict(zip(labels, np.pi / 4 * diameter**2 * counts / self.disk.shape[1], strict=True))


def basin_entries(attractors, colours, labels):
    """Legend entries (colour, name, share) of the basins that have cells here, largest first; the unsettled cells last."""
    entries = [(colour, name, np.mean(labels == index))
               for index, (name, colour) in enumerate(zip(style.names_with_ids(attractors["name"].values), colours, strict=True))]
    entries.sort(key=lambda entry: -entry[2])
    entries.append((style.UNSETTLED, "not settled", np.mean(labels < 0)))
    return [entry for entry in entries if entry[2] > 0]


def draw_one(axes, plane, basin, attractors, ids, dots):
    """One basin black on white, its strobe points as open rings."""
    mine = np.isin(basin["attractor"].values, ids)
    axes.imshow(np.where(mine[:, plane.order, None], 0.0, 1.0) * np.ones(3), extent=plane.extent, origin="lower", aspect="auto")
    if dots:
        mark_strobe_points(axes, plane, basin, attractors, dict.fromkeys(ids, "white"), "black")
    return [("black", attractors["name"].values[ids[0]], np.mean(mine))]


def draw_settling_time(axes, plane, basin):
    """Drive periods until capture, on a logarithmic scale; unsettled cells stay white."""
    time = np.ma.masked_where(plane.cells(basin["attractor"]) < 0, plane.cells(basin["settling_time"]).astype(float) + 1)
    colours = plt.get_cmap("cividis").with_extremes(bad="white")
    image = axes.imshow(time, extent=plane.extent, origin="lower", aspect="auto", cmap=colours,
                        norm=LogNorm(1, max(2.0, time.max() if time.count() else 2.0)))
    bar = axes.figure.colorbar(image, cax=axes.inset_axes([1.02, 0, 0.025, 1]))
    bar.set_label("drive periods until trapped, plus one")
    bar.outline.set_linewidth(0.7)
    return []


def draw_evidence(axes, plane, basin):
    """On what ground every cell got its label."""
    evidence = plane.cells(basin["evidence"])
    table = np.array([to_rgb(colour) for colour in EVIDENCE_COLOURS])
    axes.imshow(table[evidence], extent=plane.extent, origin="lower", aspect="auto")
    words = str(basin["evidence"].attrs["flag_meanings"]).split()
    return [(colour, word.replace("_", " "), np.mean(evidence == code))
            for code, (colour, word) in enumerate(zip(EVIDENCE_COLOURS, words, strict=False)) if np.any(evidence == code)]


def write_legend(axes, entries):
    """Colour and name in one column, the share in the next, digits under digits."""
    shares = [style.share_text(share) for _, _, share in entries]
    digits = max(share.find(".") if "." in share else share.find(" ") for share in shares)
    figure_space = "\u2007"
    patches = [Patch(facecolor=colour, edgecolor=style.INK, linewidth=0.5, label=style.name_text(name))
               for colour, name, _ in entries]
    columns = [Line2D([], [], linestyle="", label=figure_space * (digits - max(share.find("."), 1)) + share) for share in shares]
    axes.legend(handles=[*patches, *columns], ncols=2, loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0,
                handlelength=1.1, handleheight=1.1, columnspacing=-0.2, fontsize=8)


def label_axes(axes, plane):
    """Angle in units of pi, velocity in its own unit."""
    axes.set_xlim(plane.theta_range)
    axes.set_ylim(plane.velocity_range)
    width = np.ptp(plane.theta_range) / np.pi
    step = min((1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2), key=lambda step: abs(width / step - 5))
    first = np.ceil(plane.theta_range[0] / np.pi / step - 1e-9)
    ticks = np.arange(first, plane.theta_range[1] / np.pi / step + 1e-9) * step
    if width > 1 / 16:
        axes.set_xticks(ticks * np.pi, [style.pi_text(tick) for tick in ticks])
    axes.set_xlabel("angle θ from down (rad)")
    axes.set_ylabel("velocity dθ/d(ωt) (rad per drive radian)")
    axes.tick_params(direction="out", length=3)


def write_titles(axes, result, basin):
    """The scene's title, the parameters, and how the labels were found."""
    axes.set_title(title_text(result), pad=22, parse_math=False)
    axes.text(0, 1.02, style.parameters_text(result.pendulum), transform=axes.transAxes, va="bottom", ha="left",
              fontsize=9, color=style.FAINT)
    rows, columns = basin["attractor"].shape
    axes.text(1, 1.02, f"{columns} × {rows} starts, {_method(basin)}", transform=axes.transAxes, va="bottom", ha="right",
              fontsize=8, color=style.FAINT)


def _method(basin):
    words = {"icm": "interpolated cell mapping", "direct": "integrated directly", "hybrid": "mapped and re-integrated"}
    method = str(basin.attrs.get("method", ""))
    return words.get(method, method)


def draw(arguments):
    result = Result(arguments.file)
    basin, attractors = result.group("basin"), result.group("attractors")
    labels = basin["attractor"].values
    if labels.size == 0 or labels.dtype.kind not in "iu" or not -1 <= labels.min() <= labels.max() < attractors.sizes["attractor"]:
        raise BadFile(f"{result.path}: has cells of attractors that it does not list")
    plane = Plane(basin, arguments.centre)
    figure = plt.figure(figsize=(PLANE_WIDTH, PLANE_WIDTH * plane.shape))
    axes = figure.add_axes((0, 0, 1, 1))  # the page grows around the plane when it is saved
    if arguments.attractor:
        ids = chosen_ids(result, attractors, arguments.attractor)
        entries = draw_one(axes, plane, basin, attractors, ids, not arguments.no_dots)
    elif arguments.quantity == "attractor":
        entries = draw_basins(axes, plane, basin, attractors, arguments.shade, not arguments.no_dots)
    elif arguments.quantity == "evidence":
        entries = draw_evidence(axes, plane, basin)
    else:
        entries = draw_settling_time(axes, plane, basin)
    label_axes(axes, plane)
    write_titles(axes, result, basin)
    if entries and not arguments.no_legend:
        write_legend(axes, entries)
    style.save(figure, arguments.output, arguments.dpi)


def main():
    arguments = parse_arguments()
    style.use()
    draw(arguments)


if __name__ == "__main__":
    run(main)
