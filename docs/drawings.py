"""The drawings of the explanation pages, computed from the equation of motion: .venv/bin/python docs/drawings.py

Each function draws one figure into docs/figures/drawing-NAME.svg. The motion is integrated here by a plain Runge-Kutta
method of fourth order, because a drawing needs three digits. Letters, colours and widths are those of all figures
(kapitza.style); letters are outlines, so that they look the same everywhere.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import numpy as np  # noqa: E402
from matplotlib import pyplot  # noqa: E402
from matplotlib.patches import Arc, Circle, FancyArrowPatch, Polygon, Rectangle  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
from kapitza import style  # noqa: E402

FOLDER = Path(__file__).resolve().parent / "figures"
COLUMN, PAGE = 86 / 25.4, 178 / 25.4  # inches: one and two columns of a journal
K, BETA, M = 1 / 121, 1 / 55, 0.3  # Blackburn's Fig. 12
BLUE, RED, GREY, AMBER = (style.KINDS["rotation +"], style.KINDS["rotation -"], style.FAINT, style.KINDS["inverted"])
ANGLE, VELOCITY = "angle from down (deg)", "velocity (rad per drive radian)"


def force(theta, velocity, time):
    """The acceleration, per drive radian squared."""
    return -BETA * velocity - (K - M * np.cos(time)) * np.sin(theta)


def period(theta, velocity, steps=200):
    """The states after one drive period, of arrays of states."""
    h = 2 * np.pi / steps
    for i in range(steps):
        t = i * h
        a1 = force(theta, velocity, t)
        a2 = force(theta + h / 2 * velocity, velocity + h / 2 * a1, t + h / 2)
        a3 = force(theta + h / 2 * (velocity + h / 2 * a1), velocity + h / 2 * a2, t + h / 2)
        a4 = force(theta + h * (velocity + h / 2 * a2), velocity + h * a3, t + h)
        theta = theta + h * velocity + h * h / 6 * (a1 + a2 + a3)
        velocity = velocity + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return theta, velocity


def circle(theta, velocity, radius, n=200):
    angle = np.linspace(0, 2 * np.pi, n)
    return theta + radius * np.cos(angle), velocity + radius * np.sin(angle)


def save(figure, name):
    path = FOLDER / f"drawing-{name}.svg"
    figure.savefig(path, metadata={"Date": None})
    path.write_text("\n".join(line.rstrip() for line in path.read_text().splitlines()) + "\n")
    pyplot.close(figure)


def arrow(axes, start, end, both=False, colour="black"):
    style = "<|-|>" if both else "-|>"
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle=style, mutation_scale=8, color=colour, shrinkA=0, shrinkB=0))


def pendulum():
    """The pendulum, its angle from the down position, and the pivot that is shaken up and down."""
    figure, axes = pyplot.subplots(figsize=(COLUMN, 0.72 * COLUMN), layout="constrained")
    angle, length = np.radians(40), 1.0
    end = (length * np.sin(angle), -length * np.cos(angle))
    axes.add_patch(Rectangle((-0.16, -0.06), 0.32, 0.12, color="#cbd5e0"))
    axes.plot([0, 0], [0, -1.15], "--", color=GREY, lw=1)
    axes.plot([0, end[0]], [0, end[1]], color="black", lw=3, solid_capstyle="round")
    axes.add_patch(Circle(end, 0.07, color=AMBER, ec="black", zorder=3))
    axes.add_patch(Circle((0, 0), 0.03, color="black", zorder=3))
    axes.add_patch(Arc((0, 0), 0.8, 0.8, theta1=-90, theta2=-50))
    axes.text(0.14, -0.52, r"$\theta$", fontsize="x-large")
    axes.text(end[0] / 2 + 0.07, end[1] / 2 + 0.04, r"length $r$")
    axes.text(end[0] + 0.12, end[1] - 0.03, "mass $M$")
    arrow(axes, (-0.42, -0.22), (-0.42, 0.22), both=True, colour=RED)
    axes.text(-0.5, 0, "pivot at\n$A\\,\\cos\\,\\omega t$", color=RED, ha="right", va="center")
    arrow(axes, (0.95, 0.25), (0.95, -0.15))
    axes.text(1.0, 0.05, "gravity $g$")
    axes.text(0, -1.25, "down: $\\theta = 0$", ha="center")
    axes.text(0, 0.3, "inverted: $\\theta = \\pi$ (up here)", ha="center", color=GREY)
    axes.set(xlim=(-1.1, 1.5), ylim=(-1.4, 0.45), aspect="equal")
    axes.axis("off")
    save(figure, "pendulum")


def potential():
    """The effective potential of the slow motion: a second well opens at the top when m exceeds sqrt(2 k)."""
    figure, axes = pyplot.subplots(figsize=(PAGE, 0.45 * PAGE), layout="constrained")
    theta = np.linspace(-90, 270, 600)
    for m, colour in ((0.08, GREY), (np.sqrt(2 * K), BLUE), (0.3, RED)):
        energy = -K * np.cos(np.radians(theta)) + m * m / 4 * np.sin(np.radians(theta)) ** 2
        axes.plot(theta, 1000 * energy, color=colour, label=f"$m$ = {m:.3g}")
    axes.annotate("Kapitza's well", (180, 1000 * K), (180, 21), ha="center", arrowprops={"arrowstyle": "->"})
    axes.annotate("the well of gravity", (0, -1000 * K), (20, -14), arrowprops={"arrowstyle": "->"})
    axes.set(xlabel=ANGLE, ylabel="effective potential (0.001)", xticks=range(-90, 271, 90), ylim=(-17, 27))
    axes.legend(loc="lower right")
    save(figure, "potential")


def splitting():
    """One drive period as drifts (straight lines) and kicks (steps of the velocity), beside the true motion."""
    figure, (above, below) = pyplot.subplots(2, 1, figsize=(PAGE, 0.6 * PAGE), sharex=True, layout="constrained")
    n, theta, velocity = 12, 2.2, 0.35
    h = 2 * np.pi / n
    times, angles, speeds = [0.0], [theta], [velocity]
    for i in range(n):
        theta += h / 2 * velocity
        times += [(i + 0.5) * h] * 2
        angles += [theta] * 2
        kicked = velocity + h * force(theta, velocity, (i + 0.5) * h)
        speeds += [velocity, kicked]
        velocity = kicked
        theta += h / 2 * velocity
        times.append((i + 1) * h)
        angles.append(theta)
        speeds.append(velocity)
    fine, states = np.linspace(0, 2 * np.pi, 241), [(2.2, 0.35)]
    for t, step in zip(fine[:-1], np.diff(fine), strict=True):
        a, v = states[-1]
        middle = (a + step / 2 * v, v + step / 2 * force(a, v, t))
        states.append((a + step * middle[1], v + step * force(*middle, t + step / 2)))
    truth = np.array(states)
    for axes, values, exact, name in ((above, angles, truth[:, 0], "angle (rad)"),
                                      (below, speeds, truth[:, 1], VELOCITY)):
        axes.plot(fine, exact, color=GREY, lw=4, alpha=0.5, label="true motion")
        axes.plot(times, values, color=BLUE, lw=1, label=f"{n} drifts and kicks")
        axes.set_ylabel(name)
    above.legend()
    below.set(xlabel="time (drive radians)", xticks=np.arange(0, 7, 1))
    save(figure, "splitting")


def eigenbasis():
    """Columns [2, 2] that span the norm in which the map contracts about the inverted state."""
    e = 1e-6
    columns = [np.array(period(np.pi + a, b)) - [np.pi, 0] for a, b in ((e, 0.0), (0.0, e))]
    vector = np.linalg.eig(np.column_stack(columns) / e)[1][:, 0]
    return np.column_stack([vector.real, vector.imag])


def joined(grid, radius, basis):
    """The round [rows, columns] in which each cell of a grid joins the region that grows from an ellipse; 0 = it does
    not."""
    theta, velocity = grid
    rounds, corners = np.zeros((len(velocity) - 1, len(theta) - 1), int), np.meshgrid(theta, velocity)
    images = [period(*corners)]
    for _ in range(3):
        images.append(period(*images[-1]))

    def inside(a, v):
        own = np.linalg.solve(basis, np.stack([a.ravel() - np.pi, v.ravel()])).reshape(2, *a.shape)
        row, column = np.searchsorted(velocity, v) - 1, np.searchsorted(theta, a) - 1
        known = (row >= 0) & (row < rounds.shape[0]) & (column >= 0) & (column < rounds.shape[1])
        known[known] = rounds[row[known], column[known]] > 0
        return known | (np.hypot(*own) < radius)

    for number in range(1, 60):
        new = np.zeros(rounds.shape, bool)
        for image in images:
            ends = inside(*image)
            new |= ends[:-1, :-1] & ends[1:, :-1] & ends[:-1, 1:] & ends[1:, 1:]
        new &= rounds == 0
        if not new.any():
            break
        rounds[new] = number
    return rounds


def trapping():
    """Left an ellipse that each period carries into itself; right the cells of a grid that join it, round by round."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(PAGE, 0.47 * PAGE), layout="constrained")
    basis, turn = eigenbasis(), np.array(circle(0, 0, 1))
    radius = 0.12 / np.hypot(*basis[0])
    theta, velocity = np.array([[np.pi], [0]]) + radius * basis @ turn
    left.fill(np.degrees(theta), velocity, color=AMBER, alpha=0.25)
    left.plot(np.degrees(theta), velocity, color=AMBER, label="the ellipse")
    for n in range(1, 13):
        theta, velocity = period(theta, velocity)
        if n in (1, 4, 12):
            left.plot(np.degrees(theta), velocity, color=BLUE, alpha=0.4 + n / 20,
                      label=f"after {n} period{'s' * (n > 1)}")
    left.plot([180], [0], "k.", label="inverted state")
    left.set(xlabel=ANGLE, ylabel=VELOCITY)
    grid = np.radians(np.linspace(60, 300, 97)), np.linspace(-0.2, 0.2, 81)
    rounds = joined(grid, radius, basis)
    found = np.ma.masked_equal(rounds, 0)
    colours = right.pcolormesh(np.degrees(grid[0]), grid[1], found, cmap="viridis_r", rasterized=True)
    right.fill(*(np.array([[180], [0]]) + np.array([[180 / np.pi], [1]]) * (radius * basis @ turn)), color=AMBER)
    right.set(xlabel=ANGLE)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower left", ncols=5)
    figure.colorbar(colours, label="round in which a cell joins")
    save(figure, "trapping")


