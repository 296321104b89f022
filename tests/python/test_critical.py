"""Near a bifurcation and on a basin's boundary: the right label or none, never a wrong one (docs/validation/extremes.md)."""

import math

import h5py
import numpy as np
import pytest
from conftest import ROOT, with_extensive

SMALL = ROOT / "scenes" / "small.yaml"


class Basin:
    """What a run of the small scene found. An attractor is what it is called and where it is, whatever its id."""

    def __init__(self, path):
        with h5py.File(path) as file:
            group = file["attractors"]
            self.names = list(group["name"].asstr()[:])
            self.symmetric, self.mirror, self.amplitude = (group[key][:] for key in ("symmetric", "mirror", "amplitude"))
            self.strobe = np.stack([group["strobe_theta"][:, 0], group["strobe_velocity"][:, 0]], axis=1)
            self.labels, self.periods = file["basin/attractor"][:], file["basin/settling_time"][:]
            self.theta, self.velocity = file["basin/theta"][:], file["basin/velocity"][:]

    def ends(self):
        return {self.names[label] if label >= 0 else None for label in np.unique(self.labels)}


@pytest.fixture(scope="session")
def basin(kapitza, tmp_path_factory):
    """basin(theta=(min, max, count), velocity=(min, max, count), settings...) -> Basin, direct unless a setting says otherwise."""
    path = tmp_path_factory.mktemp("critical") / "x.h5"

    def call(theta, velocity, *settings):
        axes = [f"basin.{name}={{min: {float(low)!r}, max: {float(high)!r}, count: {count}}}"
                for name, (low, high, count) in (("theta", theta), ("velocity", velocity))]
        common = ["basin.method=direct", "basin.attractors.starts=64", "basin.icm={theta: 100, velocity: 100}"]
        words = [word for setting in [*axes, *common, *settings] for word in ("--set", setting)]
        kapitza("run", SMALL, "-o", path, "--force", *words, folder=path.parent)
        return Basin(path)

    return call


def around(centre, half_width, count):
    return centre - half_width, centre + half_width, count


# Bifurcations of Q = 5, Omega = 11: the epsilon where they happen, where in the plane, and what is not there below, and above.
# (name, whether it is its own mirror image)
CRITICAL = {
    "inverted flips": (0.46819030239029, (math.pi, 0), (0.1, 0.01), {("flutter", 1), ("flutter", 0)}, {("inverted", 1)}),
    "down flips": (0.44045457534337, (0, 0), (0.1, 0.1), {("down 2-nodding", 1), ("down 2-nodding", 0)}, {("down", 1)}),
    "inverted is born": (0.12904956189170, (math.pi, 0), (0.02, 0.002), {("inverted", 1)}, set()),
    "3-nodding is born": (0.46255521718229, (2.1837772, -0.0097489), (0.002, 0.002), {("inverted 3-nodding", 0)}, set()),
    "3-nodding flips": (0.47300943240971, (2.1407813, -0.0198527), (0.002, 0.002), {("inverted 6-nodding", 0)},
                        {("inverted 3-nodding", 0)}),
    "2-nodding loses its symmetry": (0.54148001976034, (-0.0161618, -0.3581809), (0.01, 0.01), {("down 2-nodding", 0)},
                                     {("down 2-nodding", 1)}),
    "flutter loses its symmetry": (0.56184564263138, (-2.0564952, -0.0136295), (0.02, 0.002), {("flutter", 0)}, {("flutter", 1)}),
}


@pytest.mark.parametrize("distance", with_extensive([1e-9], [-1e-9]))
@pytest.mark.parametrize("name", CRITICAL)
def test_either_side_of_a_bifurcation(basin, name, distance):
    """No attractor of the other side, none twice, and slow is not chaotic."""
    epsilon, centre, half_widths, not_below, not_above = CRITICAL[name]
    found = basin(around(centre[0], half_widths[0], 4), around(centre[1], half_widths[1], 4),
                  f"pendulum.drive_amplitude={epsilon + distance!r}", "basin.max_periods=1000")
    kinds = list(zip(found.names, found.symmetric.tolist(), strict=True))
    assert not set(kinds) & (not_below if distance < 0 else not_above)
    assert "chaotic" not in found.names
    assert all(kinds.count(kind) <= (1 if kind[1] else 2) for kind in kinds if "rotation" not in kind[0])


