"""kapitza plot orbit draws every kind of orbit, draws what the file says, and refuses files without one in one line."""

import json

import matplotlib.image
import numpy as np
import pytest
from conftest import plot as plot_kind
from conftest import with_extensive
from kapitza import style
from kapitza.plots import orbit as orbit_plot

BLACKBURN = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
ORBITS = {
    "nodding": (BLACKBURN, {"start": {"theta": 0.1551784805487, "velocity": 0.29665394403367}, "closed": True}),
    "rotation": (BLACKBURN, {"start": {"theta": 3.0164225972238, "velocity": 1.0688105148992}, "closed": True}),
    "rest": (BLACKBURN, {"start": {"theta": 0, "velocity": 0}, "closed": True}),
    "long": (BLACKBURN, {"start": {"theta": 3, "velocity": 0.1}, "periods": 1500}),
    "closed and long": (BLACKBURN, {"start": {"theta": 0.1551784805487, "velocity": 0.29665394403367}, "closed": True,
                                    "periods": 600}),
    "open": (BLACKBURN, {"start": {"theta": 3, "velocity": 0.1}, "periods": 50}),
    "chaotic": ({"k": 0.25, "damping": 0.05, "m": 0.5}, {"start": {"theta": 1, "velocity": 0.2}, "periods": 100}),
    "slow": (BLACKBURN, {"start": {"theta": 3, "velocity": 0}, "periods": 50, "model": "effective"}),
    "linear": ({"k": 0, "damping": 0, "m": 0.4540231668672888},
               {"start": {"theta": 0, "velocity": 0.1}, "model": "mathieu", "closed": True, "period": 2}),
}

COMMON = ("nodding",)


@pytest.fixture(scope="module")
def files(kapitza, tmp_path_factory):
    """A result file of every kind of orbit."""
    folder = tmp_path_factory.mktemp("orbits")
    for name, (pendulum, orbit) in ORBITS.items():
        (folder / f"{name}.yaml").write_text(json.dumps({"title": f"A {name} orbit", "pendulum": pendulum,
                                                         "orbit": orbit}))
        kapitza("run", folder / f"{name}.yaml", "-o", folder / f"{name}.h5")
    return folder


def plot(*arguments):
    return plot_kind("orbit", *arguments)


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.extensive] * (name not in COMMON))
                                  for name in ORBITS])
def test_every_orbit_is_drawn(files, tmp_path, name):
    done = plot(files / f"{name}.h5", "-o", tmp_path / "out.png", "--dpi", 100)
    assert (done.returncode, done.stderr) == (0, "")
    image = matplotlib.image.imread(tmp_path / "out.png")
    assert image.shape[1] > 700 and image[..., :3].std() > 0.05


@pytest.mark.extensive
def test_the_picture_says_what_the_file_holds(files, tmp_path):
    assert plot(files / "nodding.h5", "-o", tmp_path / "out.svg").returncode == 0
    text = (tmp_path / "out.svg").read_text()
    for words in ("A nodding orbit", "down 6-nodding", "period 6", "line 1/6", "1/6", "strobe points",
                  "angle from down (deg)"):
        assert words in text, words


@pytest.fixture
def axes_of(files, monkeypatch):
    """axes_of(name, *options): the panels of the picture, by name, with what --last printed in the title line."""
    def call(name, *options):
        kept = {}
        monkeypatch.setattr(orbit_plot, "lay_out",
                            lambda panels: kept.update(zip(("figure", "axes"), lay_out(panels), strict=True))
                            or (kept["figure"], kept["axes"]))
        monkeypatch.setattr(style, "save", lambda figure, output, dpi: figure.draw_without_rendering())
        done = plot(files / f"{name}.h5", *options)
        assert (done.returncode, done.stderr) == (0, "")
        return kept["axes"], " ".join(text.get_text() for text in kept["figure"].texts)
    lay_out = orbit_plot.lay_out
    return call


@pytest.mark.parametrize("name, options", with_extensive([("rest", [])], [("long", []), ("long", ["--last", "20"])]))
def test_rounding_noise_is_no_motion(axes_of, name, options):
    """At rest, or settled long before the last periods: an axis that magnifies 1e-15 would show lively motion."""
    axes, _ = axes_of(name, *options)
    assert np.ptp(axes["time"].get_ylim()) > 0.1
    assert np.ptp(axes["phase"].get_xlim()) > 0.1 and np.ptp(axes["phase"].get_ylim()) > 1e-3
    assert any("at rest" in text.get_text() for text in axes["time"].texts)
    low, high = axes["spectrum"].get_ylim()
    assert low < high
    if name == "rest":
        assert axes["spectrum"].get_yscale() == "linear" and not axes["spectrum"].lines
        assert not axes["spectrum"].collections


@pytest.mark.extensive
def test_long_records_show_their_last_periods(axes_of):
    axes, words = axes_of("long")
    assert axes["time"].get_xlim() == pytest.approx((1400, 1500)) and "last 100 periods" in words
    axes, words = axes_of("long", "--last", "1500")
    assert axes["time"].get_xlim() == pytest.approx((0, 1500)) and "last" not in words and not axes["time"].texts
    axes, words = axes_of("open", "--last", "10")
    assert axes["time"].get_xlim() == pytest.approx((40, 50)) and "last 10 periods" in words
    strobes = next(line for line in axes["phase"].lines if line.get_label() == "strobe points")
    assert len(strobes.get_xdata()) == 11


@pytest.mark.extensive
def test_a_long_closed_orbit_shows_one_round(axes_of):
    axes, words = axes_of("closed and long")
    assert axes["time"].get_xlim() == pytest.approx((0, 6)) and "last" not in words


@pytest.mark.extensive
@pytest.mark.parametrize("name, words", [("chaotic", ["chaotic", "velocity (rad per drive radian),"]),
                                         ("open", ["open record   |   settles on inverted", "amplitude (rad),"])])
def test_open_records_say_what_they_are(files, tmp_path, name, words):
    assert plot(files / f"{name}.h5", "-o", tmp_path / "out.svg").returncode == 0
    text = (tmp_path / "out.svg").read_text()
    assert all(word in text for word in words), words


def test_what_cannot_be_drawn(made_file, tmp_path):
    done = plot(made_file, "-o", tmp_path / "out.png")
    assert (done.returncode,
            done.stderr) == (1, f"kapitza: error: {made_file}: holds no orbit (studies in it: attractors, basin)\n")
    assert plot(made_file, "--panels", "tiem").returncode == 2
    assert plot(made_file, "-o", "out.gif").returncode == 2
    for last in ("0", "-3", "nan", "long"):
        assert plot(made_file, "--last", last).returncode == 2