def ellipse():
    """The error of an orbit, drawn 10^4 times too large: stretched, turned and shrunk from period to period."""
    figure, axes = pyplot.subplots(figsize=(PAGE, 0.55 * PAGE), layout="constrained")
    orbit, scale = np.array([1.35, 0.2]), 1e-4
    rim = np.array(circle(0, 0, 1)) * scale
    for n in range(4):
        shape = np.array(period(orbit[0] + rim[0], orbit[1] + rim[1])) if n else None
        if n:
            centre = np.array(period(*orbit))
            rim = shape - centre[:, None]
            orbit = centre
        wrapped = (orbit[0] + np.pi) % (2 * np.pi) - np.pi
        axes.fill(np.degrees(wrapped + rim[0] * 1200), orbit[1] + rim[1] * 1200, color=BLUE, alpha=0.3)
        axes.annotate(f"{n}", (np.degrees(wrapped), orbit[1]), ha="center", va="center")
    axes.set(xlabel=ANGLE, ylabel=VELOCITY)
    axes.set_title("error ellipses after 0 to 3 periods (drawn too large)")
    save(figure, "ellipse")


def handover():
    """A window of 11 x 11 cells and its image: cells of a tiny window share their first periods, and a cubic polynomial
    carries them."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(PAGE, 0.45 * PAGE), layout="constrained")
    side = np.linspace(-1, 1, 11)
    x, y = np.meshgrid(side, side)
    theta, velocity = 2.0 + 0.05 * x, 0.6 + 0.05 * y
    for axes, title in ((left, "the window"), (right, "its image after 2 periods")):
        for i in range(11):
            axes.plot(np.degrees(theta[i]), velocity[i], color=BLUE, lw=0.8)
            axes.plot(np.degrees(theta[:, i]), velocity[:, i], color=GREY, lw=0.8)
        axes.plot(np.degrees(theta[5, 5]), velocity[5, 5], "o", color=RED)
        axes.set_title(title)
        axes.set_xlabel(ANGLE)
        if axes is left:
            for _ in range(2):
                theta, velocity = period(theta, velocity)
            theta = theta - 2 * np.pi * np.round(theta[5, 5] / (2 * np.pi))
    left.set_ylabel(VELOCITY)
    save(figure, "handover")


def proof():
    """An enclosure that follows one start until it lies inside a region that is proved to be carried into itself."""
    figure, axes = pyplot.subplots(figsize=(PAGE, 0.55 * PAGE), layout="constrained")
    corners = np.array([[2.35], [0.05]]) + np.array([[-1, 1, 1, -1], [-1, -1, 1, 1]]) * 0.012
    basis = eigenbasis() * 0.3 / np.hypot(*eigenbasis()[0])
    rim = basis @ circle(0, 0, 1)
    axes.fill(np.degrees(np.pi + rim[0]), rim[1], color=AMBER, alpha=0.3, label="proved trapping region")
    for n in range(40):
        inside = np.all(np.hypot(*np.linalg.solve(basis, corners - [[np.pi], [0]])) < 1)
        axes.add_patch(Polygon(np.column_stack([np.degrees(corners[0]), corners[1]]), color=RED if inside else BLUE,
                               alpha=0.6,
                               label="enclosure that lies inside" if inside else ""
                               if n else "enclosure after so many periods"))
        axes.annotate(str(n), (np.degrees(corners[0].mean()), corners[1].mean()), textcoords="offset points",
                      xytext=(6, 6))
        if inside:
            break
        corners = np.array(period(*corners))
        middle = corners.mean(axis=1, keepdims=True)
        corners = middle + (corners - middle) * 1.03  # an enclosure is wider than what it encloses
    axes.set(xlabel=ANGLE, ylabel=VELOCITY)
    axes.legend(loc="upper right")
    save(figure, "proof")


if __name__ == "__main__":
    matplotlib.rcParams.update(style.settings(8) | {"svg.fonttype": "path", "axes.titlesize": "medium",
                                                    "axes.titleweight": "normal"})
    for draw in (pendulum, potential, splitting, trapping, ellipse, handover, proof):
        draw()