METHODS = ["direct", "icm"]
VELOCITY = around(0.5, 0.125, 1)
ACROSS = {0.150: {"down", "inverted"},
          0.300: {"down", "inverted", "down 6-nodding", "rotation +1/1", "rotation -1/1", "rotation +1/2",
                  "rotation -1/2", "rotation +2/6", "rotation -2/6"}}


def image(name):
    """What the mirror image of an attractor is called."""
    return name.translate(str.maketrans("+-", "-+")) if name.startswith("rotation") else name


# rad: cells that a method carries, with the steps that the program chooses and a table of 100 nodes; smaller ones are refused.
FINEST = {"direct": 1e-11, "icm": 1e-4}


def narrowest(low, high, method):
    """So many cells of [low, high], at most 1000, that the method carries."""
    return min(1000, int((high - low) / FINEST[method] * 1.001))


@pytest.fixture(scope="session")
def boundary(basin):
    """boundary(amplitude, method) -> (theta on one side, theta on the other, settings): bisected 1000-fold a run."""
    made = {}

    def call(amplitude, method):
        if (amplitude, method) in made:
            return made[amplitude, method]
        settings = [f"pendulum.drive_amplitude={amplitude}", f"basin.method={method}"]
        low, high = 0.0, 1.0
        while (count := narrowest(low, high, method)) > 1:
            found = basin((low, high, count), VELOCITY, *settings)
            assert found.ends() <= ACROSS[amplitude] | {None}
            labels, theta = found.labels[0], found.theta
            changes = np.flatnonzero((labels[1:] != labels[:-1]) & (labels[1:] >= 0) & (labels[:-1] >= 0))
            assert len(changes) > 0 and np.isfinite(theta).all()
            assert amplitude != 0.150 or high - low == 1 or len(changes) == 1
            middle = changes[len(changes) // 2]
            low, high = float(theta[middle]), float(theta[middle + 1])
        made[amplitude, method] = (low, high, settings)
        return made[amplitude, method]

    return call


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("amplitude", ACROSS)
def test_a_boundary_as_finely_as_a_method_goes(basin, boundary, amplitude, method):
    """Either side's attractor, or another one where the boundary is fractal, or none; mirrored starts to the bit."""
    low, high, settings = boundary(amplitude, method)
    assert high - low < 2.1 * FINEST[method]
    left, right = low - 64 * (high - low), high + 64 * (high - low)
    here = basin((left, right, 64), VELOCITY, *settings)
    there = basin((-right, -left, 64), (-VELOCITY[1], -VELOCITY[0], 1), *settings)
    assert here.ends() <= ACROSS[amplitude] | {None}
    assert (there.theta[::-1] == -here.theta).all()
    for label, mirrored, *periods in zip(here.labels[0], there.labels[0, ::-1], here.periods[0], there.periods[0, ::-1], strict=True):
        if label >= 0 and mirrored >= 0:
            assert here.names[label] == image(there.names[mirrored]) and periods[0] == periods[1]
        else:  # a table's orbit may end where no direct one of this window does
            assert label == mirrored or (image(here.names[label]) not in there.names if mirrored < 0 else
                                         image(there.names[mirrored]) not in here.names)


def test_the_boundary_is_where_quad_precision_puts_it(basin, boundary):
    low, high, settings = boundary(0.150, "direct")
    window = around((low + high) / 2, 4 * (high - low), 8)
    direct, exact = basin(window, VELOCITY, *settings), basin(window, VELOCITY, *settings, "basin.method=exact")
    for found in (direct, exact):
        assert (found.labels[0, :4] == found.labels[0, 0]).all() and (found.labels[0, 4:] == found.labels[0, -1]).all()
    assert direct.names == exact.names and (direct.labels == exact.labels).all() and len(direct.ends()) == 2
