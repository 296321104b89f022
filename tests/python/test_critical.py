"""Near a bifurcation and on a basin's boundary: the right label or none, never a wrong one (docs/validation/extremes.md)."""

import math

import h5py
import numpy as np
import pytest
from conftest import ROOT

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


@pytest.mark.parametrize("distance", [-1e-8, -1e-9, 1e-9])
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


@pytest.mark.parametrize("distance", [1e-6, 1e-9, 1e-10])
def test_inverted_is_labelled_close_below_its_flip(basin, distance):
    found = basin(around(math.pi, 0.3, 4), around(0, 0.02, 4), f"pendulum.drive_amplitude={0.46819030239029 - distance!r}")
    assert found.ends() == {"inverted"}


@pytest.mark.parametrize("scheme, steps, distance", [("split6", 24, 1e-4), ("split6", 24, 1e-6), ("split6", 12, 1e-5), ("rk4", 100, 1e-6)])
def test_flutter_grows_as_the_square_root(basin, scheme, steps, distance):
    """Coarse steps, whose own flutter lies elsewhere, are labelled too."""
    found = basin(around(math.pi, 0.3, 4), around(0, 0.02, 4), f"pendulum.drive_amplitude={0.46819030239029 + distance!r}",
                  "basin.max_periods=20000", f"numerics.scheme={scheme}", f"numerics.steps_per_period={steps}")
    assert found.ends() == {"flutter"} and len(found.names) == 1
    assert abs(found.amplitude[0] / math.sqrt(distance) - 3.7926) < 0.01


# The lowest point of the second tongue (Q = 5): two mirror images of period 1 part from `down`, 5.04 sqrt(m - m_c) rad apart.
TONGUE_K, TONGUE_M = 1.0856905702485, 0.9955473346077346


@pytest.mark.parametrize("apart, steps", [(1e-4, 192), (1e-6, 192), (1e-5, 24), (1e-6, 48)])
def test_mirror_images_close_together(basin, apart, steps):
    """The scene's own steps move m_c: with 24 or 48 the nearer pairs are not there, with the 192 of published values they are."""
    pendulum = f"pendulum={{k: {TONGUE_K!r}, damping: {math.sqrt(TONGUE_K) / 5!r}, m: {TONGUE_M + (apart / 5.04) ** 2!r}}}"
    found = basin((-2 * apart, 2 * apart, 16), (-2 * apart, 2 * apart, 16), pendulum, "basin.max_periods=100",
                  f"numerics.steps_per_period={steps}")
    if steps == 192 and apart > 5e-6:
        assert found.names == ["down", "down"] and list(found.mirror) == [1, 0] and (found.labels >= 0).sum() > 20
        assert abs(np.linalg.norm(found.strobe[0] - found.strobe[1]) / apart - 1) < 0.01
    assert (found.labels >= 0).sum() == 0 or not found.symmetric.any()
    for (row, column), label in np.ndenumerate(found.labels):
        mirrored = found.labels[-1 - row, -1 - column]
        assert mirrored == (found.mirror[label] if label >= 0 else -1)
        if label >= 0:
            cell = np.array([found.theta[column], found.velocity[row]])
            assert np.linalg.norm(cell - found.strobe[label]) < np.linalg.norm(cell + found.strobe[label])


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


def test_starts_on_an_unstable_cycle(kapitza, basin, boundary, tmp_path):
    """The saddle whose stable manifold is the boundary: starts on it, and beside it, end on either side or nowhere."""
    low, _, settings = boundary(0.150, "direct")
    (tmp_path / "saddle.yaml").write_text("pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.150}\n"
                                          f"orbit: {{start: {{theta: {low!r}, velocity: 0.5}}, transient: 40, closed: true}}\n")
    kapitza("run", "saddle.yaml", folder=tmp_path)
    with h5py.File(tmp_path / "saddle.h5") as file:
        orbit = file["orbit"]
        assert orbit.attrs["period"] == 1 and orbit.attrs["multiplier_re"] > 1.4
        theta, velocity = orbit["strobe_theta"][0], orbit["strobe_velocity"][0]
    for width in (1e-3, 1e-9, 1e-10):
        found = basin(around(theta, 1.5 * width, 3), around(velocity, 1.5 * width, 3), *settings)
        assert found.ends() <= {"down", "inverted", None} and len(found.names) <= 2
        assert width < 1e-4 or found.ends() == {"down", "inverted"}
