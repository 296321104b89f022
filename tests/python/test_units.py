"""Pictures in the units of a laboratory: what a tick says is the value of its place in degrees, seconds, rad/s or Hz."""

import re

import numpy as np
import pytest
import xarray
from conftest import plot
from kapitza import Result, units
from kapitza.plots import basin, orbit, potential, sweep

SI = {"mass": 0.1, "radius": 0.2, "inertia": 0.004, "friction": 0.002, "gravity": 9.81, "pivot_amplitude": 0.06, "frequency": 12.25}
OMEGA = 2 * np.pi * 12.25


@pytest.fixture(scope="module")
def result(model):
    return model(SI, basin={"theta": {"count": 12}, "velocity": {"min": -2, "max": 2, "count": 10}, "attractors": {"starts": 64}},
                 orbit={"start": {"theta": 2.9, "velocity": 0}, "periods": 30}, potential={"drive_amplitudes": [0.3]})


def page(kind, result, *words):
    """The figure of a kind with these options, drawn."""
    figure = kind.draw(result, kind.parse_arguments(["x.h5", *words]))
    figure.draw_without_rendering()
    return figure


def ticks(axis):
    """[(place, number on its label)] of the ticks that are in sight."""
    low, high = sorted(axis.get_view_interval())
    labels = [label.get_text().replace("−", "-").rstrip("°") for label in axis.get_ticklabels()]
    texts = zip(axis.get_majorticklocs(), labels, strict=True)
    power = re.compile(r"10\^\{(-?\d+)\}")
    seen = [(place, text) for place, text in texts if low <= place <= high]
    return [(place, 10.0 ** int(power.search(text)[1]) if power.search(text) else float(text)) for place, text in seen]


def assert_shows(axis, label, low, high):
    """Ticks say the numbers of their places, over this range."""
    shown = ticks(axis)
    assert len(shown) >= 3 and label in axis.get_label_text()
    assert [number for _, number in shown] == pytest.approx([place for place, _ in shown], rel=1e-5, abs=1e-9)
    assert sorted(axis.get_view_interval()) == pytest.approx([low, high], rel=1e-9)


@pytest.mark.extensive
def test_a_measured_point_lands_on_its_cell(result):
    """Data coordinates are those of the labels: degrees and rad/s, also of dots, legends aside."""
    axes = page(basin, result, "--degrees", "--si").axes[0]
    assert_shows(axes.xaxis, "angle", -180, 180)
    assert_shows(axes.yaxis, "(rad/s)", -2 * OMEGA, 2 * OMEGA)
    (image,) = axes.images
    left, right, low, high = image.get_extent()
    labels, colours = result.labels(si=True, degrees=True), image.get_array()
    seen = {}
    for degrees, speed in ((173.0, 10.0), (3.0, -8.0), (100.0, 130.0), (-100.0, -130.0)):
        column, row = int((degrees - left) / (right - left) * 12), int((speed - low) / (high - low) * 10)
        label = labels.sel(theta=degrees, velocity=speed, method="nearest").item()
        assert result.at(f"{degrees} deg", f"{speed} rad/s")["attractor"] == label
        seen[label] = {tuple(colours[row, column]), *([seen[label].pop()] if label in seen else [])}
    assert all(len(found) == 1 for found in seen.values()) and len(set.union(*seen.values())) == len(seen) >= 2
    dots = [line for line in axes.lines if len(line.get_xdata())]
    assert any(np.any(np.abs(np.abs(line.get_xdata()) - 180) < 1e-6) for line in dots)  # the inverted state


@pytest.mark.extensive
def test_times_in_seconds(result):
    times = page(basin, result, "--si", "--quantity", "settling_time").axes[0].child_axes[0]
    longest = float(result.convergence_times(si=True).where(result.labels(si=True) >= 0).max())
    assert_shows(times.yaxis, "(s,", 1 / 12.25, longest + 1 / 12.25)
    assert longest == pytest.approx(float(result.convergence_times().where(result.labels() >= 0).max()) / 12.25)


@pytest.mark.extensive
def test_an_orbit_in_seconds_and_hertz(result):
    drive, lab = ({panel.get_label(): panel for panel in page(orbit, result, *words).axes} for words in ([], ["--degrees", "--si"]))
    for name, axis, label, factor in (("time", "x", "time (s)", 1 / 12.25), ("phase", "y", "(rad/s)", OMEGA),
                                      ("spectrum", "x", "(Hz)", 12.25), ("spectrum", "y", "(deg)", 180 / np.pi)):
        interval = getattr(drive[name], f"{axis}axis").get_view_interval()
        assert_shows(getattr(lab[name], f"{axis}axis"), label, *factor * np.sort(interval))
    assert lab["phase"].lines[0].get_ydata() == pytest.approx(OMEGA * drive["phase"].lines[0].get_ydata())


@pytest.mark.extensive
def test_potentials_and_strobe_points_in_degrees(result, swept):
    assert_shows(page(potential, result, "--degrees").axes[1].xaxis, "angle", 0, 360)
    for panel in page(sweep, Result(swept), "--view", "strobe", "--degrees").axes:
        assert_shows(panel.yaxis, "strobe", *panel.get_ylim())
        angles = np.mod(np.degrees(Result(swept).group("sweep")["strobe_theta"].values), 360)
        assert np.min(panel.lines[0].get_ydata()) == pytest.approx(np.min(angles), abs=20)
    plain, degrees = (page(sweep, Result(swept), "--view", "flutter", *words).axes[1] for words in ([], ["--degrees"]))
    assert degrees.lines[0].get_ydata() == pytest.approx((180 / np.pi) ** 2 * plain.lines[0].get_ydata())
    assert "degrees²" in degrees.get_ylabel()


def test_groups_say_their_units(result):
    plain, si = result.group("attractors"), result.group("attractors", si=True, degrees=True)
    assert si["strobe_velocity"].values == pytest.approx(OMEGA * plain["strobe_velocity"].values, nan_ok=True)
    assert si["strobe_theta"].attrs["units"] == "degree" and si["strobe_velocity"].attrs["units"] == "rad s-1"
    assert si["period"].equals(plain["period"]) and si["lyapunov"].values == pytest.approx(12.25 * plain["lyapunov"].values, nan_ok=True)
    labels = result.labels(si=True)
    assert labels["velocity"].attrs["units"] == "rad s-1" and labels["theta"].attrs["units"] == "rad"
    assert labels["velocity"].values == pytest.approx(OMEGA * result.labels()["velocity"].values)


def test_what_people_write_behind_a_number():
    assert [units.angle(text) for text in ("175 deg", "175°", "pi/2", "-3 pi/4", "π", "0.5pi", "2.5", 2.5)] == pytest.approx(
        [np.radians(175), np.radians(175), np.pi / 2, -3 * np.pi / 4, np.pi, np.pi / 2, 2.5, 2.5], rel=1e-15)
    assert units.velocity("3 rad/s", 60) == 0.05 and units.velocity("90 deg/s", 1) == pytest.approx(np.pi / 2)
    for wrong in ("up", "3 rad/s"):
        with pytest.raises(ValueError, match="is not an angle"):
            units.angle(wrong)
    with pytest.raises(ValueError, match="not in SI units"):
        units.velocity("3 rad/s", None)


def test_the_footer_says_an_amplitude_in_mm():
    """As the program's messages do; a length in the largest unit of which it is at least one."""
    found = units.si_parameters({"length": 0.2, "pivot_frequency": 100 * np.pi, "pivot_amplitude": 0.012, "quality_factor": 10})
    assert list(found.values()) == ["length 20 cm", "50 Hz", "amplitude 12 mm", "Q = 10"]


@pytest.mark.parametrize("text", ["2 deg", "2deg", "2e0°"])
def test_a_sweep_keeps_the_unit_that_was_written(text):
    found = xarray.Dataset(coords={"value": ("value", np.radians([2, 5]), {"units": "rad"})})
    value = units.written_units(found, f"sweep: {{min: {text}, max: 5 deg}}")["value"]
    assert value.values == pytest.approx([2, 5]) and value.attrs["units"] == text.lstrip("2e0 ")


@pytest.mark.extensive
def test_starts_are_looked_up(result, small_result):
    """The angle is wrapped; outside the window there is no answer. `labels().sel(..., method="nearest")` clamps."""
    again = result.at(["190 deg", "-170 deg", np.radians(190) - 20 * np.pi], 0.1)
    assert len(again) == 3 and again["attractor"].nunique() == 1 and again["theta"].values == pytest.approx(np.radians(-170))
    one = result.at("190 deg", 0.1)
    assert one["name"] == again["name"][0]
    assert one["attractor"] == result.labels().sel(theta=np.radians(-170), velocity=0.1, method="nearest").item()
    for theta, velocity in ((0, 2.01), (0, "-154 rad/s"), (np.nan, 0)):
        with pytest.raises(ValueError, match="outside the window"):
            result.at(theta, velocity)
    with pytest.raises(ValueError, match="not in SI units"):
        Result(small_result).at(0, "3 rad/s")


def test_si_needs_a_scene_in_si(small_result, tmp_path):
    done = plot("basin", small_result, "-o", tmp_path / "x.png", "--si")
    assert done.returncode == 1 and "its scene is not in SI units" in done.stderr and not list(tmp_path.iterdir())
